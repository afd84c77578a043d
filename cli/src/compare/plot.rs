use std::{io, path::Path};

use plotters::{coord::Shift, prelude::*};

use super::{Outcome, Report, Row, table::figure};
use crate::output::{OutputError, write_atomically};

/// Pixels of a plot with one panel.
const SIZE: (u32, u32) = (960, 640);

/// A place to draw on.
type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Why something was not drawn.
type Fault = Box<dyn std::error::Error>;

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

/// The colour of a series.
fn color(place: usize) -> RGBAColor {
    COLORS[place % COLORS.len()].mix(if place < COLORS.len() { 1.0 } else { 0.45 })
}

/// A named line.
struct Series {
    name: String,
    points: Vec<(f64, f64)>,
}

/// Draws bytes per triangle against the speed of bounce rays, both axes logarithmic; the list, far off the others on both,
/// is mentioned.
pub fn plot_bytes(path: &Path, report: &Report) -> Result<(), OutputError> {
    /// Fewer bytes per triangle are no structure.
    const LEAST: f64 = 0.5;
    let trees: Vec<(&Row, (f64, f64))> = report
        .outcomes()
        .map(|(row, outcome)| (row, (outcome.per_triangle, outcome.speeds[1])))
        .filter(|(_, (bytes, speed))| *bytes >= LEAST && speed.is_finite())
        .collect();
    let list = report.outcomes().next().map_or(f64::NAN, |(_, outcome)| outcome.speeds[1]);
    write(path, SIZE, |canvas| {
        let range = |value: fn(&(f64, f64)) -> f64| range(trees.iter().map(|(_, point)| value(point)));
        let (x, y) = (range(|point| point.0), range(|point| point.1));
        let mut chart = ChartBuilder::on(canvas)
            .caption(format!("{}: bytes and speed", report.model), ("sans-serif", 20))
            .margin(16)
            .x_label_area_size(40)
            .y_label_area_size(60)
            .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
        chart
            .configure_mesh()
            .x_desc(format!("bytes per triangle; list (no bytes): {} million bounce rays per second", figure(list)))
            .x_label_formatter(&|x| figure(*x))
            .y_label_formatter(&|y| figure(*y))
            .y_desc("million bounce rays per second")
            .draw()?;
        for (place, (row, point)) in trees.iter().enumerate() {
            let style = color(place).filled();
            chart
                .draw_series([Circle::new(*point, 6, style)])?
                .label(row.name)
                .legend(move |(x, y)| Circle::new((x + 8, y), 6, style));
        }
        let position = SeriesLabelPosition::LowerLeft;
        chart
            .configure_series_labels()
            .position(position)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK)
            .draw()?;
        Ok(())
    })
}

/// Draws the time of a bounce ray and of building against the number of triangles, all axes logarithmic.
pub fn plot_growth(path: &Path, reports: &[Report]) -> Result<(), OutputError> {
    write(path, (SIZE.0 * 2, SIZE.1), |canvas| {
        let (left, right) = canvas.split_horizontally(SIZE.0);
        let per_ray = series(reports, |outcome| 1.0e3 / outcome.speeds[1]);
        let build = series(reports, |outcome| outcome.build * 1.0e3);
        let guides = [("O(n)", true, linear as Curve), ("O(log n)", false, logarithmic)];
        panel(&left, "nanoseconds per bounce ray", &per_ray, &guides)?;
        panel(
            &right,
            "milliseconds to build",
            &build,
            &[("O(n log n)", false, |n, m| linear(n, m) * logarithmic(n, m))],
        )
    })
}

/// By how much something grows from n to m triangles.
type Curve = fn(f64, f64) -> f64;

fn linear(n: f64, m: f64) -> f64 {
    m / n
}

fn logarithmic(n: f64, m: f64) -> f64 {
    m.ln() / n.ln()
}

/// A line per row, a point per size.
fn series(reports: &[Report], value: impl Fn(&Outcome) -> f64) -> Vec<Series> {
    let line = |(place, row): (usize, &Row)| {
        let point =
            |report: &Report| Some((f64::from(report.triangles), value(report.entries[place].1.as_ref().ok()?)));
        Series { name: row.name.to_owned(), points: reports.iter().filter_map(point).collect() }
    };
    Row::plain().iter().enumerate().map(line).collect()
}

/// Lines over the number of triangles, and dashed guides: from the first point of the first or of the last line.
fn panel(canvas: &Canvas<'_>, what: &str, series: &[Series], guides: &[(&str, bool, Curve)]) -> Result<(), Fault> {
    let all = || series.iter().flat_map(|series| &series.points);
    let (x, y) = (range(all().map(|point| point.0)), range(all().map(|point| point.1)));
    let mut chart = ChartBuilder::on(canvas)
        .caption(format!("terrain: {what}"), ("sans-serif", 20))
        .margin(16)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("triangles")
        .x_label_formatter(&|x| figure(*x))
        .y_label_formatter(&|y| figure(*y))
        .y_desc(what)
        .draw()?;
    for (place, Series { name, points }) in series.iter().enumerate() {
        let color = color(place);
        let line = LineSeries::new(points.iter().copied(), color.stroke_width(2)).point_size(3);
        chart
            .draw_series(line)?
            .label(name)
            .legend(move |(x, y)| Rectangle::new([(x, y - 2), (x + 16, y + 2)], color.filled()));
    }
    for (name, of_first, curve) in guides {
        let from = if *of_first { series.first() } else { series.last() };
        let Some(&(n, start)) = from.and_then(|series| series.points.first()) else { continue };
        let last = all().map(|point| point.0).fold(n, f64::max);
        let points: Vec<_> = (0..=32)
            .map(|step| n * (last / n).powf(f64::from(step) / 32.0))
            .map(|m| (m, start * curve(n, m)))
            .collect();
        let grey = RGBColor(120, 120, 120);
        let end = points.last().copied().unwrap_or((n, start));
        chart.draw_series(DashedLineSeries::new(points, 6, 5, grey.stroke_width(1)))?;
        let label = Text::new((*name).to_owned(), (-70, 6), ("sans-serif", 14).into_font().color(&grey));
        chart.draw_series([EmptyElement::at(end) + label])?;
    }
    let position = SeriesLabelPosition::UpperLeft;
    chart.configure_series_labels().position(position).background_style(WHITE.mix(0.8)).border_style(BLACK).draw()?;
    Ok(())
}

/// Around all positive values, with a margin; never empty.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let usable = values.filter(|value| value.is_finite() && *value > 0.0);
    let (least, most) = usable.fold((f64::INFINITY, 0.0_f64), |(a, b), value| (a.min(value), b.max(value)));
    if least > most { (1.0, 10.0) } else { (least / 1.5, most * 1.5) }
}

/// Draws an SVG and writes it.
fn write(
    path: &Path,
    size: (u32, u32),
    draw: impl FnOnce(&Canvas<'_>) -> Result<(), Fault>,
) -> Result<(), OutputError> {
    write_atomically(path, |file| {
        let mut text = String::new();
        let canvas = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let drawn = canvas.fill(&WHITE).map_err(Fault::from).and_then(|()| draw(&canvas));
        drawn.and_then(|()| Ok(canvas.present()?)).map_err(|fault| io::Error::other(fault.to_string()))?;
        drop(canvas);
        file.write_all(text.as_bytes())
    })
}
