//! Small scenes written by hand, in each of the ways glTF packs them.

use super::super::{load_bytes, survives_damage};
use super::*;
use std::borrow::Cow;
use std::fs;

/// Four corners of a square and the indices 0 1 2 0 2 3.
fn payload() -> Vec<u8> {
    let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let mut bytes: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 1, 2, 0, 2, 3].map(u16::to_le_bytes).as_flattened());
    bytes
}

/// A scene of two nodes, the second the first one's child and three times as large.
fn json(uri: &str, mode: u32) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"mesh":0,"translation":[0,0,5],"children":[1]}},{{"mesh":0,"scale":[3,3,3]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0,"mode":{mode}}},
        {{"attributes":{{"POSITION":0}},"mode":0}}]}}],"materials":[{{"name":"gold","pbrMetallicRoughness":
        {{"baseColorFactor":[1,0.5,0,1],"roughnessFactor":0.25}}}}],"buffers":[{{{uri}"byteLength":60}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}}]}}"#
    )
}

fn embedded(mode: u32) -> String {
    let bytes: String = payload().iter().map(|byte| format!("%{byte:02x}")).collect();
    json(&format!(r#""uri":"data:application/octet-stream,{bytes}","#), mode)
}

fn binary() -> Vec<u8> {
    let mut json = json("", 4).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8], data: &[u8]| [&(data.len() as u32).to_le_bytes(), kind, data].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &payload())].concat();
    let size = (chunks.len() + 12) as u32;
    [b"glTF", &2_u32.to_le_bytes()[..], &size.to_le_bytes(), &chunks].concat()
}

#[test]
fn nodes_place_their_meshes() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a b.bin"), payload()).unwrap();
    let outside = folder.path().join("a.gltf");
    fs::write(&outside, json(r#""uri":"a%20b.bin","#, 4)).unwrap();
    for model in [
        Model::load(&outside).unwrap(),
        load_bytes("a.gltf", embedded(4).as_bytes()).unwrap(),
        load_bytes("a.glb", &binary()).unwrap(),
    ] {
        assert_eq!(model.vertices[2], [1.0, 1.0, 5.0]);
        assert_eq!(model.vertices[6], [3.0, 3.0, 5.0]);
        assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
        let placed = |vertices, triangles| Placement { part: 0, vertices, triangles };
        assert_eq!(model.placements, [placed(0..4, 0..2), placed(4..8, 2..4)]);
        let gold = &model.materials[0];
        assert_eq!((gold.name.as_str(), gold.diffuse), ("gold", [0.0; 3]));
        assert_eq!((gold.specular, gold.reflectivity), ([1.0, 0.5, 0.0], 0.75));
    }
}

#[test]
fn strips_and_fans_become_triangles() {
    let first_mesh = |mode| load_bytes("a.gltf", embedded(mode).as_bytes()).unwrap().triangles;
    assert_eq!(first_mesh(5)[..4], [[0, 1, 2], [1, 0, 2], [2, 0, 2], [0, 3, 2]]);
    assert_eq!(first_mesh(6)[..4], [[1, 2, 0], [2, 0, 0], [0, 2, 0], [2, 3, 0]]);
}

#[test]
fn errors_say_what_and_where() {
    let complaint = |from: &str, to: &str| {
        let text = embedded(4).replacen(from, to, 1);
        load_bytes("a.gltf", text.as_bytes()).unwrap_err().to_string()
    };
    let index = complaint("%02%00%00", "%09%00%00");
    assert!(index.contains("triangle 0 names vertex 9, but the file has 4 vertices"), "{index}");
    let nan = complaint("%80%3f", "%c0%7f");
    assert!(nan.contains("vertex 1 (counted from 0) is not finite"), "{nan}");
    let short = complaint("\"byteLength\":60", "\"byteLength\":61");
    assert!(short.contains("buffer `data:` cannot be read (60 of 61 bytes)"), "{short}");
    let cycle = complaint(r#""scale":[3,3,3]"#, r#""children":[0]"#);
    assert!(cycle.contains("do not form a tree"), "{cycle}");
    let count = complaint("\"count\":4", "\"count\":4000000000");
    assert!(count.contains("accessor 0 holds no positions"), "{count}");
    let kind = complaint("5126", "5123");
    assert!(kind.contains("accessor 0 holds no positions"), "{kind}");
    let remote = load_bytes("a.gltf", json(r#""uri":"https://a/b","#, 4).as_bytes());
    assert!(remote.unwrap_err().to_string().contains("not a local file"));
    let lost = load_bytes("a.gltf", json(r#""uri":"b.bin","#, 4).as_bytes());
    assert!(lost.unwrap_err().to_string().contains("buffer `b.bin` cannot be read"));
    assert!(complaint("\"mode\":4", "\"mode\":1").contains("no triangles"));
}

#[test]
fn damage_is_refused_not_panicked_at() {
    survives_damage("a.glb", &binary());
    survives_damage("a.gltf", embedded(4).as_bytes());
}

/// A triangle with a picture of three bytes, and one of the same material without coordinates.
fn textured() -> String {
    let floats = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].concat();
    let mut bytes: Vec<u8> = floats.into_iter().flat_map(f32::to_le_bytes).collect();
    bytes.extend([0.0_f32, 0.0, 2.0, 0.0, 0.0, 1.0].map(f32::to_le_bytes).as_flattened());
    bytes.extend(b"PIC");
    let bytes: String = bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_1":1}},"material":0}},
        {{"attributes":{{"POSITION":0}},"material":0}}]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0,"texCoord":1}},"metallicFactor":0}}}}],
        "textures":[{{"source":0,"sampler":0}}],"samplers":[{{"magFilter":9728,"wrapS":33071,"wrapT":33071}}],
        "images":[{{"bufferView":2,"mimeType":"image/png"}}],
        "buffers":[{{"uri":"data:application/octet-stream,{bytes}","byteLength":63}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":24}},
        {{"buffer":0,"byteOffset":60,"byteLength":3}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}}]}}"#
    )
}

/// The bytes of the picture on the first material.
fn picture(model: &Model) -> Result<Cow<'_, [u8]>, String> {
    model.read_picture(&model.materials[0].image.as_ref().unwrap().contents)
}

#[test]
fn pictures_and_where_they_lie_are_read() {
    let model = load_bytes("a.gltf", textured().as_bytes()).unwrap();
    let image = model.materials[0].image.as_ref().unwrap();
    assert_eq!((&*picture(&model).unwrap(), image.nearest, image.clamp), (b"PIC".as_slice(), true, true));
    assert_eq!(model.mapping.of(0), Some([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]));
    assert_eq!((model.mapping.of(1), model.materials.len(), &model.warnings[..]), (None, 1, &[][..]));

    let with = |from: &str, to: &str| load_bytes("a.gltf", textured().replace(from, to).as_bytes()).unwrap();
    let at = |place: &str| with(r#""bufferView":2,"mimeType":"image/png""#, &format!(r#""uri":"{place}""#));
    let linked = at("no%20where.png");
    let name = linked.materials[0].image.as_ref().unwrap().contents.to_string();
    assert!(name.ends_with("no where.png`") && linked.pictures.is_empty(), "{name}");
    assert_eq!(picture(&linked).unwrap_err(), "no such file: check the path");
    assert_eq!(&*picture(&at("data:image/png;base64,UElD")).unwrap(), b"PIC");
    let remote = picture(&at("https://a/b.png")).unwrap_err();
    assert_eq!(remote, "`https://a/b.png` is not a local file: fetch it, and name that in the model");
    let beyond = with(r#""byteOffset":60,"byteLength":3"#, r#""byteOffset":60,"byteLength":9"#);
    assert_eq!(picture(&beyond).unwrap_err(), "not within its buffer: export the model again");
    assert!(picture(&at("data:image/png;base64,!")).unwrap_err().ends_with(": export the model again"));
    assert!(with(r#""type":"VEC2""#, r#""type":"VEC3""#).mapping.of(0).is_none());
    survives_damage("a.gltf", textured().as_bytes());
}

#[test]
fn a_picture_of_several_materials_is_loaded_once() {
    let material = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1},"metallicFactor":0}}"#;
    let twice = textured().replace(material, &format!("{material},{material}"));
    let twice = twice.replace(r#""source":0,"sampler":0"#, r#""source":1,"sampler":0"#);
    // The first one nobody names.
    let twice = twice.replace(r#""images":["#, r#""images":[{"bufferView":0,"mimeType":"image/png"},"#);
    let model = load_bytes("a.gltf", twice.as_bytes()).unwrap();
    assert_eq!(model.pictures, [(1, Ok(b"PIC".to_vec()))].into());
    assert!(model.materials.iter().all(|material| material.image == model.materials[0].image));
}
