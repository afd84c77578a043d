use hitscan::{Mesh, Primitives, Ray, render::Caster};

use super::{
    Made, Row,
    clock::{Query, median, time},
};
use crate::{
    difference::answer,
    failure::Failure,
    hits::HitRecord,
    progress::Progress,
    scene::Preset,
    trial::{Counts, Rays, Work},
    units::count,
};

/// Nodes and tests that a row is given for one kind of rays in one round; slower ones answer only some of the rays.
const STEPS: f64 = 2.0e7;

/// Rays on which the work of a row is estimated first.
const FIRST_LOOK: usize = 16;

/// What was measured of a row with one mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Seconds that building took.
    pub build: f64,
    /// Bytes in all.
    pub bytes: f64,
    /// Bytes once it is baked, by which structures are recommended.
    pub baked: f64,
    /// Bytes per triangle.
    pub per_triangle: f64,
    /// Nodes and tests of a bounce ray.
    pub work: Work,
    /// The same on the rays of a trial, by which structures are recommended.
    pub trial: Work,
    /// Million primary, bounce and shadow rays per second.
    pub speeds: [f64; 3],
    /// How many times faster bounce rays are than with the first row, the list.
    pub gain: f64,
}

/// A row and what came of it: or why nothing could.
pub type Entry = (Row, Result<Outcome, String>);

/// What a row has built, as a scene, and what is measured of it.
struct Entrant<'a> {
    scene: Box<dyn Caster + 'a>,
    /// It answers each so manieth ray.
    stride: usize,
    outcome: Outcome,
    /// Seconds per ray, by kind and round.
    times: [Vec<f64>; 3],
}

/// Rays and how often they are cast.
#[derive(Debug)]
pub struct Contest<'a> {
    /// The rays.
    pub rays: &'a Rays,
    /// Those by which structures are recommended.
    pub trial: &'a [Ray],
    /// How often each row casts them all.
    pub rounds: usize,
    /// What the structures are tuned for.
    pub preset: Preset,
}

impl Contest<'_> {
    /// Builds all `rows` over `mesh`, casts the rays in turns and compares the answers.
    pub fn run(&self, mesh: Mesh<'_>, rows: &[Row]) -> Result<Vec<Entry>, Failure> {
        let made: Vec<_> = rows.iter().map(|row| time(|| row.make(&mesh, self.preset))).collect();
        let progress = Progress::bar("comparing", (rows.len() * (self.rounds * 3 + 1)) as u64);
        let mut entrants = Vec::new();
        for (row, (made, build)) in rows.iter().zip(&made) {
            entrants.push(match made {
                Ok(made) => Ok(self.enter(row, &**made, made.seconds().unwrap_or(*build), mesh)?),
                Err(failure) => Err(failure.to_string()),
            });
            progress.advance(1);
        }
        let mut answers = Vec::new();
        for round in 0..self.rounds {
            for (kind, (what, query, rays)) in self.kinds().into_iter().enumerate() {
                let mut expected = vec![None; rays.len()];
                for (row, entrant) in rows.iter().zip(&mut entrants) {
                    let Ok(entrant) = entrant else { continue };
                    let seconds = query.time(&*entrant.scene, rays, entrant.stride, &mut answers);
                    if !answers.is_empty() {
                        entrant.times[kind].push(seconds / answers.len() as f64);
                    }
                    if round == 0 {
                        check(row.name, what, &answers, entrant.stride, &mut expected)?;
                    }
                    progress.advance(1);
                }
            }
        }
        let outcomes = entrants.into_iter().map(|entrant| {
            let Entrant { outcome, times, .. } = entrant?;
            Ok(Outcome { speeds: times.map(|times| 1.0e-6 / median(times)), ..outcome })
        });
        let mut entries: Vec<Entry> = rows.iter().copied().zip(outcomes).collect();
        let baseline = entries.first().and_then(|(_, outcome)| Some(outcome.as_ref().ok()?.speeds[1]));
        for (_, outcome) in &mut entries {
            if let Ok(outcome) = outcome {
                outcome.gain = outcome.speeds[1] / baseline.unwrap_or(f64::NAN);
            }
        }
        Ok(entries)
    }

    /// The kinds of rays and what is asked of them.
    fn kinds(&self) -> [(&'static str, Query, &[Ray]); 3] {
        let Rays { primary, bounce, shadow } = self.rays;
        [("primary", Query::Closest, primary), ("bounce", Query::Closest, bounce), ("shadow", Query::Any, shadow)]
    }

    /// Opens what a row has made, and counts what its rays take.
    fn enter<'m>(&self, row: &Row, made: &'m dyn Made, build: f64, mesh: Mesh<'m>) -> Result<Entrant<'m>, Failure> {
        let bounce = &self.rays.bounce;
        let work = |rays: &[Ray], stride| {
            if !made.is_counted() {
                return Ok(Work { nodes: f64::NAN, tests: f64::NAN });
            }
            let counts = Counts::default();
            Ok::<_, Failure>(Work::of(&*made.scene(mesh, Some(&counts))?, &counts, rays.iter().step_by(stride)))
        };
        // A few rays tell how many more can be afforded.
        let first = work(bounce, bounce.len().div_ceil(FIRST_LOOK).max(1))?;
        // NaN, of what is not counted, becomes 1.
        let stride =
            ((first.nodes + first.tests) * bounce.len() as f64 / STEPS).ceil().clamp(1.0, 1.0e9).max(1.0) as usize;
        let bytes = made.bytes() as f64;
        let outcome = Outcome {
            build,
            bytes,
            baked: made.baked_bytes(&mesh)? as f64,
            per_triangle: bytes / f64::from(mesh.len().max(1)),
            work: work(bounce, stride)?,
            trial: if row.is_candidate() { work(self.trial, 1)? } else { Work::default() },
            ..Outcome::default()
        };
        Ok(Entrant { scene: made.scene(mesh, None)?, stride, outcome, times: Default::default() })
    }
}

/// Compares a row's answers bit for bit with those of the rows before it, of which the first that answered a ray counts.
fn check(
    name: &'static str,
    what: &'static str,
    answers: &[HitRecord],
    stride: usize,
    expected: &mut [Option<(&'static str, HitRecord)>],
) -> Result<(), Failure> {
    let (mut differ, mut first) = (0_usize, None);
    let slots = expected.iter_mut().enumerate().step_by(stride);
    for ((ray, slot), found) in slots.zip(answers) {
        let (by, expected) = *slot.get_or_insert((name, *found));
        if (expected.t.to_bits(), expected.primitive) != (found.t.to_bits(), found.primitive) {
            differ += 1;
            first.get_or_insert((ray, by, expected, *found));
        }
    }
    match first {
        None => Ok(()),
        Some((ray, by, expected, found)) => Err(Failure::Disagreement(format!(
            "{name} answers {} {what} rays otherwise than {by}, first ray {ray}: {} instead of {}",
            count(differ),
            answer(found),
            answer(expected),
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bit_is_enough_to_disagree() {
        let hit = |t: f32, primitive| HitRecord { t, primitive };
        let mut expected = vec![None; 5];
        check("list", "bounce", &[hit(1.0, 0), HitRecord::MISS, hit(2.0, 1)], 2, &mut expected).unwrap();
        let mut answers = [hit(1.0, 0), hit(7.0, 7), HitRecord::MISS, hit(8.0, 8), hit(2.0, 1)];
        check("tree", "bounce", &answers, 1, &mut expected).unwrap();
        answers[4].t = 2.0_f32.next_up();
        answers[1].primitive = 6;
        let error = check("grid", "bounce", &answers, 1, &mut expected).unwrap_err().to_string();
        let start = "grid answers 2 bounce rays otherwise than tree, first ray 1: 6 at t = 7 instead of 7 at t = 7: ";
        assert!(error.starts_with(start), "{error}");
    }
}
