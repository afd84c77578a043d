use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

/// What `work` returns and the CPU time that this thread spent on it: other programs disturb it less than the wall clock.
pub fn time<R>(work: impl FnOnce() -> R) -> (R, Duration) {
    timed(ClockId::ThreadCPUTime, work)
}

/// What `build` returns and the CPU time of all threads of this process.
///
/// What takes less than a second is done twice: the first time also pays for fresh pages.
pub fn time_build<R>(mut build: impl FnMut() -> R) -> (R, Duration) {
    let (first, once) = timed(ClockId::ProcessCPUTime, &mut build);
    if once >= Duration::from_secs(1) {
        return (first, once);
    }
    drop(first);
    let (second, again) = timed(ClockId::ProcessCPUTime, build);
    (second, once.min(again))
}

fn timed<R>(clock: ClockId, work: impl FnOnce() -> R) -> (R, Duration) {
    let now = || {
        let time = clock_gettime(clock);
        Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
    };
    let before = now();
    let result = work();
    (result, now() - before)
}

/// The middle of `values`, the mean of the two in the middle of an even number; NaN of none.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    match (values.len() / 2, values.len() % 2) {
        (0, 0) => f64::NAN,
        (middle, 0) => (values[middle - 1] + values[middle]) / 2.0,
        (middle, _) => values[middle],
    }
}
