use std::time::Duration;

use hitscan::{Hit, Ray, render::Caster};

use crate::hits::HitRecord;

/// What is asked of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// The first hit.
    Closest,
    /// Whether there is one.
    Any,
}

impl Query {
    /// The answer to a ray.
    fn ask(self, scene: &dyn Caster, ray: &Ray) -> HitRecord {
        let record = |Hit { t, primitive }| HitRecord { t, primitive };
        match self {
            Self::Closest => scene.closest_hit(ray, 0).map_or(HitRecord::MISS, record),
            Self::Any if scene.any_hit(ray, 0) => HitRecord { t: 0.0, primitive: 0 },
            Self::Any => HitRecord::MISS,
        }
    }

    /// Puts the answers to each `stride`th of `rays` into `answers`; the seconds that it took.
    pub fn time(self, scene: &dyn Caster, rays: &[Ray], stride: usize, answers: &mut Vec<HitRecord>) -> f64 {
        answers.clear();
        answers.reserve(rays.len() / stride + 1);
        time(|| answers.extend(rays.iter().step_by(stride).map(|ray| self.ask(scene, ray)))).1
    }
}

/// What `work` returns, and the seconds that it took.
pub fn time<R>(work: impl FnOnce() -> R) -> (R, f64) {
    let begun = now();
    let result = work();
    (result, (now() - begun).as_secs_f64())
}

/// The time that this thread has spent working: other programs disturb it less than the time of day.
#[cfg(unix)]
fn now() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// The time that has passed, where there is no better clock.
#[cfg(not(unix))]
fn now() -> Duration {
    use std::{sync::LazyLock, time::Instant};
    static BEGUN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGUN.elapsed()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_is_found() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(Vec::new()).is_nan());
    }
}
