use core::fmt;

/// What a section holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Kind {
    /// Positions, three `f32` each.
    Vertices,
    /// How many vertices, the box that their lattice is over, then three `u16` each.
    LatticeVertices,
    /// How many triangles, a first vertex for each 64, then three `u8` each.
    Meshlets,
    /// How many quads, a first vertex for each 64, then four `u8` each.
    Quads,
    /// How many triangles, then three `u16` each.
    NarrowIndices,
    /// Triangles, three `u32` each.
    WideIndices,
    /// How many vertices, then a normal of 16 bits each.
    Normals,
    /// How many vertices, the least texture coordinates, the steps between them, then two numbers of 16 bits each.
    TexCoords,
    /// How many triangles, the place of each, then facets: nine `f32` and a number each.
    Soup,
    /// Spheres: centre and radius, four `f32` each.
    Spheres,
    /// A kD-tree, as [`KdTree::as_words`](crate::KdTree::as_words) gives it.
    KdTree,
    /// A kD-tree with nodes of 4 bytes.
    CompactKdTree,
    /// A uniform grid.
    Grid,
    /// An octree.
    Octree,
    /// A bounding volume hierarchy.
    Bvh,
    /// A dual-split tree.
    DualSplit,
    /// Numbers of primitives that stand in another order.
    Numbers,
    /// Placed scenes.
    Instances,
    /// An asset within the asset: a scene to be placed.
    Part,
    /// Materials: eight `f32` each.
    Materials,
    /// How many primitives, then a material number of 16 bits each.
    MaterialNumbers,
    /// How many materials, where each one's texture begins, then sizes, palettes and texels.
    Textures,
    /// Something that this version does not know.
    Unknown(u32),
}

impl Kind {
    const KNOWN: [Self; 22] = [
        Self::Vertices,
        Self::LatticeVertices,
        Self::Meshlets,
        Self::Quads,
        Self::NarrowIndices,
        Self::WideIndices,
        Self::Normals,
        Self::TexCoords,
        Self::Soup,
        Self::Spheres,
        Self::KdTree,
        Self::CompactKdTree,
        Self::Grid,
        Self::Octree,
        Self::Bvh,
        Self::DualSplit,
        Self::Numbers,
        Self::Instances,
        Self::Part,
        Self::Materials,
        Self::MaterialNumbers,
        Self::Textures,
    ];

    /// Four letters in the order of the bytes.
    pub(crate) const fn code(self) -> u32 {
        match self {
            Self::Vertices => u32::from_le_bytes(*b"vert"),
            Self::LatticeVertices => u32::from_le_bytes(*b"lvtx"),
            Self::Meshlets => u32::from_le_bytes(*b"idx1"),
            Self::Quads => u32::from_le_bytes(*b"quad"),
            Self::NarrowIndices => u32::from_le_bytes(*b"idx2"),
            Self::WideIndices => u32::from_le_bytes(*b"idx4"),
            Self::Normals => u32::from_le_bytes(*b"nrml"),
            Self::TexCoords => u32::from_le_bytes(*b"txuv"),
            Self::Soup => u32::from_le_bytes(*b"soup"),
            Self::Spheres => u32::from_le_bytes(*b"sphr"),
            Self::KdTree => u32::from_le_bytes(*b"kdtr"),
            Self::CompactKdTree => u32::from_le_bytes(*b"kdt4"),
            Self::Grid => u32::from_le_bytes(*b"grid"),
            Self::Octree => u32::from_le_bytes(*b"octr"),
            Self::Bvh => u32::from_le_bytes(*b"bvh2"),
            Self::DualSplit => u32::from_le_bytes(*b"dust"),
            Self::Numbers => u32::from_le_bytes(*b"nmbr"),
            Self::Instances => u32::from_le_bytes(*b"inst"),
            Self::Part => u32::from_le_bytes(*b"part"),
            Self::Materials => u32::from_le_bytes(*b"matl"),
            Self::MaterialNumbers => u32::from_le_bytes(*b"matn"),
            Self::Textures => u32::from_le_bytes(*b"txtr"),
            Self::Unknown(code) => code,
        }
    }

    /// Their codes, looked through where they lie: comparisons with constants, one after the other, are more code.
    #[expect(clippy::indexing_slicing, reason = "of constants: it would not compile")]
    const CODES: [u32; Self::KNOWN.len()] = {
        let mut codes = [0; Self::KNOWN.len()];
        let mut place = 0;
        while place < codes.len() {
            codes[place] = Self::KNOWN[place].code();
            place += 1;
        }
        codes
    };

    pub(crate) fn from_code(code: u32) -> Self {
        let place = Self::CODES.iter().position(|&known| known == code);
        place.and_then(|place| Self::KNOWN.get(place).copied()).unwrap_or(Self::Unknown(code))
    }

    /// The version that this library writes, and the only one that it reads.
    pub(crate) const fn version(self) -> u32 {
        match self {
            // The first had a number beside each triangle or reference.
            Self::Soup | Self::Grid => 2,
            _ => 1,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertices => f.write_str("vertices"),
            Self::LatticeVertices => f.write_str("lattice vertices"),
            Self::Meshlets => f.write_str("meshlets"),
            Self::Quads => f.write_str("quads"),
            Self::NarrowIndices => f.write_str("16-bit indices"),
            Self::WideIndices => f.write_str("32-bit indices"),
            Self::Normals => f.write_str("normals"),
            Self::TexCoords => f.write_str("texture coordinates"),
            Self::Soup => f.write_str("triangle soup"),
            Self::Spheres => f.write_str("spheres"),
            Self::KdTree => f.write_str("kD-tree"),
            Self::CompactKdTree => f.write_str("compact kD-tree"),
            Self::Grid => f.write_str("grid"),
            Self::Octree => f.write_str("octree"),
            Self::Bvh => f.write_str("BVH"),
            Self::DualSplit => f.write_str("dual-split tree"),
            Self::Numbers => f.write_str("numbers"),
            Self::Instances => f.write_str("instances"),
            Self::Part => f.write_str("part"),
            Self::Materials => f.write_str("materials"),
            Self::MaterialNumbers => f.write_str("material numbers"),
            Self::Textures => f.write_str("textures"),
            Self::Unknown(code) => write!(f, "unknown ({code:#010x})"),
        }
    }
}
