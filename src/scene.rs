//! A structure together with its primitives: what rays are cast at.

use core::fmt;

use crate::{
    accel::{Accelerator, Entries, Traversal},
    asset::{Asset, Stored},
    error::Error,
    geometry::{Aabb, Bundle, PreparedRay, Ray, beyond},
    primitives::{Hit, Primitives, Span, Surface},
    query::{Any, Closest, Collector, First, Hits, Nearest, Next, PausedQuery, Wanted, Where, end_of, start_of},
};

/// The structure was built over another number of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mismatch {
    /// Primitives of the structure.
    pub structure: u32,
    /// Primitives given.
    pub primitives: u32,
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the structure is over {} primitives, but there are {}", self.structure, self.primitives)
    }
}

impl core::error::Error for Mismatch {}

/// A structure and the primitives it was built over.
///
/// All queries return the same bits for every structure: the hits are ordered by `t`, then by number, and an interval's
/// ends belong to it. An invalid ray hits nothing.
#[derive(Clone, Copy, Debug)]
pub struct Scene<A, P> {
    accelerator: A,
    primitives: P,
}

impl<'a> Asset<'a> {
    /// The scene of the structure and the primitives that it holds; both are checked in full, and only what is named is
    /// linked into the program.
    ///
    /// # Errors
    ///
    /// What is wrong with the sections, or that there are none.
    pub fn scene<A, P>(&self) -> Result<Scene<A, P>, Error>
    where
        A: Accelerator + Stored<'a>,
        P: Primitives + Stored<'a>,
    {
        Ok(Scene::new(self.read()?, self.read()?)?)
    }
}

impl<A: Accelerator, P: Primitives> Scene<A, P> {
    /// The scene of `primitives`, by value or by reference, under `accelerator`.
    ///
    /// # Errors
    ///
    /// [`Mismatch`] if the numbers of primitives differ. That they are the same ones is the caller's to see to.
    pub fn new(accelerator: A, primitives: P) -> Result<Self, Mismatch> {
        let (structure, count) = (accelerator.primitives(), primitives.len());
        if structure == count {
            Ok(Self { accelerator, primitives })
        } else {
            Err(Mismatch { structure, primitives: count })
        }
    }

    /// The structure.
    #[must_use]
    pub const fn accelerator(&self) -> &A {
        &self.accelerator
    }

    /// The primitives.
    #[must_use]
    pub const fn primitives(&self) -> &P {
        &self.primitives
    }

    /// The box around everything.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.accelerator.bounds()
    }

    /// The surface at a hit of `ray`.
    #[must_use]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.primitives.surface(ray, hit)
    }

    /// The first hit of the ray.
    #[must_use]
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        // Kept where it was made: to move a prepared ray takes a hundred instructions.
        let prepared = PreparedRay::here(ray);
        let ray = prepared.as_ref()?;
        let mut closest = Closest::new(ray);
        self.search(ray, &mut closest);
        closest.hit()
    }

    /// Where walks of the rays in `bundle` may begin, for [`closest_hit_from`](Self::closest_hit_from): the few parts of
    /// the structure that they can enter.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Ray, Scene, geometry::Bundle, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let rays = [0.1, 0.2, 0.3].map(|x| Ray::new(Vec3::new(x, 0.2, -1.0), Vec3::Z));
    /// let entries = scene.enter(&Bundle::around(rays).unwrap());
    /// for ray in &rays {
    ///     assert_eq!(scene.closest_hit_from(&entries, ray), scene.closest_hit(ray));
    /// }
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn enter(&self, bundle: &Bundle) -> Entries {
        self.accelerator.enter(bundle)
    }

    /// The first hit of a ray of the bundle for which these entries were found, the same as [`closest_hit`](Self::closest_hit).
    #[must_use]
    pub fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        if entries.is_empty() {
            return None;
        }
        let prepared = PreparedRay::here(ray);
        let ray = prepared.as_ref()?;
        let mut closest = Closest::new(ray);
        for entry in entries.iter() {
            // All that is left begins later.
            if entry.enter > beyond(closest.until().t) {
                break;
            }
            let mut traversal = self.accelerator.traverse_from(entry, ray);
            while let Some(leaf) = traversal.next_leaf(ray, closest.until().t) {
                self.offer(leaf, ray, &mut closest);
            }
        }
        closest.hit()
    }

    /// The first hit of the ray that `keep` accepts: cut-outs, or everything but oneself.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Ray, Scene, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let ray = Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z);
    /// let other = scene.closest_hit_where(&ray, |hit| hit.primitive != 0).unwrap();
    /// assert_eq!(other.primitive, 1);
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn closest_hit_where(&self, ray: &Ray, keep: impl FnMut(&Hit) -> bool) -> Option<Hit> {
        let prepared = ray.prepare();
        let ray = prepared.as_ref()?;
        let mut closest = Where::new(Closest::new(ray), keep);
        self.search(ray, &mut closest);
        closest.into_inner().hit()
    }

    /// Whether the ray hits anything: for shadows and visibility, cheaper than the closest hit.
    #[must_use]
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.any_hit_where(ray, |_| true)
    }

    /// The closest hit or any one, by the same code.
    ///
    /// [`closest_hit`](Self::closest_hit) and [`any_hit`](Self::any_hit) are each compiled for themselves, which is faster, any hits by a
    /// tenth. Where both are asked and flash is scarce, this is one piece of code in place of two: 1.6 to 6.2 kB less.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Ray, Scene, glam::Vec3, query::Wanted};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let (eye, lamp) = (Vec3::new(0.2, 0.2, 1.0), Vec3::new(3.0, 0.0, 1.0));
    /// let ray = Ray::new(eye, Vec3::NEG_Z);
    /// let hit = scene.hit(&ray, Wanted::Closest).unwrap();
    /// let surface = scene.surface(&ray, &hit);
    /// let way = lamp - surface.point;
    /// let to_lamp = Ray::new(surface.start_towards(way), way).up_to(1.0);
    /// assert!(scene.hit(&to_lamp, Wanted::Any).is_none()); // not in shadow
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn hit(&self, ray: &Ray, wanted: Wanted) -> Option<Hit> {
        let prepared = PreparedRay::here(ray);
        let ray = prepared.as_ref()?;
        let mut first = First::new(ray, wanted);
        self.search(ray, &mut first);
        first.hit()
    }

    /// As [`any_hit`](Self::any_hit), trying first the primitive that `last` names, and naming there what was found: shadow
    /// rays side by side are often stopped by the same one.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Ray, Scene, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let mut last = None;
    /// for x in [0.1, 0.2, 0.3] {
    ///     assert!(scene.any_hit_near(&Ray::new(Vec3::new(x, 0.2, -1.0), Vec3::Z), &mut last));
    /// }
    /// assert_eq!(last, Some(0));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    #[must_use]
    pub fn any_hit_near(&self, ray: &Ray, last: &mut Option<u32>) -> bool {
        let prepared = ray.prepare();
        let Some(ray) = prepared.as_ref() else { return false };
        let any = Any::new(ray);
        let stops = |index| self.intersect(index, ray, any.span(any.from())).is_some();
        if last.is_some_and(|last| last < self.primitives.len() && stops(last)) {
            return true;
        }
        let mut traversal = self.accelerator.traverse(ray);
        while let Some(mut leaf) = traversal.next_leaf(ray, any.until().t) {
            if let Some(index) = leaf.find(|&index| stops(index)) {
                *last = Some(index);
                return true;
            }
        }
        false
    }

    /// Whether the ray has a hit that `keep` accepts.
    #[must_use]
    pub fn any_hit_where(&self, ray: &Ray, keep: impl FnMut(&Hit) -> bool) -> bool {
        let Some(ray) = &PreparedRay::here(ray) else { return false };
        let mut any = Where::new(Any::new(ray), keep);
        self.search(ray, &mut any);
        any.into_inner().found()
    }

    /// All hits of the ray in order, found eight at a time; without heap, and paid only as far as it is read.
    #[must_use]
    pub fn hits(&self, ray: &Ray) -> Hits<'_, A, P> {
        Hits::new(self, ray)
    }

    /// Replaces the contents of `hits` by the first hits of the ray, in order, as many as its capacity holds:
    /// any `heapless::Vec`, of heapless 0.9.
    ///
    /// ```
    /// # use hitscan::{List, Mesh, Ray, Scene, glam::Vec3};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 2], [0, 1, 2]])?;
    /// # let scene = Scene::new(List::new(&mesh)?, &mesh)?;
    /// let mut first_two: heapless::Vec<_, 2> = heapless::Vec::new();
    /// scene.nearest_hits(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z), &mut first_two);
    /// assert_eq!((first_two[0].primitive, first_two[1].primitive), (0, 1));
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    pub fn nearest_hits(&self, ray: &Ray, hits: &mut heapless::VecView<Hit>) {
        hits.clear();
        if let Some(ray) = &ray.prepare() {
            self.search(ray, &mut Nearest::new(start_of(ray), end_of(ray), hits));
        }
    }

    /// The closest hit, to be looked for a few nodes at a time.
    #[must_use]
    pub fn begin(&self, ray: &Ray) -> PausedQuery<'_, A, P> {
        PausedQuery::new(self, ray)
    }

    /// Offers the hits of the ray, leaf by leaf, until `collector` has enough. All queries that need not pause are this.
    pub(crate) fn search<C: Collector>(&self, ray: &PreparedRay, collector: &mut C) {
        self.accelerator.visit(ray, collector.until().t, |leaf| {
            let is_enough = self.offer(leaf, ray, collector);
            (!is_enough).then_some(collector.until().t)
        });
    }

    /// Offers the hits with the primitives of a leaf; whether `collector` has enough.
    #[inline(always)]
    pub(crate) fn offer<C: Collector>(
        &self,
        leaf: impl Iterator<Item = u32>,
        ray: &PreparedRay,
        collector: &mut C,
    ) -> bool {
        for index in leaf {
            let mut from = collector.from();
            while let Some(hit) = self.intersect(index, ray, collector.span(from)) {
                match collector.take(hit) {
                    Next::Primitive => break,
                    Next::Hit => from = Hit { primitive: hit.primitive.saturating_add(1), ..hit },
                    Next::Nothing => return true,
                }
            }
        }
        false
    }

    /// The first hit with a primitive that is wanted.
    #[inline(always)]
    pub(crate) fn intersect(&self, index: u32, ray: &PreparedRay, span: Span) -> Option<Hit> {
        // Compared first: where there are no masks, nothing is left of this.
        let mask = self.primitives.mask(index);
        if mask != u32::MAX && mask & ray.ray().mask == 0 {
            return None;
        }
        let span =
            if self.primitives.is_certified(index) { span } else { span.within(&self.primitives.bounds(index), ray)? };
        self.primitives.intersect(index, ray, &span)
    }
}
