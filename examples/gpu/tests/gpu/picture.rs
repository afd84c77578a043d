use hitscan::{
    asset::Asset,
    glam::Vec3,
    render::{Camera, Color, Light, Material},
};
use hitscan_gpu::{Parts, Picture, Stage, Uploaded, World};

use crate::{
    common::meshes,
    scene::{Form, baker, device, plans},
};

#[test]
fn pictures_are_those_of_the_library_but_for_roundings() {
    let Some(device) = device() else { return };
    let (vertices, triangles) = meshes::random(300, 0.5);
    let words = baker(&vertices, &triangles, &plans()[2], Form::Plain).unwrap().finish();
    let asset = Asset::from_words(&words).unwrap();
    let parts = Parts::read(&asset).unwrap();
    let world = World::read(&asset, &parts).unwrap();
    let uploaded = Uploaded::new(device, &asset, None).unwrap();
    let bounds = world.as_caster().bounds();
    let stage = Stage {
        camera: Camera::framing(&bounds, Vec3::new(0.3, 0.5, 1.0), Vec3::Y),
        lights: vec![
            Light::directional(Vec3::new(-1.0, -2.0, -1.0), Vec3::splat(0.8)),
            Light::point(Vec3::new(0.0, 9.0, 1.0), Vec3::new(0.3, 0.2, 0.1)),
        ],
        width: 93,
        height: 71,
        samples: 2,
        bounces: 2,
        material: Material::default().with_reflectivity(0.4),
    };
    let picture = Picture::draw(&uploaded, &asset, &world, &stage).unwrap();
    let renderer = stage.renderer(world.as_caster(), stage.materials(&asset));
    let expected =
        (0..71).flat_map(|y| (0..93).map(move |x| (x, y))).map(|(x, y)| <[u8; 3]>::from_linear(renderer.pixel(x, y)));
    let apart = |(a, b): (&[u8; 3], [u8; 3])| a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
    let differences: Vec<u8> = picture.pixels.iter().zip(expected).map(apart).collect();
    assert_eq!(differences.len(), 93 * 71);
    let off = |by: u8| differences.iter().filter(|&&d| d > by).count();
    println!("{} finished, {} differ, {} by more than 2", picture.finished, off(0), off(2));
    // Where a ray just passes an edge, a rounding in the ray before it decides.
    assert!(off(2) * 200 < differences.len(), "{}", off(2));
    assert!(picture.finished * 5 < differences.len(), "{}", picture.finished);
    assert!(picture.pixels.iter().any(|pixel| pixel != &picture.pixels[0]));
}
