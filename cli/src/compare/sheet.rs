use std::{io, path::Path};

use super::{Outcome, Report};
use crate::output::{OutputError, write_atomically};

/// The columns of the file.
const COLUMNS: [&str; 15] = [
    "model",
    "triangles",
    "preset",
    "structure",
    "build_s",
    "bytes",
    "bytes_per_triangle",
    "nodes_per_ray",
    "tests_per_ray",
    "primary_mrays_per_s",
    "bounce_mrays_per_s",
    "shadow_mrays_per_s",
    "speed_up_over_list",
    "unfit",
    "failure",
];

/// Writes the reports as comma-separated values, a line per mesh and row.
pub fn write_csv(path: &Path, reports: &[Report]) -> Result<(), OutputError> {
    write_atomically(path, |file| {
        let mut sheet = csv::Writer::from_writer(file);
        sheet.write_record(COLUMNS).map_err(io::Error::from)?;
        for report in reports {
            for (row, outcome) in &report.entries {
                let head =
                    [&report.model, &report.triangles.to_string(), report.preset.name(), row.name].map(str::to_owned);
                let tail = match outcome {
                    Ok(outcome) => {
                        numbers(outcome).into_iter().chain([report.unfit(outcome).join(", "), String::new()]).collect()
                    }
                    Err(reason) => [vec![String::new(); 10], vec![reason.clone()]].concat(),
                };
                sheet.write_record(head.into_iter().chain(tail)).map_err(io::Error::from)?;
            }
        }
        sheet.flush()
    })
}

/// The numbers of an outcome, in the order of the columns.
fn numbers(outcome: &Outcome) -> Vec<String> {
    let Outcome { build, bytes, per_triangle, work, speeds: [primary, bounce, shadow], gain, .. } = *outcome;
    let numbers = [build, bytes, per_triangle, work.nodes, work.tests, primary, bounce, shadow, gain];
    numbers.iter().map(|number| if number.is_finite() { number.to_string() } else { String::new() }).collect()
}
