//! Corners of triangles in bytes: as meshlets and as pairs.

use crate::{bake::waves, folder::Folder};

/// A folder with a waved square of 800 triangles and rays that fall on it.
fn waves_and_rays() -> Folder {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    let down = |i: u32| [(i % 50) as f32 * 0.4, 9.0, (i / 50) as f32 * 0.4, 0.01, -1.0, 0.02];
    folder.write_rays("down.rays", &(0..2500).map(down).collect::<Vec<_>>());
    folder
}

#[test]
fn meshlets_take_three_bytes_a_triangle() {
    let folder = waves_and_rays();
    for structure in ["dual-split", "grid", "bvh", "list"] {
        folder.succeed(&format!("bake waves.obj -o plain.hits -s {structure}"));
        folder.succeed(&format!("bake waves.obj -o packed.hits -s {structure} --meshlets"));
        let less = folder.read("plain.hits").len() as i64 - folder.read("packed.hits").len() as i64;
        // Of 800 triangles, with some of 441 vertices twice; the grid's lists change with the order.
        assert!((1_300..2_600).contains(&less), "{structure} {less}");
        assert!(folder.succeed("info packed.hits").contains("meshlets"));
        folder.succeed(&format!("bake waves.obj -o both.hits -s {structure} --meshlets --lattice"));
        assert!(folder.read("both.hits").len() + 2_400 < folder.read("packed.hits").len());
        folder.succeed("cast plain.hits down.rays -o plain.bin");
        folder.succeed("cast packed.hits down.rays -o packed.bin");
        let parameters =
            |name: &str| -> Vec<Vec<u8>> { folder.read(name).chunks(8).map(|hit| hit[..4].to_vec()).collect() };
        assert!(parameters("plain.bin") == parameters("packed.bin"), "{structure}");
    }
    // Numbers are kept where that is wanted, and bytes where they are scarce.
    folder.succeed("bake waves.obj -o plain.hits");
    folder.succeed("bake waves.obj -o kept.hits -s grid --meshlets --keep-numbers");
    for name in ["plain", "kept"] {
        folder.succeed(&format!("cast {name}.hits down.rays -o {name}.bin"));
    }
    assert!(folder.read("plain.bin") == folder.read("kept.bin"));
    let free = folder.read("both.hits").len();
    for structure in ["kdtree", "grid", "auto"] {
        for most in [free + 4000, free + 3000] {
            folder.succeed(&format!("bake waves.obj -o tight.hits -s {structure} --meshlets --lattice --fit {most}"));
            assert!(folder.read("tight.hits").len() <= most);
        }
    }
    folder.succeed("render kept.hits -o picture.png --size 40x30");
    folder.refuse("bake waves.obj -o none.hits --meshlets --soup");
}

#[test]
fn pairs_take_two_bytes_a_triangle_and_half_the_references() {
    let folder = waves_and_rays();
    let parameters = |name: &str| -> Vec<f32> {
        folder.read(name).chunks(8).map(|hit| f32::from_le_bytes([hit[0], hit[1], hit[2], hit[3]])).collect()
    };
    for structure in ["dual-split", "grid", "bvh", "kdtree", "octree", "list", "auto"] {
        folder.succeed(&format!("bake waves.obj -o plain.hits -s {structure} --meshlets"));
        let text = folder.succeed(&format!("bake waves.obj -o pairs.hits -s {structure} --quads"));
        assert!(text.contains("triangles stand in pairs"), "{text}");
        let less = folder.read("plain.hits").len() as i64 - folder.read("pairs.hits").len() as i64;
        // Of 800 triangles.
        assert!((700..40_000).contains(&less), "{structure} {less}");
        let text = folder.succeed("info pairs.hits");
        assert!(text.contains("  triangles          800\n") && text.contains("quads"), "{text}");
        folder.succeed("cast plain.hits down.rays -o plain.bin");
        folder.succeed("cast pairs.hits down.rays -o pairs.bin");
        // A triangle may begin with another corner.
        let (plain, pairs) = (parameters("plain.bin"), parameters("pairs.bin"));
        assert_eq!(plain.len(), pairs.len());
        assert!(plain.iter().zip(&pairs).all(|(a, b)| a.to_bits() == b.to_bits() || (a / b - 1.0).abs() < 1.0e-5));
        // Other structures are over the triangles, whose numbers are the same.
        folder.succeed("cast pairs.hits down.rays -s bvh -o single.bin");
        assert!(folder.read("pairs.bin") == folder.read("single.bin"), "{structure}");
        folder.succeed(&format!("bake waves.obj -o both.hits -s {structure} --quads --lattice"));
        assert!(folder.read("both.hits").len() + 2_400 < folder.read("pairs.hits").len());
        folder.succeed("cast both.hits down.rays -o both.bin");
        folder.succeed("cast both.hits down.rays -s list -o single.bin");
        assert!(folder.read("both.bin") == folder.read("single.bin"), "{structure}");
    }
    folder.succeed("bake waves.obj -o pairs.hits -s grid --quads --normals");
    let free = folder.read("pairs.hits").len();
    for most in [free - 500, free - 1500] {
        folder.succeed(&format!("bake waves.obj -o tight.hits -s grid --quads --normals --fit {most}"));
        assert!(folder.read("tight.hits").len() <= most);
    }
    folder.succeed("render pairs.hits -o pairs.png --size 40x30");
    folder.succeed("render pairs.hits -s kdtree -o single.png --size 40x30");
    assert!(folder.read("pairs.png") == folder.read("single.png"));
    for other in ["--meshlets", "--keep-numbers", "--soup"] {
        folder.refuse(&format!("bake waves.obj -o none.hits --quads {other}"));
    }
    // For a chip: grids and kD-trees are what was measured over pairs.
    let predicted = |text: &str| text.lines().find(|line| line.contains("instructions on average")).unwrap().to_owned();
    let average = |text: &str| -> u32 {
        let words = predicted(text).replace(',', "");
        words.split_whitespace().find_map(|word| word.parse().ok()).unwrap()
    };
    let [grid, tree] = ["grid", "kdtree"]
        .map(|structure| average(&folder.succeed(&format!("bake waves.obj --quads --target m4 -s {structure}"))));
    let text = folder.succeed("bake waves.obj -o chip.hits --quads --target m4");
    assert!(text.contains("chosen because: about ") && average(&text) == grid.min(tree), "{grid} {tree} {text}");
    assert_eq!(predicted(&folder.succeed("info chip.hits --target m4")), predicted(&text));
    let most = folder.read("chip.hits").len() * 2 / 3;
    folder.succeed(&format!("bake waves.obj -o tight.hits --quads --target m4 --fit {most}"));
    assert!(folder.read("tight.hits").len() <= most);
    let error = folder.refuse("bake waves.obj -o none.hits --quads --target m4 -s octree");
    assert!(error.contains("over pairs") && error.contains("choose --structure grid or kdtree"), "{error}");
    folder.succeed("bake waves.obj -o pairs.hits -s octree --quads");
    assert!(folder.succeed("info pairs.hits --target m4").contains("this structure was not measured there"));
}
