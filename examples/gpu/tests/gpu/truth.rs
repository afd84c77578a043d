//! Real meshes: certain rays against the truth in double precision, and all rays against the library.

use std::{collections::HashMap, env, fs, path::Path};

use hitscan::{Hit, Ray, accel::Plan, asset::Asset, bvh, dualsplit, glam::Vec3};
use hitscan_gpu::{Parts, Query, Uploaded, World, settle};

use crate::{
    common::bits,
    scene::{Form, baker, device, plans, say},
};

/// Meshes above this many triangles are tested with one structure, one that is built quickly.
const LARGE: usize = 20_000;

fn floats(path: &Path) -> Vec<f32> {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    bytes.as_chunks().0.iter().copied().map(f32::from_le_bytes).collect()
}

/// Vertices welded by their bits, and triangles in the file's order.
fn load(path: &Path) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut numbers, mut vertices) = (HashMap::new(), Vec::new());
    let mut number = |p: &[f32]| {
        *numbers.entry([p[0], p[1], p[2]].map(f32::to_bits)).or_insert_with(|| {
            vertices.push(Vec3::from_slice(p));
            vertices.len() as u32 - 1
        })
    };
    let corners: Vec<u32> = floats(path)[1..].chunks_exact(3).map(&mut number).collect();
    (vertices, corners.as_chunks().0.to_vec())
}

/// Whether a hit is a fault by the reference's record of 24 bytes, if that is certain.
fn is_fault(record: &[u8], ray: &Ray, hit: Option<Hit>, delta: f64) -> Option<bool> {
    let word = |i: usize| u32::from_le_bytes(record[i..i + 4].try_into().unwrap());
    let t = f64::from_le_bytes(record[..8].try_into().unwrap());
    let (primitive, ties, flags) = (word(16), word(20) & 0xffff, word(20) >> 16);
    let (is_hit, is_ambiguous, is_certain) = (flags & 1 != 0, flags & 2 != 0, flags & 64 != 0);
    let length = ray.direction.to_array().map(|x| f64::from(x).powi(2)).iter().sum::<f64>().sqrt();
    let tolerance = 1.0e-4 * if is_hit { t.abs() } else { 0.0 } + 8.0 * delta / length;
    is_certain.then(|| match hit {
        None => is_hit,
        Some(hit) => {
            let other = ties <= 1 && !is_ambiguous && hit.primitive != primitive;
            !is_hit || (f64::from(hit.t) - t).abs() > tolerance || other
        }
    })
}

#[test]
fn real_meshes_are_answered_as_in_double_precision() {
    let Some(device) = device() else { return };
    let Some(folder) = env::var_os("HITSCAN_DATA") else {
        say("\n*** SKIPPED: the truth test. HITSCAN_DATA names no folder of meshes, so NOTHING WAS COMPARED. ***\n\n");
        return;
    };
    let folder = Path::new(&folder);
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "tri"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert!(!names.is_empty());
    say(
        "| mesh | structure | certain rays | faults | finished, closest | finished, any |\n|---|---|---|---|---|---|\n",
    );
    for (index, name) in names.iter().enumerate() {
        let (vertices, triangles) = load(&folder.join(format!("{name}.tri")));
        let truth = |extension: &str| folder.join("truth").join(format!("{name}.{extension}"));
        // The reference counts hits at t > 0 only.
        let ray = |r: &[f32]| Ray::new(Vec3::from_slice(r), Vec3::from_slice(&r[3..])).starting_at(f32::from_bits(1));
        let rays: Vec<Ray> = floats(&truth("rays")).chunks_exact(6).map(ray).collect();
        let answers = fs::read(truth("f64")).unwrap();
        let text = fs::read_to_string(truth("json")).unwrap();
        let (_, number) = text.split_once("\"delta\":").unwrap();
        let delta: f64 = number[..number.find([',', '}']).unwrap()].trim().parse().unwrap();
        let quick = [
            Plan::DualSplit(dualsplit::Options::quick()),
            Plan::Bvh(bvh::Options { reinsertions: 0, ..bvh::Options::balanced() }),
        ];
        let some = if triangles.len() > LARGE { vec![quick[index % 2]] } else { plans().to_vec() };
        for (step, plan) in some.into_iter().enumerate() {
            let words = baker(&vertices, &triangles, &plan, Form::Plain).unwrap().finish();
            let asset = Asset::from_words(&words).unwrap();
            let parts = Parts::read(&asset).unwrap();
            let world = World::read(&asset, &parts).unwrap();
            let uploaded = Uploaded::new(device, &asset, None).unwrap();
            let said = uploaded.cast(&rays, Query::Closest);
            let (hits, tally) = settle(&world, &rays, &said, Query::Closest);
            let (mut certain, mut faults) = (0, 0);
            for ((ray, hit), record) in rays.iter().zip(&hits).zip(answers.chunks_exact(24)) {
                assert_eq!(bits(*hit), bits(world.as_caster().closest_hit(ray, 0)), "{name} {ray:?}");
                let fault = is_fault(record, ray, *hit, delta);
                certain += usize::from(fault.is_some());
                faults += usize::from(fault == Some(true));
            }
            // As another GPU may round: all of one structure, and some of the others.
            let some = rays.len() / if (index + step).is_multiple_of(3) { 1 } else { 8 };
            let roughly = Uploaded::new(device, &asset, None).unwrap().roughly();
            let (rough, rough_tally) =
                settle(&world, &rays[..some], &roughly.cast(&rays[..some], Query::Closest), Query::Closest);
            assert!(rough.iter().zip(&hits).all(|(a, b)| bits(*a) == bits(*b)), "{name}");
            assert_eq!(rough_tally.refuted, 0, "{name}");
            let (any, any_tally) = settle(&world, &rays, &uploaded.cast(&rays, Query::Any), Query::Any);
            assert!(any.iter().zip(&hits).all(|(any, hit)| any.is_some() == hit.is_some()), "{name}");
            let share = |finished: usize| 100.0 * finished as f64 / rays.len() as f64;
            say(&format!(
                "| {name} | {:?} | {certain} | {faults} | {:.2} % | {:.2} % |\n",
                plan.kind().unwrap(),
                share(tally.finished),
                share(any_tally.finished)
            ));
            assert_eq!((faults, tally.refuted, any_tally.refuted), (0, 0, 0), "{name}");
            // A quarter of these rays are aimed at edges and corners.
            assert!(tally.finished * 2 < rays.len(), "{name} {tally:?}");
        }
    }
}
