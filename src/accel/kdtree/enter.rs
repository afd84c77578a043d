use super::{
    KdTree, MAX_DEPTH,
    node::{Kind, Side},
};
use crate::{
    accel::{Entries, Entry},
    geometry::{Aabb, Axis, Bundle},
    math::{greatest, least},
};

/// A node, and when rays of a bundle can be in its cell.
#[derive(Clone, Copy, Debug)]
struct Beam {
    node: u32,
    enter: f32,
    exit: f32,
}

/// What a bundle finds at a node.
#[derive(Clone, Copy, Debug)]
enum Found {
    /// Primitives.
    Primitives,
    /// Nothing, or nothing that its rays meet.
    Nothing,
    /// What counts is on one side of a plane.
    Half(Beam, Plane, Side),
    /// It may be on both.
    Halves([Beam; 2], Plane),
}

#[derive(Clone, Copy, Debug)]
struct Plane(Axis, f32);

impl Plane {
    /// What of a box is on a side.
    fn cut(self, bounds: &Aabb, side: Side) -> Aabb {
        let (below, above) = bounds.split(self.0, self.1);
        if side == Side::Left { below } else { above }
    }
}

/// Nodes that are visited to tell whether a cell is empty; it counts as one that is not if they do not suffice.
const PATIENCE: u32 = 64;

impl KdTree<'_> {
    /// The smallest cell that holds all that the rays can meet; none if there is nothing.
    ///
    /// Where they are on both sides of a plane, and there is nothing for them on one, the cell is on the other.
    pub(super) fn entries(&self, bundle: &Bundle) -> Entries {
        let mut bounds = self.bounds;
        let Some((enter, exit)) = bundle.interval(&bounds) else { return Entries::default() };
        let mut at = Beam { node: 0, enter, exit };
        loop {
            let (next, plane, side) = match self.look(bundle, at) {
                Found::Nothing => return Entries::default(),
                Found::Primitives => break,
                Found::Half(next, plane, side) => (next, plane, side),
                Found::Halves([left, right], plane) => {
                    match (self.is_empty(bundle, left), self.is_empty(bundle, right)) {
                        (true, true) => return Entries::default(),
                        (true, false) => (right, plane, Side::Right),
                        (false, true) => (left, plane, Side::Left),
                        (false, false) => break,
                    }
                }
            };
            bounds = plane.cut(&bounds, side);
            at = next;
        }
        Entry { bounds, node: at.node, enter: at.enter }.into()
    }

    /// Whether there certainly is nothing in a cell that the rays can meet.
    fn is_empty(&self, bundle: &Bundle, at: Beam) -> bool {
        let mut waiting: heapless::Vec<Beam, MAX_DEPTH> = heapless::Vec::new();
        let mut next = Some(at);
        for _ in 0..PATIENCE {
            let Some(beam) = next else { return true };
            next = match self.look(bundle, beam) {
                Found::Primitives => return false,
                Found::Nothing => waiting.pop(),
                Found::Half(half, ..) => Some(half),
                Found::Halves([left, right], _) => {
                    // Cannot fail: no tree is deeper than its stack.
                    let _ = waiting.push(right);
                    Some(left)
                }
            };
        }
        false
    }

    /// One step of all rays at once: the intervals of a walk, with the earliest entry and the latest exit of any ray.
    #[inline(always)]
    fn look(&self, bundle: &Bundle, Beam { node, enter, exit }: Beam) -> Found {
        let (axis, position, right, empty) = match self.nodes.get(node as usize).map(|node| node.kind()) {
            Some(Kind::Inner { axis, position, right, empty }) => (axis, position, right, empty),
            Some(Kind::Leaf { count, .. }) if count > 0 => return Found::Primitives,
            _ => return Found::Nothing,
        };
        let passage = bundle.passage(axis, position, enter);
        let near = (enter, least(passage.latest, exit));
        let far = (greatest(passage.earliest, enter), exit);
        let (left, below) = (node + 1, if passage.descends { far } else { near });
        let above = if passage.descends { near } else { far };
        let beam = |node, (enter, exit)| Beam { node, enter, exit };
        // Written so that NaN visits.
        let without_left = empty == Some(Side::Left) || below.0 > below.1;
        let without_right = empty == Some(Side::Right) || above.0 > above.1;
        let plane = Plane(axis, position);
        match (without_left, without_right) {
            (true, true) => Found::Nothing,
            // Of a cut, both are the next node.
            (true, false) => Found::Half(beam(right, above), plane, Side::Right),
            (false, true) => Found::Half(beam(left, below), plane, Side::Left),
            (false, false) => Found::Halves([beam(left, below), beam(right, above)], plane),
        }
    }
}
