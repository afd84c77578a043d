//! Wavefront material libraries.

use std::collections::HashMap;

use super::Material;
use super::obj::BYTE_ORDER_MARK;

/// Reads the materials of a library by name. A value that does not parse leaves the neutral one:
/// a bad colour is no reason to refuse a mesh.
pub(super) fn read(text: &str) -> HashMap<String, Material> {
    let mut materials = HashMap::new();
    let mut current: Option<(Material, u32)> = None;
    for line in text.trim_start_matches(BYTE_ORDER_MARK).lines().map(str::trim) {
        let (key, value) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match (key, &mut current) {
            ("newmtl", _) => {
                let next = (Material::neutral(value.trim()), 0);
                insert(&mut materials, current.replace(next));
            }
            ("Kd", Some((material, _))) => material.diffuse = colour(value, material.diffuse),
            ("Ks", Some((material, _))) => material.specular = colour(value, material.specular),
            ("Ns", Some((material, _))) => {
                material.shininess = number(value).unwrap_or(1.0).max(1.0);
            }
            ("illum", Some((_, model))) => *model = value.trim().parse().unwrap_or(0),
            _ => {}
        }
    }
    insert(&mut materials, current);
    materials
}

/// Files the finished material; from illumination model 3 on, surfaces mirror by their `Ks`.
fn insert(materials: &mut HashMap<String, Material>, done: Option<(Material, u32)>) {
    if let Some((mut material, model)) = done {
        if model >= 3 {
            material.reflectivity = material.specular.into_iter().fold(0.0, f32::max);
        }
        materials.insert(material.name.clone(), material);
    }
}

/// `r g b`, or one number for a grey.
fn colour(value: &str, otherwise: [f32; 3]) -> [f32; 3] {
    let channels: Option<Vec<f32>> = value.split_whitespace().map(number).collect();
    match channels.as_deref() {
        Some([r, g, b]) => [*r, *g, *b].map(|x| x.clamp(0.0, 1.0)),
        Some([grey]) => [grey.clamp(0.0, 1.0); 3],
        _ => otherwise,
    }
}

fn number(word: &str) -> Option<f32> {
    word.trim().parse().ok().filter(|x: &f32| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_highlight_and_mirror_are_read() {
        let library = "# c\nKd 1 1 1\nnewmtl red wall\r\n  Kd 1 0.5 0\nKs 0.5 7 0\nNs 30\nillum 3\n\
                       newmtl grey\nKd 0.25\nKs nan 0 0\nNs x\nillum\nnewmtl";
        let materials = read(library);
        let red = &materials["red wall"];
        assert_eq!((red.diffuse, red.specular), ([1.0, 0.5, 0.0], [0.5, 1.0, 0.0]));
        assert_eq!((red.shininess, red.reflectivity), (30.0, 1.0));
        let grey = Material { diffuse: [0.25; 3], ..Material::neutral("grey") };
        assert_eq!(materials["grey"], grey);
    }
}
