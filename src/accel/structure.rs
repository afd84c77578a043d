//! All structures as one type, for tools that let people choose.

use super::{
    Accelerator, Bvh, Cell, CompactKdTree, DualSplit, Entries, Entry, Grid, Hierarchy, Inside, KdTree, Leaf, List,
    Octree, Step, Traversal, bvh, dualsplit, grid, kdtree, octree,
};
use crate::{
    arena::Arena,
    asset::{Asset, AssetError, Kind, Stored},
    error::{BuildError, Error},
    geometry::{Aabb, Bundle, PreparedRay},
    primitives::Primitives,
};

macro_rules! structures {
    ($($(#[$doc:meta])* $name:ident($options:ty),)*) => {
        /// Any structure of this crate: it links them all, and asks at every step which one it is.
        ///
        /// ```
        /// use hitscan::{Arena, Mesh, Ray, Scene, accel::{Plan, Structure}, glam::Vec3, kdtree};
        /// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
        /// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
        /// let mut memory = [0; 1000];
        /// for plan in [Plan::List, Plan::KdTree(kdtree::Options::small())] {
        ///     let mut arena = Arena::new(&mut memory);
        ///     let scene = Scene::new(Structure::build(&mesh, &mut arena, &plan)?, &mesh)?;
        ///     assert!(scene.any_hit(&Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z)));
        /// }
        /// # Ok::<(), hitscan::Error>(())
        /// ```
        #[derive(Clone, Copy, Debug)]
        #[non_exhaustive]
        pub enum Structure<'a> {
            /// None: every ray tests every primitive.
            List(List),
            $($(#[$doc])* $name($name<'a>),)*
        }

        /// Which structure to build, and how.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[non_exhaustive]
        pub enum Plan {
            /// None.
            List,
            $($(#[$doc])* $name($options),)*
        }

        impl Plan {
            /// The kind of section that holds the structure; a list needs none.
            #[must_use]
            pub const fn kind(&self) -> Option<Kind> {
                match self {
                    Self::List => None,
                    $(Self::$name(_) => Some(Kind::$name),)*
                }
            }

            /// Every structure with its default options, the list first.
            pub fn all() -> impl Iterator<Item = Self> {
                [Self::List, $(Self::$name(<$options>::default()),)*].into_iter()
            }

            /// Words of arena that always suffice.
            #[must_use]
            pub const fn words(&self, primitives: usize) -> usize {
                match self {
                    Self::List => 0,
                    $(Self::$name(options) => $name::words(primitives, options),)*
                }
            }
        }

        impl<'a> Structure<'a> {
            /// Builds what `plan` says over `primitives`.
            ///
            /// # Errors
            ///
            /// Those of the structure's own `build`.
            pub fn build<P: Primitives + ?Sized>(
                primitives: &P,
                arena: &mut Arena<'a>,
                plan: &Plan,
            ) -> Result<Self, BuildError> {
                match plan {
                    Plan::List => List::new(primitives).map(Self::List),
                    $(Plan::$name(options) => $name::build(primitives, arena, options).map(Self::$name),)*
                }
            }

            /// The structure of this kind in `words`, checked in full.
            ///
            /// # Errors
            ///
            /// What is wrong with the words; [`AssetError::NoStructure`] if that kind of section holds none.
            pub fn open(kind: Kind, words: &'a [u32]) -> Result<Self, Error> {
                match kind {
                    $(Kind::$name => Ok(Self::$name($name::open(words)?)),)*
                    _ => Err(AssetError::NoStructure.into()),
                }
            }

            /// The kind of section that holds it; a list needs none.
            #[must_use]
            pub const fn kind(&self) -> Option<Kind> {
                match self {
                    Self::List(_) => None,
                    $(Self::$name(_) => Some(Kind::$name),)*
                }
            }

            /// Its words; a list has none.
            #[must_use]
            pub const fn as_words(&self) -> &'a [u32] {
                match self {
                    Self::List(_) => &[],
                    $(Self::$name(structure) => structure.as_words(),)*
                }
            }
        }

        impl<'a> Accelerator for Structure<'a> {
            type Traversal = AnyTraversal<'a>;

            fn primitives(&self) -> u32 {
                match self {
                    Self::List(list) => list.primitives(),
                    $(Self::$name(structure) => structure.primitives(),)*
                }
            }

            fn bounds(&self) -> Aabb {
                match self {
                    Self::List(list) => list.bounds(),
                    $(Self::$name(structure) => structure.bounds(),)*
                }
            }

            fn traverse(&self, ray: &PreparedRay) -> AnyTraversal<'a> {
                match self {
                    Self::List(list) => AnyTraversal::List(list.traverse(ray)),
                    $(Self::$name(structure) => AnyTraversal::$name(structure.traverse(ray)),)*
                }
            }

            fn enter(&self, bundle: &Bundle) -> Entries {
                match self {
                    Self::List(list) => list.enter(bundle),
                    $(Self::$name(structure) => structure.enter(bundle),)*
                }
            }

            fn sweep(&self, bundle: &Bundle, mut visit: impl FnMut(AnyLeaf<'a>) -> f32) -> bool {
                match self {
                    Self::List(list) => list.sweep(bundle, |range| visit(AnyLeaf::All(range.into()))),
                    $(Self::$name(structure) => structure.sweep(bundle, |leaf| visit(leaf.into())),)*
                }
            }

            fn traverse_from(&self, entry: &Entry, ray: &PreparedRay) -> AnyTraversal<'a> {
                match self {
                    Self::List(list) => AnyTraversal::List(list.traverse_from(entry, ray)),
                    $(Self::$name(structure) => AnyTraversal::$name(structure.traverse_from(entry, ray)),)*
                }
            }
        }

        impl<'a> Hierarchy for Structure<'a> {
            type Node = AnyNode<'a>;
            type Leaf = AnyLeaf<'a>;

            fn root(&self) -> Option<Cell<AnyNode<'a>>> {
                match self {
                    Self::List(list) => list.root().map(|cell| cell.with(AnyNode::List(cell.node))),
                    $(Self::$name(structure) => structure.root().map(|cell| cell.with(AnyNode::$name(cell.node))),)*
                }
            }

            fn open(&self, cell: &Cell<AnyNode<'a>>) -> Inside<AnyNode<'a>, AnyLeaf<'a>> {
                match (self, cell.node) {
                    (Self::List(list), AnyNode::List(node)) => match list.open(&cell.with(node)) {
                        Inside::Leaf(range) => Inside::Leaf(AnyLeaf::All(range.into())),
                        Inside::Cells(cells) => {
                            Inside::Cells(cells.map(|cell| cell.map(|cell| cell.with(AnyNode::List(cell.node)))))
                        }
                    },
                    $((Self::$name(structure), AnyNode::$name(node)) => match structure.open(&cell.with(node)) {
                        Inside::Leaf(leaf) => Inside::Leaf(leaf.into()),
                        Inside::Cells(cells) => {
                            Inside::Cells(cells.map(|cell| cell.map(|cell| cell.with(AnyNode::$name(cell.node)))))
                        }
                    },)*
                    // A cell of another structure holds nothing of this one.
                    _ => Inside::Cells([None; 2]),
                }
            }
        }

        /// The walk over a [`Structure`].
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        #[allow(missing_docs, clippy::large_enum_variant, reason = "one per structure; each is on the stack only once")]
        pub enum AnyTraversal<'a> {
            List(<List as Accelerator>::Traversal),
            $($name(<$name<'a> as Accelerator>::Traversal),)*
        }

        impl<'a> Traversal for AnyTraversal<'a> {
            type Leaf = AnyLeaf<'a>;

            fn next_leaf(&mut self, ray: &PreparedRay, t_max: f32) -> Option<AnyLeaf<'a>> {
                match self {
                    Self::List(walk) => walk.next_leaf(ray, t_max).map(|range| AnyLeaf::All(range.into())),
                    $(Self::$name(walk) => walk.next_leaf(ray, t_max).map(AnyLeaf::from),)*
                }
            }

            fn step(&mut self, ray: &PreparedRay, t_max: f32, budget: &mut u32) -> Step<AnyLeaf<'a>> {
                match self {
                    Self::List(walk) => walk.step(ray, t_max, budget).map(|range| AnyLeaf::All(range.into())),
                    $(Self::$name(walk) => walk.step(ray, t_max, budget).map(AnyLeaf::from),)*
                }
            }
        }

        /// A node of a [`Structure`].
        #[derive(Clone, Copy, Debug)]
        #[non_exhaustive]
        #[allow(missing_docs, reason = "one per structure")]
        pub enum AnyNode<'a> {
            List(<List as Hierarchy>::Node),
            $($name(<$name<'a> as Hierarchy>::Node),)*
        }

        $(impl<'a> From<$name<'a>> for Structure<'a> {
            fn from(structure: $name<'a>) -> Self {
                Self::$name(structure)
            }
        })*

        /// The first section that holds a structure.
        impl<'a> Stored<'a> for Structure<'a> {
            fn read(asset: &Asset<'a>) -> Result<Self, Error> {
                const KINDS: &[Kind] = &[$(Kind::$name),*];
                match asset.sections().find(|section| KINDS.contains(&section.kind)) {
                    Some(section) => Self::open(section.kind, section.words),
                    None => Err(AssetError::NoStructure.into()),
                }
            }
        }
    };
}

structures! {
    /// A uniform grid.
    Grid(grid::Options),
    /// An octree.
    Octree(octree::Options),
    /// A kD-tree.
    KdTree(kdtree::Options),
    /// A kD-tree with nodes of 4 bytes.
    CompactKdTree(kdtree::Options),
    /// A bounding volume hierarchy.
    Bvh(bvh::Options),
    /// A dual-split tree.
    DualSplit(dualsplit::Options),
}

/// What the walk over a [`Structure`] gives.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "one per kind of leaf")]
pub enum AnyLeaf<'a> {
    All(Leaf<'a>),
    Met(grid::Met<'a>),
}

impl<'a> From<Leaf<'a>> for AnyLeaf<'a> {
    fn from(leaf: Leaf<'a>) -> Self {
        Self::All(leaf)
    }
}

impl<'a> From<grid::Met<'a>> for AnyLeaf<'a> {
    fn from(leaf: grid::Met<'a>) -> Self {
        Self::Met(leaf)
    }
}

impl Iterator for AnyLeaf<'_> {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        match self {
            Self::All(leaf) => leaf.next(),
            Self::Met(leaf) => leaf.next(),
        }
    }
}

impl From<List> for Structure<'_> {
    fn from(list: List) -> Self {
        Self::List(list)
    }
}
