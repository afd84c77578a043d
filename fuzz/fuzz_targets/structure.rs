//! Any bits as a mesh, options and rays: refused, or the structure answers as the list.
#![no_main]

use hitscan::{
    Arena, List, Mesh, Ray, Scene,
    accel::{Plan, Structure},
    bvh, dualsplit,
    glam::Vec3,
    grid, kdtree, octree,
};
use libfuzzer_sys::{
    arbitrary::{self, Arbitrary},
    fuzz_target,
};

#[derive(Arbitrary, Debug)]
struct Input {
    vertices: Vec<[u32; 3]>,
    triangles: Vec<[u8; 3]>,
    rays: Vec<([u32; 3], [u32; 3], [u32; 2])>,
    kind: u8,
    how: u8,
    leaf_size: u8,
    depth: u8,
    cost: u32,
    bytes: u16,
    memory: u16,
}

impl Input {
    fn plan(&self) -> Plan {
        let pick = usize::from(self.how);
        let (leaf_size, intersection_cost, clip) = (self.leaf_size.into(), f32::from_bits(self.cost), self.how < 200);
        let max_bytes = (self.bytes > 0).then_some(self.bytes.into());
        let kd = kdtree::Options {
            split: [kdtree::Split::Midpoint, kdtree::Split::Median, kdtree::Split::Sah][pick % 3],
            leaf_size,
            max_depth: Some(self.depth.into()),
            intersection_cost,
            clip,
            max_bytes,
            ..kdtree::Options::fast()
        };
        match self.kind % 6 {
            0 => Plan::Grid(grid::Options {
                density: intersection_cost,
                form: grid::Form::ALL[pick % 3],
                clip,
                max_bytes,
                ..grid::Options::fast()
            }),
            1 => Plan::Octree(octree::Options {
                split: [octree::Split::Middle, octree::Split::Sah][pick % 2],
                leaf_size,
                max_depth: self.depth.into(),
                intersection_cost,
                clip,
                max_bytes,
                ..octree::Options::fast()
            }),
            2 => Plan::KdTree(kd),
            3 => Plan::CompactKdTree(kd),
            4 => Plan::Bvh(bvh::Options {
                method: [bvh::Method::Sah, bvh::Method::Ploc][pick % 2],
                leaf_size,
                intersection_cost,
                reinsertions: u32::from(self.depth % 4),
                max_bytes,
                ..bvh::Options::fast()
            }),
            _ => Plan::DualSplit(dualsplit::Options { leaf_size, intersection_cost, ..dualsplit::Options::fast() }),
        }
    }
}

fn vector(bits: [u32; 3]) -> Vec3 {
    Vec3::from_array(bits.map(f32::from_bits))
}

fuzz_target!(|input: Input| {
    let plan = input.plan();
    let vertices: Vec<Vec3> = input.vertices.into_iter().map(vector).collect();
    let triangles: Vec<[u32; 3]> = input.triangles.into_iter().map(|corners| corners.map(u32::from)).collect();
    let Ok(mesh) = Mesh::new(&vertices, &triangles[..]) else { return };
    let mut memory = vec![0; usize::from(input.memory)];
    let Ok(built) = Structure::build(&mesh, &mut Arena::new(&mut memory), &plan) else { return };
    let kind = plan.kind().expect("no list is planned");
    let opened = Structure::open(kind, built.as_words()).expect("a structure that was built can be opened");
    let (scene, list) = (Scene::new(opened, mesh).unwrap(), Scene::new(List::new(&mesh).unwrap(), mesh).unwrap());
    for (origin, direction, [t_min, t_max]) in input.rays {
        let ray = Ray::new(vector(origin), vector(direction));
        for ray in [ray, ray.starting_at(f32::from_bits(t_min)).up_to(f32::from_bits(t_max))] {
            assert_eq!(scene.closest_hit(&ray), list.closest_hit(&ray));
            assert_eq!(scene.any_hit(&ray), list.any_hit(&ray));
        }
        assert_eq!(scene.nearest_point(ray.origin, f32::MAX), list.nearest_point(ray.origin, f32::MAX));
    }
});
