//! The house has floors, and arrows only point down: no module imports from a floor above its own.
//!
//! | floor | modules |
//! |---|---|
//! | 0 | `math`, `geometry`, `testing` |
//! | 1 | `primitives`, `arena`, `asset` |
//! | 2 | `accel` |
//! | 3 | `scene`, `lattice_scene`, `query`, `instances` |
//! | 4 | `render`, `sensor` |
//! | 5 | outlets, none of which imports another: `display`, `bake`, `parallel`, `wide` |
//!
//! `error` stands beside them: every floor may import it. It gathers the error types of all floors but the outlets.
#![allow(missing_docs)]

use std::{
    fs,
    path::{Path, PathBuf},
};

const FLOORS: [&[&str]; 6] = [
    &["math", "geometry", "testing"],
    &["primitives", "arena", "asset"],
    &["accel"],
    &["scene", "lattice_scene", "query", "instances"],
    &["render", "sensor"],
    &["display", "bake", "parallel", "wide"],
];

const OUTLETS: usize = 5;

fn floor(module: &str) -> Option<usize> {
    FLOORS.iter().position(|modules| modules.contains(&module))
}

/// The code without comments and without what stands in quotation marks.
fn bare(source: &str) -> String {
    let mut code = String::new();
    for line in source.lines() {
        let line = line.replace("'\"'", "").replace("\\\"", "");
        let unquoted = line.split('"').step_by(2).collect::<Vec<_>>().join("\"");
        code.push_str(unquoted.split("//").next().unwrap_or_default());
        code.push('\n');
    }
    code
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn name(code: &str) -> &str {
    &code[..code.find(|c| !is_name(c)).unwrap_or(code.len())]
}

/// The first names of a use tree: of `a::B`, or of `{a::B, c::{D, e::F}}`.
fn heads(tree: &str) -> Vec<&str> {
    let Some(group) = tree.strip_prefix('{') else { return vec![name(tree)] };
    let (mut depth, mut heads, mut rest) = (0, vec![name(group.trim_start())], group);
    while let Some(at) = rest.find(['{', '}', ',']) {
        let (symbol, after) = (&rest[at..=at], rest[at + 1..].trim_start());
        match symbol {
            "{" => depth += 1,
            "}" if depth == 0 => break,
            "}" => depth -= 1,
            _ if depth == 0 => heads.push(name(after)),
            _ => {}
        }
        rest = after;
    }
    heads.retain(|head| !head.is_empty());
    heads
}

/// How many inline modules are open at `at`.
fn inline_modules(code: &str, at: usize) -> usize {
    let mut open = vec![];
    for (index, c) in code[..at].char_indices() {
        match c {
            '{' => {
                let start = code[..index].rfind([';', '{', '}']).map_or(0, |i| i + 1);
                open.push(code[start..index].split_whitespace().any(|word| word == "mod"));
            }
            '}' => drop(open.pop()),
            _ => {}
        }
    }
    open.into_iter().filter(|&module| module).count()
}

/// The modules of the crate's root that `code` names; it stands `depth` modules below the root.
fn imports(code: &str, depth: usize) -> Vec<String> {
    let mut found = vec![];
    for (at, _) in code.match_indices("crate::") {
        if !code[..at].ends_with(is_name) && !code[..at].ends_with('$') {
            found.extend(heads(&code[at + "crate::".len()..]));
        }
    }
    for (at, _) in code.match_indices("super::") {
        if !code[..at].ends_with("super::") && !code[..at].ends_with(is_name) {
            let up = code[at..].split("super::").take_while(|part| part.is_empty()).count();
            if up >= depth + inline_modules(code, at) {
                found.extend(heads(&code[at + up * "super::".len()..]));
            }
        }
    }
    found.into_iter().map(str::to_owned).collect()
}

/// Why `code`, in the file `path` below `src`, breaks the rule.
fn violations(path: &Path, source: &str) -> Vec<String> {
    let mut modules: Vec<String> =
        path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if modules.last().is_some_and(|last| last == "mod") {
        modules.pop();
    }
    let own = modules[0].as_str();
    if own == "lib" {
        return vec![];
    }
    let complain = |what: String| format!("src/{}: {what}", path.display());
    let here = floor(own);
    if here.is_none() && own != "error" {
        return vec![complain(format!("`{own}` is not in the table of floors"))];
    }
    let judge = |import: String| {
        if import == own || import == "error" {
            return None;
        }
        let Some(there) = floor(&import) else {
            return Some(complain(format!("imports `{import}`, which is not in the table of floors")));
        };
        let allowed = match here {
            Some(OUTLETS) => there < OUTLETS,
            Some(here) => there <= here,
            None => there < OUTLETS,
        };
        (!allowed).then(|| complain(format!("floor {here:?} imports `{import}` of floor {there}")))
    };
    imports(&bare(source), modules.len()).into_iter().filter_map(judge).collect()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect()
}

#[test]
fn arrows_point_down() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let files = files(&src);
    assert!(files.len() > 30, "{files:?}");
    let found: Vec<String> = files
        .iter()
        .flat_map(|file| violations(file.strip_prefix(&src).unwrap(), &fs::read_to_string(file).unwrap()))
        .collect();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn arrows_up_are_found() {
    let broken = |path: &str, source: &str| !violations(Path::new(path), source).is_empty();
    assert!(broken("geometry/ray.rs", "use crate::primitives::Hit;"));
    assert!(broken("accel/list.rs", "use crate::{\n    geometry::{Aabb, Ray},\n    scene::Scene,\n};"));
    assert!(broken("primitives/mesh.rs", "fn f() -> crate::accel::Leaf { loop {} }"));
    assert!(broken("primitives/mesh.rs", "use super::super::render::Camera;"));
    assert!(broken("arena.rs", "use super::accel::List;"));
    assert!(broken("arena.rs", "mod tests { use super::super::accel::List; }"));
    assert!(broken("bake.rs", "use crate::display::draw;"));
    assert!(broken("attic.rs", ""));
    assert!(broken("scene.rs", "use crate::{attic::Trunk};"));
    assert!(broken("error.rs", "use crate::bake::BakeError;"));

    assert!(!broken("scene.rs", "use crate::{accel::{Leaf, scene}, query::Hits, error::Error};"));
    assert!(!broken("bake.rs", "use crate::{bake::Sink, render::Camera};"));
    assert!(!broken("accel/kdtree/build.rs", "use super::{node::Node, super::Leaf};\nuse super::super::render;"));
    assert!(!broken("arena.rs", "mod tests { use super::*; fn f() {} }"));
    assert!(!broken("math.rs", "// use crate::render::Camera;\nconst A: &str = \"crate::render\";"));
    assert!(!broken("asset/mod.rs", "macro_rules! m { () => { $crate::bake::run() } }"));
}
