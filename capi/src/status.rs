//! What a function came to.

use core::ffi::CStr;

use engine::{Error, asset::AssetError, error::BuildError, primitives::MeshError};

/// What a function came to: negative where something is wrong.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// The query found something.
    Hit = 1,
    /// The query found nothing.
    Miss = 2,
    /// A pointer is null.
    Null = -1,
    /// A pointer is not aligned for what it points to; assets must lie at multiples of 4 bytes.
    Misaligned = -2,
    /// A length is out of range, or not the one that the asset's header says.
    Length = -3,
    /// The scene is not open.
    Closed = -4,
    /// No such structure or preset.
    Choice = -5,
    /// What is needed was left out when this library was built: see its features.
    LeftOut = -6,
    /// Not an asset.
    Magic = -7,
    /// The byte order is another machine's.
    ByteOrder = -8,
    /// The asset was made for another version of this library.
    Version = -9,
    /// The asset is damaged: its checksum is wrong.
    Checksum = -10,
    /// The asset lacks a section that a scene needs, such as triangles.
    Missing = -11,
    /// The asset contradicts itself.
    Malformed = -12,
    /// A triangle names a vertex that does not exist.
    Index = -13,
    /// A coordinate is not finite or beyond 2^126.
    Vertex = -14,
    /// More triangles than the structure can name.
    TooMany = -15,
    /// The arena is too small.
    Full = -16,
}

impl Status {
    /// All of them.
    const ALL: [Self; 19] = [
        Self::Ok,
        Self::Hit,
        Self::Miss,
        Self::Null,
        Self::Misaligned,
        Self::Length,
        Self::Closed,
        Self::Choice,
        Self::LeftOut,
        Self::Magic,
        Self::ByteOrder,
        Self::Version,
        Self::Checksum,
        Self::Missing,
        Self::Malformed,
        Self::Index,
        Self::Vertex,
        Self::TooMany,
        Self::Full,
    ];

    /// The text for a number from C.
    pub fn text(number: i32) -> &'static CStr {
        Self::ALL.into_iter().find(|status| *status as i32 == number).map_or(c"no such status", Self::describe)
    }

    const fn describe(self) -> &'static CStr {
        match self {
            Self::Ok => c"done",
            Self::Hit => c"the query found something",
            Self::Miss => c"the query found nothing",
            Self::Null => c"a pointer is null",
            Self::Misaligned => c"a pointer is not aligned; assets must lie at multiples of 4 bytes",
            Self::Length => c"a length is out of range, or not the one in the asset's header",
            Self::Closed => c"the scene is not open",
            Self::Choice => c"no such structure or preset",
            Self::LeftOut => c"the structure was left out when the library was built",
            Self::Magic => c"not an asset",
            Self::ByteOrder => c"the byte order is another machine's",
            Self::Version => c"the asset was made for another version of the library",
            Self::Checksum => c"the asset is damaged: its checksum is wrong",
            Self::Missing => c"the asset lacks a section that a scene needs",
            Self::Malformed => c"the asset contradicts itself",
            Self::Index => c"a triangle names a vertex that does not exist",
            Self::Vertex => c"a coordinate is not finite or beyond 2^126",
            Self::TooMany => c"more triangles than the structure can name",
            Self::Full => c"the arena is too small",
        }
    }
}

impl From<Error> for Status {
    fn from(error: Error) -> Self {
        match error {
            Error::Mesh(error) => error.into(),
            Error::Asset(error) => error.into(),
            Error::Build(error) => error.into(),
            // What else can be wrong is within the sections of an asset.
            _ => Self::Malformed,
        }
    }
}

impl From<MeshError> for Status {
    fn from(error: MeshError) -> Self {
        match error {
            MeshError::Index { .. } => Self::Index,
            MeshError::Vertex { .. } | MeshError::Frame => Self::Vertex,
            MeshError::TooMany => Self::TooMany,
            MeshError::Masks { .. } | MeshError::Meshlets { .. } | MeshError::Quads => Self::Length,
        }
    }
}

impl From<AssetError> for Status {
    fn from(error: AssetError) -> Self {
        match error {
            AssetError::Misaligned => Self::Misaligned,
            AssetError::Length { .. } => Self::Length,
            AssetError::Magic { .. } => Self::Magic,
            AssetError::ByteOrder => Self::ByteOrder,
            AssetError::Version { .. } => Self::Version,
            AssetError::Checksum { .. } => Self::Checksum,
            AssetError::Missing { .. } | AssetError::NoStructure => Self::Missing,
            AssetError::Table { .. } | AssetError::Shape { .. } => Self::Malformed,
        }
    }
}

impl From<BuildError> for Status {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Full(_) | BuildError::Budget { .. } => Self::Full,
            BuildError::Bounds { .. } => Self::Vertex,
            BuildError::TooMany { .. } => Self::TooMany,
        }
    }
}
