//! A scene over any structure that was not left out: which one is asked once per query, not at every node.

use engine::{
    Arena, Scene,
    accel::Plan,
    asset::{Asset, Kind},
    error::Error,
};

use crate::{status::Status, triangles::Triangles};

macro_rules! structures {
    ($($feature:literal $name:ident,)*) => {
        /// A scene, checked in full.
        #[derive(Clone, Copy)]
        pub enum View {
            /// Each ray tests each triangle.
            #[cfg(feature = "list")]
            List(Scene<engine::List, Triangles>),
            $(#[cfg(feature = $feature)] $name(Scene<engine::$name<'static>, Triangles>),)*
        }

        impl View {
            /// The scene in an asset: its first structure, over its triangles.
            pub fn stored(asset: &Asset<'static>) -> Result<Self, Status> {
                let triangles = Triangles::stored(asset)?;
                for section in asset.sections() {
                    match section.kind {
                        $(Kind::$name => {
                            #[cfg(feature = $feature)]
                            return Ok(Self::$name(Scene::new(asset.read()?, triangles).map_err(Error::from)?));
                            #[cfg(not(feature = $feature))]
                            return Err(Status::LeftOut);
                        })*
                        _ => {}
                    }
                }
                #[cfg(feature = "list")]
                return Self::listed(triangles);
                #[cfg(not(feature = "list"))]
                Err(Status::LeftOut)
            }

            /// Builds the structure over `mesh`.
            #[allow(unused_variables, reason = "a list needs no arena")]
            pub fn build(mesh: Triangles, arena: &mut Arena<'static>, plan: &Plan) -> Result<Self, Status> {
                match plan {
                    #[cfg(feature = "list")]
                    Plan::List => Self::listed(mesh),
                    $(#[cfg(feature = $feature)]
                    Plan::$name(options) => {
                        let structure = engine::$name::build(&mesh, arena, options)?;
                        Ok(Self::$name(Scene::new(structure, mesh).map_err(Error::from)?))
                    })*
                    _ => Err(Status::LeftOut),
                }
            }
        }
    };
}

structures! {
    "grid" Grid,
    "octree" Octree,
    "kdtree" KdTree,
    "compact-kdtree" CompactKdTree,
    "bvh" Bvh,
    "dual-split" DualSplit,
}

#[cfg(feature = "list")]
impl View {
    fn listed(mesh: Triangles) -> Result<Self, Status> {
        let list = engine::List::new(&mesh)?;
        Ok(Self::List(Scene::new(list, mesh).map_err(Error::from)?))
    }
}

/// What a scene answers, whatever its structure.
macro_rules! ask {
    ($view:expr, $scene:ident => $answer:expr) => {
        match $view {
            #[cfg(feature = "list")]
            View::List($scene) => $answer,
            #[cfg(feature = "grid")]
            View::Grid($scene) => $answer,
            #[cfg(feature = "octree")]
            View::Octree($scene) => $answer,
            #[cfg(feature = "kdtree")]
            View::KdTree($scene) => $answer,
            #[cfg(feature = "compact-kdtree")]
            View::CompactKdTree($scene) => $answer,
            #[cfg(feature = "bvh")]
            View::Bvh($scene) => $answer,
            #[cfg(feature = "dual-split")]
            View::DualSplit($scene) => $answer,
        }
    };
}
pub(crate) use ask;
