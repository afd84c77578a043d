use bvh::{
    aabb::{Aabb, Bounded},
    bounding_hierarchy::BHShape,
    bvh::{Bvh, BvhNode},
    ray::Ray,
};
use nalgebra::{Point3, Vector3};

use super::{Contender, Engine, Wanted, shadow};
use crate::{clock::time_build, mesh::Mesh};

/// A triangle by a corner and two edges.
#[derive(Clone)]
struct Triangle {
    corner: Vector3<f32>,
    edges: [Vector3<f32>; 2],
    bounds: Aabb<f32, 3>,
    node: usize,
}

impl Triangle {
    fn new(corners: [hitscan::glam::Vec3; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| Point3::from(corner.to_array()));
        let bounds = Aabb::with_bounds(a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        Self { corner: a.coords, edges: [b - a, c - a], bounds, node: 0 }
    }

    /// The `t` of the hit, infinite for a miss (Möller and Trumbore 1997): the crate's own test sees front faces only.
    fn intersect(&self, ray: &Ray<f32, 3>) -> f32 {
        let [b, c] = self.edges;
        let p = ray.direction.cross(&c);
        let inverse = b.dot(&p).recip();
        let from = ray.origin.coords - self.corner;
        let q = from.cross(&b);
        let (u, v) = (from.dot(&p) * inverse, ray.direction.dot(&q) * inverse);
        let t = c.dot(&q) * inverse;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 { t } else { f32::INFINITY }
    }
}

impl Bounded<f32, 3> for Triangle {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.bounds
    }
}

impl BHShape<f32, 3> for Triangle {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The crate `bvh`; its rays begin at 0.
struct Plain {
    tree: Bvh<f32, 3>,
    triangles: Vec<Triangle>,
}

/// Builds it if it is wanted.
pub fn bvh(mesh: &Mesh, wanted: &Wanted) -> Option<Contender<'static>> {
    const NAME: &str = "bvh";
    if !wanted.has(NAME) {
        return None;
    }
    let mut triangles: Vec<Triangle> = mesh.triangles().map(Triangle::new).collect();
    let (tree, build) = time_build(|| Bvh::build(&mut triangles));
    Some(Contender { name: NAME.into(), role: None, build, engine: Box::new(Plain { tree, triangles }) })
}

fn ray(ray: &hitscan::Ray) -> Ray<f32, 3> {
    let mut converted = Ray::new(ray.origin.to_array().into(), Vector3::x());
    // `new` would make its length one, and every `t` another.
    converted.direction = ray.direction.to_array().into();
    converted.inv_direction = converted.direction.map(f32::recip);
    converted
}

impl Engine for Plain {
    fn bytes(&self) -> usize {
        self.tree.nodes.len() * size_of::<BvhNode<f32, 3>>() + size_of_val(&self.triangles[..])
    }

    fn closest(&self, rays: &[hitscan::Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|origin| {
            let ray = ray(origin);
            let mut best = origin.t_max;
            let mut hit = f32::INFINITY;
            // Nearly sorted by where the ray enters their boxes, which is not enough to stop early.
            for triangle in self.tree.nearest_traverse_iterator(&ray, &self.triangles) {
                let t = triangle.intersect(&ray);
                if t <= best {
                    (best, hit) = (t, t);
                }
            }
            hit
        }));
    }

    fn any(&self, rays: &[hitscan::Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|origin| {
            let ray = ray(origin);
            let mut candidates = self.tree.traverse_iterator(&ray, &self.triangles);
            shadow(candidates.any(|triangle| triangle.intersect(&ray) <= origin.t_max))
        }));
    }
}
