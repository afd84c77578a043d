//! Wavefront material libraries.

use std::collections::HashMap;
use std::path::Path;

use super::obj::BYTE_ORDER_MARK;
use super::{Contents, Image, Material};

/// Reads the materials of a library by name; the pictures that they name lie in `folder`. A value that
/// does not parse leaves the neutral one: a bad colour is no reason to refuse a mesh.
pub(super) fn read(text: &str, folder: &Path) -> HashMap<String, Material> {
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
            ("map_Kd", Some((material, _))) => material.image = image(value, folder),
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
        // Written by programs for which a picture takes the place of the colour.
        if material.image.is_some() && material.diffuse == [0.0; 3] {
            material.diffuse = [1.0; 3];
        }
        materials.insert(material.name.clone(), material);
    }
}

/// A file name behind options, of which only `-clamp` is looked at: pictures are neither moved nor
/// stretched.
fn image(text: &str, folder: &Path) -> Option<Image> {
    let mut rest = text.trim();
    let mut clamp = false;
    loop {
        let (option, mut after) = first_word(rest);
        // The arguments that an option must have, and those that it may have, which are numbers.
        let (needed, most) = match option {
            "-o" | "-s" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-imfchan" | "-texres" | "-type" => (1, 1),
            _ => break,
        };
        for place in 0..most {
            let (word, behind) = first_word(after);
            if place >= needed && number(word).is_none() {
                break;
            }
            clamp |= option == "-clamp" && word == "on";
            after = behind;
        }
        rest = after;
    }
    let contents = Contents::File(folder.join(rest.replace('\\', "/")));
    (!rest.is_empty()).then_some(Image { contents, nearest: false, clamp })
}

/// A line's first word, and what follows it.
fn first_word(line: &str) -> (&str, &str) {
    line.split_once(char::is_whitespace).map_or((line, ""), |(word, rest)| (word, rest.trim_start()))
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
        let materials = read(library, Path::new(""));
        let red = &materials["red wall"];
        assert_eq!((red.diffuse, red.specular), ([1.0, 0.5, 0.0], [0.5, 1.0, 0.0]));
        assert_eq!((red.shininess, red.reflectivity), (30.0, 1.0));
        let grey = Material { diffuse: [0.25; 3], ..Material::neutral("grey") };
        assert_eq!(materials["grey"], grey);
    }

    #[test]
    fn pictures_are_found_behind_their_options() {
        let name = |text: &str| match image(text, Path::new("here"))?.contents {
            Contents::File(path) => Some(path.to_str().unwrap().replace('\\', "/")),
            Contents::Here(_) => None,
        };
        for text in ["a b.png", " -s 2 2 a b.png ", "-o 1 -clamp on -mm 0 1 a b.png", "-blendu off -t 1 2 3 a b.png"] {
            assert_eq!(name(text).as_deref(), Some("here/a b.png"), "{text}");
        }
        assert_eq!(name("skins\\a.png").as_deref(), Some("here/skins/a.png"));
        for none in ["", " ", "-s 1 1 1", "-clamp", "-clamp on", "-mm", "-bm 1 -o"] {
            assert_eq!(name(none), None, "{none}");
        }
        for file in ["-", "-a.png", "- a.png"] {
            assert_eq!(name(file), Some(format!("here/{file}")));
        }
        assert!(image("-clamp on a.png", Path::new("")).unwrap().clamp);
        let materials = read("newmtl a\nKd 0 0 0\nmap_Kd a.png\nnewmtl b\nKd 0 0 0\nmap_Kd", Path::new(""));
        assert_eq!((materials["a"].diffuse, materials["b"].diffuse), ([1.0; 3], [0.0; 3]));
    }
}
