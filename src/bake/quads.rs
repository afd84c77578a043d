use alloc::{vec, vec::Vec};

use super::InMeshlets;
use crate::primitives::{Indices, Mesh, MeshError};

/// Triangles of which each two share an edge.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pairs {
    /// The corners of the triangles: `a b c` and `a c d`, `a b c` and `a c d`, …
    pub corners: Vec<[u32; 3]>,
    /// The old number of each triangle; of one without area, which follows a triangle without partner, that one's.
    pub numbers: Vec<u32>,
}

/// A side of a triangle, from a corner to the next one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    triangle: usize,
    corner: usize,
}

impl Side {
    /// The vertices from which it leads and to which.
    fn ends(self, corners: &[[u32; 3]]) -> [u32; 2] {
        let triangle = corners[self.triangle];
        [triangle[self.corner], triangle[(self.corner + 1) % 3]]
    }

    /// The vertex of its triangle that it does not touch.
    fn opposite(self, corners: &[[u32; 3]]) -> u32 {
        corners[self.triangle][(self.corner + 2) % 3]
    }
}

/// All pairs of sides along the same edge in opposite directions, those along the longest edges first.
fn candidates(mesh: &Mesh<'_>, corners: &[[u32; 3]]) -> Vec<[Side; 2]> {
    let sides = (0..corners.len()).flat_map(|triangle| (0..3).map(move |corner| Side { triangle, corner }));
    let mut edges: Vec<([u32; 2], Side)> = sides
        .map(|side| {
            let [from, to] = side.ends(corners);
            ([from.min(to), from.max(to)], side)
        })
        .collect();
    edges.sort_unstable();
    let mut pairs = vec![];
    for edge in edges.chunk_by(|(one, _), (other, _)| one == other) {
        for (place, &([from, to], one)) in edge.iter().enumerate() {
            let [a, b] = [from, to].map(|vertex| mesh.vertices()[vertex as usize]);
            let others = edge[place + 1..].iter().map(|&(_, other)| other);
            let runs_against =
                |other: &Side| other.ends(corners) != one.ends(corners) && other.triangle != one.triangle;
            pairs.extend(
                others
                    .filter(|other| from != to && runs_against(other))
                    .map(|other| (a.distance_squared(b), [one, other])),
            );
        }
    }
    pairs.sort_by(|(one, _), (other, _)| other.total_cmp(one));
    pairs.into_iter().map(|(_, pair)| pair).collect()
}

/// Triangles that a search for a partner looks at before it gives up.
const PATIENCE: usize = 1000;

/// For each triangle its pair, if it gets one: first those along the longest edges, then such as take partners from one another
/// until a triangle that is alone gets one, after Berge, *Two theorems in graph theory*, 1957.
fn matching(candidates: &[[Side; 2]], triangles: usize) -> Vec<Option<usize>> {
    let mut around = vec![vec![]; triangles];
    let mut chosen = vec![None; triangles];
    for (number, [one, other]) in candidates.iter().enumerate() {
        let [one, other] = [one.triangle, other.triangle];
        around[one].push((other, number));
        around[other].push((one, number));
        if chosen[one].is_none() && chosen[other].is_none() {
            (chosen[one], chosen[other]) = (Some(number), Some(number));
        }
    }
    let mut seen_from = vec![usize::MAX; triangles];
    for alone in 0..triangles {
        if chosen[alone].is_some() {
            continue;
        }
        seen_from[alone] = alone;
        let mut steps = vec![Step { triangle: alone, before: 0, neighbour: alone, pair: 0 }];
        let mut place = 0;
        'search: while place < steps.len().min(PATIENCE) {
            for &(neighbour, pair) in &around[steps[place].triangle] {
                if seen_from[neighbour] == alone {
                    continue;
                }
                seen_from[neighbour] = alone;
                let Some(other) = chosen[neighbour] else {
                    exchange(&mut chosen, &steps, Step { triangle: alone, before: place, neighbour, pair });
                    break 'search;
                };
                let [one, other] = candidates[other].map(|side| side.triangle);
                let partner = if one == neighbour { other } else { one };
                if seen_from[partner] != alone {
                    seen_from[partner] = alone;
                    steps.push(Step { triangle: partner, before: place, neighbour, pair });
                }
            }
            place += 1;
        }
    }
    chosen
}

/// A step of a search for a partner: the triangle that would be alone if its partner, a neighbour of the triangle of the step
/// before, went over to that.
struct Step {
    triangle: usize,
    before: usize,
    neighbour: usize,
    pair: usize,
}

/// Gives each triangle on the way to `last` its next neighbour as a partner.
fn exchange(chosen: &mut [Option<usize>], steps: &[Step], last: Step) {
    let mut step = &last;
    loop {
        let before = &steps[step.before];
        (chosen[before.triangle], chosen[step.neighbour]) = (Some(step.pair), Some(step.pair));
        if step.before == 0 {
            return;
        }
        step = before;
    }
}

/// Puts triangles that share an edge beside each other, for [`quads`] and a [`QuadMesh`](crate::primitives::QuadMesh).
///
/// Almost all of a closed mesh find a partner: by Petersen's theorem (1891) all could. A triangle may begin with
/// another corner then, which changes the last bits of parameters, and what belongs to triangles is to be ordered by their old
/// [`numbers`](Pairs::numbers).
///
/// ```
/// use hitscan::{Mesh, bake, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [2, 3, 0]])?;
/// let pairs = bake::pairs(&mesh);
/// assert_eq!(pairs.corners, [[0, 1, 2], [0, 2, 3]]);
/// let quads = bake::quads(&pairs.corners[..])?;
/// let vertices = quads.vertices(&vertices);
/// let smaller = Mesh::new(&vertices, quads.indices())?;
/// # Ok::<(), hitscan::primitives::MeshError>(())
/// ```
#[must_use]
pub fn pairs(mesh: &Mesh<'_>) -> Pairs {
    let old: Vec<[u32; 3]> =
        (0..mesh.indices().len() as u32).filter_map(|triangle| mesh.indices().get(triangle)).collect();
    let candidates = candidates(mesh, &old);
    let (mut corners, mut numbers) = (vec![], vec![]);
    for (triangle, pair) in matching(&candidates, old.len()).into_iter().enumerate() {
        let Some([one, other]) = pair.map(|pair| candidates[pair]) else {
            let [a, b, c] = old[triangle];
            corners.extend([[a, b, c], [a, c, c]]);
            numbers.extend([triangle as u32; 2]);
            continue;
        };
        // Where the first of the two stands.
        if triangle == one.triangle.min(other.triangle) {
            let (own, other) = if one.triangle == triangle { (one, other) } else { (other, one) };
            let [c, a] = own.ends(&old);
            corners.extend([[a, own.opposite(&old), c], [a, c, other.opposite(&old)]]);
            numbers.extend([triangle as u32, other.triangle as u32]);
        }
    }
    Pairs { corners, numbers }
}

/// Puts vertices into the order in which pairs of triangles name them, so that four bytes are enough for the corners of two. As
/// [`meshlets`](super::meshlets), it is for triangles that follow one another where they are neighbours.
///
/// # Errors
///
/// [`MeshError::Quads`] if the triangles do not stand as [`pairs`] puts them.
pub fn quads<'a>(indices: impl Into<Indices<'a>>) -> Result<InMeshlets<4>, MeshError> {
    let indices = indices.into();
    let quad = |first: u32| match (indices.get(first)?, indices.get(first + 1)?) {
        ([a, b, c], [d, e, f]) if (d, e) == (a, c) => Some([a, b, c, f]),
        _ => None,
    };
    let quads: Option<Vec<[u32; 4]>> = (0..indices.len() as u32).step_by(2).map(quad).collect();
    Ok(InMeshlets::of(&quads.ok_or(MeshError::Quads)?))
}
