//! What lies near a point: a ball grows around it until it touches something.

use glam::Vec3;

use super::{Any, Collector, Inner, Nearest as Several, Next, Overlaps, Where};
use crate::{
    accel::{Cell, Hierarchy, Inside, MAX_LEVELS},
    geometry::{Aabb, Sphere},
    math::greatest,
    primitives::{Hit, Nearest, Probe, Proximity},
    scene::Scene,
};

/// Queries without a ray. The answers are those of the list, bit for bit; masks are not asked.
impl<A: Hierarchy, P: Proximity> Scene<A, P> {
    /// The point of all primitives closest to `point`, at most `max_distance` away; of several at the same distance that of
    /// the least number. `None` if there is none, or `point` or the distance is not valid.
    ///
    /// The search keeps a stack of [`MAX_LEVELS`] cells, some 2 kB. Triangles and spheres are measured in `f64`.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Scene, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let nearest = scene.nearest_point(Vec3::new(0.25, -3.0, 4.0), 10.0).unwrap();
    /// assert_eq!((nearest.point, nearest.distance, nearest.primitive), (Vec3::X * 0.25, 5.0, 0));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn nearest_point(&self, point: Vec3, max_distance: f32) -> Option<Nearest> {
        self.nearest_point_where(point, max_distance, |_| true)
    }

    /// The closest point of the primitives that `keep` accepts by their numbers.
    #[must_use]
    pub fn nearest_point_where(
        &self,
        point: Vec3,
        max_distance: f32,
        mut keep: impl FnMut(u32) -> bool,
    ) -> Option<Nearest> {
        let probe = Probe::new(point, max_distance)?;
        let mut nearest = Where::new(Inner::new(*probe.span()), |hit: &Hit| keep(hit.primitive));
        self.grow(&probe, &mut nearest);
        self.located(point, nearest.into_inner().hit()?)
    }

    /// Whether a primitive touches the ball within `sphere`, its surface included.
    #[must_use]
    pub fn any_overlap(&self, sphere: &Sphere) -> bool {
        let Some(probe) = Probe::new(sphere.center, sphere.radius) else { return false };
        let mut any = Any::within(probe.span());
        self.grow(&probe, &mut any);
        any.found()
    }

    /// The primitives that touch the ball within `sphere`, each once, the nearest to its centre first.
    ///
    /// Found eight at a time, without heap, and paid only as far as it is read. Each eight are a search of their own.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Scene, geometry::Sphere, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 2, 3], [1, 2, 3]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let bumper = Sphere::new(Vec3::new(-0.1, 0.5, 0.2), 0.23);
    /// let touched: Vec<u32> = scene.overlaps(&bumper).map(|nearest| nearest.primitive).collect();
    /// assert_eq!(touched, [1, 0]);
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn overlaps(&self, sphere: &Sphere) -> Overlaps<'_, A, P> {
        Overlaps::new(self, sphere)
    }

    /// The least hits from `from` on, as many as there is room for.
    pub(crate) fn nearest_touches(&self, probe: &Probe, from: Hit, hits: &mut heapless::VecView<Hit>) {
        self.grow(probe, &mut Several::new(from, probe.span().until(), hits));
    }

    /// A hit together with the point where it is.
    pub(crate) fn located(&self, point: Vec3, hit: Hit) -> Option<Nearest> {
        let closest = self.primitives().closest_point(hit.primitive, point)?;
        Some(Nearest { point: closest, distance: hit.t, primitive: hit.primitive })
    }

    /// Offers the hits of a growing ball until `collector` has enough: depth first, the nearer cell before the farther.
    pub(crate) fn grow<C: Collector>(&self, probe: &Probe, collector: &mut C) {
        let Some(root) = self.accelerator().root() else { return };
        let ball = Ball::new(probe, &root.bounds);
        let mut limit = ball.limit(collector.until().t);
        let mut stack: heapless::Vec<(f32, Cell<A::Node>), MAX_LEVELS> = heapless::Vec::new();
        let mut next = Some((0.0, root));
        while let Some((distance, cell)) = next.take().or_else(|| stack.pop()) {
            if distance > limit {
                continue;
            }
            match self.accelerator().open(&cell) {
                Inside::Leaf(leaf) => {
                    if self.offer_near(leaf, &ball, probe, collector) {
                        return;
                    }
                    limit = ball.limit(collector.until().t);
                }
                Inside::Cells(cells) => {
                    let [first, second] = cells.map(|cell| cell.map(|cell| (ball.square(&cell.bounds), cell)));
                    next = match (first, second) {
                        (Some(first), Some(second)) => {
                            let (near, far) = if second.0 < first.0 { (second, first) } else { (first, second) };
                            // There is room: no more cells lie within one another.
                            let _ = stack.push(far);
                            Some(near)
                        }
                        (one, other) => one.or(other),
                    };
                }
            }
        }
    }

    /// Offers the primitives of a leaf; whether `collector` has enough.
    fn offer_near<C: Collector>(
        &self,
        leaf: impl Iterator<Item = u32>,
        ball: &Ball,
        probe: &Probe,
        collector: &mut C,
    ) -> bool {
        let primitives = self.primitives();
        let mut limit = ball.limit(collector.until().t);
        for index in leaf {
            let bounds = primitives.bounds(index);
            if ball.square(&bounds) > limit {
                continue;
            }
            let probe = if primitives.is_certified(index) { *probe } else { probe.outside(&bounds) };
            let mut from = collector.from();
            while let Some(hit) = primitives.approach(index, &probe.between(from, collector.until())) {
                match collector.take(hit) {
                    Next::Primitive => break,
                    Next::Hit => from = Hit { primitive: hit.primitive.saturating_add(1), ..hit },
                    Next::Nothing => return true,
                }
            }
            limit = ball.limit(collector.until().t);
        }
        false
    }
}

/// 2^-40: what the differences of coordinates may cost the distance of a certified shape, with room to spare.
const ABSOLUTE: f32 = 1.0 / 1_099_511_627_776.0;

/// 2^-18: what its own roundings may cost a distance, with room to spare.
const RELATIVE: f32 = 1.0 / 262_144.0;

/// Decides which boxes the ball can have reached.
///
/// Distances are compared as squares. They are scaled by a power of two that takes the farthest corner to about 2^40, so that
/// no square overflows, and one that vanishes is far below the slack.
struct Ball {
    point: Vec3,
    scale: f32,
    unit: f32,
    slack: f32,
}

impl Ball {
    fn new(probe: &Probe, bounds: &Aabb) -> Self {
        let point = probe.point();
        let sides = (bounds.min - point).abs().max((bounds.max - point).abs());
        let reach = greatest(sides.x, greatest(sides.y, sides.z));
        // Exponents are counted from 127 on; those of 0 and of the least numbers are 0.
        let exponent = (reach.to_bits() >> 23 & 255).clamp(40, 254);
        let scale = f32::from_bits((294 - exponent) << 23);
        Self { point, scale, unit: probe.unit(), slack: reach * scale * ABSOLUTE }
    }

    /// What [`square`](Self::square) exceeds only for boxes in which everything is farther than `t`.
    fn limit(&self, t: f32) -> f32 {
        // With room for what underflows where distances are made of these.
        let radius = (t + f32::MIN_POSITIVE) * self.scale / self.unit;
        let radius = radius + (radius * RELATIVE + self.slack);
        radius * radius
    }

    /// The squared distance of a box, scaled.
    #[inline(always)]
    fn square(&self, bounds: &Aabb) -> f32 {
        let v = bounds.gaps(self.point) * self.scale;
        v.x * v.x + v.y * v.y + v.z * v.z
    }
}
