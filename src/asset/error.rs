use core::fmt;

use super::Kind;

/// Why bytes are not an asset, or not the one wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AssetError {
    /// The first byte is not at a multiple of four: use [`include_asset!`](crate::include_asset) or a slice of words.
    Misaligned,
    /// The length is not that of an asset.
    Length {
        /// Bytes expected.
        expected: usize,
        /// Bytes given.
        found: usize,
    },
    /// The first word is not an asset's.
    Magic {
        /// The word.
        found: u32,
    },
    /// The words are in the byte order of another kind of machine, or this machine is not little-endian.
    ByteOrder,
    /// A format version, or that of a section, which this library does not read.
    Version {
        /// The section, or none for the format.
        kind: Option<Kind>,
        /// The version found.
        found: u32,
        /// The version that this library reads.
        supported: u32,
    },
    /// The checksum is wrong: the bytes were damaged.
    Checksum {
        /// As it stands in the header.
        expected: u32,
        /// As the words have it.
        found: u32,
    },
    /// An entry of the table is wrong.
    Table {
        /// The entry.
        entry: u32,
    },
    /// A section is not there.
    Missing {
        /// What it would hold.
        kind: Kind,
    },
    /// A structure of whatever kind is not there.
    NoStructure,
    /// The length of a section does not fit what it holds.
    Shape {
        /// The section.
        kind: Kind,
        /// Its length.
        words: usize,
    },
}

impl fmt::Display for AssetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Misaligned => write!(f, "the asset does not lie at a multiple of 4 bytes"),
            Self::Length { expected, found } => write!(f, "the asset has {found} bytes, {expected} were expected"),
            Self::Magic { found } => write!(f, "not an asset: it begins with {found:#010x}"),
            Self::ByteOrder => write!(f, "the asset's byte order is not this machine's"),
            Self::Version { kind: None, found, supported } => {
                write!(f, "the asset has version {found}, this library reads {supported}")
            }
            Self::Version { kind: Some(kind), found, supported } => {
                write!(f, "the section of {kind} has version {found}, this library reads {supported}")
            }
            Self::Checksum { expected, found } => {
                write!(f, "the asset is damaged: its checksum is {found:#010x}, not {expected:#010x}")
            }
            Self::Table { entry } => write!(f, "entry {entry} of the asset's table is wrong"),
            Self::Missing { kind } => write!(f, "the asset has no section of {kind}"),
            Self::NoStructure => write!(f, "the asset has no section that holds a structure"),
            Self::Shape { kind, words } => write!(f, "a section of {kind} cannot have {words} words"),
        }
    }
}

impl core::error::Error for AssetError {}
