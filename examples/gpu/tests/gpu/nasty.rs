//! The scenes of `tests/nasty_cases.txt` of the library that are of triangles.

use std::collections::BTreeMap;

use hitscan::{Ray, glam::Vec3};

use crate::scene::{Form, baker, compare, device, plans};

fn numbers(words: &[&str]) -> Vec<f32> {
    words.iter().map(|word| f32::from_bits(u32::from_str_radix(word, 16).unwrap())).collect()
}

fn points(numbers: &[f32]) -> Vec<Vec3> {
    numbers.chunks_exact(3).map(Vec3::from_slice).collect()
}

#[test]
fn nasty_scenes_are_answered_as_by_the_library() {
    let Some(device) = device() else { return };
    let mut cases: BTreeMap<&str, (Vec<Vec3>, Vec<Ray>)> = BTreeMap::new();
    let mut current = "";
    for line in include_str!("../../../../tests/nasty_cases.txt").lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let case = cases.entry(current).or_default();
        match words[0] {
            "S" => current = words[1],
            "T" => case.0.extend(points(&numbers(&words[1..10]))),
            "G" => {
                let mut corners = points(&numbers(&words[3..12]));
                let step = points(&numbers(&words[12..])).first().copied().unwrap_or_default();
                for _ in 0..words[2].parse().unwrap() {
                    case.0.extend(&corners);
                    corners.iter_mut().for_each(|corner| *corner += step);
                }
            }
            "R" => {
                let f = numbers(&words[1..9]);
                let ray = Ray::new(Vec3::from_slice(&f), Vec3::from_slice(&f[3..]));
                case.1.push(ray.starting_at(f[6]).up_to(f[7]));
            }
            _ => {}
        }
    }
    let mut compared = 0;
    for (index, (vertices, rays)) in cases.values().enumerate().filter(|(_, case)| !case.1.is_empty()) {
        let triangles: Vec<[u32; 3]> = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        // The largest under one structure only.
        let some = if triangles.len() > 10_000 { vec![plans()[index % 3]] } else { plans().to_vec() };
        for plan in some {
            // What the library refuses is not uploaded.
            if let Some(baker) = baker(vertices, &triangles, &plan, Form::Plain) {
                compared += usize::from(compare(device, &baker.finish(), rays, None).is_some());
            }
        }
    }
    assert!(compared > 80, "{compared}");
}
