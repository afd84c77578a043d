//! The builder: the order of the primitives, the links of the pairs, their boxes, the leaves; each a pass over words.
//!
//! ```text
//! | header | items 7n, neighbours n; then pairs 8 (n - 1) | list n | lefts n | scratch |
//! ```

use super::{
    Bvh, HEADER_WORDS,
    collapse::{Marks, collapse},
    descend::descend,
    fit::fit,
    node::{Link, MAX_NUMBER, Node, PAIR_WORDS, Pair, Planes, Surface},
    open::{is_narrow, list_words},
    options::{Method, Options},
    ploc,
    reinsert::{order, reinsert},
    sah,
};
use crate::{
    accel::leaf::References,
    arena::Full,
    error::BuildError,
    geometry::Aabb,
    primitives::{Primitives, bounds_of},
};

/// A primitive, or what became of several, and its box.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Item {
    pub(super) bounds: Aabb,
    pub(super) number: u32,
}

/// Words of scratch per primitive behind list and lefts.
const fn scratch_words(method: Method) -> usize {
    match method {
        Method::Sah => 2,
        Method::Ploc => ploc::NODE_WORDS,
    }
}

/// See [`Bvh::words`].
pub(super) const fn words(primitives: usize, options: &Options) -> usize {
    primitives.saturating_mul(PAIR_WORDS + 2 + scratch_words(options.method)).saturating_add(HEADER_WORDS)
}

/// The words, divided.
struct Stage<'w> {
    header: &'w mut [u32],
    front: &'w mut [u32],
    /// Which primitive stands at which position.
    list: &'w mut [u32],
    /// By pair, how many positions its left part has; and scratch.
    back: &'w mut [u32],
}

impl<'w> Stage<'w> {
    fn new(words: &'w mut [u32], primitives: usize) -> Option<Self> {
        let (header, rest) = words.split_at_mut_checked(HEADER_WORDS)?;
        let (front, rest) = rest.split_at_mut_checked(primitives * PAIR_WORDS)?;
        let (list, back) = rest.split_at_mut_checked(primitives)?;
        Some(Self { header, front, list, back })
    }
}

/// Writes a hierarchy over `primitives` to the front of `words`; how many it took.
pub(super) fn build<P: Primitives + ?Sized>(
    primitives: &P,
    words: &mut [u32],
    options: &Options,
) -> Result<usize, BuildError> {
    let count = primitives.len();
    if count > MAX_NUMBER {
        return Err(BuildError::TooMany { limit: MAX_NUMBER });
    }
    let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
    let full = Full { at_least: self::words(count as usize, options), available: words.len() };
    let words = words.get_mut(..full.at_least).ok_or(full)?;
    let stage = Stage::new(words, count as usize).ok_or(full)?;
    let pairs = stage.run(primitives, bounds, options).ok_or(full)?;
    let bytes = (HEADER_WORDS + pairs as usize * PAIR_WORDS) * 4;
    match options.max_bytes {
        Some(allowed) if bytes > allowed => Err(BuildError::Budget { at_least: bytes, allowed }),
        _ => Ok(pack(words, count as usize, pairs as usize)),
    }
}

impl Stage<'_> {
    fn run<P: Primitives + ?Sized>(self, primitives: &P, bounds: Aabb, options: &Options) -> Option<u32> {
        let Self { header, front, list, back } = self;
        let count = primitives.len();
        match options.method {
            Method::Sah => sah::order(primitives, front, list, back)?,
            Method::Ploc => ploc::order(primitives, &bounds, front, list, back)?,
        }
        let (pairs, _) = front.split_at_mut_checked((count.max(1) - 1) as usize * PAIR_WORDS)?;
        let pairs: &mut [Pair] = bytemuck::try_cast_slice_mut(pairs).ok()?;
        let (lefts, scratch) = back.split_at_mut_checked(count as usize)?;
        let (parents, scratch) = scratch.split_at_mut_checked(count as usize)?;
        let lattice = Bvh::lattice(&bounds);
        let surface = Surface::within(&bounds);
        link(count, lefts, pairs);
        fit(pairs, References::wide(list), primitives, &lattice);
        if options.reinsertions > 0 && count > 2 {
            reinsert(pairs, parents, scratch, surface, options.reinsertions);
            order(pairs, scratch, list, parents, lefts);
            copy(list, parents);
            link(count, lefts, pairs);
            fit(pairs, References::wide(list), primitives, &lattice);
        }
        // What the words were for is done.
        let mut marks = Marks { leaves: lefts, costs: parents, kept: scratch };
        marks.choose(pairs, &surface, options);
        let remains = collapse(pairs, count, lefts);
        copy(header, &remains.header(count, bounds).to_words());
        Some(remains.pairs)
    }
}

/// Links pairs with one another and with their primitives, one to a leaf.
fn link(count: u32, lefts: &[u32], pairs: &mut [Pair]) {
    let child = |pair: u32, first: u32, count: u32| {
        let link = if count == 1 { Link::leaf(first, 1) } else { Link::inner(pair) };
        Node { planes: Planes::default(), link }
    };
    descend(
        count,
        |range| lefts.get(range.pair as usize).copied().unwrap_or(0),
        |range, left| {
            if let Some(pair) = pairs.get_mut(range.pair as usize) {
                *pair = [
                    child(range.pair + 1, range.first, left),
                    child(range.pair + left, range.first + left, range.count - left),
                ];
            }
        },
    );
}

/// Moves the list behind the pairs, two numbers to a word if they fit; the length of all.
fn pack(words: &mut [u32], count: usize, pairs: usize) -> usize {
    let (from, to, length) = (HEADER_WORDS + count * PAIR_WORDS, HEADER_WORDS + pairs * PAIR_WORDS, list_words(count));
    let of = |words: &[u32], index: usize| words.get(from + index).copied().filter(|_| index < count).unwrap_or(0);
    for index in 0..length {
        let word = match is_narrow(count) {
            true => of(words, index * 2) | of(words, index * 2 + 1) << 16,
            false => of(words, index),
        };
        // Never behind what is still to be read.
        if let Some(place) = words.get_mut(to + index) {
            *place = word;
        }
    }
    to + length
}

/// As `slice::copy_from_slice`, but without a panic for the linker to keep.
pub(super) fn copy(to: &mut [u32], from: &[u32]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = *from;
    }
}
