//! Any bytes as a model file of every format: refused in words, or a model that is what it promises to be.
#![no_main]

use std::{env, fs, path::PathBuf, process, sync::LazyLock};

use libfuzzer_sys::fuzz_target;

#[allow(dead_code)]
#[path = "../../cli/src/input.rs"]
mod input;
#[allow(dead_code, unused_imports)]
#[path = "../../cli/src/model/mod.rs"]
mod model;
#[allow(dead_code)]
#[path = "../../cli/src/units.rs"]
mod units;

/// Files to write to, one for each format.
static FILES: LazyLock<[PathBuf; 6]> = LazyLock::new(|| {
    let folder = env::temp_dir().join(format!("hitscan-fuzz-{}", process::id()));
    fs::create_dir_all(&folder).expect("a folder for models");
    ["obj", "stl", "ply", "gltf", "glb", "obj.gz"].map(|extension| folder.join("model").with_extension(extension))
});

// The loader itself catches what readers of others panic of.
fuzz_target!(|bytes: &[u8]| {
    let Some((&format, bytes)) = bytes.split_first() else { return };
    let path = &FILES[usize::from(format) % FILES.len()];
    fs::write(path, bytes).expect("a disk with room");
    match model::Model::load(path) {
        Ok(mut model) => {
            assert!(!model.triangles.is_empty() && !model.materials.is_empty());
            assert!(model.vertices.iter().flatten().all(|x| x.is_finite()));
            assert!(model.triangles.iter().flatten().all(|&vertex| (vertex as usize) < model.vertices.len()));
            assert!(model.material_ids.is_empty() || model.material_ids.len() == model.triangles.len());
            assert!(model.material_ids.iter().all(|&id| usize::from(id) < model.materials.len()));
            let pictured: Vec<bool> = model.materials.iter().map(|material| material.image.is_some()).collect();
            let is_pictured = |id: u16| pictured.get(usize::from(id)) == Some(&true);
            if model.settle(is_pictured).is_ok() {
                let mapped = |triangle: usize| model.mapping.of(triangle).is_some();
                assert!((0..model.triangles.len()).all(|at| !is_pictured(model.material(at)) || mapped(at)));
            }
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
});
