use crate::{geometry::Aabb, math::greatest};

/// How likely rays meet a box: its surface, with lengths relative to one so that nothing overflows.
pub(super) struct Weight {
    scale: f32,
}

impl Weight {
    /// For boxes within this one.
    pub(super) fn within(bounds: &Aabb) -> Self {
        let largest = greatest(bounds.size().max_element(), f32::MIN_POSITIVE);
        Self { scale: 1.0 / largest }
    }

    /// Half the surface, and a little for the lengths so that boxes without surface are told apart, too; nothing of
    /// the empty box.
    pub(super) fn of(&self, bounds: &Aabb) -> f32 {
        if bounds.is_empty() {
            return 0.0;
        }
        let size = bounds.size();
        let (x, y, z) = (size.x * self.scale, size.y * self.scale, size.z * self.scale);
        x * y + y * z + z * x + (x + y + z) * 1.0e-6
    }
}
