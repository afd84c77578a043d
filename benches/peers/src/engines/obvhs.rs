use std::time::Duration;

use obvhs::{
    BvhBuildParams,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    cwbvh::{CwBvh, builder::build_cwbvh_from_tris},
    ray::{Ray, RayHit},
    rt_triangle::RtTriangle,
    triangle::Triangle,
};

use super::{Engine, shadow};
use crate::{clock::time, mesh::Mesh};

/// The mesh as obvhs' builders want it.
pub fn obvhs_triangles(mesh: &Mesh) -> Vec<Triangle> {
    mesh.triangles()
        .map(|corners| corners.map(|corner| corner.to_array().into()))
        .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
        .collect()
}

/// The triangles in the order of the leaves: its documentation's way to spare an indirection, its type for speed on CPUs.
fn in_order(triangles: &[Triangle], order: &[u32]) -> Vec<RtTriangle> {
    order.iter().map(|&number| RtTriangle::from(&triangles[number as usize])).collect()
}

fn ray(ray: &hitscan::Ray) -> Ray {
    Ray::new(ray.origin.to_array().into(), ray.direction.to_array().into(), ray.t_min, ray.t_max)
}

macro_rules! engine {
    ($(#[$doc:meta])* $engine:ident, $bvh:ty, $build:ident, $preset:ident, $name:literal) => {
        $(#[$doc])*
        pub struct $engine {
            bvh: $bvh,
            triangles: Vec<RtTriangle>,
        }

        impl $engine {
            /// Builds it; the triangles put in order afterwards do not count.
            pub fn build(triangles: &[Triangle]) -> (Self, Duration) {
                let build = || $build(triangles, BvhBuildParams::$preset(), &mut Duration::default());
                let (_, first) = time(build);
                let (bvh, second) = time(build);
                let triangles = in_order(triangles, &bvh.primitive_indices);
                (Self { bvh, triangles }, first.min(second))
            }
        }

        impl Engine for $engine {
            fn name(&self) -> String {
                $name.into()
            }

            fn bytes(&self) -> usize {
                size_of_val(&self.bvh.nodes[..])
                    + size_of_val(&self.bvh.primitive_indices[..])
                    + size_of_val(&self.triangles[..])
            }

            fn closest(&self, rays: &[hitscan::Ray], t: &mut Vec<f32>) {
                t.extend(rays.iter().map(|origin| {
                    let mut hit = RayHit::none();
                    self.bvh.ray_traverse(ray(origin), &mut hit, |ray, id| self.triangles[id].intersect(ray));
                    hit.t
                }));
            }

            fn any(&self, rays: &[hitscan::Ray], t: &mut Vec<f32>) {
                t.extend(rays.iter().map(|origin| {
                    shadow(!self.bvh.ray_traverse_miss(ray(origin), |ray, id| self.triangles[id].intersect(ray)))
                }));
            }
        }
    };
}

engine! {
    /// obvhs' binary BVH by the `slow` preset: what the ratios refer to.
    Bvh2Slow, Bvh2, build_bvh2_from_tris, slow_build, "obvhs bvh2.slow"
}

engine! {
    /// obvhs' compressed wide BVH by the `very_slow` preset.
    CwBvhVerySlow, CwBvh, build_cwbvh_from_tris, very_slow_build, "obvhs cwbvh.very_slow"
}
