//! What a caller is told: every error says what is wrong, and where.
#![allow(missing_docs)]

use std::error;

use hitscan::{
    Arena, Error, KdTree, List, Mesh, Scene,
    accel::{Malformed, Reason},
    arena::Full,
    asset::{Asset, AssetError, Kind},
    error::BuildError,
    geometry::{Sphere, Transform},
    glam::{Mat3, Vec3},
    instances::InstanceError,
    lattice_scene::LatticeError,
    primitives::{MeshError, Order, Renumbering, Reordered, Spheres},
    render::{Texels, Texture},
    scene::Mismatch,
};

const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

fn says(error: impl Into<Error>, message: &str) {
    let error = error.into();
    assert_eq!(error.to_string(), message);
    assert!(error::Error::source(&error).is_none(), "{message}: nothing stands behind it");
}

#[test]
fn what_is_no_mesh() {
    says(Mesh::new(&CORNERS, &[[0_u32, 1, 7]]).unwrap_err(), "triangle 0 names vertex 7, but there are 3 vertices");
    let corners = [Vec3::ZERO, Vec3::NAN, Vec3::Y];
    says(Mesh::new(&corners, &[[0_u32, 1, 2]]).unwrap_err(), "vertex 1 of triangle 0 is not finite or beyond 2^126");
    let mesh = Mesh::new(&CORNERS, &[[0_u32, 1, 2]]).unwrap();
    says(mesh.with_masks(&[1, 2]).unwrap_err(), "2 masks were given for 1 triangles");
    says(MeshError::Frame, "the box of the lattice is empty, not finite or beyond 2^126");
    says(
        MeshError::Meshlets { meshlets: 1, triangles: 65 },
        "1 first vertices were given for 65 triangles, not one for each 64",
    );
    says(MeshError::TooMany, "a mesh holds at most 2^32 - 2 triangles");
}

#[test]
fn what_is_no_shape_no_order_no_map() {
    let point = [Sphere { center: Vec3::ZERO, radius: 0.0 }];
    says(Spheres::new(&point).unwrap_err(), "sphere 0 (radius 0) needs a finite centre and a radius above 0");
    let mesh = Mesh::new(&CORNERS, &[[0_u32, 1, 2]; 2]).unwrap();
    let order = Order::Wide(&[1, 1]);
    says(Renumbering::new(order, order).unwrap_err(), "the order of primitives and its inverse differ at place 0");
    let order = Order::Narrow(&[0]);
    says(
        Reordered::new(mesh, Renumbering::new(order, order).unwrap()).unwrap_err(),
        "the order of primitives and its inverse differ at place 2",
    );
    says(Transform::new(Mat3::ZERO, Vec3::ZERO).unwrap_err(), "the transform cannot be inverted: its determinant is 0");
}

#[test]
fn what_is_no_texture() {
    let texture = |width, texels| Texture::new(width, 2, texels).unwrap_err();
    says(texture(0, Texels::Rgb565(&[])), "the texture has no pixels");
    says(texture(3, Texels::Rgb565(&[0; 5])), "the texture's slice should have 6 elements, not 5");
    // Two texels an element.
    let texels = Texels::Palette4 { palette: &[0], texels: &[0; 6] };
    says(texture(3, texels), "the texture's slice should have 3 elements, not 6");
}

#[test]
fn what_cannot_be_built() {
    let mesh = Mesh::new(&CORNERS, &[[0_u32, 1, 2]; 9]).unwrap();
    let mut memory = [0; 4];
    let full = KdTree::build(&mesh, &mut Arena::new(&mut memory), &Default::default()).unwrap_err();
    let BuildError::Full(Full { at_least, available: 4 }) = full else { panic!("{full}") };
    says(full, &format!("the arena has 4 words free, at least {at_least} are needed"));
    says(BuildError::Bounds { primitive: 4 }, "the bounds of primitive 4 are empty, not finite or beyond 2^126");
    says(BuildError::TooMany { limit: 65_536 }, "the structure can name at most 65536 of them");
    says(BuildError::Budget { at_least: 40, allowed: 8 }, "8 bytes are allowed, at least 40 are needed");

    let list = List::new(&Mesh::new(&CORNERS, &[[0_u32, 1, 2]]).unwrap()).unwrap();
    let mismatch = Scene::new(list, mesh).unwrap_err();
    assert_eq!(mismatch, Mismatch { structure: 1, primitives: 9 });
    says(mismatch, "the structure is over 1 primitives, but there are 9");
    says(LatticeError::Mismatch(mismatch), "the structure is over 1 primitives, but there are 9");
    says(LatticeError::Frame, "the bounds of the structure are not the frame of the lattice");
    says(LatticeError::TooFine, "planes of the lattice have the same position: its frame is too small");
}

#[test]
fn what_cannot_be_placed() {
    let errors = [
        (InstanceError::Scene { instance: 2, scene: 7, scenes: 3 }, "instance 2 places scene 7, but there are 3"),
        (InstanceError::Place { instance: 2 }, "instance 2 lies where coordinates are not finite or beyond 2^126"),
        (InstanceError::Number { instance: 2 }, "instance 2 does not continue the numbers of the one before"),
        (InstanceError::Skewed { instance: 2 }, "instance 2 changes angles, and with them distances"),
        (InstanceError::TooMany, "at most 2^32 - 2 primitives can be numbered"),
    ];
    errors.into_iter().for_each(|(error, message)| says(error, message));
}

#[test]
fn what_is_no_asset() {
    says(Asset::from_words(&[7; 3]).unwrap_err(), "the asset has 12 bytes, 24 were expected");
    says(Asset::open(&[0; 14]).unwrap_err(), "the asset has 14 bytes, 24 were expected");
    let errors = [
        (AssetError::Misaligned, "the asset does not lie at a multiple of 4 bytes"),
        (AssetError::Magic { found: 0xBAD }, "not an asset: it begins with 0x00000bad"),
        (AssetError::ByteOrder, "the asset's byte order is not this machine's"),
        (AssetError::Version { kind: None, found: 9, supported: 1 }, "the asset has version 9, this library reads 1"),
        (
            AssetError::Version { kind: Some(Kind::Bvh), found: 9, supported: 1 },
            "the section of BVH has version 9, this library reads 1",
        ),
        (
            AssetError::Checksum { expected: 1, found: 2 },
            "the asset is damaged: its checksum is 0x00000002, not 0x00000001",
        ),
        (AssetError::Table { entry: 3 }, "entry 3 of the asset's table is wrong"),
        (AssetError::NoStructure, "the asset has no section that holds a structure"),
        (AssetError::Shape { kind: Kind::Part, words: 5 }, "a section of part cannot have 5 words"),
    ];
    errors.into_iter().for_each(|(error, message)| says(error, message));

    let kinds = [
        (Kind::Vertices, "vertices"),
        (Kind::LatticeVertices, "lattice vertices"),
        (Kind::Meshlets, "meshlets"),
        (Kind::NarrowIndices, "16-bit indices"),
        (Kind::WideIndices, "32-bit indices"),
        (Kind::Normals, "normals"),
        (Kind::TexCoords, "texture coordinates"),
        (Kind::Soup, "triangle soup"),
        (Kind::Spheres, "spheres"),
        (Kind::KdTree, "kD-tree"),
        (Kind::CompactKdTree, "compact kD-tree"),
        (Kind::Grid, "grid"),
        (Kind::Octree, "octree"),
        (Kind::Bvh, "BVH"),
        (Kind::DualSplit, "dual-split tree"),
        (Kind::Numbers, "numbers"),
        (Kind::Instances, "instances"),
        (Kind::Part, "part"),
        (Kind::Materials, "materials"),
        (Kind::MaterialNumbers, "material numbers"),
        (Kind::Textures, "textures"),
        (Kind::Unknown(0xBAD), "unknown (0x00000bad)"),
    ];
    for (kind, name) in kinds {
        says(AssetError::Missing { kind }, &format!("the asset has no section of {name}"));
    }
}

#[test]
fn what_is_no_structure() {
    says(KdTree::open(&[7; 3]).unwrap_err(), "no kD-tree: at word 0 its length is not what its header says");
    let reasons = [
        (Reason::Length, "its length is not what its header says"),
        (Reason::Header, "a number in the header is out of range"),
        (Reason::Bounds, "its bounds are not finite or not in order"),
        (Reason::Plane, "a plane is not finite or not in order"),
        (Reason::Link, "a node's child is not where it must be"),
        (Reason::Depth, "it is deeper than it says or than a walk's stack"),
        (Reason::References, "a leaf's references are not where they must be"),
        (Reason::Primitive, "a leaf names a primitive that does not exist, or once too often"),
    ];
    for (reason, what) in reasons {
        says(Malformed { structure: Kind::Octree, word: 12, reason }, &format!("no octree: at word 12 {what}"));
    }
}
