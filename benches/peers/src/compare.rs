use std::time::Duration;

use hitscan::{Arena, Bvh, Error, Scene, bvh};

use crate::{
    clock::{median, time},
    engines::{Contender, Libraries, Memory, Role, Wanted, hitscan, peers},
    mesh::Mesh,
    rays::{self, Kind, Order, Query, RaySet, View},
};

/// What came of one mesh.
#[derive(Debug)]
pub struct Outcome {
    /// The mesh, with @inside if that is where it is seen from.
    pub name: String,
    /// How many triangles it has.
    pub triangles: usize,
    /// How many rays of each kind were cast.
    pub rays: [usize; 4],
    /// One for each engine.
    pub rows: Vec<Row>,
}

/// What came of one engine.
#[derive(Debug)]
pub struct Row {
    /// The engine.
    pub name: String,
    /// Whether others are measured by it.
    pub role: Option<Role>,
    /// All that its rays may read.
    pub bytes: usize,
    /// CPU time of its build.
    pub build: Duration,
    /// What came of each kind of rays that it casts.
    pub casts: [Option<Cast>; 4],
}

/// What came of the rays of one set with one engine.
#[derive(Debug)]
pub struct Cast {
    /// Rays per second of each round.
    pub speeds: Vec<f64>,
    /// Rays with another answer than hitscan's, which is exact.
    pub differ: usize,
}

impl Cast {
    /// The median of the rounds' speeds.
    pub fn speed(&self) -> f64 {
        median(self.speeds.iter().copied())
    }

    /// The median of the rounds' ratios.
    pub fn ratio(&self, to: &Self) -> f64 {
        median(self.speeds.iter().zip(&to.speeds).map(|(speed, reference)| speed / reference))
    }
}

/// How much is cast, and how.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Primary rays.
    pub rays: usize,
    /// Times that each set is cast.
    pub rounds: usize,
    /// How the rays are ordered.
    pub order: Order,
}

/// Builds every engine over the mesh and casts the rays.
pub fn run(mesh: &Mesh, view: View, effort: Effort, libraries: &Libraries, wanted: &Wanted) -> Result<Outcome, Error> {
    let triangles = mesh.view()?;
    let sets = guide(&triangles, view, effort)?;
    let mut memory = Memory::new(mesh.len(), wanted);
    let mut contenders = peers(mesh, libraries, wanted);
    contenders.extend(hitscan(&triangles, mesh.bytes(), &mut memory, wanted)?);

    let mut casts: Vec<[Option<Cast>; 4]> = contenders.iter().map(|_| [const { None }; 4]).collect();
    for (place, set) in sets.iter().enumerate() {
        for (casts, cast) in casts.iter_mut().zip(cast(&contenders, set, effort.rounds)) {
            casts[place] = cast;
        }
    }
    let row = |(contender, casts): (Contender<'_>, _)| Row {
        bytes: contender.engine.bytes(),
        name: contender.name,
        role: contender.role,
        build: contender.build,
        casts,
    };
    Ok(Outcome {
        name: if view == View::Inside { format!("{}@inside", mesh.name) } else { mesh.name.clone() },
        triangles: mesh.len(),
        rays: sets.each_ref().map(|set| set.rays.len()),
        rows: contenders.into_iter().zip(casts).map(row).collect(),
    })
}

/// The rays and their true answers, by hitscan.
fn guide(mesh: &hitscan::Mesh<'_>, view: View, effort: Effort) -> Result<[RaySet; 4], Error> {
    let options = bvh::Options::balanced();
    let mut memory = vec![0; Bvh::words(mesh.indices().len(), &options)];
    let tree = Bvh::build(mesh, &mut Arena::new(&mut memory), &options)?;
    Ok(rays::all(&Scene::new(tree, mesh)?, view, effort.rays, effort.order))
}

/// Casts the rays with each engine in turn, as many times over as there are rounds.
fn cast(contenders: &[Contender<'_>], set: &RaySet, rounds: usize) -> Vec<Option<Cast>> {
    let mut casts: Vec<Option<Cast>> = contenders
        .iter()
        .map(|contender| contender.engine.casts(set.kind).then(|| Cast { speeds: Vec::new(), differ: 0 }))
        .collect();
    let mut answers = Vec::with_capacity(set.rays.len());
    for _ in 0..rounds {
        for (contender, cast) in contenders.iter().zip(&mut casts) {
            let Some(cast) = cast else { continue };
            answers.clear();
            let (_, spent) = time(|| match set.kind.query() {
                Query::Closest => contender.engine.closest(&set.rays, &mut answers),
                Query::Any => contender.engine.any(&set.rays, &mut answers),
            });
            cast.speeds.push(set.rays.len() as f64 / spent.as_secs_f64());
            cast.differ = answers.iter().zip(&set.truth).filter(|&(&a, &b)| differ(a, b)).count();
        }
    }
    casts
}

/// Whether one hits and the other does not, or both hit more than 1e-4 apart.
fn differ(a: f32, b: f32) -> bool {
    a.is_finite() != b.is_finite() || a.is_finite() && (a - b).abs() > 1.0e-4 * b.abs()
}

impl Outcome {
    /// What the others of this mesh are measured by for rays of the kind at `place`: of several, the fastest.
    pub fn reference(&self, role: Role, place: usize) -> Option<&Cast> {
        let casts = self.rows.iter().filter(|row| row.role == Some(role)).filter_map(|row| row.casts[place].as_ref());
        casts.max_by(|a, b| a.speed().total_cmp(&b.speed()))
    }
}

impl Row {
    /// Bytes per triangle.
    pub fn bytes_per_triangle(&self, triangles: usize) -> f64 {
        self.bytes as f64 / triangles as f64
    }

    /// Millions of triangles built per second of CPU time.
    pub fn build_speed(&self, triangles: usize) -> f64 {
        triangles as f64 / self.build.as_secs_f64() / 1.0e6
    }

    /// How many answers differ.
    pub fn differences(&self) -> usize {
        self.casts.iter().flatten().map(|cast| cast.differ).sum()
    }

    /// How many answers differ, of each kind that was cast.
    pub fn differ(&self) -> String {
        let count = |cast: &Option<Cast>| cast.as_ref().map_or_else(|| "–".into(), |cast| cast.differ.to_string());
        self.casts.each_ref().map(count).join(" / ")
    }
}

/// The kinds of rays with the places where their casts are.
pub fn kinds() -> impl Iterator<Item = (usize, Kind)> {
    Kind::ALL.into_iter().enumerate()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::procedural;

    /// How many rays may differ: those through edges, which the peers answer one way or the other.
    const FEW: usize = 3;

    #[test]
    fn all_engines_agree() {
        let libraries = Libraries::open(&[]).expect("without paths, none is an answer");
        let effort = Effort { rays: 4096, rounds: 1, order: Order::Tiles };
        for mesh in [procedural::knot(2000), procedural::soup(1000), procedural::terrain(1000)] {
            let outcome = run(&mesh, View::Outside, effort, &libraries, &Wanted::default()).expect("a mesh");
            assert!(outcome.rays.iter().all(|&rays| rays > 3000), "{}: {:?}", mesh.name, outcome.rays);
            for row in &outcome.rows {
                let most = if row.name.starts_with("hitscan") { 0 } else { FEW };
                assert!(row.differences() <= most, "{}: {} differs: {}", mesh.name, row.name, row.differ());
                assert!(row.bytes > 0 && row.casts.iter().any(Option::is_some), "{}", row.name);
            }
        }
    }

    #[test]
    fn an_answer_differs_where_it_is_another() {
        assert!(differ(1.0, f32::INFINITY) && differ(f32::INFINITY, 1.0) && differ(1.0, 1.001));
        assert!(!differ(f32::INFINITY, f32::INFINITY) && !differ(1.0, 1.0 + f32::EPSILON));
    }
}
