use super::Material;
use crate::{
    accel::{Accelerator, Entries, LatticeAccelerator},
    geometry::{Aabb, Bundle, Pencil, Ray},
    lattice_scene::LatticeScene,
    primitives::{Hit, LatticeMesh, LatticeTriangles, Primitives, Surface},
    query::ItemBuffer,
    scene::Scene,
};

/// What a renderer asks: every [`Scene`] answers, and every [`LatticeScene`].
///
/// Wrap one to count or time rays. `depth` is how often light was reflected on the way to the camera: 0 for the camera's
/// own rays and for shadows at what they hit.
pub trait Caster {
    /// The first hit of the ray.
    fn closest_hit(&self, ray: &Ray, depth: u32) -> Option<Hit>;

    /// Where the camera's rays in a tile may begin; all tiles begin with everything unless this is implemented.
    fn enter(&self, _bundle: &Bundle) -> Entries {
        Entries::everything(self.bounds())
    }

    /// The first hit of a camera's ray, of the bundle for which these entries were found.
    fn closest_hit_from(&self, _entries: &Entries, ray: &Ray) -> Option<Hit> {
        self.closest_hit(ray, 0)
    }

    /// The first hits of all the camera's rays in a tile; false if they are to be asked for one by one.
    fn closest_hits(&self, _pencil: &Pencil, _hits: &mut ItemBuffer) -> bool {
        false
    }

    /// Whether anything lies on the ray, a shadow ray.
    fn any_hit(&self, ray: &Ray, depth: u32) -> bool;

    /// As [`any_hit`](Self::any_hit), for a shadow ray beside another: what `last` names may be tried first.
    fn any_hit_near(&self, ray: &Ray, depth: u32, _last: &mut Option<u32>) -> bool {
        self.any_hit(ray, depth)
    }

    /// The surface at a hit.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface;

    /// The material of what was hit, if the scene knows it: worlds of instances do, for whose primitives, all numbered
    /// through, nobody has a list, and so do [textured](super::Textured) scenes. Otherwise the renderer's materials count.
    fn material(&self, _hit: &Hit, _surface: &Surface) -> Option<Material> {
        None
    }

    /// The box around everything.
    fn bounds(&self) -> Aabb;
}

impl<A: Accelerator, P: Primitives> Caster for Scene<A, P> {
    fn closest_hit(&self, ray: &Ray, _depth: u32) -> Option<Hit> {
        Self::closest_hit(self, ray)
    }

    fn enter(&self, bundle: &Bundle) -> Entries {
        Self::enter(self, bundle)
    }

    fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        Self::closest_hit_from(self, entries, ray)
    }

    fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        Self::closest_hits(self, pencil, hits)
    }

    fn any_hit(&self, ray: &Ray, _depth: u32) -> bool {
        Self::any_hit(self, ray)
    }

    fn any_hit_near(&self, ray: &Ray, _depth: u32, last: &mut Option<u32>) -> bool {
        Self::any_hit_near(self, ray, last)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Self::surface(self, ray, hit)
    }

    fn bounds(&self) -> Aabb {
        Self::bounds(self)
    }
}

/// Rays in whole numbers, surfaces and light in floating point.
impl<A: LatticeAccelerator, P: LatticeTriangles> Caster for LatticeScene<A, P> {
    fn closest_hit(&self, ray: &Ray, _depth: u32) -> Option<Hit> {
        Self::closest_hit(self, ray)
    }

    /// Tells whether there is anything: rays in whole numbers begin at the root all the same.
    ///
    /// What a ray hits lies within its rounding of the line that was meant, so that one beside it, of the wider bundle, passes
    /// through. Of origins so far away that the width is lost in them, exits are later by more than that.
    #[inline(never)] // The wider bundle is not kept.
    fn enter(&self, bundle: &Bundle) -> Entries {
        self.accelerator().enter(&bundle.padded(rounding(self)))
    }

    fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        if entries.is_empty() { None } else { Self::closest_hit(self, ray) }
    }

    fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        Self::closest_hits(self, pencil, hits)
    }

    fn any_hit(&self, ray: &Ray, _depth: u32) -> bool {
        Self::any_hit(self, ray)
    }

    /// With a point that is as far off as rays are, rounded to the lattice, so that what leaves a surface does not meet it.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let surface = self.triangles().surface(ray, hit);
        Surface { error: surface.error + rounding(self), ..surface }
    }

    fn bounds(&self) -> Aabb {
        self.accelerator().bounds()
    }
}

/// How far off rays in whole numbers may be.
fn rounding<A: LatticeAccelerator, P: LatticeTriangles>(scene: &LatticeScene<A, P>) -> f32 {
    /// Steps by which a line, and the depth at which it crosses a triangle, may be off, and half as many again.
    const STEPS: f32 = 12.0;
    scene.triangles().mesh().frame().size().max_element() * (STEPS / LatticeMesh::LAST as f32)
}
