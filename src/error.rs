//! One enum for `?` in programs that do several things.

use core::fmt;

use crate::{
    accel::Malformed,
    arena::Full,
    asset::AssetError,
    geometry::Singular,
    instances::InstanceError,
    lattice_scene::LatticeError,
    primitives::{MeshError, OrderError, SphereError},
    render::TextureError,
    scene::Mismatch,
};

/// Why a structure could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BuildError {
    /// The arena is too small.
    Full(Full),
    /// The bounds of a primitive are empty, not finite or beyond 2^126.
    Bounds {
        /// The first such primitive.
        primitive: u32,
    },
    /// More primitives, nodes or references than the structure's numbers can name.
    TooMany {
        /// How many can be.
        limit: u32,
    },
    /// The byte budget is below what a single leaf takes.
    Budget {
        /// Bytes without which it does not go.
        at_least: usize,
        /// Bytes allowed.
        allowed: usize,
    },
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full(full) => full.fmt(f),
            Self::Bounds { primitive } => {
                write!(f, "the bounds of primitive {primitive} are empty, not finite or beyond 2^126")
            }
            Self::TooMany { limit } => write!(f, "the structure can name at most {limit} of them"),
            Self::Budget { at_least, allowed } => {
                write!(f, "{allowed} bytes are allowed, at least {at_least} are needed")
            }
        }
    }
}

impl core::error::Error for BuildError {}

impl From<Full> for BuildError {
    fn from(full: Full) -> Self {
        Self::Full(full)
    }
}

macro_rules! any_of {
    ($($(#[$doc:meta])* $variant:ident($error:ty),)*) => {
        /// Any error of this crate.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[non_exhaustive]
        pub enum Error {
            $($(#[$doc])* $variant($error),)*
        }

        impl fmt::Display for Error {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self {
                    $(Self::$variant(error) => error.fmt(f),)*
                }
            }
        }

        impl core::error::Error for Error {}

        $(impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::$variant(error)
            }
        })*
    };
}

any_of! {
    /// Triangles.
    Mesh(MeshError),
    /// Spheres.
    Sphere(SphereError),
    /// The order of primitives.
    Order(OrderError),
    /// A structure.
    Build(BuildError),
    /// A structure and primitives that do not belong together.
    Mismatch(Mismatch),
    /// An asset.
    Asset(AssetError),
    /// The words of a structure.
    Malformed(Malformed),
    /// A structure and a mesh that do not stand on one lattice.
    Lattice(LatticeError),
    /// Placed scenes.
    Instance(InstanceError),
    /// A transform.
    Transform(Singular),
    /// A texture.
    Texture(TextureError),
}
