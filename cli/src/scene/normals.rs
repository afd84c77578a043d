use std::collections::HashMap;

use hitscan::{Mesh, Primitives, glam::Vec3};

/// The mean normal of the triangles around each vertex, weighted by their areas; what stands at the same place is one
/// vertex.
pub fn normals_by_place(mesh: &Mesh<'_>) -> Vec<Vec3> {
    let key = |at: Vec3| (at + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut sums = HashMap::new();
    for index in 0..mesh.len() {
        let triangle = mesh.triangle(index);
        for corner in [triangle.a, triangle.b, triangle.c] {
            *sums.entry(key(corner)).or_insert(Vec3::ZERO) += triangle.normal();
        }
    }
    // Scaled first, so that squares neither overflow nor vanish.
    let unit = |sum: &Vec3| (*sum / sum.abs().max_element()).normalize_or_zero();
    let mean = |at: &Vec3| sums.get(&key(*at)).map_or(Vec3::ZERO, unit);
    mesh.vertices().iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use hitscan::{List, Ray, Scene, primitives::Smooth};

    use super::*;

    /// A roof of two slopes over the x axis, each rising `pitch` over a width of 1.
    fn corners(pitch: f32) -> [Vec3; 4] {
        [Vec3::ZERO, Vec3::X, Vec3::new(0.5, -pitch, 1.0), Vec3::new(0.5, -pitch, -1.0)]
    }

    /// The normal near the ridge, seen along `direction`, and the mirrored direction's height above the real surface.
    fn look(pitch: f32, direction: Vec3) -> (Vec3, f32) {
        let vertices = corners(pitch);
        let mesh = Mesh::new(&vertices, &[[0_u16, 2, 1], [0, 1, 3]]).unwrap();
        let normals = normals_by_place(&mesh);
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
    fn a_roof_of_any_size_is_rounded() {
        for size in [1.0e-12, 1.0e12] {
            let vertices = corners(0.3).map(|corner| corner * size);
            let mesh = Mesh::new(&vertices, &[[0_u16, 2, 1], [0, 1, 3]]).unwrap();
            let [ridge, ..] = normals_by_place(&mesh)[..] else { panic!("no normals") };
            assert!((ridge - Vec3::Y).length() < 1.0e-6, "{ridge}");
        }
    }

    #[test]
    fn nothing_is_mirrored_into_the_roof() {
        for slope in [0.35, 0.5, 2.0] {
            let (_, height) = look(0.3, Vec3::new(0.0, -slope, -1.0));
            assert!(height > 0.0, "{slope}: {height}");
        }
    }
}
