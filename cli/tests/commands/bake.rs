//! Assets: their bytes, their budget, and what is told about them.

use crate::{
    folder::{Folder, TETRAHEDRON},
    render::decode,
};

/// A waved square of `side` x `side` x 2 triangles.
pub fn waves(side: usize) -> String {
    let mut text = String::new();
    for (y, x) in (0..=side).flat_map(|y| (0..=side).map(move |x| (y, x))) {
        let (x, y) = (x as f32, y as f32);
        text += &format!("v {x} {} {y}\n", (x * 0.7).sin() + (y * 0.9).cos());
    }
    for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
        let corner = y * (side + 1) + x + 1;
        let (right, below) = (corner + 1, corner + side + 1);
        text += &format!("f {corner} {below} {right}\nf {right} {below} {}\n", below + 1);
    }
    text
}

#[test]
fn the_table_adds_up() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    let text = folder.succeed("bake waves.obj -o waves.hits");
    let bytes = |what: &str| -> usize {
        let line = text.lines().find(|line| line.starts_with(what)).unwrap();
        line[20..].split_whitespace().next().unwrap().replace(',', "").parse().unwrap()
    };
    let size = folder.read("waves.hits").len();
    assert_eq!(bytes("total"), size);
    assert_eq!(bytes("geometry") + bytes("structure") + bytes("materials") + bytes("header"), size);
    assert!(text.contains("800 triangles") && text.contains("worst case of a ray: depth "), "{text}");
    folder.succeed("bake waves.obj -o again.hits");
    assert!(folder.read("again.hits") == folder.read("waves.hits"));
}

#[test]
fn the_budget_is_kept_or_refused() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    folder.succeed("bake waves.obj -o free.hits -p fast");
    let free = folder.read("free.hits").len();
    for most in [free, free * 7 / 8, free * 3 / 4] {
        folder.succeed(&format!("bake waves.obj -o tight.hits -p fast --fit {most}"));
        assert!(folder.read("tight.hits").len() <= most);
    }
    let error = folder.refuse("bake waves.obj -o none.hits --fit 4K");
    assert!(error.contains("--fit 4096: all but the structure takes "), "{error}");
    assert!(error.contains("allow more bytes, or give --lattice or --meshlets"), "{error}");
    folder.succeed("bake waves.obj -o list.hits -s list");
    let rest = folder.read("list.hits").len();
    for structure in ["kdtree", "grid", "bvh", "dual-split", "auto"] {
        let error = folder.refuse(&format!("bake waves.obj -o none.hits -s {structure} --fit {}", rest + 64));
        assert!(error.contains("all but the structure takes ") && error.contains("which leaves "), "{error}");
        assert!(error.contains("give --lattice or --meshlets"), "{error}");
    }
    let error = folder.refuse(&format!("bake waves.obj -o none.hits --lattice --meshlets --fit {}", 16 * 400));
    assert!(error.ends_with("allow more bytes, or simplify the mesh\n") || !error.contains("give --"), "{error}");
}

#[test]
fn vertices_on_a_lattice_take_half_the_bytes() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    for structure in ["dual-split", "kdtree-compact", "list"] {
        folder.succeed(&format!("bake waves.obj -o plain.hits -s {structure}"));
        let text = folder.succeed(&format!("bake waves.obj -o lattice.hits -s {structure} --lattice"));
        let line = text.lines().find_map(|line| line.strip_prefix("vertices moved by at most ")).unwrap();
        let moved: f32 = line.split_once(' ').unwrap().0.parse().unwrap();
        assert!(moved > 0.0 && moved < 3.0e-4, "{moved}");
        let text = folder.succeed("info lattice.hits");
        assert!(text.contains("lattice vertices") && text.contains("planes [0.000"), "{text}");
        assert!(folder.succeed("info waves.obj").contains(&format!("vertices would move by up to {moved}")));
        let down = |i: u32| [(i % 50) as f32 * 0.4, 9.0, (i / 50) as f32 * 0.4, 0.01, -1.0, 0.02];
        folder.write_rays("down.rays", &(0..2500).map(down).collect::<Vec<_>>());
        folder.succeed("cast plain.hits down.rays -o plain.bin");
        folder.succeed("cast lattice.hits down.rays -o lattice.bin");
        let parameters = |name: &str| -> Vec<f32> {
            let bytes = folder.read(name);
            bytes.chunks(8).map(|hit| f32::from_le_bytes([hit[0], hit[1], hit[2], hit[3]])).collect()
        };
        let (plain, lattice) = (parameters("plain.bin"), parameters("lattice.bin"));
        let close = plain.iter().zip(&lattice).filter(|(a, b)| (*a - *b).abs() < 0.01).count();
        assert!(close > 2000, "{close}");
    }
    // 441 vertices.
    let bytes = |name| folder.read(name).len() as i64;
    assert!((bytes("plain.hits") - bytes("lattice.hits") - 441 * 6).abs() < 64);
    folder.succeed("render lattice.hits -o picture.png --size 40x30");
}

#[test]
fn meshes_and_assets_are_described() {
    let folder = Folder::new();
    let open = TETRAHEDRON.replace("f 2 3 4", "f 1 2 3\nf 1 1 2");
    folder.write("open.obj", open);
    let has = |text: &str, what: &str, value: &str| {
        let found = text.lines().any(|line| line.trim().starts_with(what) && line.ends_with(value));
        assert!(found, "{what} {value}: {text}");
    };
    let text = folder.succeed("info tetrahedron.obj");
    for (what, value) in [("triangles", " 4"), ("closed", "yes"), ("boundary", " 0"), ("size", "[1, 1, 1]")] {
        has(&text, what, value);
    }
    let text = folder.succeed("info open.obj");
    for (what, value) in [
        ("triangles", " 5"),
        ("closed", "no"),
        ("boundary", " 2"),
        ("non-manifold", " 2"),
        ("without", " 1"),
        ("dupl", " 1"),
    ] {
        has(&text, what, value);
    }
    folder.succeed("bake tetrahedron.obj -o asset.hits");
    let text = folder.succeed("info asset.hits");
    for (what, value) in
        [("vertices", "48 bytes, version 1"), ("16-bit", "28 bytes, version 1"), ("depth", ""), ("expected", "")]
    {
        has(&text, what, value);
    }
    has(&text, "total", &format!("{} bytes", folder.read("asset.hits").len()));
}

#[test]
fn what_is_placed_twice_is_known_as_such() {
    let folder = Folder::new();
    folder.write("twice.gltf", TWICE);
    let text = folder.succeed("info twice.gltf");
    for line in ["unique triangles   2 in 1 part, placed 3 times", "placed triangles   6"] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let text = folder.succeed("info tetrahedron.obj");
    for line in ["unique triangles   4, each placed once", "placed triangles   4", "bytes as instances 72"] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

/// A square in three places.
const TWICE: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
    "nodes":[{"mesh":0},{"mesh":0,"translation":[2,0,0]},{"mesh":0,"scale":[-1,3,3]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA"}],
    "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}]}"#;

/// A wavy sheet of 2 x 12 x 12 triangles in stripes of two materials.
fn sheet() -> String {
    let corner = |i: u32| format!("v {} {} {}\n", i % 13, (i * 7 % 11) as f32 / 4.0, i / 13);
    let mut text = String::from("mtllib sheet.mtl\n");
    (0..169).for_each(|i| text += &corner(i));
    for i in 0..144 {
        let a = i / 12 * 13 + i % 12 + 1;
        let (b, c, d) = (a + 1, a + 13, a + 14);
        text += &format!("usemtl {}\nf {a} {c} {b}\nf {b} {c} {d}\n", ["red", "blue"][i as usize % 2]);
    }
    text
}

#[test]
fn triangles_that_stand_in_another_order_keep_their_materials_and_if_asked_their_numbers() {
    let folder = Folder::new();
    folder.write("sheet.obj", sheet());
    folder.write("sheet.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    let down = |i: u32| [(i % 50) as f32 * 0.25, 9.0, (i / 50) as f32 * 0.25, 0.01, -1.0, 0.02];
    folder.write_rays("down.rays", &(0..2500).map(down).collect::<Vec<_>>());
    folder.succeed("cast sheet.obj down.rays -o reference.bin -s list");
    folder.succeed("render sheet.obj -o reference.png --size 60x40");
    for structure in ["bvh", "bvh-ploc", "dual-split"] {
        folder.succeed(&format!("bake sheet.obj -o plain.hits -s {structure}"));
        folder.succeed(&format!("bake sheet.obj -o kept.hits -s {structure} --keep-numbers"));
        let more = folder.read("kept.hits").len() - folder.read("plain.hits").len();
        assert!((288 * 4..288 * 4 + 48).contains(&more), "{structure}: {more}");
        for asset in ["plain.hits", "kept.hits"] {
            folder.succeed(&format!("cast {asset} down.rays -o other.bin"));
            let (other, reference) = (folder.read("other.bin"), folder.read("reference.bin"));
            let parameters = |hits: &[u8]| hits.chunks(8).map(|hit| hit[..4].to_vec()).collect::<Vec<_>>();
            assert!(parameters(&other) == parameters(&reference), "{structure} {asset}");
            assert_eq!(other == reference, asset == "kept.hits", "{structure} {asset}");
            folder.succeed(&format!("render {asset} -o other.png --size 60x40"));
            assert!(folder.read("other.png") == folder.read("reference.png"), "{structure} {asset}");
        }
    }
}

#[test]
fn what_an_asset_cannot_do_is_said() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    let order = "numbers are not the model's (--keep-numbers keeps them)";
    let whole = "no `LatticeScene` can be made";
    let fpu = "a Cortex-M0 has no FPU: with --lattice";
    for (options, has, lacks) in [
        ("", "", [order, whole, fpu]),
        ("-s bvh", order, [whole, fpu, fpu]),
        ("-s dual-split", order, [whole, fpu, fpu]),
        ("-s bvh --keep-numbers", "", [order, whole, fpu]),
        ("--meshlets", order, [whole, fpu, fpu]),
        ("--lattice", whole, [order, fpu, fpu]),
        ("--lattice -s kdtree-compact", "", [order, whole, fpu]),
        ("--lattice --target m0", "", [whole, fpu, fpu]),
        ("--target m4", "", [whole, fpu, fpu]),
        ("--target m0", fpu, [whole; 3]),
        ("--target m0 -s grid", "with --lattice -s dual-split, for", [whole; 3]),
    ] {
        let text = folder.succeed(&format!("bake waves.obj -o waves.hits {options}"));
        assert!(text.contains(has) && lacks.iter().all(|other| !text.contains(other)), "{options}: {text}");
    }
    // The figure is what the option then brings.
    let text = folder.succeed("bake waves.obj -o waves.hits --target m0");
    let figure = text.split("a ray takes about ").nth(1).unwrap().split(' ').next().unwrap();
    let text = folder.succeed("bake waves.obj -o waves.hits --target m0 --lattice");
    assert!(text.contains(&format!("{figure} instructions on average")), "{figure}: {text}");
    let text = folder.succeed("bake waves.obj -o waves.hits --target rv32imc");
    assert!(text.contains("about ") && text.contains(" instructions a ray on an RV32IMC"), "{text}");
}

#[test]
fn a_chip_gets_what_is_fastest_within_its_bytes() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    let instructions = |text: &str| -> u32 {
        let line = text.lines().find(|line| line.starts_with("chosen because: about ")).unwrap();
        line.split(' ').nth(3).unwrap().replace(',', "").parse().unwrap()
    };
    let free = folder.succeed("bake waves.obj -o free.hits --target m4");
    let most = folder.read("free.hits").len() * 3 / 4;
    let tight = folder.succeed(&format!("bake waves.obj -o tight.hits --target m4 --fit {most}"));
    assert!(folder.read("tight.hits").len() <= most);
    assert!(instructions(&free) < instructions(&tight), "{free}{tight}");
    assert!(free.contains("on a Cortex-M4F") && free.contains("bytes of stack"), "{free}");
    for preset in ["small", "balanced", "fast"] {
        folder.succeed(&format!("bake waves.obj -o this.hits -s kdtree -p {preset}"));
        let this = folder.succeed("info this.hits --target m0");
        assert!(this.contains("on a Cortex-M0") && this.contains("worst case"), "{this}");
    }
    let error = folder.refuse(&format!("bake waves.obj -o none.hits --target m0 --fit {}", most / 2));
    assert!(error.contains("allow more bytes"), "{error}");
    let error = folder.refuse("bake waves.obj --target z80");
    assert!(error.contains("z80") && error.contains("rv32imc"), "{error}");
}

/// Normals take 2 bytes a vertex, and a picture of the asset is that of the smooth mesh but for what they are off.
#[test]
fn normals_are_baked_for_smooth_pictures() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    folder.succeed("bake waves.obj -o flat.hits");
    folder.succeed("bake waves.obj -o smooth.hits --normals");
    let bytes = |name| folder.read(name).len() as i64;
    // 441 vertices, a count, an entry in the table and padding.
    assert!((882..882 + 64).contains(&(bytes("smooth.hits") - bytes("flat.hits"))));
    assert!(folder.succeed("info smooth.hits").contains("normals"));
    let picture = |of: &str| {
        folder.succeed(&format!("render {of} --size 64x48 --samples 1 -o picture.png"));
        decode(&folder.read("picture.png")).2
    };
    let [flat, baked, smooth] = ["flat.hits", "smooth.hits", "waves.obj --smooth"].map(picture);
    let off = |other: &[u8]| -> u64 { smooth.iter().zip(other).map(|(a, b)| u64::from(a.abs_diff(*b))).sum() };
    assert!(off(&baked) * 5 < off(&flat), "{} {}", off(&baked), off(&flat));
    folder.refuse("bake waves.obj -o none.hits --normals --lattice");
}

#[test]
fn a_soup_answers_and_looks_like_its_mesh() {
    let folder = Folder::new();
    folder.write("sheet.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    folder.write("sheet.obj", sheet());
    let rays: Vec<[f32; 6]> =
        (0..500).map(|n| [(n % 25) as f32 * 0.47, 9.0, (n / 25) as f32 * 0.59, 0.01, -1.0, 0.02]).collect();
    folder.write_rays("rays", &rays);
    folder.succeed("cast sheet.obj rays -o expected");
    let view = "--size 48x32 --samples 1";
    for smooth in ["", "--smooth"] {
        folder.succeed(&format!("render sheet.obj {view} {smooth} -o mesh{smooth}.png"));
    }
    for options in ["", "-p fast", "-s grid", "-s bvh", "-s octree", "-s kdtree-compact"] {
        let text = folder.succeed(&format!("bake sheet.obj -o soup.hits --soup {options}"));
        let bytes = |what: &str| -> usize {
            let line = text.lines().find(|line| line.starts_with(what)).unwrap();
            line[20..].split_whitespace().next().unwrap().replace(',', "").parse().unwrap()
        };
        let size = folder.read("soup.hits").len();
        assert_eq!(["geometry", "structure", "materials", "header"].map(bytes).iter().sum::<usize>(), size);
        folder.succeed("cast soup.hits rays -o hits");
        assert!(folder.read("hits") == folder.read("expected"), "{options}");
        folder.succeed("cast soup.hits rays -s bvh -o hits");
        assert!(folder.read("hits") == folder.read("expected"), "{options}");
        for smooth in ["", "--smooth"] {
            folder.succeed(&format!("render soup.hits {view} {smooth} -o soup.png"));
            assert!(folder.read("soup.png") == folder.read(&format!("mesh{smooth}.png")), "{options} {smooth}");
        }
        let said = folder.succeed("info soup.hits").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(bytes("geometry") == 288 * 36 && said.contains("triangles 288"), "{said}");
    }
    for unfit in ["--lattice", "--fit 64K", "--textures", "--target m4"] {
        folder.refuse(&format!("bake sheet.obj -o none.hits --soup {unfit}"));
    }
    let text = folder.succeed("info soup.hits --target m4");
    assert!(
        text.contains("triangles ") && text.contains("what a soup takes on a Cortex-M4F: name a --structure"),
        "{text}"
    );
    folder.succeed("info soup.hits --target m4 -s kdtree");
}
