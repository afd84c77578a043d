//! Words into a hierarchy: looked at once, so that nothing can fail later.

use glam::Vec3;

use super::{
    Bvh, HEADER_WORDS, MAX_DEPTH,
    node::{Link, PAIR_WORDS},
};
use crate::{
    accel::{Malformed, Reason, leaf::References},
    asset::Kind,
    geometry::Aabb,
};

/// The header as it stands in the words.
pub(super) struct Header {
    pub(super) pairs: u32,
    pub(super) primitives: u32,
    pub(super) depth: u32,
    pub(super) root: Link,
    pub(super) bounds: Aabb,
}

impl Header {
    pub(super) fn to_words(&self) -> [u32; HEADER_WORDS] {
        let [x0, y0, z0] = self.bounds.min.to_array().map(f32::to_bits);
        let [x1, y1, z1] = self.bounds.max.to_array().map(f32::to_bits);
        [self.pairs, self.primitives, self.depth, self.root.to_bits(), x0, y0, z0, x1, y1, z1]
    }

    pub(super) fn from_words(words: &[u32]) -> Option<Self> {
        let &[pairs, primitives, depth, root, x0, y0, z0, x1, y1, z1] = words.first_chunk::<HEADER_WORDS>()?;
        let corner = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
        let bounds = Aabb::new(corner([x0, y0, z0]), corner([x1, y1, z1]));
        Some(Self { pairs, primitives, depth, root: Link::from_bits(root), bounds })
    }
}

/// Words of the list that says which primitive stands at which position: two numbers in each where they fit.
pub(super) const fn list_words(primitives: usize) -> usize {
    if is_narrow(primitives) { primitives.div_ceil(2) } else { primitives }
}

/// Whether numbers take 16 bits.
pub(super) const fn is_narrow(primitives: usize) -> bool {
    primitives <= 1 << 16
}

/// The list of `primitives` in `list`; without one each stands at the position of its number.
pub(super) const fn references(list: &[u32], primitives: usize) -> References<'_> {
    if is_narrow(primitives) && !list.is_empty() { References::narrow(list) } else { References::wide(list) }
}

/// A number that depends on each bit of `number` (the finalizer of MurmurHash3).
const fn mixed(number: u32) -> u32 {
    let number = (number ^ number >> 16).wrapping_mul(0x85eb_ca6b);
    let number = (number ^ number >> 13).wrapping_mul(0xc2b2_ae35);
    number ^ number >> 16
}

impl<'a> Bvh<'a> {
    /// The hierarchy in `words`, as [`as_words`](Self::as_words) gave them; all of them are checked, in O(n).
    ///
    /// Afterwards a walk stays within the words and visits each pair at most once, whatever the words say. Whether they
    /// also say the truth about some primitives, only a checksum over both can tell.
    ///
    /// # Errors
    ///
    /// [`Malformed`] says what is wrong and at which word. A list of primitives that names one twice escapes once in 2^32
    /// times, as there is no memory to mark them in.
    pub fn open(words: &'a [u32]) -> Result<Self, Malformed> {
        let error = |word, reason| Malformed { structure: Kind::Bvh, word, reason };
        let bvh = Self::view(words).ok_or(error(0, Reason::Length))?;
        let empty = bvh.primitives == 0 && bvh.bounds == Aabb::EMPTY;
        if !(bvh.bounds.is_valid() || empty) {
            return Err(error(4, Reason::Bounds));
        }
        if bvh.depth as usize > MAX_DEPTH {
            return Err(error(2, Reason::Depth));
        }
        if bvh.primitives == 0 && bvh.root != Link::inner(0) {
            return Err(error(3, Reason::Link));
        }
        bvh.check_links()?;
        for (index, pair) in bvh.pairs.iter().enumerate() {
            if pair.iter().any(|node| node.planes.bounds(&bvh.lattice).is_empty()) {
                return Err(error(HEADER_WORDS + index * PAIR_WORDS, Reason::Plane));
            }
        }
        bvh.check_list().map_err(|()| error(HEADER_WORDS + bvh.pairs.len() * PAIR_WORDS, Reason::Primitive))?;
        Ok(bvh)
    }

    /// Depth first: each pair comes after the one before, each leaf's primitives after those of the leaf before. So each
    /// has exactly one parent.
    fn check_links(&self) -> Result<(), Malformed> {
        // Links to come, with the pairs above them and the word where they stand.
        let mut pending: heapless::Vec<(Link, u32, usize), MAX_DEPTH> = heapless::Vec::new();
        let (mut pairs, mut primitives) = (0, 0_u32);
        let mut next = (self.primitives > 0).then_some((self.root, 0, 3));
        while let Some((link, depth, word)) = next {
            let error = |reason| Malformed { structure: Kind::Bvh, word, reason };
            next = if link.is_leaf() {
                if link.number() != primitives || link.count() > self.primitives - primitives {
                    return Err(error(Reason::References));
                }
                primitives += link.count();
                pending.pop()
            } else {
                let Some([left, right]) = self.pairs.get(link.number() as usize).filter(|_| link.number() == pairs)
                else {
                    return Err(error(Reason::Link));
                };
                let place = HEADER_WORDS + pairs as usize * PAIR_WORDS;
                let depth = depth + 1;
                pairs += 1;
                if depth > self.depth || pending.push((right.link, depth, place + 7)).is_err() {
                    return Err(error(Reason::Depth));
                }
                Some((left.link, depth, place + 3))
            };
        }
        let error = |word, reason| Malformed { structure: Kind::Bvh, word, reason };
        if pairs as usize != self.pairs.len() {
            return Err(error(0, Reason::Link));
        }
        if primitives != self.primitives {
            return Err(error(1, Reason::References));
        }
        Ok(())
    }

    /// Whether the list names all primitives.
    fn check_list(&self) -> Result<(), ()> {
        let (mut named, mut expected) = (0_u32, 0_u32);
        for (index, number) in self.order().enumerate() {
            if number >= self.primitives {
                return Err(());
            }
            named = named.wrapping_add(mixed(number));
            expected = expected.wrapping_add(mixed(index as u32));
        }
        if named == expected { Ok(()) } else { Err(()) }
    }

    /// The parts of `words` by their header, if the lengths agree.
    pub(super) fn view(words: &'a [u32]) -> Option<Self> {
        let Header { pairs, primitives, depth, root, bounds } = Header::from_words(words)?;
        let (_, rest) = words.split_at_checked(HEADER_WORDS)?;
        let (pairs, list) = rest.split_at_checked((pairs as usize).checked_mul(PAIR_WORDS)?)?;
        if !list.is_empty() && list.len() != list_words(primitives as usize) {
            return None;
        }
        let references = references(list, primitives as usize);
        let lattice = Self::lattice(&bounds);
        let pairs = bytemuck::try_cast_slice(pairs).ok()?;
        Some(Self { words, pairs, references, root, primitives, depth, bounds, lattice })
    }
}
