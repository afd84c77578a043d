use hitscan::{Hit, Mesh, PreparedRay, Primitives, Ray, Span, geometry::Aabb, glam::Vec3, primitives::Surface};

/// The least cosine between a mirrored ray and the surface it leaves.
const GRAZING: f32 = 0.02;

/// The least cosine between a triangle's normal and that of its corners, 35 degrees: beyond, it is part of an edge that is
/// meant.
const CREASE: f32 = 0.82;

/// A mesh that is shaded as if it were curved: a decorator that blends the normals of a triangle's corners.
///
/// Phong, *Illumination for computer generated pictures*, 1975. What is hit, and where, stays the mesh's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smooth<'a> {
    mesh: Mesh<'a>,
    normals: &'a [Vec3],
}

/// The mean normal of the triangles around each vertex, weighted by their areas.
pub(crate) fn normals(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; vertices.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| vertices.get(corner as usize).copied().unwrap_or_default());
        let normal = (b - a).cross(c - a);
        for corner in corners {
            if let Some(sum) = sums.get_mut(*corner as usize) {
                *sum += normal;
            }
        }
    }
    sums.into_iter().map(Vec3::normalize_or_zero).collect()
}

impl<'a> Smooth<'a> {
    /// The mesh with a normal for each vertex; a missing or zero normal leaves the triangles around it flat.
    pub(crate) const fn new(mesh: Mesh<'a>, normals: &'a [Vec3]) -> Self {
        Self { mesh, normals }
    }

    fn normal(&self, surface: &Surface, triangle: u32) -> Option<Vec3> {
        let corners = self.mesh.indices().get(triangle)?;
        let [a, b, c] = corners.map(|vertex| self.normals.get(vertex as usize).copied().unwrap_or_default());
        if [a, b, c].into_iter().any(|normal| normal.dot(surface.geometric_normal) < CREASE) {
            return None;
        }
        let (v, w) = (surface.uv.x, surface.uv.y);
        (a * (1.0 - v - w) + b * v + c * w).try_normalize()
    }
}

impl Primitives for Smooth<'_> {
    #[inline]
    fn len(&self) -> u32 {
        self.mesh.len()
    }

    fn bounds(&self, index: u32) -> Aabb {
        self.mesh.bounds(index)
    }

    #[inline]
    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        self.mesh.intersect(index, ray, span)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let surface = self.mesh.surface(ray, hit);
        match self.normal(&surface, hit.primitive) {
            Some(normal) => {
                Surface { shading_normal: above(&surface, ray.direction.normalize_or_zero(), normal), ..surface }
            }
            None => surface,
        }
    }

    fn is_certified(&self, index: u32) -> bool {
        self.mesh.is_certified(index)
    }

    fn clip(&self, index: u32, cell: &Aabb) -> Option<Aabb> {
        self.mesh.clip(index, cell)
    }
}

/// The shading normal, bent so far that what it mirrors leaves the real surface instead of entering it.
fn above(surface: &Surface, direction: Vec3, normal: Vec3) -> Vec3 {
    let side = if surface.front { 1.0 } else { -1.0 };
    let (geometric, normal) = (surface.normal_towards_ray(), normal * side);
    let mirrored = direction - normal * (2.0 * direction.dot(normal));
    let height = mirrored.dot(geometric);
    if height >= GRAZING {
        return normal * side;
    }
    // The half vector between the way in and a mirrored way lifted above the surface.
    let lifted = (mirrored + geometric * (GRAZING - height)).normalize_or_zero();
    (lifted - direction).try_normalize().unwrap_or(geometric) * side
}
