use hitscan::glam::Vec3;

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
