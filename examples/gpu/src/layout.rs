use std::fmt;

use bytemuck::{Pod, Zeroable};
use hitscan::{
    Instance,
    asset::{Asset, AssetError, Kind},
};

/// A part of the scene as `shaders/scene.wgsl` sees it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Part {
    structure: u32,
    header: u32,
    list: u32,
    vertices: u32,
    indices: u32,
    form: u32,
    root: u32,
    primitives: u32,
}

impl Part {
    /// Bytes that a node and a primitive take to read.
    pub(crate) fn traffic(&self) -> (f64, f64) {
        let node = if self.structure == 2 { 32.0 } else { 8.0 };
        let reference = [0.0, 2.0, 4.0, 0.0][self.form as usize & 3];
        let vertices = if self.form & 4 == 0 { 36.0 } else { 18.0 };
        let corners = match self.form & 24 {
            0 => 12.0,
            8 => 6.0,
            _ => 7.0,
        };
        (node, reference + vertices + corners)
    }
}

/// Where in an asset's words everything is; the words themselves stay as they are.
#[derive(Clone, Debug)]
pub struct Layout {
    pub(crate) parts: Vec<Part>,
    /// A bit per kind of structure.
    pub(crate) structures: u32,
    /// Whether the first part places the others.
    pub(crate) placed: bool,
}

/// Why an asset is not for these shaders.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfit {
    /// Its structure is of a kind that they do not know.
    Structure,
    /// Its triangles stand in pairs.
    Pairs,
    /// A section is missing.
    Asset(AssetError),
    /// It is farther out than they calculate.
    Range {
        /// The largest coordinate.
        coordinate: f32,
    },
    /// An instance is larger or smaller than they calculate.
    Instance {
        /// Its number.
        instance: usize,
    },
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Structure => {
                write!(f, "its structure is none of kdtree, bvh and dual-split: bake it with --structure bvh")
            }
            Self::Pairs => write!(f, "its triangles stand in pairs: bake it without --quads"),
            Self::Asset(error) => error.fmt(f),
            Self::Range { coordinate } => {
                write!(f, "it reaches out to {coordinate:e}, farther than 2^30: scale it down")
            }
            Self::Instance { instance } => {
                write!(f, "instance {instance} is scaled by less than 2^-40 or more than 2^40: scale it otherwise")
            }
        }
    }
}

impl std::error::Error for Unfit {}

impl From<AssetError> for Unfit {
    fn from(error: AssetError) -> Self {
        Self::Asset(error)
    }
}

/// 2^30, the largest coordinate.
const FARTHEST: f32 = 1_073_741_824.0;

/// What an instance's inverse is made of, if not 0: 2^-40 to 2^40.
const SCALES: std::ops::RangeInclusive<f32> = 9.094_947e-13..=1.099_511_6e12;

/// Words before the nodes, and before the box in them, of all three structures.
const HEADER_WORDS: u32 = 10;
const BOX_WORD: usize = 4;

impl Layout {
    /// Of an asset that was checked: its structures, parts and instances.
    ///
    /// # Errors
    ///
    /// [`Unfit`].
    pub fn of(asset: &Asset<'_>) -> Result<Self, Unfit> {
        let mut layout = Self { parts: Vec::new(), structures: 0, placed: false };
        let whole = asset.as_words();
        layout.placed = asset.sections().any(|section| section.kind == Kind::Instances);
        let first = layout.structure(whole, asset)?;
        if !layout.placed {
            layout.parts.push(triangles(first, whole, asset)?);
            return Ok(layout);
        }
        let placed: &[Instance] = bytemuck::cast_slice(asset.section(Kind::Instances)?);
        for (instance, words) in bytemuck::cast_slice::<_, [f32; 24]>(placed).iter().enumerate() {
            if !words[9..18].iter().all(|&x| x == 0.0 || SCALES.contains(&x.abs())) {
                return Err(Unfit::Instance { instance });
            }
        }
        layout.parts.push(Part { vertices: place(whole, asset.section(Kind::Instances)?), ..first });
        for part in asset.parts() {
            let part = part?;
            let structure = layout.structure(whole, &part)?;
            layout.parts.push(triangles(structure, whole, &part)?);
        }
        Ok(layout)
    }

    /// The structure of an asset in the words of the whole.
    fn structure(&mut self, whole: &[u32], asset: &Asset<'_>) -> Result<Part, Unfit> {
        const KINDS: [Kind; 3] = [Kind::KdTree, Kind::DualSplit, Kind::Bvh];
        let found =
            asset.sections().find_map(|section| Some((KINDS.iter().position(|kind| *kind == section.kind)?, section)));
        let (kind, section) = found.ok_or(Unfit::Structure)?;
        let words = section.words;
        let number = |index: usize| words.get(index).copied().unwrap_or(0);
        let reach = (BOX_WORD..BOX_WORD + 6).map(|index| f32::from_bits(number(index)).abs());
        // An empty scene's box is infinite.
        let coordinate = reach.filter(|x| x.is_finite()).fold(0.0, f32::max);
        if coordinate > FARTHEST {
            return Err(Unfit::Range { coordinate });
        }
        let (nodes, primitives, listed) = match KINDS[kind] {
            Kind::KdTree => (number(0) * 2, number(2), true),
            Kind::DualSplit => (number(0), number(1), number(3) == 1),
            _ => (number(0) * 8, number(1), words.len() > (HEADER_WORDS + number(0) * 8) as usize),
        };
        let narrow = primitives <= 1 << 16;
        self.structures |= 1 << kind;
        let header = place(whole, words);
        let form = if !listed {
            0
        } else if narrow {
            1
        } else {
            2
        };
        // Of a BVH the fourth word is the root.
        Ok(Part {
            structure: kind as u32,
            header,
            list: header + HEADER_WORDS + nodes,
            form,
            root: number(3),
            primitives,
            ..Part::default()
        })
    }
}

/// The number of the word of `whole` at which a section begins.
pub(crate) fn place(whole: &[u32], section: &[u32]) -> u32 {
    ((section.as_ptr().addr() - whole.as_ptr().addr()) / 4) as u32
}

/// A part with its triangles.
fn triangles(part: Part, whole: &[u32], asset: &Asset<'_>) -> Result<Part, Unfit> {
    let section = |kind| asset.section(kind).map(|words| place(whole, words));
    // Counts, and the frame of a lattice, stand before what they are of.
    let (vertices, lattice) = match section(Kind::LatticeVertices) {
        Ok(start) => (start + 7, 4),
        Err(_) => (section(Kind::Vertices)?, 0),
    };
    if section(Kind::Quads).is_ok() {
        return Err(Unfit::Pairs);
    }
    let (indices, width) = match (section(Kind::Meshlets), section(Kind::NarrowIndices)) {
        (Ok(start), _) => (start + 1, 16),
        (_, Ok(start)) => (start + 1, 8),
        _ => (section(Kind::WideIndices)?, 0),
    };
    Ok(Part { vertices, indices, form: part.form | lattice | width, ..part })
}
