//! What the tests share: assets, and both ways of casting rays at them.

use std::{
    env,
    io::{self, Write},
    sync::OnceLock,
};

use hitscan::{
    Mesh, Ray,
    accel::{Plan, Structure},
    asset::Asset,
    bake::{self, Baker},
    bvh, dualsplit,
    glam::Vec3,
    kdtree,
};
use hitscan_gpu::{Device, Parts, Query, Tally, Uploaded, World, settle};

use crate::common::bits;

/// Past the test harness, which keeps what `eprintln` says of tests that pass.
pub fn say(text: &str) {
    io::stderr().lock().write_all(text.as_bytes()).unwrap();
}

/// The GPU of all tests, opened once: shaders take seconds to compile.
pub fn device() -> Option<&'static Device> {
    static DEVICE: OnceLock<Option<Device>> = OnceLock::new();
    let opened = DEVICE.get_or_init(|| match Device::open(None) {
        Ok(device) => Some(device),
        Err(error) => {
            assert!(env::var_os("HITSCAN_GPU_REQUIRED").is_none(), "{error}");
            say(&format!("\n*** SKIPPED: {error}. NOTHING WAS COMPARED. ***\n\n"));
            None
        }
    });
    opened.as_ref()
}

/// The three structures that shaders walk.
pub fn plans() -> [Plan; 3] {
    [
        Plan::KdTree(kdtree::Options::fast()),
        Plan::DualSplit(dualsplit::Options::balanced()),
        Plan::Bvh(bvh::Options::balanced()),
    ]
}

/// How the triangles of an asset are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// As they are.
    Plain,
    /// In the order of the leaves, with the numbers of old.
    Numbered,
    /// Corners in bytes.
    Meshlets,
    /// On a lattice.
    OnLattice,
}

impl Form {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Plain, Self::Numbered, Self::Meshlets, Self::OnLattice];
}

/// An asset that is not put together yet; none if nothing can be built over the mesh.
pub fn baker(vertices: &[Vec3], triangles: &[[u32; 3]], plan: &Plan, form: Form) -> Option<Baker> {
    let mesh = Mesh::new(vertices, triangles).ok()?;
    let words = bake::build(&mesh, plan).ok()?;
    let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
    match form {
        Form::Plain => Some(Baker::new().mesh(&mesh).structure(structure)),
        Form::Numbered => {
            let Some((words, order)) = bake::ordered(&structure) else {
                return baker(vertices, triangles, plan, Form::Plain);
            };
            let corners = bake::reorder(&mesh, &order);
            let mesh = Mesh::new(vertices, &corners[..]).unwrap();
            let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
            Some(Baker::new().mesh(&mesh).structure(structure).numbers(&order))
        }
        Form::OnLattice => {
            let snapped = bake::lattice(&mesh);
            let mesh = snapped.mesh(&mesh).ok()?;
            let words = bake::build(&mesh, plan).ok()?;
            let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
            Some(Baker::new().lattice_mesh(&mesh).structure(structure))
        }
        Form::Meshlets => {
            let meshlets = bake::meshlets(&mesh);
            let vertices = meshlets.vertices(vertices);
            let mesh = Mesh::new(&vertices, meshlets.indices()).ok()?;
            let words = bake::build(&mesh, plan).ok()?;
            let structure = Structure::open(plan.kind().unwrap(), &words).unwrap();
            Some(Baker::new().mesh(&mesh).structure(structure))
        }
    }
}

/// Casts rays both ways and compares all; none if the asset is not for shaders.
pub fn compare(device: &Device, words: &[u32], rays: &[Ray], binding: Option<u64>) -> Option<Tally> {
    let asset = Asset::from_words(words).unwrap();
    let parts = Parts::read(&asset).unwrap();
    let world = World::read(&asset, &parts).unwrap();
    let mut uploaded = Uploaded::new(device, &asset, binding).ok()?;
    let mut sum = Tally::default();
    for (query, rough) in [(Query::Closest, false), (Query::Any, false), (Query::Closest, true)] {
        if rough {
            uploaded = uploaded.roughly();
        }
        let answers = uploaded.cast(rays, query);
        assert_eq!(answers.len(), rays.len());
        let (hits, tally) = settle(&world, rays, &answers, query);
        for ((ray, hit), answer) in rays.iter().zip(&hits).zip(&answers) {
            let expected = world.as_caster().closest_hit(ray, 0);
            match query {
                Query::Closest => {
                    assert_eq!(bits(*hit), bits(expected), "{ray:?} {answer:?}");
                    // Certain answers need nobody to mend them.
                    assert!(!answer.is_certain() || answer.place().is_some() == expected.is_some(), "{ray:?}");
                }
                Query::Any => {
                    assert_eq!(hit.is_some(), expected.is_some(), "{ray:?} {answer:?}");
                }
            }
        }
        assert_eq!(tally.refuted, 0, "{rough}");
        sum.rays += tally.rays;
        sum.finished += tally.finished;
    }
    Some(sum)
}
