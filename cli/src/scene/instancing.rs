use std::collections::BTreeMap;

use hitscan::{Instance, from_fn, geometry::Aabb};

use super::{Built, Choice, Geometry, Palette, Preset};
use crate::{failure::Failure, model::Placement};

/// What a mesh file would take if the parts that it places several times were kept once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instancing {
    /// Different parts.
    pub parts: usize,
    /// How often they are placed in all.
    pub placements: usize,
    /// Triangles of the parts, each counted once.
    pub unique: usize,
    /// Bytes of the parts, of a structure over each, of the instances, and of the structure over these.
    pub bytes: usize,
}

impl Instancing {
    /// Builds the structures to know; `None` if nothing is placed twice.
    pub fn of(geometry: &Geometry, choice: Choice, preset: Preset) -> Result<Option<Self>, Failure> {
        let placed = || geometry.placements.iter().filter(|placement| !placement.triangles.is_empty());
        // Where it is placed first serves as the part itself.
        let parts: BTreeMap<usize, &Placement> = placed().rev().map(|placement| (placement.part, placement)).collect();
        let placements = placed().count();
        if parts.len() == placements {
            return Ok(None);
        }
        let (mut unique, mut bytes) = (0, placements * size_of::<Instance>());
        for placement in parts.values() {
            let part = part(geometry, placement);
            unique += part.len();
            bytes += part.bytes() + Built::new(&part.mesh()?, choice, preset)?.bytes();
        }
        let boxes: Vec<Aabb> = placed().map(|placement| bounds(geometry, placement)).collect();
        let boxes =
            from_fn(boxes.len() as u32, |index| boxes.get(index as usize).copied().unwrap_or(Aabb::EMPTY), |_, _| None);
        bytes += Built::new(&boxes, choice, preset)?.bytes();
        Ok(Some(Self { parts: parts.len(), placements, unique, bytes }))
    }
}

/// The corners of the triangles of a placement.
fn corners<'a>(geometry: &'a Geometry, placement: &Placement) -> impl Iterator<Item = [u32; 3]> + use<'a> {
    let indices = geometry.indices();
    placement.triangles.clone().filter_map(move |triangle| indices.get(triangle as u32))
}

/// The triangles of a placement for themselves.
fn part(geometry: &Geometry, placement: &Placement) -> Geometry {
    let vertices = geometry.vertices.get(placement.vertices.clone()).unwrap_or_default();
    let first = placement.vertices.start as u32;
    let triangles = corners(geometry, placement).map(|corners| corners.map(|vertex| vertex - first)).collect();
    Geometry::new(vertices.to_vec(), triangles, Palette::default())
}

/// The box around a placement.
fn bounds(geometry: &Geometry, placement: &Placement) -> Aabb {
    let vertices = corners(geometry, placement).flatten();
    Aabb::around(vertices.filter_map(|vertex| geometry.vertices.get(vertex as usize).copied()))
}

#[cfg(test)]
mod tests {
    use hitscan::glam::Vec3;

    use super::*;

    /// Copies of a fan of triangles.
    fn fans(copies: usize) -> Geometry {
        let (mut vertices, mut triangles, mut placements) = (Vec::new(), Vec::new(), Vec::new());
        for copy in 0..copies {
            let (vertex, triangle) = (vertices.len(), triangles.len());
            vertices.extend((0..30_u8).map(|i| Vec3::new(copy as f32 * 9.0, f32::from(i), f32::from(i % 7))));
            triangles.extend((1..29).map(|i| [0, i, i + 1].map(|corner| corner + vertex as u32)));
            let (vertices, triangles) = (vertex..vertices.len(), triangle..triangles.len());
            placements.push(Placement { part: 3, vertices, triangles });
        }
        Geometry { placements, ..Geometry::new(vertices, triangles, Palette::default()) }
    }

    #[test]
    fn what_is_placed_often_is_kept_once() {
        let of = |copies| Instancing::of(&fans(copies), Choice::Auto, Preset::Small).unwrap();
        assert_eq!(of(1), None);
        let (few, many) = (of(10).unwrap(), of(40).unwrap());
        assert_eq!((few.parts, few.placements, few.unique), (1, 10, 28));
        assert_eq!((many.parts, many.placements, many.unique), (1, 40, 28));
        let more = many.bytes - few.bytes;
        assert!(more >= 30 * size_of::<Instance>() && more < 30 * 200, "{more}");
    }
}
