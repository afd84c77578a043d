//! A structure and its triangles on one lattice: rays in whole numbers, for chips without floating point.

use core::fmt;

use crate::{
    accel::{LatticeAccelerator, LatticeWalk},
    asset::{Asset, Stored},
    error::Error,
    geometry::{Depth, LatticeRay, LatticeSpace, Ray},
    primitives::{Hit, LatticeTriangles, Sides},
    scene::Mismatch,
};

/// Why a structure and triangles do not stand on one lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LatticeError {
    /// The structure is over other primitives.
    Mismatch(Mismatch),
    /// The bounds of the structure are not the frame of the mesh: it was built over something else, or a vertex is on a last
    /// plane that lies outside the frame.
    Frame,
    /// The lattice is so fine that some of its planes have the same `f32` position.
    TooFine,
}

impl fmt::Display for LatticeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mismatch(mismatch) => mismatch.fmt(f),
            Self::Frame => write!(f, "the bounds of the structure are not the frame of the lattice"),
            Self::TooFine => write!(f, "planes of the lattice have the same position: its frame is too small"),
        }
    }
}

impl core::error::Error for LatticeError {}

/// A structure and the triangles on a lattice that it was built over, asked in whole numbers.
///
/// Closest and any hits, as of a [`Scene`](crate::Scene), for chips that have no FPU: four to ten times as fast there. Its
/// answers are its own. A ray is rounded to the lattice, corners are rounded as the ray sees them, and `t` is as exact as
/// the lattice is, so hits near edges and `t` differ from a [`Scene`](crate::Scene)'s by about a step of the lattice. But
/// they are exact in the same sense: bit for bit those of a list, whatever the structure, on every target; and no ray passes
/// between triangles that share an edge or a corner.
///
/// ```
/// use hitscan::{Arena, DualSplit, LatticeMesh, LatticeScene, Ray, dualsplit::Options, geometry::Aabb, glam::Vec3};
/// let frame = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// let vertices = [[0, 0, 30_000], [60_000, 0, 30_000], [0, 60_000, 30_000], [0, 0, 0]];
/// let mesh = LatticeMesh::new(&frame, &vertices, &[[0_u16, 1, 2], [0, 1, 3]])?;
/// let mut memory = [0; DualSplit::words(2, &Options::balanced())];
/// let tree = DualSplit::build(&mesh, &mut Arena::new(&mut memory), &Options::balanced())?;
/// let scene = LatticeScene::new(tree, &mesh)?;
///
/// let ray = Ray::new(glam::Vec3::new(0.2, 0.2, -1.0), Vec3::Z);
/// let hit = scene.closest_hit(&ray).unwrap();
/// assert!(hit.primitive == 0 && (hit.t - 1.0 - 30_000.0 / 65_535.0).abs() < 1.0e-5);
/// assert!(scene.any_hit(&ray));
/// # use hitscan::glam;
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct LatticeScene<A, P> {
    accelerator: A,
    triangles: P,
    space: LatticeSpace,
}

/// The closest hit so far, as depth and number.
#[derive(Clone, Copy)]
struct Best {
    depth: i32,
    number: u32,
}

impl<'a> Asset<'a> {
    /// As [`scene`](Self::scene), in whole numbers.
    ///
    /// # Errors
    ///
    /// What is wrong with the sections, that there are none, or that they do not stand on one lattice.
    pub fn lattice_scene<A, P>(&self) -> Result<LatticeScene<A, P>, Error>
    where
        A: LatticeAccelerator + Stored<'a>,
        P: LatticeTriangles + Stored<'a>,
    {
        Ok(LatticeScene::new(self.read()?, self.read()?)?)
    }
}

impl<A: LatticeAccelerator, P: LatticeTriangles> LatticeScene<A, P> {
    /// The scene of `triangles`, by value or by reference, under `accelerator`.
    ///
    /// # Errors
    ///
    /// [`LatticeError`] if they do not stand on one lattice. That the structure was built over these triangles is the
    /// caller's to see to.
    pub fn new(accelerator: A, triangles: P) -> Result<Self, LatticeError> {
        let (structure, primitives) = (accelerator.primitives(), triangles.len());
        if structure != primitives {
            return Err(LatticeError::Mismatch(Mismatch { structure, primitives }));
        }
        let frame = triangles.mesh().frame();
        // Of nothing there are no bounds.
        if accelerator.bounds() != *frame && primitives > 0 {
            return Err(LatticeError::Frame);
        }
        let space = LatticeSpace::over(frame).ok_or(LatticeError::TooFine)?;
        Ok(Self { accelerator, triangles, space })
    }

    /// The structure.
    #[must_use]
    pub const fn accelerator(&self) -> &A {
        &self.accelerator
    }

    /// The triangles.
    #[must_use]
    pub const fn triangles(&self) -> &P {
        &self.triangles
    }

    /// The space of the lattice: it makes rays.
    #[must_use]
    pub const fn space(&self) -> &LatticeSpace {
        &self.space
    }

    /// The first hit of the ray.
    #[must_use]
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        // Kept where it was made: to move it would take as long as a node.
        let ray = self.space.ray(ray);
        self.closest_hit_along(ray.as_ref()?)
    }

    /// Whether the ray hits anything: for shadows and visibility, cheaper than the closest hit.
    #[must_use]
    pub fn any_hit(&self, ray: &Ray) -> bool {
        let ray = self.space.ray(ray);
        ray.as_ref().is_some_and(|ray| self.any_hit_along(ray))
    }

    /// The first hit of a ray in whole numbers, made by the [`space`](Self::space) of this scene.
    #[must_use]
    #[inline(never)] // What a walk keeps on the stack is not there yet while a ray is made.
    pub fn closest_hit_along(&self, ray: &LatticeRay) -> Option<Hit> {
        // No primitive has the number behind all.
        let mut best = Best { depth: ray.depths.1, number: u32::MAX };
        let mut walk = self.accelerator.walk();
        while let Some(leaf) = walk.next_leaf(ray, best.depth >> 8) {
            for index in leaf {
                if let Some(Depth { depth, front }) = self.crossing(index, ray)
                    && self.shows(front)
                    && ray.depths.0 <= depth
                    && depth <= best.depth
                {
                    let number = self.triangles.number(index);
                    if depth < best.depth || number < best.number {
                        best = Best { depth, number };
                    }
                }
            }
        }
        (best.number != u32::MAX).then(|| Hit { t: ray.parameter(best.depth), primitive: best.number })
    }

    /// As [`any_hit`](Self::any_hit), for a ray in whole numbers, made by the [`space`](Self::space) of this scene.
    #[must_use]
    #[inline(never)]
    pub fn any_hit_along(&self, ray: &LatticeRay) -> bool {
        let (from, until) = ray.depths;
        let mut walk = self.accelerator.walk();
        while let Some(mut leaf) = walk.next_leaf(ray, until >> 8) {
            let is_hit = |Depth { depth, front }| self.shows(front) && from <= depth && depth <= until;
            if leaf.any(|index| self.crossing(index, ray).is_some_and(is_hit)) {
                return true;
            }
        }
        false
    }

    /// Where the ray crosses a triangle that it sees.
    #[inline(never)] // Not within the walk: each would keep the other's numbers on the stack.
    fn crossing(&self, index: u32, ray: &LatticeRay) -> Option<Depth> {
        ray.sight.crossing(self.visible(index, ray.mask)?)
    }

    /// The corners of a triangle that a ray of this mask may see.
    #[inline(always)]
    pub(crate) fn visible(&self, index: u32, mask: u32) -> Option<[&[u16; 3]; 3]> {
        if self.triangles.mask(index) & mask == 0 { None } else { self.triangles.mesh().corners(index) }
    }

    /// Whether triangles can be hit from a side.
    #[inline(always)]
    pub(crate) fn shows(&self, front: bool) -> bool {
        front || self.triangles.mesh().sides() == Sides::Both
    }
}
