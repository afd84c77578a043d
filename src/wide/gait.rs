//! How the rays of a batch go: which of the walks is the fastest for them.

use fearless_simd::Simd;

use super::{
    batch::{self, RUNNERS},
    coherence::Coherence,
    packet::{self, Packet},
    tree::Tree,
    walk,
};
use crate::{geometry::Ray, primitives::Hit};

/// So few rays walk alone.
const FEWEST: usize = 16;

/// Bytes of a tree that does not fit into the nearer caches.
const LARGE: usize = 16 << 20;

/// The sine of the angle between neighbours that go together: 6 degrees.
const CLOSE: f32 = 0.1;

/// That in a large tree, a seventh of a degree: others soon part there, and then wait for memory one after the other.
const CLOSE_IN_LARGE: f32 = 0.0025;

/// So few rays are not worth a [sample](is_better_alone).
const FEW: usize = 16 * RUNNERS;

/// How rays go.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Gait {
    /// One after the other.
    Alone,
    /// Some at a time, by turns.
    ByTurns,
    /// Neighbours together.
    Together,
}

impl Gait {
    /// That of these rays. Where neighbours go the same way but vectors are short, the processor guesses right what each will
    /// meet, so that one after the other is fastest, unless the tree is so large that they wait for memory.
    fn of(tree: &Tree, coherence: Coherence, rays: &[Ray], packets: bool) -> Self {
        let is_large = tree.bytes() >= LARGE;
        if rays.len() < FEWEST {
            Self::Alone
        } else if !coherence.is_found(rays, if is_large { CLOSE_IN_LARGE } else { CLOSE }) {
            Self::ByTurns
        } else if packets {
            Self::Together
        } else if is_large {
            Self::ByTurns
        } else {
            Self::Alone
        }
    }
}

/// Whether a few of the rays look at far fewer blocks if they walk alone: by distance, where by turns they have the order of their
/// octant, which is a poor one among long and flat boxes around where they begin.
#[inline(always)]
pub(super) fn is_better_alone<S: Simd>(simd: S, tree: &Tree, rays: &[Ray]) -> bool {
    let step = (rays.len() / RUNNERS).max(1);
    let sample: heapless::Vec<Ray, RUNNERS> = rays.iter().step_by(step).take(RUNNERS).copied().collect();
    // Not by a closure, which has not the kernel's instructions.
    let mut alone = 0;
    for ray in &sample {
        alone += walk::tested(simd, tree, ray);
    }
    let by_turns = batch::run(simd, tree, &sample, &mut [None; RUNNERS][..]);
    3 * by_turns > 4 * alone
}

/// The least hits of `rays`.
#[inline(always)]
pub(super) fn closest<S: Simd>(simd: S, tree: &Tree, coherence: Coherence, rays: &[Ray], hits: &mut [Option<Hit>]) {
    let rays = rays.get(..hits.len()).unwrap_or(rays);
    let mut gait = Gait::of(tree, coherence, rays, Packet::<S>::PAYS);
    let measured = coherence == Coherence::Measured && rays.len() >= FEW && tree.bytes() < LARGE;
    let alone = simd.vectorize(
        #[inline(always)]
        || gait == Gait::ByTurns && measured && is_better_alone(simd, tree, rays),
    );
    if alone {
        gait = Gait::Alone;
    }
    if gait == Gait::Alone {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = walk::closest(simd, tree, ray);
        }
    } else if Packet::<S>::PAYS && gait == Gait::Together {
        packet::run(simd, tree, rays, hits);
    } else {
        batch::run(simd, tree, rays, hits);
    }
}

/// Whether `rays` have hits.
#[inline(always)]
pub(super) fn any<S: Simd>(simd: S, tree: &Tree, coherence: Coherence, rays: &[Ray], hits: &mut [bool]) {
    let rays = rays.get(..hits.len()).unwrap_or(rays);
    let gait = Gait::of(tree, coherence, rays, Packet::<S>::PAYS);
    if gait == Gait::Alone {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = walk::any(simd, tree, ray);
        }
    } else if Packet::<S>::PAYS && gait == Gait::Together {
        packet::run(simd, tree, rays, hits);
    } else {
        batch::run(simd, tree, rays, hits);
    }
}
