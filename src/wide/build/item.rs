use crate::geometry::Aabb;
use crate::wide::hull::Hull;

/// A reference to a primitive: the box of it, or of a part of it, and its number.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(super) struct Item(Hull);

impl Item {
    /// The primitive of this number within `bounds`.
    #[inline(always)]
    pub(super) fn new(bounds: &Aabb, number: u32) -> Self {
        Self(Hull::new(bounds, [number, 0]))
    }

    /// The box.
    #[inline(always)]
    pub(super) const fn hull(&self) -> Hull {
        self.0
    }

    /// The primitive.
    #[inline(always)]
    pub(super) const fn number(&self) -> u32 {
        self.0.words()[0]
    }
}

/// The boxes of items and of their middles, doubled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) hull: Hull,
    pub(super) middles: Hull,
}

impl Extent {
    /// Of no items.
    pub(super) const EMPTY: Self = Self { hull: Hull::EMPTY, middles: Hull::EMPTY };

    /// Of all items.
    #[inline]
    pub(super) fn of(items: &[Item]) -> Self {
        let mut all = Self::EMPTY;
        for item in items {
            all.add(item);
        }
        all
    }

    /// Of one item more.
    #[inline(always)]
    pub(super) fn add(&mut self, item: &Item) {
        self.hull = self.hull.union(item.hull());
        self.middles = self.middles.union(Hull::around(item.hull().middle()));
    }

    /// Of both.
    pub(super) fn union(self, other: Self) -> Self {
        Self { hull: self.hull.union(other.hull), middles: self.middles.union(other.middles) }
    }
}
