//! Pictures: the same for any number of threads, and only whole ones.

use crate::folder::{Folder, TETRAHEDRON};

/// Width, height and pixels of a PNG.
pub fn decode(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, pixels)
}

#[test]
fn the_built_in_scene_is_the_same_on_any_number_of_threads_and_in_any_structure() {
    let folder = Folder::new();
    for (name, options) in [("one", "-t 1"), ("two", "-t 2"), ("fast", "-p fast"), ("small", "-p small")] {
        let text = folder.succeed(&format!("render --size 48x32 --samples 1 {options} -o {name}.png"));
        assert!(text.contains("rays at depth 3") && text.contains("time in queries"), "{text}");
    }
    let one = folder.read("one.png");
    for other in ["two.png", "fast.png", "small.png"] {
        assert!(folder.read(other) == one, "{other}");
    }
    let (width, height, pixels) = decode(&one);
    assert_eq!((width, height), (48, 32));
    let colors: std::collections::HashSet<&[u8]> = pixels.chunks(3).collect();
    assert!(colors.len() > 500, "only {} colours", colors.len());
}

#[test]
fn rays_are_counted() {
    let folder = Folder::new();
    let text =
        folder.succeed("render tetrahedron.obj --size 20x10 --samples 2 --bounces 0 --terms ambient --no-ground");
    assert!(text.contains("tetrahedron.obj: 4 triangles"), "{text}");
    assert!(text.contains("800 primary") && text.contains(" 0 shadow") && !text.contains("depth 1"), "{text}");
    let (.., pixels) = decode(&folder.read("picture.png"));
    assert!(pixels.chunks(3).any(|pixel| pixel != &pixels[..3]), "an empty picture");
}

#[test]
fn an_asset_is_drawn_like_its_mesh() {
    let folder = Folder::new();
    folder.write("red.mtl", "newmtl red\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 30\nillum 3\n");
    let model = TETRAHEDRON.replace("f 2 3 4", "usemtl red\nf 2 3 4");
    folder.write("model.obj", format!("mtllib red.mtl\n{model}"));
    for name in ["model", "tetrahedron"] {
        folder.succeed(&format!("bake {name}.obj -o {name}.hits"));
        for file in ["obj", "hits"] {
            folder.succeed(&format!("render {name}.{file} --size 64x48 --samples 1 -o {name}.{file}.png"));
        }
        let [mesh, asset] = ["obj", "hits"].map(|file| folder.read(&format!("{name}.{file}.png")));
        assert!(mesh == asset, "{name}");
    }
    assert!(folder.read("model.obj.png") != folder.read("tetrahedron.obj.png"));
}

#[test]
fn terms_structures_cameras_and_smoothness_are_accepted() {
    let folder = Folder::new();
    let render = "render tetrahedron.obj --size 8x8 --samples 1";
    for options in [
        "-s list",
        "-s auto --smooth",
        "--camera -1,2,3/0,0,0/50",
        "--camera 0,5,0/0,0,0",
        "--up z --terms shadows,diffuse",
    ] {
        folder.succeed(&format!("{render} {options}"));
    }
    let shown = folder.succeed(&format!("{render} --preview"));
    assert_eq!(shown.matches('▀').count(), 8 * 4);
    // The picture on standard output, the figures beside it.
    let output = folder.run(&format!("{render} -o -"));
    assert_eq!(decode(&output.stdout).0, 8);
    assert!(String::from_utf8(output.stderr).unwrap().contains("4 triangles"));
}

#[test]
fn bad_pictures_are_refused() {
    let folder = Folder::new();
    for size in ["0x0", "0x9", "9", "-1x9", "65536x1", "60000x60000", "axb"] {
        assert!(folder.refuse(&format!("render --size={size}")).contains("640x480"), "{size}");
    }
    for camera in ["1,2,3", "1,1,1/1,1,1", "nan,0,0/1,1,1", "0,0,0/1,1,1/0", "0,0,0/inf,1,1"] {
        folder.refuse(&format!("render --camera {camera}"));
    }
    for options in
        ["--threads 0", "--samples 0", "--samples 99", "--bounces 17", "--terms glow", "--up w", "--preset best"]
    {
        folder.refuse(&format!("render {options}"));
    }
    let error = folder.refuse("render --structure tree");
    assert!(error.contains("unknown structure, choose one of auto, list, "), "{error}");
}
