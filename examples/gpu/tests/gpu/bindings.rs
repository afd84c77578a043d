use hitscan::asset::Asset;
use hitscan_gpu::Uploaded;

use crate::{
    adversarial::rays_at,
    common::{Random, meshes},
    scene::{Form, baker, compare, device, plans},
};

#[test]
fn scenes_of_several_bindings_are_answered_and_larger_ones_refused() {
    let Some(device) = device() else { return };
    let (vertices, triangles) = meshes::random(2000, 0.1);
    let rays = rays_at(&mut Random::new(3), 1.0, 1000);
    for plan in plans() {
        let words = baker(&vertices, &triangles, &plan, Form::Plain).unwrap().finish();
        let asset = Asset::from_words(&words).unwrap();
        let bytes = words.len() as u64 * 4;
        let binding = (bytes / 3).next_power_of_two();
        let bindings = Uploaded::new(device, &asset, Some(binding)).unwrap().bindings();
        assert!((2..=3).contains(&bindings), "{bindings}");
        compare(device, &words, &rays, Some(binding)).unwrap();
        let refused = Uploaded::new(device, &asset, Some(bytes / 16)).unwrap_err().to_string();
        assert!(refused.contains("bytes") && refused.contains("bake"), "{refused}");
    }
}
