use hitscan::Primitives;

use super::{Chip, Prediction};
use crate::{
    failure::Failure,
    scene::{Built, Choice, Named, Preset},
    trial::Rays,
};

/// The structure, of those asked for and in every preset, that takes a ray the fewest instructions on a chip and at most so
/// many bytes when it is baked: a function of counts and of the table of costs, the same every time and everywhere.
pub fn choose<P: Primitives + Sync>(
    primitives: &P,
    chip: Chip,
    choice: Choice,
    most: Option<usize>,
) -> Result<Built, Failure> {
    let asked: Vec<&Named> = match choice {
        Choice::Auto => Named::ALL.iter().filter(|named| named.is_candidate).collect(),
        Choice::Named(named) => vec![named],
    };
    let (mut tried, mut refused) = (Vec::new(), None);
    for (named, preset) in asked.into_iter().flat_map(|named| Preset::ALL.map(|preset| (named, preset))) {
        match Built::named(primitives, named, preset, most) {
            Ok(built) => tried.push(built),
            Err(failure) => refused = Some(failure),
        }
    }
    let Some(first) = tried.first() else {
        return Err(refused.unwrap_or_else(|| Failure::new("there is no structure", "choose one with --structure")));
    };
    let rays = Rays::around(&*first.scene(primitives)?);
    let mut best: Option<(f64, Built)> = None;
    let mut least = None;
    for built in tried {
        let Some(prediction) = Prediction::new(chip, &built, primitives, &rays)? else { continue };
        let bytes = built.baked_bytes(primitives)?;
        least = Some(least.unwrap_or(bytes).min(bytes));
        if most.is_some_and(|most| bytes > most) {
            continue;
        }
        if best.as_ref().is_none_or(|(typical, _)| prediction.typical < *typical) {
            best = Some((prediction.typical, built.because(prediction.to_string())));
        }
    }
    best.map(|(_, built)| built).ok_or_else(|| match least {
        Some(least) => Failure::Crowded { allowed: most.unwrap_or_default(), least },
        None => {
            Failure::new("nobody measured what this structure takes over pairs", "choose --structure grid or kdtree")
        }
    })
}
