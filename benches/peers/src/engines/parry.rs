use hitscan::Ray;
use parry3d::{math::Vector, query, query::RayCast, shape::TriMesh};

use super::{Contender, Engine, Wanted, shadow};
use crate::{clock::time_build, mesh::Mesh};

/// parry3d's triangle mesh; its rays begin at 0.
struct Parry(TriMesh);

/// Builds it if it is wanted.
pub fn parry(mesh: &Mesh, wanted: &Wanted) -> Option<Contender<'static>> {
    const NAME: &str = "parry3d TriMesh";
    if !wanted.has(NAME) {
        return None;
    }
    let vertices: Vec<_> = mesh.vertices().map(|v| Vector::new(v.x, v.y, v.z)).collect();
    let corners: Vec<_> = mesh.corners().collect();
    let (built, build) = time_build(|| TriMesh::new(vertices.clone(), corners.clone()));
    let engine = Box::new(Parry(built.inspect_err(|error| eprintln!("{NAME}: {error}")).ok()?));
    Some(Contender { name: NAME.into(), role: None, build, engine })
}

fn ray(ray: &Ray) -> query::Ray {
    let vector = |v: hitscan::glam::Vec3| Vector::new(v.x, v.y, v.z);
    query::Ray::new(vector(ray.origin), vector(ray.direction))
}

impl Engine for Parry {
    fn bytes(&self) -> usize {
        self.0.bvh().heap_memory_size() + size_of_val(self.0.vertices()) + size_of_val(self.0.indices())
    }

    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(
            rays.iter().map(|origin| self.0.cast_local_ray(&ray(origin), origin.t_max, false).unwrap_or(f32::INFINITY)),
        );
    }

    fn any(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|origin| shadow(self.0.intersects_local_ray(&ray(origin), origin.t_max))));
    }
}
