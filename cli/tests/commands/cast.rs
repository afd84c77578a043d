//! Rays: the same answers from every structure, mesh or asset, on any number of threads.

use crate::{
    bake::waves,
    folder::{Folder, TETRAHEDRON},
};

/// Rays from a sphere around the tetrahedron towards points near it, the same every time.
fn rays(count: usize) -> Vec<[f32; 6]> {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 16_777_216.0 * 2.0 - 1.0
    };
    let mut ray = || {
        let origin = [0; 3].map(|_| 3.0 * random());
        let target = [0; 3].map(|_| 0.6 * random() + 0.3);
        [origin[0], origin[1], origin[2], target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]]
    };
    (0..count).map(|_| ray()).collect()
}

#[test]
fn every_way_gives_the_same_bytes() {
    let folder = Folder::new();
    folder.write_rays("some.rays", &rays(5000));
    folder.succeed("bake tetrahedron.obj -o kdtree.hits");
    folder.succeed("bake tetrahedron.obj -o list.hits -s list");
    folder.succeed("cast tetrahedron.obj some.rays -o reference.bin -s list -t 1");
    let ways = [
        "tetrahedron.obj some.rays -s kdtree",
        "tetrahedron.obj some.rays -s kdtree -p small -t 3",
        "tetrahedron.obj some.rays -p fast -t 2",
        "kdtree.hits some.rays",
        "kdtree.hits some.rays -s list",
        "list.hits some.rays",
    ];
    for way in ways {
        folder.succeed(&format!("cast {way} -o other.bin"));
        assert!(folder.read("other.bin") == folder.read("reference.bin"), "{way}");
        let text = folder.succeed("diff reference.bin other.bin");
        assert_eq!(text, "5000 rays, no difference\n");
    }
}

#[test]
fn answers_are_what_was_asked() {
    let folder = Folder::new();
    // Through two triangles, beside all, and with nothing left of the ray.
    folder.write_rays("few.rays", &[[0.2, 0.2, -1.0, 0.0, 0.0, 1.0], [5.0, 0.2, -1.0, 0.0, 0.0, 1.0]]);
    folder.write_rays(
        "cut.rays",
        &[[0.2, 0.2, -1.0, 0.0, 0.0, 1.0, 0.0, 0.5], [0.2, 0.2, -1.0, 0.0, 0.0, 1.0, 1.25, 9.0]],
    );
    let table = |arguments: &str| folder.succeed(&format!("cast tetrahedron.obj {arguments} --csv"));
    assert_eq!(table("few.rays"), "ray,t,primitive\n0,1,0\n1,,\n");
    assert_eq!(table("few.rays -q any"), "ray,hit\n0,1\n1,0\n");
    assert_eq!(table("few.rays -q count"), "ray,t,hits\n0,1,2\n1,,0\n");
    assert_eq!(table("cut.rays --interval"), "ray,t,primitive\n0,,\n1,1.6,3\n");

    let bytes = |query: &str| folder.run(&format!("cast tetrahedron.obj few.rays -q {query}")).stdout;
    let record = |t: f32, primitive: u32| [t.to_le_bytes(), primitive.to_le_bytes()].concat();
    assert_eq!(bytes("closest"), [record(1.0, 0), record(f32::INFINITY, u32::MAX)].concat());
    assert_eq!(bytes("any"), [record(0.0, 0), record(f32::INFINITY, u32::MAX)].concat());
    assert_eq!(bytes("count"), [record(1.0, 2), record(f32::INFINITY, 0)].concat());
}

#[test]
fn figures_go_to_standard_error() {
    let folder = Folder::new();
    folder.write_rays("some.rays", &rays(10));
    let output = folder.run("cast tetrahedron.obj some.rays");
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.contains("built in") && text.contains("10 rays") && text.contains("Mrays/s"), "{text}");
    assert_eq!(output.stdout.len(), 80);
}

#[test]
fn differences_are_counted_and_decide_the_code() {
    let folder = Folder::new();
    folder.write_rays("some.rays", &rays(500));
    folder.succeed("cast tetrahedron.obj some.rays -o a.bin");
    folder.write("moved.obj", TETRAHEDRON.replace("v 0 0 1", "v 0 0 0.7"));
    folder.succeed("cast moved.obj some.rays -o b.bin");
    let output = folder.run("diff a.bin b.bin");
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("500 rays, ") && text.contains("hit only in A") && text.contains("\nray "), "{text}");
}

/// The structure that no asset holds answers and looks like the others, and is refused where it cannot.
#[test]
fn the_structure_of_hosts_answers_like_the_list() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(20));
    let rays: Vec<[f32; 6]> =
        (0..2000).map(|n| [(n % 50) as f32 * 0.43, 5.0, (n / 50) as f32 * 0.51, 0.1, -1.0, 0.2]).collect();
    folder.write_rays("rays", &rays);
    folder.succeed("bake waves.obj -o lattice.hits --lattice");
    folder.succeed("bake waves.obj -o soup.hits --soup");
    for scene in ["waves.obj", "lattice.hits", "soup.hits"] {
        for query in ["closest", "any", "count"] {
            folder.succeed(&format!("cast {scene} rays -q {query} -s list -o list"));
            for preset in ["small", "balanced", "fast"] {
                folder.succeed(&format!("cast {scene} rays -q {query} -s wide -p {preset} -o wide"));
                assert!(folder.read("wide") == folder.read("list"), "{scene} {query} {preset}");
            }
        }
        for smooth in ["", "--smooth"] {
            folder.succeed(&format!("render {scene} --size 48x32 --samples 1 {smooth} -o list.png -s list"));
            let text = folder.succeed(&format!("render {scene} --size 48x32 --samples 1 {smooth} -o wide.png -s wide"));
            assert!(text.contains("wide balanced, ") && text.contains(" bytes ("), "{text}");
            assert!(folder.read("wide.png") == folder.read("list.png"), "{scene} {smooth}");
        }
    }
    folder.succeed("bake waves.obj -o kept.hits -s bvh --keep-numbers");
    for command in ["bake waves.obj -o a.hits -s wide", "info waves.obj -s wide", "render -s wide -o a.png"] {
        let error = folder.refuse(command);
        assert!(error.contains("wide is for render, cast and compare: choose another structure"), "{error}");
    }
    assert!(folder.refuse("cast kept.hits rays -s wide").contains("name the mesh it was made from"));
}
