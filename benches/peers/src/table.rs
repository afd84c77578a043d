//! What came of it, as Markdown.

use std::iter;

use crate::{
    clock::median,
    compare::{Cast, Outcome, Row, kinds},
    engines::Role,
};

/// Prints a line of a table.
fn line(cells: impl IntoIterator<Item = String>) {
    println!("| {} |", cells.into_iter().collect::<Vec<_>>().join(" | "));
}

/// Prints the head of a table: the first column to the left, the others to the right.
fn head(cells: impl IntoIterator<Item = String>) {
    let cells: Vec<String> = cells.into_iter().collect();
    let rule = iter::once("---".to_owned()).chain(cells.iter().skip(1).map(|_| "---:".to_owned())).collect::<Vec<_>>();
    line(cells);
    line(rule);
}

/// Prints the table of one mesh: millions of rays per second, and in parentheses the ratio to what the others are measured by.
pub fn mesh(outcome: &Outcome) {
    let Outcome { name, triangles, rays, rows } = outcome;
    println!("### {name}: {triangles} triangles\n");
    let titles = kinds().map(|(place, kind)| format!("{kind}, {} k", rays[place] / 1000));
    head(
        ["engine", "B/tri", "build, M tri/s"].map(String::from).into_iter().chain(titles).chain(["differ".to_owned()]),
    );
    let role = first_role(outcome);
    for row in rows {
        let cell = |(place, _): (usize, _)| {
            let Some(cast) = &row.casts[place] else { return "–".to_owned() };
            let speed = cast.speed() / 1.0e6;
            let reference = role.and_then(|role| outcome.reference(role, place));
            reference.map_or_else(|| format!("{speed:.2}"), |to| format!("{speed:.2} ({:.2})", cast.ratio(to)))
        };
        let start = [
            row.name.clone(),
            format!("{:.1}", row.bytes_per_triangle(*triangles)),
            format!("{:.2}", row.build_speed(*triangles)),
        ];
        line(start.into_iter().chain(kinds().map(cell)).chain([row.differ()]));
    }
    println!();
}

/// Prints medians over all meshes, a table for each engine that the others are measured by.
pub fn summary(outcomes: &[Outcome]) {
    let titles = [
        (Role::High, "Embree high"),
        (Role::Robust, "Embree robust"),
        (Role::Packets, "Embree's packets of 16"),
        (Role::Obvhs, "the faster of obvhs'"),
    ];
    for (role, title) in titles {
        if outcomes.iter().any(|outcome| has(outcome, role)) {
            println!("### Ratio to {title}: median over {} meshes (least)\n", outcomes.len());
            against(outcomes, role);
            println!();
        }
    }
}

fn against(outcomes: &[Outcome], role: Role) {
    let places: Vec<usize> = kinds()
        .map(|(place, _)| place)
        .filter(|&place| outcomes.iter().any(|outcome| outcome.reference(role, place).is_some()))
        .collect();
    let titles = kinds().filter(|(place, _)| places.contains(place)).map(|(_, kind)| kind.to_string());
    let start = ["engine", "B/tri", "build, M tri/s"].map(String::from).into_iter();
    head(start.chain(titles).chain(["differ".to_owned()]));
    for name in names(outcomes) {
        let over = |value: &dyn Fn(&Row, &Outcome) -> f64| median(rows(outcomes, name).map(|(row, of)| value(row, of)));
        let start = [
            name.to_owned(),
            format!("{:.1}", over(&|row, of| row.bytes_per_triangle(of.triangles))),
            format!("{:.2}", over(&|row, of| row.build_speed(of.triangles))),
        ];
        let cell = |&place: &usize| {
            let ratios: Vec<f64> = ratios(outcomes, name, role, place).map(|(_, ratio)| ratio).collect();
            let least = ratios.iter().copied().reduce(f64::min);
            least.map_or_else(|| "–".to_owned(), |least| format!("{:.2} ({least:.2})", median(ratios)))
        };
        let differ: usize = rows(outcomes, name).map(|(row, _)| row.differences()).sum();
        line(start.into_iter().chain(places.iter().map(cell)).chain([differ.to_string()]));
    }
}

/// The engine that a mesh's table refers to: Embree if it is there.
pub fn first_role(outcome: &Outcome) -> Option<Role> {
    [Role::High, Role::Obvhs].into_iter().find(|&role| has(outcome, role))
}

fn has(outcome: &Outcome, role: Role) -> bool {
    outcome.rows.iter().any(|row| row.role == Some(role))
}

/// The engines, in the order of the first mesh.
pub fn names(outcomes: &[Outcome]) -> impl Iterator<Item = &str> {
    outcomes.first().into_iter().flat_map(|outcome| &outcome.rows).map(|row| row.name.as_str())
}

fn rows<'a>(outcomes: &'a [Outcome], name: &'a str) -> impl Iterator<Item = (&'a Row, &'a Outcome)> {
    outcomes.iter().filter_map(move |outcome| Some((outcome.rows.iter().find(|row| row.name == name)?, outcome)))
}

/// The ratio of this engine to another for each mesh, with the mesh's place.
pub fn ratios<'a>(
    outcomes: &'a [Outcome],
    name: &'a str,
    role: Role,
    place: usize,
) -> impl Iterator<Item = (usize, f64)> {
    outcomes.iter().enumerate().filter_map(move |(mesh, outcome)| {
        let cast: &Cast = outcome.rows.iter().find(|row| row.name == name)?.casts[place].as_ref()?;
        Some((mesh, cast.ratio(outcome.reference(role, place)?)))
    })
}
