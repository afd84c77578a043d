//! Which structure suits the primitives: found by trying all and counting, the same for `--structure auto` and `compare`.

mod rays;
mod recommend;
mod work;

use hitscan::Primitives;

pub use rays::{Rays, outside};
pub use recommend::{Candidate, Recommendation, by_number, recommend};
pub use work::{Counts, Work, scene};

use crate::{
    failure::Failure,
    scene::{Built, Named, Preset},
};

/// Builds what `compare` recommends for these primitives, if it is in at most so many bytes.
pub fn choose<P: Primitives + Sync>(primitives: &P, preset: Preset, most: Option<usize>) -> Result<Built, Failure> {
    if let Some(Recommendation { named, why }) = by_number(primitives.len()) {
        return Ok(Built::named(primitives, named, preset, most)?.because(why));
    }
    let (mut tried, mut refused) = (Vec::new(), None);
    for named in Named::ALL.iter().filter(|named| named.is_candidate) {
        match Built::named(primitives, named, preset, most) {
            Ok(built) => tried.push((named, built.baked_bytes(primitives)?, built)),
            Err(failure) => refused = Some(failure),
        }
    }
    let fits = |(_, bytes, _): &(&Named, usize, Built)| most.is_none_or(|most| *bytes <= most);
    // Where nothing fits, the caller says so of whatever it gets.
    if tried.iter().any(fits) {
        tried.retain(fits);
    }
    let mut rays = Rays::default();
    if let Some((_, _, first)) = tried.first() {
        rays = Rays::around(&*first.scene(primitives)?);
    }
    let mut candidates = Vec::new();
    for (named, bytes, built) in &tried {
        let counts = Counts::default();
        let scene = scene(built.structure(primitives)?, primitives, Some(&counts))?;
        let work = Work::of(&*scene, &counts, rays.bounce.iter());
        candidates.push(candidate(named, *bytes, primitives.len(), work));
    }
    let best = recommend(&candidates, preset);
    let chosen = best.and_then(|Recommendation { named, why }| {
        let place = tried.iter().position(|(other, ..)| *other == named)?;
        Some(tried.swap_remove(place).2.because(why))
    });
    let nothing = || Failure::new("no structure can be built", "choose one with --structure");
    chosen.ok_or_else(|| refused.unwrap_or_else(nothing))
}

/// A structure that takes so many bytes in all once it is baked, and so much work for a ray.
pub fn candidate(named: &'static Named, bytes: usize, primitives: u32, work: Work) -> Candidate {
    let bytes = bytes as f64 / f64::from(primitives.max(1));
    Candidate { named, bytes, work: work.in_tests(named.node_cost) }
}
