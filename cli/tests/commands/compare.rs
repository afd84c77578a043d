//! The comparison: its rows, its files, its recommendation, and that it refuses what it cannot compare.

use crate::{bake::waves, folder::Folder};

/// Few rays, so that tests are quick.
const QUICK: &str = "-n 400 --rounds 1";

/// The cells of the row `name` of a table.
fn row<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let line = text.lines().find(|line| line.split_whitespace().next() == Some(name));
    line.unwrap_or_else(|| panic!("{name}: {text}")).split_whitespace().collect()
}

/// The names of all structures, from the message about one that is unknown.
fn structures(folder: &Folder) -> Vec<String> {
    let error = folder.refuse("info tetrahedron.obj -s no-such");
    let names = error.split("choose one of ").nth(1).unwrap().split(": ").next().unwrap();
    names.split(", ").map(|name| name.trim().to_owned()).collect()
}

#[test]
fn every_structure_has_a_row_and_one_is_recommended() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(30));
    let text = folder.succeed(&format!("compare waves.obj {QUICK}"));
    assert!(text.starts_with("waves.obj: 1,800 triangles, preset balanced; 400 primary, "), "{text}");
    let names = structures(&folder);
    assert!(names.len() > 4);
    for name in names.iter().filter(|name| *name != "auto") {
        assert!(row(&text, name).len() >= 11, "{name}: {text}");
    }
    // The list tests everything and has no nodes.
    assert_eq!(row(&text, "list")[3..7], ["0", "0.0", "-", "1,800"]);
    let last = text.lines().last().unwrap();
    assert!(last.starts_with("recommended, and what --structure auto takes: "), "{last}");
    let recommended = last.split(": ").nth(1).unwrap();
    for command in ["info waves.obj -s auto", "bake waves.obj -s auto -o waves.hits"] {
        let text = folder.succeed(command);
        assert!(text.contains(&format!(" {recommended} balanced")) && text.contains("chosen because"), "{text}");
    }
    let fit = folder.succeed(&format!("compare tetrahedron.obj {QUICK}"));
    assert!(fit.contains("recommended: list: for up to 8 primitives"), "{fit}");
}

#[test]
fn the_recommendation_is_the_same_every_time() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(25));
    for preset in ["small", "balanced", "fast"] {
        let last = || {
            let text = folder.succeed(&format!("compare waves.obj {QUICK} -p {preset}"));
            text.trim_end().lines().last().unwrap().to_owned()
        };
        assert_eq!(last(), last());
    }
}

#[test]
fn several_models_have_medians_and_files() {
    let folder = Folder::new();
    folder.write("small.obj", waves(8));
    folder.write("large.obj", waves(30));
    let text = folder.succeed(&format!("compare small.obj large.obj {QUICK} --csv all.csv --plot all.svg"));
    assert!(
        text.starts_with("small.obj: 128")
            && text.contains("\n\nlarge.obj: ")
            && text.contains("\n\nmedians of 2 meshes\n"),
        "{text}"
    );
    let csv = String::from_utf8(folder.read("all.csv")).unwrap();
    let rows = structures(&folder).len() - 1;
    assert!(csv.starts_with("model,triangles,preset,structure,build_s,"), "{csv}");
    assert!(csv.lines().count() > 2 * rows, "{csv}");
    assert!(csv.lines().all(|line| line.split(',').count() >= 15), "{csv}");
    let svg = String::from_utf8(folder.read("all.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(svg.contains("kdtree") && svg.contains("list (no bytes)"));
}

#[test]
fn growth_is_shown() {
    let folder = Folder::new();
    let text = folder.succeed("compare --growth=4k -n 200 --rounds 1 --plot growth.svg --csv growth.csv");
    for title in ["ns per bounce ray", "time to build"] {
        let line = text.lines().find(|line| line.starts_with(title)).unwrap();
        assert!(line.contains("1,000") && line.contains("4,000") && line.ends_with("growth"), "{line}");
    }
    assert!(text.contains("\nrecommended, and what --structure auto takes: "), "{text}");
    let svg = String::from_utf8(folder.read("growth.svg")).unwrap();
    assert!(["O(n)", "O(log n)", "O(n log n)"].into_iter().all(|guide| svg.contains(guide)));
    assert!(String::from_utf8(folder.read("growth.csv")).unwrap().contains("\n\"terrain of 4,000\",4000,"));
    assert!(folder.refuse("compare --growth=999").contains("1,000"));
    assert!(folder.refuse("compare --growth=4000001").contains("the largest terrain has 4,000,000 triangles: ask for"));
}

#[test]
fn own_rays_are_counted() {
    let folder = Folder::new();
    folder.write("waves.obj", waves(10));
    folder.write_rays("down.rays", &[[5.0, 9.0, 5.0, 0.01, -1.0, 0.02_f32]; 7]);
    let text = folder.succeed(&format!("compare waves.obj --rays down.rays {QUICK}"));
    assert!(text.contains(" 7 given, "), "{text}");
    folder.write("none.rays", "");
    assert!(folder.refuse("compare waves.obj --rays none.rays").contains("none.rays: holds no rays"));
    folder.write("ragged.rays", [0; 25]);
    assert!(folder.refuse("compare waves.obj --rays ragged.rays").contains("not a whole number of rays"));
    assert!(folder.refuse("compare waves.obj --rays missing.rays").contains("no such file"));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = Folder::new();
    for arguments in [
        "missing.obj",
        "tetrahedron.obj missing.obj --count 0",
        "tetrahedron.obj --rounds 0",
        "tetrahedron.obj --growth=4k",
        "--interval",
        "tetrahedron.obj --csv no/such/folder.csv",
        "tetrahedron.obj --plot .",
        "--camera 1,1,1/1,1,1",
    ] {
        folder.refuse(&format!("compare {arguments}"));
    }
    folder.succeed(&format!("compare tetrahedron.obj {QUICK} --camera 3,2,5/0,0,0/40 -p small"));
}
