//! Baking (feature `alloc`): structures and assets made on a host, for anywhere.
//!
//! By `hitscan bake`, or in the `build.rs` of a firmware, with hitscan among its build dependencies:
//!
//! ```no_run
//! use hitscan::{Mesh, accel::{Plan, Structure}, bake::{self, Baker}, glam::Vec3, kdtree::Options};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (vertices, triangles) = ([Vec3::ZERO, Vec3::X, Vec3::Y], [[0_u16, 1, 2]]);
//! let mesh = Mesh::new(&vertices, &triangles)?;
//! let plan = Plan::KdTree(Options::balanced().fit(64 * 1024));
//! let words = bake::build(&mesh, &plan)?;
//! let asset = Baker::new().mesh(&mesh).structure(Structure::open(plan.kind().unwrap(), &words)?).finish();
//! let file = std::path::Path::new(&std::env::var("OUT_DIR")?).join("scene.hits");
//! std::fs::write(file, asset.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())?;
//! # Ok(()) }
//! ```
//!
//! The firmware includes it by `include_asset!(concat!(env!("OUT_DIR"), "/scene.hits"))`.

mod lattice;
mod meshlets;
mod quads;

use alloc::{vec, vec::Vec};

use glam::{Vec2, Vec3};

use crate::{
    accel::{Plan, Structure},
    arena::{Arena, Full},
    asset::{ALIGNMENT, BYTE_ORDER, CHECKSUM_WORD, ENTRY_WORDS, HEADER_WORDS, Kind, MAGIC, VERSION, checksum},
    error::BuildError,
    geometry::{Sphere, Triangle},
    instances::Instance,
    primitives::{Indices, LatticeMesh, Mesh, Meshlets, Normals, Primitives, TexCoords, Triangles},
    render::{Material, Numbers, Texture, Textures},
};

pub use lattice::{OnLattice, lattice};
pub use meshlets::{InMeshlets, meshlets};
pub use quads::{Pairs, pairs, quads};

/// Builds a structure in as much memory as that takes; its words are for its `open`, or for [`Baker::structure`].
///
/// ```
/// use hitscan::{KdTree, Mesh, accel::Plan, bake, glam::Vec3, kdtree::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let words = bake::build(&mesh, &Plan::KdTree(Options::fast()))?;
/// assert_eq!(KdTree::open(&words)?.node_count(), 1);
/// # Ok::<(), hitscan::Error>(())
/// ```
///
/// # Errors
///
/// Those of [`Structure::build`], except that memory does not run out.
pub fn build<P: Primitives + ?Sized>(primitives: &P, plan: &Plan) -> Result<Vec<u32>, BuildError> {
    let most = plan.words(primitives.len() as usize);
    // Usually a fraction of what always suffices is enough, and untouched memory would still be cleared.
    let mut size = most.min(4096 + primitives.len() as usize * 24);
    loop {
        let mut memory = vec![0; size];
        let used = match Structure::build(primitives, &mut Arena::new(&mut memory), plan) {
            Ok(structure) => structure.as_words().len(),
            Err(BuildError::Full(Full { at_least, .. })) if size < most => {
                size = (size * 2).max(at_least).min(most);
                continue;
            }
            Err(error) => return Err(error),
        };
        memory.truncate(used);
        memory.shrink_to_fit();
        return Ok(memory);
    }
}

/// A structure over primitives that stand in the order of its leaves, and that order: the old numbers by place.
///
/// Hierarchies whose leaves are ranges need no list of numbers then; `None` of other structures. The mesh is put into
/// order by [`reorder`], and [`Baker::numbers`] stores the order for who wants the old numbers.
///
/// ```
/// use hitscan::{Mesh, Primitives, Scene, accel::{Plan, Structure}, bake, bvh, glam::Vec3};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])?;
/// let plan = Plan::Bvh(bvh::Options::small());
/// let words = bake::build(&mesh, &plan)?;
///
/// let (words, order) = bake::ordered(&Structure::open(plan.kind().unwrap(), &words)?).unwrap();
/// let corners = bake::reorder(&mesh, &order);
/// let scene = Scene::new(Structure::open(plan.kind().unwrap(), &words)?, Mesh::new(&vertices, &corners[..])?)?;
/// # Ok::<(), hitscan::Error>(())
/// ```
#[must_use]
pub fn ordered(structure: &Structure<'_>) -> Option<(Vec<u32>, Vec<u32>)> {
    match structure {
        Structure::Bvh(bvh) => Some((bvh.ordered().as_words().to_vec(), bvh.order().collect())),
        Structure::DualSplit(tree) => Some((tree.ordered_words().collect(), tree.order().collect())),
        _ => None,
    }
}

/// The corners of a mesh's triangles in another order, which names the triangles that exist.
#[must_use]
pub fn reorder<'a>(mesh: impl Into<Indices<'a>>, order: &[u32]) -> Vec<[u32; 3]> {
    let indices = mesh.into();
    order.iter().filter_map(|&triangle| indices.get(triangle)).collect()
}

/// Puts sections together into an asset: the same bytes on every host. See [`Asset`](crate::asset::Asset).
#[derive(Clone, Debug, Default)]
pub struct Baker {
    sections: Vec<(Kind, Vec<u32>)>,
}

impl Baker {
    /// An asset without sections.
    #[must_use]
    pub const fn new() -> Self {
        Self { sections: Vec::new() }
    }

    /// The same with a mesh: its vertices and its indices, these in 16 bits if they fit.
    #[must_use]
    pub fn mesh(self, mesh: &Mesh<'_>) -> Self {
        let vertices = mesh.vertices().iter().flat_map(|v| v.to_array()).map(f32::to_bits).collect();
        self.section(Kind::Vertices, vertices).indices(mesh.indices(), mesh.vertices().len())
    }

    /// The same with a mesh on a lattice: its vertices, in half the bytes, and its indices.
    #[must_use]
    pub fn lattice_mesh(self, mesh: &LatticeMesh<'_>) -> Self {
        let frame = [mesh.frame().min, mesh.frame().max].into_iter().flat_map(|corner| corner.to_array());
        let mut words = vec![mesh.vertices().len() as u32];
        words.extend(frame.map(f32::to_bits));
        let numbers: Vec<u32> = mesh.vertices().iter().flatten().map(|&number| u32::from(number)).collect();
        words.extend(halves(&numbers));
        self.section(Kind::LatticeVertices, words).indices(mesh.indices(), mesh.vertices().len())
    }

    /// The same with the normals of a mesh's vertices, in 2 bytes each: see [`Normals`].
    #[must_use]
    pub fn normals(self, normals: &[Vec3]) -> Self {
        let numbers = normals.iter().map(|&normal| Normals::packed(normal).into());
        self.section(Kind::Normals, counted_halves(normals.len() as u32, numbers))
    }

    /// The same with the texture coordinates of a mesh's vertices, in 4 bytes each: see [`TexCoords`].
    ///
    /// What is not finite is moved to the end of the range of those that are.
    #[must_use]
    pub fn tex_coords(self, coordinates: &[Vec2]) -> Self {
        self.section(Kind::TexCoords, TexCoords::packed(coordinates).collect())
    }

    /// The same with these triangles as a [`Soup`](crate::primitives::Soup): only the corners are kept.
    #[must_use]
    pub fn soup<P: Triangles + ?Sized>(self, triangles: &P) -> Self {
        let corners = (0..triangles.len()).flat_map(|index| {
            let Triangle { a, b, c } = triangles.triangle(index);
            [a, b, c].into_iter().flat_map(|corner| corner.to_array()).map(f32::to_bits)
        });
        self.section(Kind::Soup, corners.collect())
    }

    fn indices(self, indices: Indices<'_>, vertices: usize) -> Self {
        let count = indices.len() as u32;
        match indices {
            Indices::Meshlets(meshlets) => return self.section(Kind::Meshlets, counted_meshlets(meshlets)),
            Indices::Quads(quads) => return self.section(Kind::Quads, counted_meshlets(quads)),
            Indices::Narrow(_) | Indices::Wide(_) => {}
        }
        let corners = (0..count).flat_map(|triangle| indices.get(triangle)).flatten();
        if matches!(indices, Indices::Narrow(_)) || vertices <= 1 << 16 {
            self.section(Kind::NarrowIndices, counted_halves(count, corners))
        } else {
            self.section(Kind::WideIndices, corners.collect())
        }
    }

    /// The same with spheres.
    #[must_use]
    pub fn spheres(self, spheres: &[Sphere]) -> Self {
        let words = bytemuck::cast_slice(spheres).to_vec();
        self.section(Kind::Spheres, words)
    }

    /// The same with a structure; a list needs no section.
    #[must_use]
    pub fn structure<'a>(self, structure: impl Into<Structure<'a>>) -> Self {
        let structure = structure.into();
        match structure.kind() {
            Some(kind) => self.section(kind, structure.as_words().to_vec()),
            None => self,
        }
    }

    /// The same with instances, as [`Instances::place`](crate::Instances::place) numbered them.
    #[must_use]
    pub fn instances(self, placed: &[Instance]) -> Self {
        self.section(Kind::Instances, bytemuck::cast_slice(placed).to_vec())
    }

    /// The same with a whole asset as a part: a scene to be placed.
    #[must_use]
    pub fn part(self, asset: Self) -> Self {
        self.section(Kind::Part, asset.finish())
    }

    /// The same with the numbers that reordered primitives had: at each place stands the primitive `numbers[place]`.
    #[must_use]
    pub fn numbers(self, numbers: &[u32]) -> Self {
        let mut places = vec![0; numbers.len()];
        for (place, &number) in numbers.iter().enumerate() {
            if let Some(slot) = places.get_mut(number as usize) {
                *slot = place as u32;
            }
        }
        let count = numbers.len() as u32;
        let mut words = vec![count];
        for list in [numbers, &places] {
            if count > 1 << 16 {
                words.extend(list);
            } else {
                words.extend(halves(list));
            }
        }
        self.section(Kind::Numbers, words)
    }

    /// The same with materials.
    #[must_use]
    pub fn materials(self, palette: &[Material], numbers: Numbers<'_>) -> Self {
        let baker = self.section(Kind::Materials, bytemuck::cast_slice(palette).to_vec());
        let halves = match numbers {
            Numbers::First => return baker,
            Numbers::Narrow(numbers) => {
                counted_halves(numbers.len() as u32, numbers.iter().map(|&number| u32::from(number)))
            }
            Numbers::Wide(numbers) => {
                counted_halves(numbers.len() as u32, numbers.iter().map(|&number| u32::from(number)))
            }
        };
        baker.section(Kind::MaterialNumbers, halves)
    }

    /// The same with the textures of materials, by their numbers; what several have in common is stored once.
    #[must_use]
    pub fn textures(self, textures: &[Option<Texture<'_>>]) -> Self {
        self.section(Kind::Textures, Textures::packed(textures))
    }

    fn section(mut self, kind: Kind, words: Vec<u32>) -> Self {
        self.sections.push((kind, words));
        self
    }

    /// The asset in words; in a file they are little-endian.
    ///
    /// # Panics
    ///
    /// If it has 2^32 words or more.
    #[must_use]
    #[expect(clippy::expect_used, reason = "said above; what bakes is a host")]
    pub fn finish(self) -> Vec<u32> {
        let number = |n: usize| u32::try_from(n).expect("an asset has less than 2^32 words");
        let mut words = vec![MAGIC, BYTE_ORDER, VERSION, 0, 0, number(self.sections.len())];
        let mut end = HEADER_WORDS + self.sections.len() * ENTRY_WORDS;
        for (kind, contents) in &self.sections {
            let offset = end.next_multiple_of(ALIGNMENT);
            words.extend([kind.code(), kind.version(), number(offset), number(contents.len())]);
            end = offset + contents.len();
        }
        for (_, contents) in &self.sections {
            words.resize(words.len().next_multiple_of(ALIGNMENT), 0);
            words.extend(contents);
        }
        words[3] = number(words.len());
        words[CHECKSUM_WORD] = checksum(&words);
        words
    }
}

/// A count and as many numbers of 16 bits, two per word.
fn counted_halves(count: u32, numbers: impl Iterator<Item = u32>) -> Vec<u32> {
    let numbers: Vec<u32> = numbers.collect();
    core::iter::once(count).chain(halves(&numbers)).collect()
}

/// How many there are, the first vertex of each 64, and their corners in bytes.
fn counted_meshlets<const CORNERS: usize>(meshlets: Meshlets<'_, CORNERS>) -> Vec<u32> {
    let words = core::iter::once(meshlets.len() as u32).chain(meshlets.first().iter().copied());
    words.chain(bytes(meshlets.corners().as_flattened())).collect()
}

/// Bytes, four per word.
fn bytes(bytes: &[u8]) -> impl Iterator<Item = u32> {
    bytes.chunks(4).map(|four| four.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte)))
}

/// Numbers of 16 bits, two per word.
fn halves(numbers: &[u32]) -> impl Iterator<Item = u32> {
    numbers.chunks(2).map(|pair| pair[0] | pair.get(1).map_or(0, |high| high << 16))
}
