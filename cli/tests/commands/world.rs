//! Worlds: what a text places is what is drawn and hit.

use crate::folder::Folder;

const WORLD: &str = "[part.a]\nmesh = \"tetrahedron.obj\"\n\
                     [[place]]\npart = \"a\"\n[[place]]\npart = \"a\"\nat = [4, 0, 0]\nscale = 2\n";

#[test]
fn a_world_is_hit_like_the_mesh_of_its_copies() {
    let folder = Folder::new();
    folder.write("world.toml", WORLD);
    folder.write(
        "flat.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n\
         v 4 0 0\nv 6 0 0\nv 4 2 0\nv 4 0 2\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n",
    );
    let rays: Vec<[f32; 6]> =
        (0..400).map(|n| [(n % 40) as f32 * 0.17 - 0.2, (n / 40) as f32 * 0.23 + 0.01, 9.0, 0.0, 0.0, -1.0]).collect();
    folder.write_rays("rays", &rays);
    folder.succeed("cast flat.obj rays -o flat");
    for structure in ["kdtree", "bvh", "dual-split", "grid"] {
        let text = folder.succeed(&format!("bake world.toml -o world.hits -s {structure} -p small"));
        assert!(text.contains("8 triangles, 4 of their own placed 2 times"), "{text}");
        folder.succeed("cast world.hits rays -o world");
        assert!(folder.read("world") == folder.read("flat"), "{structure}");
    }
    assert!(folder.read("flat").chunks(8).filter(|hit| hit[4..] != [255; 4]).count() > 30);
    folder.succeed("cast world.toml rays -q count -o world");
    folder.succeed("cast flat.obj rays -q count -o flat");
    assert!(folder.read("world") == folder.read("flat"));
}

#[test]
fn materials_and_pictures_are_those_of_the_parts() {
    let folder = Folder::new();
    folder.write("red.mtl", "newmtl red\nKd 1 0 0\n");
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    folder.write("red.obj", format!("mtllib red.mtl\n{mesh}"));
    folder.write("red.toml", "[part.a]\nmesh = \"red.obj\"\n[[place]]\npart = \"a\"\n");
    folder.write("grey.toml", "[part.a]\nmesh = \"tetrahedron.obj\"\n[[place]]\npart = \"a\"\n");
    let settings = "--size 24x16 --samples 1 --camera 2,2,3/0.2,0.2,0.2 --no-ground --terms ambient,diffuse";
    for name in ["red.obj", "red.toml", "tetrahedron.obj", "grey.toml"] {
        folder.succeed(&format!("render {name} {settings} -o {name}.png"));
    }
    assert!(folder.read("red.obj.png") == folder.read("red.toml.png"));
    assert!(folder.read("tetrahedron.obj.png") == folder.read("grey.toml.png"));
    assert!(folder.read("red.toml.png") != folder.read("grey.toml.png"));
    folder.succeed("bake red.toml -o red.hits");
    folder.succeed("render red.hits --size 24x16 --samples 1 -o asset.png");
    folder.succeed("render red.toml --size 24x16 --samples 1 -o text.png");
    assert!(folder.read("asset.png") == folder.read("text.png"));
}

#[test]
fn a_world_is_described_part_by_part() {
    let folder = Folder::new();
    folder.write("world.toml", WORLD);
    folder.succeed("bake world.toml -o world.hits");
    for world in ["world.toml", "world.hits"] {
        let text = folder.succeed(&format!("info {world}"));
        let said = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for line in [
            "8 triangles, 4 of their own placed 2 times",
            "in all 8 triangles",
            "size [6.000007, 2.000004, 2.000004]",
            "instances 2",
            "part 0 placed 2 times",
            "triangles 4",
        ] {
            assert!(said.contains(line), "{line}: {text}");
        }
    }
    let text = folder.refuse("info world.hits --target m4");
    assert!(text.contains("is a world of placed scenes"), "{text}");
}

#[test]
fn plants_are_placed_in_thousands() {
    let folder = Folder::new();
    folder.write(
        "meadow.toml",
        "[part.shrub]\nmesh = \"plant:7\"\n[[place]]\npart = \"shrub\"\nscatter = 2000\nfrom = [-20, 0, -20]\n\
         to = [20, 0, 20]\nturns = [0, 360, 0]\nscales = 0.3\n",
    );
    let text = folder.succeed("render meadow.toml --size 16x12 --samples 1 -o a.png");
    assert!(text.contains("placed 2,000 times"), "{text}");
    folder.succeed("bake meadow.toml -o meadow.hits");
    assert!(folder.read("meadow.hits").len() < 20 << 20);
}

#[test]
fn descriptions_that_say_nothing_sensible_are_refused() {
    let folder = Folder::new();
    folder.write("good.toml", WORLD);
    let help = folder.succeed("bake --help");
    assert!(help.contains("[[part.hedge.place]]") && help.contains("scatter = 1000"), "{help}");
    assert!(!folder.succeed("bake -h").contains("[[place]]"));
    for (text, why) in [
        ("[part", "line 1"),
        ("[part.a]\nmesh = \"tetrahedron.obj\"\n[[place]]\npart = \"b\"\n", "there is no part \"b\""),
        ("[part.a]\nmesh = \"none.obj\"\n[[place]]\npart = \"a\"\n", "none.obj: no such file"),
        (
            "[part.a]\nmesh = \"tetrahedron.obj\"\n[[place]]\npart = \"a\"\ncolour = 3\n",
            "line 5: unknown field `colour`",
        ),
        ("[part.a]\nmesh = \"tetrahedron.obj\"\n[[place]]\npart = \"a\"\nat = [nan, 0, 0]\n", "inverted"),
        ("[part.a]\nmesh = \"bad.toml\"\n[[place]]\npart = \"a\"\n", "bad.toml"),
        (
            "[part.a]\nmesh = \"tetrahedron.obj\"\n[part.b]\n[[part.b.place]]\npart = \"a\"\ngrid = [0, 1, 1]\n\
             [part.c]\n[[part.c.place]]\npart = \"b\"\ngrid = [9999, 1, 1]\n\
             [[place]]\npart = \"c\"\ngrid = [9999, 1, 1]\n",
            "places",
        ),
        ("", "places nothing"),
    ] {
        folder.write("bad.toml", text);
        for command in ["render bad.toml -o out.png", "bake bad.toml -o out.hits"] {
            let error = folder.refuse(command);
            assert!(error.contains(why), "{text}: {error}");
            let is_mesh = why.contains(".obj") || why.contains(".toml");
            assert!(is_mesh || error.ends_with("see `hitscan bake --help`\n"), "{error}");
        }
    }
    for options in ["--lattice", "--normals", "--fit 3K", "--target m4", "-s list"] {
        folder.refuse(&format!("bake good.toml -o out.hits {options}"));
    }
    folder.succeed("bake good.toml -o good.hits");
    for command in ["info good.hits --target m4", "compare good.hits -n 100 --rounds 1", "render good.hits -s bvh"] {
        folder.refuse(command);
    }
    let mut bytes = folder.read("good.hits");
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    folder.write("good.hits", bytes);
    assert!(folder.refuse("render good.hits").contains("good.hits"));
}
