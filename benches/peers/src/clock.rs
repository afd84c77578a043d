use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

/// What `work` returns and the CPU time that this thread spent on it: other programs disturb it less than the wall clock.
pub fn time<R>(work: impl FnOnce() -> R) -> (R, Duration) {
    let before = now();
    let result = work();
    (result, now() - before)
}

fn now() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// The middle of `values`, the mean of the two in the middle of an even number; NaN of none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match (values.len() / 2, values.len() % 2) {
        (0, 0) => f64::NAN,
        (middle, 0) => (values[middle - 1] + values[middle]) / 2.0,
        (middle, _) => values[middle],
    }
}
