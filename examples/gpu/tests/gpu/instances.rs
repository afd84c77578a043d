use hitscan::{
    Instance, Instances, Mesh, Ray, Scene,
    accel::{Plan, Structure},
    asset::Asset,
    bake::{self, Baker},
    geometry::Transform,
    glam::{Mat3, Vec3},
};

use crate::{
    adversarial::rays_at,
    common::{FAMILIES, Random, adversarial_mesh, adversarial_ray, meshes},
    scene::{Form, baker, compare, device, plans},
};

type Triangles = (Vec<Vec3>, Vec<[u32; 3]>);

/// An asset of placed parts, the top level of `top`; none if nothing can be built over it.
fn place(parts: &[Triangles], mut placed: Vec<Instance>, plan: &Plan, top: &Plan) -> Option<Vec<u32>> {
    let form = [Form::Plain, Form::OnLattice][parts.len() % 2];
    let bakers: Option<Vec<Baker>> = parts.iter().map(|(v, t)| baker(v, t, plan, form)).collect();
    let bakers = bakers?;
    let assets: Vec<Vec<u32>> = bakers.iter().map(|baker| baker.clone().finish()).collect();
    let opened: Vec<Asset<'_>> = assets.iter().map(|words| Asset::from_words(words).unwrap()).collect();
    let whole = match form {
        Form::OnLattice => {
            let scenes: Vec<Scene<Structure<'_>, hitscan::LatticeMesh<'_>>> =
                opened.iter().map(|asset| asset.scene().unwrap()).collect();
            bake::build(&Instances::place(&scenes, &mut placed).ok()?, top).ok()?
        }
        _ => {
            let scenes: Vec<Scene<Structure<'_>, Mesh<'_>>> =
                opened.iter().map(|asset| asset.scene().unwrap()).collect();
            bake::build(&Instances::place(&scenes, &mut placed).ok()?, top).ok()?
        }
    };
    let structure = Structure::open(top.kind().unwrap(), &whole).unwrap();
    let all = Baker::new().instances(&placed).structure(structure);
    Some(bakers.into_iter().fold(all, Baker::part).finish())
}

fn transform(random: &mut Random, spread: f32) -> Transform {
    loop {
        let mut unit = || random.unit() * 2.0 - 1.0;
        let turn = Mat3::from_rotation_y(unit() * 4.0) * Mat3::from_rotation_x(unit() * 4.0);
        let scale = Mat3::from_diagonal(Vec3::new(1.5 + unit(), unit(), 1.5 + unit()));
        let linear = match random.below(4) {
            0 => Mat3::IDENTITY,
            1 => turn,
            2 => Mat3::from_rotation_z(std::f32::consts::FRAC_PI_2),
            _ => turn * scale,
        };
        let place = Vec3::from_array([0; 3].map(|_| (random.unit() - 0.5) * spread));
        if let Ok(transform) = Transform::new(linear, place) {
            return transform;
        }
    }
}

#[test]
fn placed_scenes_are_answered_as_by_the_library() {
    let Some(device) = device() else { return };
    let mut random = Random::new(23);
    for round in 0..6 {
        let parts: Vec<Triangles> = (0..1 + round % 2).map(|_| meshes::random(400, 0.2)).collect();
        let instance = |random: &mut Random| {
            let instance = Instance::new(random.below(parts.len()) as u32, transform(random, 12.0));
            if random.one_in(9) { instance.with_mask(0) } else { instance }
        };
        let placed: Vec<Instance> = (0..60).map(|_| instance(&mut random)).collect();
        let (plan, top) = (plans()[round % 3], plans()[(round + round / 3) % 3]);
        let words = place(&parts, placed, &plan, &top).unwrap();
        let rays = rays_at(&mut random, 14.0, 2000);
        let tally = compare(device, &words, &rays, None).unwrap();
        assert!(tally.finished * 100 < tally.rays * 10, "{round} {tally:?}");
    }
}

#[test]
fn adversarial_placed_scenes_are_answered_as_by_the_library() {
    let Some(device) = device() else { return };
    let mut random = Random::new(29);
    let mut scenes = 0;
    for round in 0..60 {
        let family = round % FAMILIES;
        let parts: Vec<Triangles> = (0..2).map(|_| adversarial_mesh(&mut random, family, 12)).collect();
        let placed = (0..1 + random.below(8))
            .map(|_| Instance::new(random.below(2) as u32, transform(&mut random, 3.0)))
            .collect();
        let plan = plans()[round % 3];
        let Some(words) = place(&parts, placed, &plan, &plan) else { continue };
        let rays: Vec<Ray> = (0..300).map(|_| adversarial_ray(&mut random, family, &parts[0].0)).collect();
        scenes += usize::from(compare(device, &words, &rays, None).is_some());
    }
    assert!(scenes > 15, "{scenes}");
}
