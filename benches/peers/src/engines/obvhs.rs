use std::time::Duration;

use obvhs::{
    BvhBuildParams,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    cwbvh::{CwBvh, builder::build_cwbvh_from_tris},
    ray::{Ray, RayHit},
    rt_triangle::RtTriangle,
    triangle::Triangle,
};

use super::{Contender, Engine, Role, Wanted, shadow};
use crate::{clock::time_build, mesh::Mesh};

/// Builds those of obvhs that are wanted.
pub fn obvhs(mesh: &Mesh, wanted: &Wanted) -> Vec<Contender<'static>> {
    let triangles = triangles(mesh);
    [CwBvhVerySlow::contender(&triangles, wanted), Bvh2VerySlow::contender(&triangles, wanted)]
        .into_iter()
        .flatten()
        .collect()
}

/// The mesh as its builders want it.
fn triangles(mesh: &Mesh) -> Vec<Triangle> {
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
    ($(#[$doc:meta])* $engine:ident, $bvh:ty, $build:ident, $name:literal) => {
        $(#[$doc])*
        struct $engine {
            bvh: $bvh,
            triangles: Vec<RtTriangle>,
        }

        impl $engine {
            /// Builds it if it is wanted; the triangles put in order afterwards do not count.
            fn contender(triangles: &[Triangle], wanted: &Wanted) -> Option<Contender<'static>> {
                if !wanted.has($name) {
                    return None;
                }
                let (bvh, build) = time_build(|| {
                    $build(triangles, BvhBuildParams::very_slow_build(), &mut Duration::default())
                });
                let triangles = in_order(triangles, &bvh.primitive_indices);
                let engine = Box::new(Self { bvh, triangles });
                Some(Contender { name: $name.into(), role: Some(Role::Obvhs), build, engine })
            }
        }

        impl Engine for $engine {
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
    /// obvhs' compressed wide BVH.
    CwBvhVerySlow, CwBvh, build_cwbvh_from_tris, "obvhs CwBvh"
}

engine! {
    /// obvhs' binary BVH.
    Bvh2VerySlow, Bvh2, build_bvh2_from_tris, "obvhs Bvh2"
}
