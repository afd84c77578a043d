use std::collections::HashMap;

use hitscan::{Mesh, Primitives, glam::Vec3};

/// What a mesh is made of, vertices at the same place taken for one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Anatomy {
    /// Triangles.
    pub triangles: usize,
    /// Vertices as stored.
    pub vertices: usize,
    /// Different places among those that triangles use.
    pub places: usize,
    /// Edges with a triangle on one side only.
    pub boundary_edges: usize,
    /// Edges of more than two triangles.
    pub non_manifold_edges: usize,
    /// Triangles that have exactly no area.
    pub degenerate: usize,
    /// Triangles with the same three corners as one before.
    pub duplicate: usize,
}

impl Anatomy {
    /// Looks at all triangles; those with a corner twice have no edges that count.
    pub fn of(mesh: &Mesh<'_>) -> Self {
        let mut places = HashMap::new();
        let mut place_of = |at: Vec3| {
            let next = places.len() as u32;
            // Adding 0 makes -0.0 the same place as 0.0.
            *places.entry((at + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
        };
        let mut edges = Vec::with_capacity(mesh.len() as usize * 3);
        let mut triples = Vec::with_capacity(mesh.len() as usize);
        let mut degenerate = 0;
        for index in 0..mesh.len() {
            let triangle = mesh.triangle(index);
            let mut corners = [triangle.a, triangle.b, triangle.c].map(&mut place_of);
            degenerate += usize::from(is_flat([triangle.a, triangle.b, triangle.c]));
            corners.sort_unstable();
            let [a, b, c] = corners;
            if a != b && b != c {
                edges.extend([(a, b), (b, c), (a, c)]);
            }
            triples.push(corners);
        }
        let (mut boundary_edges, mut non_manifold_edges, mut duplicate) = (0, 0, 0);
        edges.sort_unstable();
        for uses in edges.chunk_by(PartialEq::eq) {
            boundary_edges += usize::from(uses.len() == 1);
            non_manifold_edges += usize::from(uses.len() > 2);
        }
        triples.sort_unstable();
        for same in triples.chunk_by(PartialEq::eq) {
            duplicate += same.len() - 1;
        }
        let (triangles, vertices, places) = (triples.len(), mesh.vertices().len(), places.len());
        Self { triangles, vertices, places, boundary_edges, non_manifold_edges, degenerate, duplicate }
    }

    /// Whether every edge has a triangle on either side.
    pub fn is_closed(&self) -> bool {
        self.boundary_edges + self.non_manifold_edges == 0
    }
}

/// Whether three points lie exactly on a line: their triangle casts no shadow on any coordinate plane.
fn is_flat([a, b, c]: [Vec3; 3]) -> bool {
    let shadow = |i: usize, j: usize| {
        let [(ax, ay), (bx, by), (cx, cy)] = [a, b, c].map(|p| (f64::from(p[i]), f64::from(p[j])));
        // Twice the shadow's area; products of two f32 are exact in f64.
        [ax * by, -(ay * bx), bx * cy, -(by * cx), cx * ay, -(cy * ax)]
    };
    sums_to_zero(shadow(0, 1)) && sums_to_zero(shadow(1, 2)) && sums_to_zero(shadow(2, 0))
}

/// Whether the sum of six numbers is exactly 0.
///
/// Shewchuk, *Adaptive precision floating-point arithmetic and fast robust geometric predicates*, 1997: the sum is kept as
/// parts that do not overlap, which are all 0 only if it is.
fn sums_to_zero(terms: [f64; 6]) -> bool {
    let mut parts = [0.0; 6];
    for (count, term) in terms.into_iter().enumerate() {
        let mut carry = term;
        for part in &mut parts[..count] {
            let sum = carry + *part;
            let virtual_part = sum - carry;
            *part = (carry - (sum - virtual_part)) + (*part - virtual_part);
            carry = sum;
        }
        parts[count] = carry;
    }
    parts.iter().all(|part| *part == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u16; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    const CORNERS: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];

    #[test]
    fn a_closed_mesh_stays_closed_when_its_vertices_are_doubled() {
        let anatomy = Anatomy::of(&Mesh::new(&CORNERS, &TETRAHEDRON).unwrap());
        assert!(anatomy.is_closed());
        let soup: Vec<Vec3> = TETRAHEDRON.iter().flatten().map(|&v| CORNERS[usize::from(v)] * -1.0 * -1.0).collect();
        let soup: Vec<Vec3> =
            soup.iter().enumerate().map(|(i, v)| if i % 2 == 0 { *v } else { *v - Vec3::ZERO }).collect();
        let triples: Vec<[u16; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let anatomy = Anatomy::of(&Mesh::new(&soup, &triples[..]).unwrap());
        assert!(anatomy.is_closed());
        assert_eq!((anatomy.vertices, anatomy.places), (12, 4));
    }

    #[test]
    fn open_doubled_and_flat_triangles_are_counted() {
        let indices = [[0_u16, 1, 2], [1, 2, 0], [0, 1, 3], [0, 1, 1]];
        let anatomy = Anatomy::of(&Mesh::new(&CORNERS, &indices).unwrap());
        assert_eq!((anatomy.boundary_edges, anatomy.non_manifold_edges), (2, 1));
        assert_eq!((anatomy.duplicate, anatomy.degenerate), (1, 1));
        assert!(!anatomy.is_closed());
    }

    #[test]
    fn flatness_is_exact() {
        let line = |z: f32| [Vec3::splat(0.1), Vec3::splat(0.2), Vec3::new(0.3, 0.3, z)];
        // 0.1 and 0.2 as f32 differ by a factor of exactly 2, and 3 times the former is not the f32 nearest to 0.3.
        assert!(is_flat(line(0.3)));
        assert!(!is_flat(line(0.3_f32.next_up())));
        let far = Vec3::splat(1.0e38);
        assert!(is_flat([far, -far, Vec3::ZERO]));
        assert!(!is_flat([far, -far, Vec3::new(1.0e-45, 0.0, 0.0)]));
    }
}
