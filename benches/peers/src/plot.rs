use std::{error::Error, path::Path};

use plotters::{coord::Shift, prelude::*};

use crate::{
    compare::{Outcome, kinds},
    engines::Role,
    table::{first_role, names, ratios},
};

/// Pixels of each of the four panels.
const PANEL: (u32, u32) = (960, 480);

/// Colours that differ for the eyes of all (Okabe and Ito 2008); when they run out, they come again paler.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(204, 121, 167),
];

/// Where the axis of ratios has its marks.
const RATIOS: [f64; 13] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 4.0, 6.0, 8.0];

/// The colour of a series.
fn color(place: usize) -> RGBAColor {
    COLORS[place % COLORS.len()].mix(if place < COLORS.len() { 1.0 } else { 0.45 })
}

/// Draws the ratios of each engine over the meshes, a panel for each kind of rays.
pub fn write(path: &Path, outcomes: &[Outcome]) -> Result<(), Box<dyn Error>> {
    let Some(role) = outcomes.first().and_then(first_role) else {
        return Err("there is nothing to compare with".into());
    };
    let canvas = SVGBackend::new(path, (PANEL.0 * 2, PANEL.1 * 2)).into_drawing_area();
    canvas.fill(&WHITE)?;
    for ((place, kind), area) in kinds().zip(canvas.split_evenly((2, 2))) {
        panel(&area, outcomes, role, place, &kind.to_string())?;
    }
    Ok(canvas.present()?)
}

fn panel(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    outcomes: &[Outcome],
    role: Role,
    place: usize,
    kind: &str,
) -> Result<(), Box<dyn Error>> {
    let to = if role == Role::High { "Embree high" } else { "obvhs" };
    let last = outcomes.len().saturating_sub(1) as f64;
    let points = |name| -> Vec<(f64, f64)> {
        ratios(outcomes, name, role, place).map(|(mesh, ratio)| (mesh as f64, ratio)).collect()
    };
    let all = || names(outcomes).flat_map(points).map(|point| point.1);
    let (least, most) = (all().fold(0.5, f64::min) / 1.2, all().fold(1.0, f64::max) * 1.2);
    let marks = RATIOS.into_iter().filter(|mark| (least..most).contains(mark)).collect();
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{kind} rays, ratio to {to}"), ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(30)
        .y_label_area_size(50)
        .build_cartesian_2d(-0.4..last * 1.35 + 0.4, (least..most).log_scale().with_key_points(marks))?;
    let name = |x: &f64| {
        let whole = (x - x.round()).abs() < 1.0e-6 && *x > -0.5;
        outcomes.get(x.round() as usize).filter(|_| whole).map_or_else(String::new, |outcome| outcome.name.clone())
    };
    chart
        .configure_mesh()
        .disable_x_mesh()
        .max_light_lines(0)
        .x_labels(outcomes.len() * 2)
        .x_label_formatter(&name)
        .y_label_formatter(&|ratio| format!("{ratio:.1}"))
        .draw()?;
    for (number, name) in names(outcomes).enumerate() {
        let (points, color) = (points(name), color(number));
        if points.is_empty() {
            continue;
        }
        chart
            .draw_series(LineSeries::new(points, color.stroke_width(1)).point_size(4))?
            .label(name)
            .legend(move |(x, y)| Circle::new((x + 8, y), 4, color.filled()));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK)
        .label_font(("sans-serif", 11))
        .draw()?;
    Ok(())
}
