use super::{
    Entry, Outcome, Row,
    clock::median,
    table::{Table, figure},
};
use crate::{
    scene::{Named, Preset},
    trial::{Recommendation, Work, by_number, candidate, recommend},
    units::{count, seconds},
};

/// The most bytes per triangle of a structure that is fit for a mesh.
const MOST_BYTES: f64 = 200.0;

/// The most seconds that one may take to build.
const MOST_SECONDS: f64 = 10.0;

/// How many times slower than the fastest one it may be.
const SLOWEST: f64 = 4.0;

/// What all rows came to with one mesh, or with the median of several.
#[derive(Clone, Debug)]
pub struct Report {
    /// The mesh, for people.
    pub model: String,
    /// Its triangles.
    pub triangles: u32,
    /// What the structures were tuned for.
    pub preset: Preset,
    /// The rows in order.
    pub entries: Vec<Entry>,
}

impl Report {
    /// The table and what follows from it.
    pub fn render(&self) -> String {
        let mut table = Table::new([
            "structure",
            "build",
            "bytes",
            "B/tri",
            "nodes",
            "tests",
            "primary",
            "bounce",
            "shadow",
            "x list",
            "",
        ]);
        for (row, outcome) in &self.entries {
            match outcome {
                Ok(outcome) => table.push(self.cells(row, outcome)),
                Err(reason) => table.push([row.name; 1].into_iter().chain(["-"; 9]).chain([reason.as_str()])),
            }
        }
        let mut text = table.render();
        for line in self.verdict() {
            text += &format!("{line}\n");
        }
        text
    }

    fn cells(&self, row: &Row, outcome: &Outcome) -> Vec<String> {
        let Outcome { build, bytes, per_triangle, work, speeds: [primary, bounce, shadow], gain, .. } = *outcome;
        // A list has no nodes; what its walk counts are the primitives.
        let nodes = if row.named == Named::list() { "-".to_owned() } else { figure(work.nodes) };
        vec![
            row.name.to_owned(),
            seconds(build),
            count(bytes as u64),
            format!("{per_triangle:.1}"),
            nodes,
            figure(work.tests),
            figure(primary),
            figure(bounce),
            figure(shadow),
            figure(gain),
            self.unfit(outcome).join(", "),
        ]
    }

    /// Why a row is not fit for the mesh.
    pub fn unfit(&self, outcome: &Outcome) -> Vec<String> {
        let speed = |outcome: &Outcome| outcome.speeds[1];
        let best = self.outcomes().map(|(_, outcome)| speed(outcome)).fold(0.0, f64::max);
        let slower = best / speed(outcome);
        let mut reasons = Vec::new();
        if outcome.per_triangle > MOST_BYTES {
            reasons.push(format!("unfit: over {MOST_BYTES} B per triangle"));
        }
        if outcome.build > MOST_SECONDS {
            reasons.push(format!("unfit: over {MOST_SECONDS} s to build"));
        }
        if slower > SLOWEST {
            reasons.push(format!("{}x slower than the fastest", figure(slower)));
        }
        reasons
    }

    /// The rows that could be measured.
    pub fn outcomes(&self) -> impl Iterator<Item = (&Row, &Outcome)> {
        self.entries.iter().filter_map(|(row, outcome)| Some((row, outcome.as_ref().ok()?)))
    }

    /// What is recommended, by counts and bytes, and what `auto` takes if that is another one.
    pub fn verdict(&self) -> Vec<String> {
        let rule = by_number(self.triangles);
        let counted = self.counted();
        let line =
            |what: &str, Recommendation { named, why }: &Recommendation| format!("{what}: {}: {why}", named.name);
        match (&rule, &counted) {
            (Some(rule), _) if rule.named == Named::list() => vec![line("recommended", rule)],
            (Some(rule), Some(counted)) => vec![line("recommended", counted), line("--structure auto", rule)],
            (None, Some(counted)) => vec![line("recommended, and what --structure auto takes", counted)],
            (_, None) => Vec::new(),
        }
    }

    /// What is recommended by counts and bytes.
    fn counted(&self) -> Option<Recommendation> {
        let candidates: Vec<_> = self
            .outcomes()
            .filter(|(row, _)| row.is_candidate())
            .map(|(row, outcome)| candidate(row.named, outcome.baked as usize, self.triangles, outcome.trial))
            .collect();
        recommend(&candidates, self.preset)
    }
}

/// Each row's medians over several meshes, of which it has not failed with any.
pub fn medians(reports: &[Report]) -> Option<Report> {
    let first = reports.first()?;
    let mut entries = Vec::new();
    for (place, (row, _)) in first.entries.iter().enumerate() {
        let outcomes: Result<Vec<&Outcome>, _> =
            reports.iter().map(|report| report.entries[place].1.as_ref()).collect();
        let outcome = outcomes.map_err(|_| "not built over all of them".to_owned()).map(|all| {
            let of = |value: fn(&Outcome) -> f64| median(all.iter().map(|outcome| value(outcome)).collect());
            Outcome {
                build: of(|o| o.build),
                bytes: of(|o| o.bytes),
                baked: of(|o| o.baked),
                per_triangle: of(|o| o.per_triangle),
                work: Work { nodes: of(|o| o.work.nodes), tests: of(|o| o.work.tests) },
                trial: Work { nodes: of(|o| o.trial.nodes), tests: of(|o| o.trial.tests) },
                speeds: [of(|o| o.speeds[0]), of(|o| o.speeds[1]), of(|o| o.speeds[2])],
                gain: of(|o| o.gain),
            }
        });
        entries.push((*row, outcome));
    }
    let triangles = median(reports.iter().map(|report| report.triangles.into()).collect()) as u32;
    Some(Report { model: format!("medians of {} meshes", reports.len()), triangles, preset: first.preset, entries })
}
