use std::collections::HashMap;

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
pub struct Smooth<'a> {
    mesh: Mesh<'a>,
    normals: &'a [Vec3],
}

impl<'a> Smooth<'a> {
    /// The mesh with a normal for each vertex; a missing or zero normal leaves the triangles around it flat.
    pub fn new(mesh: Mesh<'a>, normals: &'a [Vec3]) -> Self {
        Self { mesh, normals }
    }

    /// The mean normal of the triangles around each vertex, weighted by their areas; what stands at the same place is one
    /// vertex.
    pub fn normals(mesh: &Mesh<'_>) -> Vec<Vec3> {
        let key = |at: Vec3| (at + Vec3::ZERO).to_array().map(f32::to_bits);
        let mut sums = HashMap::new();
        for index in 0..mesh.len() {
            let triangle = mesh.triangle(index);
            for corner in [triangle.a, triangle.b, triangle.c] {
                *sums.entry(key(corner)).or_insert(Vec3::ZERO) += triangle.normal();
            }
        }
        let mean = |at: &Vec3| sums.get(&key(*at)).map_or(Vec3::ZERO, |sum| sum.normalize_or_zero());
        mesh.vertices().iter().map(mean).collect()
    }

    fn normal(&self, surface: &Surface, triangle: u32) -> Option<Vec3> {
        let corners = self.mesh.indices().get(triangle)?;
        let [a, b, c] = corners.map(|vertex| self.normals.get(vertex as usize).copied().unwrap_or(Vec3::ZERO));
        if [a, b, c].into_iter().any(|normal| normal.dot(surface.geometric_normal) < CREASE) {
            return None;
        }
        let (v, w) = (surface.uv.x, surface.uv.y);
        (a * (1.0 - v - w) + b * v + c * w).try_normalize()
    }
}

impl Primitives for Smooth<'_> {
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

#[cfg(test)]
mod tests {
    use hitscan::{List, Scene};

    use super::*;

    /// A roof of two slopes over the x axis, each rising `pitch` over a width of 1.
    fn corners(pitch: f32) -> [Vec3; 4] {
        [Vec3::ZERO, Vec3::X, Vec3::new(0.5, -pitch, 1.0), Vec3::new(0.5, -pitch, -1.0)]
    }

    /// The normal near the ridge, seen along `direction`, and the mirrored direction's height above the real surface.
    fn look(pitch: f32, direction: Vec3) -> (Vec3, f32) {
        let vertices = corners(pitch);
        let mesh = Mesh::new(&vertices, &[[0_u16, 2, 1], [0, 1, 3]]).unwrap();
        let normals = Smooth::normals(&mesh);
        let scene = Scene::new(List::new(&mesh).unwrap(), Smooth::new(mesh, &normals)).unwrap();
        let ray = Ray::new(Vec3::new(0.5, -pitch * 0.01, 0.01) - direction, direction);
        let surface = scene.surface(&ray, &scene.closest_hit(&ray).unwrap());
        let direction = direction.normalize();
        let mirrored = direction - surface.shading_normal * (2.0 * direction.dot(surface.shading_normal));
        (surface.shading_normal, mirrored.dot(surface.normal_towards_ray()))
    }

    #[test]
    fn a_flat_roof_is_rounded_and_a_steep_one_is_not() {
        let (normal, _) = look(0.3, Vec3::NEG_Y);
        assert!(normal.y > 0.999, "{normal}");
        let (normal, _) = look(2.0, Vec3::NEG_Y);
        assert!(normal.y < 0.5, "{normal}");
    }

    #[test]
    fn nothing_is_mirrored_into_the_roof() {
        for slope in [0.35, 0.5, 2.0] {
            let (_, height) = look(0.3, Vec3::new(0.0, -slope, -1.0));
            assert!(height > 0.0, "{slope}: {height}");
        }
    }
}
