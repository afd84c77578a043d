//! Assets: meshes, structures and materials in one block of words, used where it lies.
//!
//! A file, a `static` in flash, a GPU buffer and a message hold the same little-endian words:
//!
//! | word | what |
//! |---|---|
//! | 0 | `HITS` |
//! | 1 | byte order, `0x01020304` |
//! | 2 | version of this format |
//! | 3 | words in all |
//! | 4 | checksum of all other words |
//! | 5 | sections |
//! | 6 … | per section: kind, version, offset and length in words |
//! | … | the sections, each at a multiple of four words, in the order of the table, zeros between |
//!
//! [`Asset::open`] checks header, table and checksum; [`Asset::read`] checks a section in full, once. After that nothing
//! can fail. Bytes behind the last section are an error. Assets are made by `bake` (feature `alloc`), the same bytes on
//! every host.

mod aligned;
mod error;
mod kind;

pub use aligned::Aligned;
pub use error::AssetError;
pub use kind::Kind;

use crate::error::Error;

/// The first word, `HITS` in bytes.
pub(crate) const MAGIC: u32 = u32::from_le_bytes(*b"HITS");

/// The second word, as a machine of the same byte order reads it.
pub(crate) const BYTE_ORDER: u32 = 0x0102_0304;

/// The version of header and table.
pub(crate) const VERSION: u32 = 1;

/// Words before the table.
pub(crate) const HEADER_WORDS: usize = 6;

/// Words per entry of the table.
pub(crate) const ENTRY_WORDS: usize = 4;

/// The word that holds the checksum.
pub(crate) const CHECKSUM_WORD: usize = 4;

/// Sections begin at multiples of this many words.
pub(crate) const ALIGNMENT: usize = 4;

/// A checked header and table over borrowed words.
///
/// ```
/// # #[cfg(feature = "alloc")] {
/// use hitscan::{KdTree, Mesh, Ray, accel::Plan, asset::Asset, bake::{self, Baker}, glam::Vec3, kdtree::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let tree = bake::build(&mesh, &Plan::KdTree(Options::small()))?;
/// let words = Baker::new().mesh(&mesh).structure(KdTree::open(&tree)?).finish();
///
/// let scene = Asset::from_words(&words)?.scene::<KdTree, Mesh>()?;
/// assert!(scene.any_hit(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z)));
/// # }
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Asset<'a> {
    words: &'a [u32],
    sections: u32,
}

/// A part of an asset.
#[derive(Clone, Copy, Debug)]
pub struct Section<'a> {
    /// What it holds.
    pub kind: Kind,
    /// The version of its layout.
    pub version: u32,
    /// Its contents.
    pub words: &'a [u32],
}

/// Views that an asset can hold.
pub trait Stored<'a>: Sized {
    /// The view of the asset's sections of this kind, checked in full.
    ///
    /// # Errors
    ///
    /// What is wrong with them, or that there are none.
    fn read(asset: &Asset<'a>) -> Result<Self, Error>;
}

impl<'a> Asset<'a> {
    /// The asset in `bytes`, which begin at a multiple of four and end with its last section.
    ///
    /// # Errors
    ///
    /// [`AssetError`]; no bytes make it panic.
    pub fn open(bytes: &'a [u8]) -> Result<Self, AssetError> {
        let (found, least) = (bytes.len(), HEADER_WORDS * 4);
        if found < least {
            return Err(AssetError::Length { expected: least, found });
        }
        let (whole, rest) = bytes.split_at(found - found % 4);
        // The length fits, so only the address can be wrong.
        let asset = Self::from_words(bytemuck::try_cast_slice(whole).map_err(|_| AssetError::Misaligned)?);
        match asset {
            Ok(_) if !rest.is_empty() => Err(AssetError::Length { expected: whole.len(), found }),
            Err(AssetError::Length { expected, .. }) => Err(AssetError::Length { expected, found }),
            asset => asset,
        }
    }

    /// The asset in `words`.
    ///
    /// # Errors
    ///
    /// [`AssetError`]; no words make it panic.
    pub fn from_words(words: &'a [u32]) -> Result<Self, AssetError> {
        let found = words.len() * 4;
        let &[magic, byte_order, version, length, expected, sections] =
            words.first_chunk::<HEADER_WORDS>().ok_or(AssetError::Length { expected: HEADER_WORDS * 4, found })?;
        if magic != MAGIC {
            let swapped = magic == MAGIC.swap_bytes();
            return Err(if swapped { AssetError::ByteOrder } else { AssetError::Magic { found: magic } });
        }
        if byte_order != BYTE_ORDER || cfg!(target_endian = "big") {
            return Err(AssetError::ByteOrder);
        }
        if version != VERSION {
            return Err(AssetError::Version { kind: None, found: version, supported: VERSION });
        }
        if length as usize != words.len() {
            return Err(AssetError::Length { expected: (length as usize).saturating_mul(4), found });
        }
        let sum = checksum(words);
        if sum != expected {
            return Err(AssetError::Checksum { expected, found: sum });
        }
        let asset = Self { words, sections };
        asset.check_table()?;
        Ok(asset)
    }

    /// Entries in order, next to one another, known ones in a version that is read, up to the last word.
    fn check_table(&self) -> Result<(), AssetError> {
        let table = (self.sections as usize).checked_mul(ENTRY_WORDS).and_then(|words| words.checked_add(HEADER_WORDS));
        let mut end = table.filter(|&end| end <= self.words.len()).ok_or(AssetError::Table { entry: 0 })?;
        for entry in 0..self.sections {
            let error = AssetError::Table { entry };
            let [kind, version, offset, length] = self.entry(entry).ok_or(error)?;
            let kind = Kind::from_code(kind);
            if !matches!(kind, Kind::Unknown(_)) && version != kind.version() {
                return Err(AssetError::Version { kind: Some(kind), found: version, supported: kind.version() });
            }
            if offset as usize != end.next_multiple_of(ALIGNMENT) {
                return Err(error);
            }
            end = (offset as usize).checked_add(length as usize).filter(|&end| end <= self.words.len()).ok_or(error)?;
        }
        if end == self.words.len() { Ok(()) } else { Err(AssetError::Table { entry: self.sections }) }
    }

    fn entry(&self, entry: u32) -> Option<[u32; ENTRY_WORDS]> {
        let at = HEADER_WORDS + entry as usize * ENTRY_WORDS;
        self.words.get(at..)?.first_chunk().copied()
    }

    /// The words of the section that an entry names.
    fn words_of(&self, entry: u32) -> Option<&'a [u32]> {
        let [.., offset, length] = self.entry(entry)?;
        self.words.get(offset as usize..)?.get(..length as usize)
    }

    /// All of its words.
    #[must_use]
    pub const fn as_words(&self) -> &'a [u32] {
        self.words
    }

    /// The sections in order.
    pub fn sections(&self) -> impl Iterator<Item = Section<'a>> + use<'a> {
        let asset = *self;
        (0..self.sections).filter_map(move |entry| {
            let [kind, version, ..] = asset.entry(entry)?;
            Some(Section { kind: Kind::from_code(kind), version, words: asset.words_of(entry)? })
        })
    }

    /// The words of the first section of a kind.
    ///
    /// # Errors
    ///
    /// [`AssetError::Missing`] if there is none.
    pub fn section(&self, kind: Kind) -> Result<&'a [u32], AssetError> {
        let mut entries = 0..self.sections;
        let found = entries.find(|&entry| self.entry(entry).is_some_and(|[code, ..]| code == kind.code()));
        found.and_then(|entry| self.words_of(entry)).ok_or(AssetError::Missing { kind })
    }

    /// The assets that are parts of it, in order: scenes to be placed.
    ///
    /// ```
    /// use hitscan::{Bvh, Error, Instance, Instances, KdTree, Mesh, Ray, Scene};
    /// use hitscan::{accel::Plan, asset::Asset, bake::{self, Baker}, bvh, geometry::Transform, glam::{Mat3, Vec3}, kdtree};
    /// // On a host, or by `hitscan bake world.toml`: one triangle, placed twice.
    /// let mesh = Mesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0_u16, 1, 2]])?;
    /// let words = bake::build(&mesh, &Plan::KdTree(kdtree::Options::balanced()))?;
    /// let scenes = [Scene::new(KdTree::open(&words)?, mesh)?];
    /// let there = Transform::new(Mat3::IDENTITY, Vec3::X * 5.0).unwrap();
    /// let mut placed = [Transform::IDENTITY, there].map(|transform| Instance::new(0, transform));
    /// let world = Instances::place(&scenes, &mut placed)?;
    /// let above = bake::build(&world, &Plan::Bvh(bvh::Options::balanced()))?;
    /// let part = Baker::new().mesh(&mesh).structure(KdTree::open(&words)?);
    /// let baked = Baker::new().part(part).structure(Bvh::open(&above)?).instances(&placed).finish();
    ///
    /// // Wherever the asset lies; where there is no heap, the scenes go into an array or a `heapless::Vec`.
    /// let asset = Asset::from_words(&baked)?;
    /// let scenes = asset.parts().map(|part| part?.scene::<KdTree, Mesh>()).collect::<Result<Vec<_>, Error>>()?;
    /// let world = Instances::new(&scenes, asset.read::<&[Instance]>()?)?;
    /// let scene = Scene::new(asset.read::<Bvh>()?, &world)?;
    /// assert!(scene.any_hit(&Ray::new(Vec3::new(5.2, 0.2, -1.0), Vec3::Z)));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn parts(&self) -> impl Iterator<Item = Result<Self, AssetError>> + use<'a> {
        self.sections().filter(|section| section.kind == Kind::Part).map(|section| Self::from_words(section.words))
    }

    /// A view of what it holds, checked in full, in O(n).
    ///
    /// # Errors
    ///
    /// What is wrong with the sections, or that there are none.
    pub fn read<T: Stored<'a>>(&self) -> Result<T, Error> {
        T::read(self)
    }
}

/// A sum over all words but the checksum itself, which no change of a single word leaves as it is: each step is a
/// bijection. After Fowler, Noll and Vo (FNV-1a), by words.
pub(crate) fn checksum(words: &[u32]) -> u32 {
    let summed = words.iter().enumerate().filter(|(index, _)| *index != CHECKSUM_WORD);
    summed.fold(0x811c_9dc5, |sum, (_, word)| (sum ^ word).wrapping_mul(0x0100_0193).rotate_left(13))
}
