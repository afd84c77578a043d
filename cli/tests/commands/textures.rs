//! Textures: from the files that materials name to the picture, and what is said where they cannot be had.

use crate::{folder::Folder, render::decode};

/// A PNG of squares of these colours, `side` x `side` pixels each, four in a row.
fn squares(side: u32, colors: &[[u8; 3]]) -> Vec<u8> {
    let (width, height) = (4 * side, colors.len() as u32 / 4 * side);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x / side + y / side * 4) as usize));
    let pixels: Vec<[u8; 3]> = pixels.map(|square| colors[square]).collect();
    encode(width, height, &pixels)
}

fn encode(width: u32, height: u32, pixels: &[[u8; 3]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(pixels.as_flattened()).unwrap();
    bytes
}

const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 255, 0];
const BLUE: [u8; 3] = [0, 0, 255];
const WHITE: [u8; 3] = [255; 3];

/// Two squares side by side in the plane z = 0, which have an edge in common but lie in different parts of the picture:
/// there is a seam between them.
const SIGN: &str = "mtllib sign.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n\
                    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0 0.5\nvt 0.5 0.5\nvt 0.5 1\nvt 0 1\n\
                    usemtl sign\nf 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\n";

const MATERIAL: &str = "newmtl sign\nKd 1 1 1\nmap_Kd skin.png\n";

/// From the front, without shades.
const VIEW: &str = "--size 80x40 --samples 1 --terms ambient --no-ground --camera 1,0.5,3/1,0.5,0/30";

/// The pure colours of a picture by their shares, in percent: red, green, blue, none of them.
fn shares(png: &[u8]) -> [usize; 4] {
    let (width, height, pixels) = decode(png);
    let mut counts = [0; 4];
    for pixel in pixels.as_chunks::<3>().0 {
        let strong = |channel: usize| (0..3).all(|other| other == channel || pixel[channel] / 4 > pixel[other]);
        counts[(0..3).find(|channel| strong(*channel)).unwrap_or(3)] += 1;
    }
    counts.map(|count| count * 100 / (width * height) as usize)
}

#[test]
fn an_asset_shows_the_textures_of_its_model() {
    let folder = Folder::new();
    folder.write("sign.obj", SIGN);
    folder.write("sign.mtl", MATERIAL);
    let upper = [RED, RED, GREEN, GREEN, BLUE, BLUE, BLUE, BLUE];
    folder.write("skin.png", squares(8, &upper));
    folder.succeed(&format!("render sign.obj -o model.png {VIEW}"));
    let model = folder.read("model.png");
    // The left square shows all of it, the right one the upper left quarter, which is red.
    let [red, green, blue, _] = shares(&model);
    assert!(red > 2 * blue && blue > green && green > 3, "{red} {green} {blue}");

    let text = folder.succeed("bake sign.obj -o sign.hits --textures=2048");
    let bytes = |what: &str| -> usize {
        let line = text.lines().find(|line| line.starts_with(what)).unwrap();
        line[20..].split_whitespace().next().unwrap().replace(',', "").parse().unwrap()
    };
    let size = folder.read("sign.hits").len();
    assert_eq!(["geometry", "structure", "materials", "textures", "header"].map(bytes).iter().sum::<usize>(), size);
    // Three colours: half a byte a pixel, a palette of 32 bytes, a header of 8, a table; coordinates of 8 vertices.
    assert_eq!(bytes("textures"), 32 * 16 / 2 + 32 + 8 + 8 + 8 * 4 + 20);
    for options in ["", "-s bvh", "-s dual-split --keep-numbers", "--normals"] {
        folder.succeed(&format!("bake sign.obj -o sign.hits --textures=2048 {options}"));
        folder.succeed(&format!("render sign.hits -o asset.png {VIEW}"));
        assert!(folder.read("asset.png") == model, "{options}");
    }
    folder.succeed("bake sign.obj -o sign.hits --textures --lattice -s kdtree-compact");
    folder.succeed(&format!("render sign.hits -o asset.png {VIEW}"));
    assert_eq!(shares(&folder.read("asset.png")), shares(&model));

    // Without being asked an asset has none.
    let plain = folder.succeed("bake sign.obj -o plain.hits");
    assert!(!plain.contains("textures"), "{plain}");
    folder.succeed(&format!("render plain.hits -o plain.png {VIEW}"));
    assert_eq!(shares(&folder.read("plain.png"))[..2], [0, 0]);
}

#[test]
fn textures_are_made_smaller_in_light() {
    let folder = Folder::new();
    folder.write("sign.obj", SIGN);
    folder.write("sign.mtl", MATERIAL);
    // Half white and half black, pixel by pixel: half the light is 188 of 255.
    folder.write("skin.png", squares(1, &[WHITE, [0; 3], WHITE, [0; 3]].repeat(4)));
    for (most, bytes) in [(4, 8 + 32), (2, 8 + 8), (1, 8 + 4)] {
        let text = folder.succeed(&format!("bake sign.obj -o sign.hits --textures={most}"));
        let coordinates = 8 * 4 + 20;
        let expected = (bytes + 8 + coordinates).to_string();
        let line = text.lines().find(|line| line.starts_with("textures")).unwrap();
        assert_eq!(line.split_whitespace().nth(1), Some(expected.as_str()), "{most}");
    }
    let words: Vec<u32> = folder.read("sign.hits").as_chunks().0.iter().copied().map(u32::from_le_bytes).collect();
    let asset = hitscan::asset::Asset::from_words(&words).unwrap();
    let textures: hitscan::render::Textures<'_> = asset.read().unwrap();
    let light = textures.get(0).unwrap().color(hitscan::glam::Vec2::ZERO);
    assert!((light - 0.5).abs().max_element() < 0.02, "{light}");
}

#[test]
fn what_is_missing_is_said_and_drawn_plain() {
    let folder = Folder::new();
    let draw = || {
        let output = folder.run(&format!("render sign.obj -o picture.png {VIEW}"));
        assert!(output.status.success());
        (String::from_utf8(output.stderr).unwrap(), shares(&folder.read("picture.png")))
    };
    let red = MATERIAL.replace("1 1 1", "1 0 0");
    folder.write("sign.obj", SIGN);
    folder.write("sign.mtl", &red);
    let (said, plain) = draw();
    assert_eq!(said, "hitscan: warning: sign.obj: without texture `skin.png`: no such file: check the path\n");
    assert!(plain[0] > 20 && plain[2] == 0, "{plain:?}");
    let whole = squares(8, &[WHITE; 4]);
    for (bad, mend) in [
        (&b""[..], "neither PNG nor JPEG: convert it to one"),
        (b"P6 1 1 255 abc", "neither PNG nor JPEG: convert it to one"),
        (&encode(10_000, 1, &[WHITE; 10_000]), "too large: make it at most 8192 pixels wide and high"),
        (&whole[..40], "): save it again"),
        (&whole[..whole.len() / 2], "): save it again"),
    ] {
        folder.write("skin.png", bad);
        let (said, shown) = draw();
        assert!(said.contains("without texture `skin.png`: ") && said.contains(mend), "{said}");
        assert_eq!((said.lines().count(), shown), (1, plain));
    }
    folder.write("skin.png", &whole);
    assert_eq!(draw(), (String::new(), plain));

    // Corners without coordinates, with none that are numbers, and with none that are there.
    folder.write("skin.png", squares(8, &[BLUE; 4]));
    folder.write("sign.mtl", MATERIAL);
    let textured = draw();
    assert!(textured.0.is_empty() && textured.1[2] > 20);
    for (from, to) in [("6/7 3/8", "6 3"), ("vt 0.5 1", "vt nan 1"), ("6/7", "6/99"), ("6/7", "6/x"), ("6/7", "6//7")] {
        folder.write("sign.obj", SIGN.replace(from, to));
        let (said, shown) = draw();
        assert!(said.contains(" of 4 triangles lack texture coordinates"), "{to}: {said}");
        assert!(shown[2] > 10 && shown[2] < textured.1[2], "{to}: {shown:?}");
    }
    // Who does not ask for textures hears nothing of them.
    for command in ["info sign.obj", "bake sign.obj -o a.hits"] {
        let output = folder.run(command);
        assert!(output.status.success() && output.stderr.is_empty(), "{command}: {output:?}");
    }
    folder.write("sign.obj", SIGN);
    let error = folder.refuse("bake sign.obj -o a.hits --textures=0");
    assert!(error.contains("--textures"), "{error}");
}

#[test]
fn textures_of_placed_parts_are_those_of_their_models() {
    let folder = Folder::new();
    folder.write("sign.obj", SIGN);
    folder.write("sign.mtl", MATERIAL);
    folder.write("skin.png", squares(8, &[RED, RED, GREEN, GREEN, BLUE, BLUE, BLUE, BLUE]));
    folder.write("one.toml", "[part.a]\nmesh = \"sign.obj\"\n[[place]]\npart = \"a\"\n");
    folder.write(
        "world.toml",
        "[part.a]\nmesh = \"sign.obj\"\n[part.b]\nmesh = \"tetrahedron.obj\"\n[[place]]\npart = \"b\"\nat = [9, 9, 9]\n\
         [[place]]\npart = \"a\"\nscale = 0.5\n[[place]]\npart = \"a\"\nat = [1, 0, 0]\nscale = 0.5\n",
    );
    let [model, one, twice] = ["sign.obj", "one.toml", "world.toml"].map(|scene| {
        folder.succeed(&format!("render {scene} -o picture.png --up y {VIEW}"));
        folder.read("picture.png")
    });
    assert!(one == model);
    // Half as large and side by side: half of the area, and the same colours.
    let (model, placed) = (shares(&model), shares(&twice));
    for (large, small) in model.into_iter().zip(placed).take(3) {
        assert!(small > 0 && (small * 2).abs_diff(large) <= 2, "{model:?} {placed:?}");
    }
    for structure in ["kdtree", "bvh", "grid"] {
        folder.succeed(&format!("bake world.toml -o world.hits --textures=2048 -s {structure}"));
        folder.succeed(&format!("render world.hits -o asset.png {VIEW}"));
        assert!(folder.read("asset.png") == twice, "{structure}");
    }
    let with = folder.read("world.hits").len();
    folder.succeed("bake world.toml -o world.hits -s grid");
    assert!(folder.read("world.hits").len() + 256 < with);
    folder.succeed(&format!("render world.hits -o plain.png {VIEW}"));
    assert_eq!(shares(&folder.read("plain.png"))[..2], [0, 0]);
}
