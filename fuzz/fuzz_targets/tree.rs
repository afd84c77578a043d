//! Any bits as a mesh, options and rays: refused, or the kD-tree answers as the list.
#![no_main]

use hitscan::{
    Arena, KdTree, List, Mesh, Ray, Scene,
    glam::Vec3,
    kdtree::{Options, Split},
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
    split: u8,
    leaf_size: u8,
    depth: u8,
    cost: u32,
    bytes: u16,
    memory: u16,
}

fn vector(bits: [u32; 3]) -> Vec3 {
    Vec3::from_array(bits.map(f32::from_bits))
}

fuzz_target!(|input: Input| {
    let vertices: Vec<Vec3> = input.vertices.into_iter().map(vector).collect();
    let triangles: Vec<[u32; 3]> = input.triangles.into_iter().map(|corners| corners.map(u32::from)).collect();
    let Ok(mesh) = Mesh::new(&vertices, &triangles[..]) else { return };
    let options = Options {
        split: [Split::Midpoint, Split::Median, Split::Sah][usize::from(input.split) % 3],
        leaf_size: input.leaf_size.into(),
        max_depth: Some(input.depth.into()),
        intersection_cost: f32::from_bits(input.cost),
        clip: input.split < 200,
        max_bytes: (input.bytes > 0).then_some(input.bytes.into()),
        ..Options::fast()
    };
    let mut memory = vec![0; usize::from(input.memory)];
    let Ok(tree) = KdTree::build(&mesh, &mut Arena::new(&mut memory), &options) else { return };
    let tree = KdTree::open(tree.as_words()).expect("a tree that was built can be opened");
    let (tree, list) = (Scene::new(tree, mesh).unwrap(), Scene::new(List::new(&mesh).unwrap(), mesh).unwrap());
    for (origin, direction, [t_min, t_max]) in input.rays {
        let ray = Ray::new(vector(origin), vector(direction));
        for ray in [ray, ray.starting_at(f32::from_bits(t_min)).up_to(f32::from_bits(t_max))] {
            assert_eq!(tree.closest_hit(&ray), list.closest_hit(&ray));
            assert_eq!(tree.any_hit(&ray), list.any_hit(&ray));
        }
    }
});
