use super::{
    Contest, Outcome, Report, Row, rays_at,
    table::{Table, figure},
    terrain,
};
use crate::{
    failure::Failure,
    scene::Preset,
    units::{count, seconds},
};

/// Triangles of the terrains.
pub const SIZES: [u32; 7] = [1000, 4000, 16_000, 64_000, 250_000, 1_000_000, 4_000_000];

/// Measures all structures over terrains of so many triangles.
pub fn growth(sizes: &[u32], preset: Preset, rays: usize, rounds: usize) -> Result<Vec<Report>, Failure> {
    let rows = Row::plain();
    let measure = |&size: &u32| {
        let geometry = terrain(size);
        let mesh = geometry.mesh()?;
        let (rays, trial) = rays_at(&mesh, None, rays)?;
        let entries = Contest { rays: &rays, trial: &trial.bounce, rounds, preset }.run(mesh, &rows)?;
        Ok(Report { model: format!("terrain of {}", count(size)), triangles: size, preset, entries })
    };
    sizes.iter().map(measure).collect()
}

/// A table of a row per structure and a column per size: `cell` of each, and by how much the last exceeds the first.
fn render(reports: &[Report], what: &str, value: impl Fn(&Outcome) -> f64, cell: impl Fn(f64) -> String) -> String {
    let sizes = reports.iter().map(|report| count(report.triangles));
    let mut table = Table::new([what.to_owned()].into_iter().chain(sizes).chain(["growth".to_owned()]));
    for (place, row) in Row::plain().iter().enumerate() {
        let values: Vec<f64> =
            reports.iter().map(|report| report.entries[place].1.as_ref().map_or(f64::NAN, &value)).collect();
        let grown = values.last().zip(values.first()).map_or(f64::NAN, |(last, first)| last / first);
        let cells = values.iter().map(|&value| cell(value));
        table.push([row.name.to_owned()].into_iter().chain(cells).chain([figure(grown)]));
    }
    table.render()
}

/// Time per ray, build time and what follows for the largest.
pub fn describe(reports: &[Report]) -> String {
    let per_ray = render(reports, "ns per bounce ray", |outcome| 1.0e3 / outcome.speeds[1], figure);
    let build = render(reports, "time to build", |outcome| outcome.build, seconds);
    let verdict = reports.last().map_or(Vec::new(), Report::verdict).join("\n");
    format!("{per_ray}\n{build}{verdict}\n")
}
