use alloc::vec::Vec;

use glam::Vec3;

use crate::{
    geometry::{Aabb, Axis, Lattice, MAX_COORDINATE},
    primitives::{Indices, LatticeMesh, Mesh, MeshError, Primitives},
};

/// Vertices on a lattice, for [`LatticeMesh`].
#[derive(Clone, Debug, PartialEq)]
pub struct OnLattice {
    /// The box that the lattice is over: a little more than the mesh.
    pub frame: Aabb,
    /// The vertices in their old order.
    pub vertices: Vec<[u16; 3]>,
    /// The farthest that a vertex in use was moved, in the mesh's units.
    pub displacement: f32,
}

impl OnLattice {
    /// The mesh of triangles between these vertices.
    ///
    /// # Errors
    ///
    /// Those of [`LatticeMesh::new`].
    pub fn mesh<'a>(&'a self, indices: impl Into<Indices<'a>>) -> Result<LatticeMesh<'a>, MeshError> {
        LatticeMesh::new(&self.frame, &self.vertices, indices)
    }
}

/// Puts each vertex of a mesh to the nearest place where planes of a lattice meet, in 6 bytes instead of 12.
///
/// The lattice has 65,535 planes along each side of the mesh's bounds, so vertices move by at most half of what lies
/// between two: a model of a metre by 8 micrometres along each axis, and [`OnLattice::displacement`] says how far in all.
/// The planes are at least as far apart as tells their `f32` positions apart.
///
/// ```
/// use hitscan::{Mesh, Scene, accel::{Plan, Structure}, bake, dualsplit::Options, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE / 3.0];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3]])?;
/// let snapped = bake::lattice(&mesh);
/// assert!(snapped.displacement < 1.0e-5);
///
/// let mesh = snapped.mesh(mesh.indices())?;
/// let words = bake::build(&mesh, &Plan::DualSplit(Options::balanced()))?;
/// let asset = bake::Baker::new().lattice_mesh(&mesh).structure(hitscan::DualSplit::open(&words)?).finish();
/// # let _ = asset;
/// # Ok::<(), hitscan::Error>(())
/// ```
#[must_use]
pub fn lattice(mesh: &Mesh<'_>) -> OnLattice {
    let frame = frame((0..mesh.len()).map(|index| mesh.bounds(index)).fold(Aabb::EMPTY, |all, one| all.union(&one)));
    let lattice = Lattice::over(&frame, [LatticeMesh::LAST; 3]);
    let vertices: Vec<_> =
        mesh.vertices().iter().map(|&vertex| Axis::ALL.map(|axis| nearest(&lattice, axis, vertex))).collect();
    let mut snapped = OnLattice { frame, vertices, displacement: 0.0 };
    let largest = match snapped.mesh(mesh) {
        Ok(moved) => displacement(mesh, &moved),
        // Only where it was beyond all coordinates before.
        Err(_) => f32::INFINITY,
    };
    snapped.displacement = largest;
    snapped
}

/// The number of the plane next to a vertex.
fn nearest(lattice: &Lattice, axis: Axis, vertex: Vec3) -> u16 {
    let x = axis.of(vertex);
    let below = lattice.below(axis, x).min(LAST_USED);
    let above = (below + 1).min(LAST_USED);
    let distance = |number| (f64::from(lattice.position(axis, number)) - f64::from(x)).abs();
    (if distance(above) < distance(below) { above } else { below }) as u16
}

/// The last plane may lie outside the frame, so that vertices on it would make the bounds larger than it is.
const LAST_USED: u32 = LatticeMesh::LAST - 1;

/// The box over which a lattice has a plane before the last at or behind the ends of `bounds`, and tells all of its planes
/// apart.
fn frame(bounds: Aabb) -> Aabb {
    if bounds.is_empty() {
        return Aabb::new(Vec3::ZERO, Vec3::ONE);
    }
    let longest = bounds.size().max_element();
    let end = |min: f32, max: f32| {
        // Steps of four to eight units in the last place of the largest coordinate; along an axis without extent, the
        // frame is as thick as that needs.
        let largest = if min.abs() > max.abs() { min.abs() } else { max.abs() };
        let least = (largest / 32.0).max(longest / 65_536.0).max(f32::MIN_POSITIVE * 131_072.0);
        let size = (max - min).max(least);
        // One step more, and what the roundings take.
        (min + size * (65_537.0 / 65_535.0)).min(MAX_COORDINATE)
    };
    let (min, max) = (bounds.min, bounds.max);
    Aabb::new(min, Vec3::new(end(min.x, max.x), end(min.y, max.y), end(min.z, max.z)))
}

/// The farthest that a corner of a triangle was moved, rounded up.
fn displacement(mesh: &Mesh<'_>, moved: &LatticeMesh<'_>) -> f32 {
    let positions: Vec<Vec3> = moved.positions().collect();
    let corners = (0..mesh.len()).filter_map(|triangle| mesh.indices().get(triangle)).flatten();
    let squares = corners.filter_map(|vertex| {
        let (from, to) = (mesh.vertices().get(vertex as usize)?, positions.get(vertex as usize)?);
        let along = |(to, from)| f64::from(to) - f64::from(from);
        Some(to.to_array().into_iter().zip(from.to_array()).map(along).map(|length| length * length).sum())
    });
    let exact = crate::math::sqrt64(squares.fold(0.0, f64::max));
    let rounded = exact as f32;
    if f64::from(rounded) < exact { rounded.next_up() } else { rounded }
}
