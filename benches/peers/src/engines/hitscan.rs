use clap::ValueEnum;
use hitscan::{Arena, KdTree, Mesh, Ray, Scene, error::BuildError, kdtree::Options};

use super::{Engine, shadow};

/// How hitscan's kD-tree is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Preset {
    /// The fewest bytes.
    Small,
    /// The default.
    Balanced,
    /// The least time per ray.
    Fast,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Small, Self::Balanced, Self::Fast];

    /// What hitscan calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Small => "small",
            Self::Balanced => "balanced",
            Self::Fast => "fast",
        }
    }

    /// Words that suffice to build over `mesh`.
    pub fn words(self, mesh: &Mesh<'_>) -> usize {
        KdTree::words(mesh.indices().len(), &self.options())
    }

    /// The tree over `mesh`, in `memory`.
    pub fn build<'m>(self, mesh: &Mesh<'_>, memory: &'m mut [u32]) -> Result<KdTree<'m>, BuildError> {
        KdTree::build(mesh, &mut Arena::new(memory), &self.options())
    }

    const fn options(self) -> Options {
        match self {
            Self::Small => Options::small(),
            Self::Balanced => Options::balanced(),
            Self::Fast => Options::fast(),
        }
    }
}

/// hitscan's kD-tree.
#[derive(Clone, Copy, Debug)]
pub struct Kd<'a> {
    /// How it was built.
    pub preset: Preset,
    /// The tree and the mesh.
    pub scene: Scene<KdTree<'a>, &'a Mesh<'a>>,
}

impl Engine for Kd<'_> {
    fn name(&self) -> String {
        format!("hitscan {}", self.preset.name())
    }

    fn bytes(&self) -> usize {
        size_of_val(self.scene.accelerator().as_words())
    }

    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|ray| self.scene.closest_hit(ray).map_or(f32::INFINITY, |hit| hit.t)));
    }

    fn any(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|ray| shadow(self.scene.any_hit(ray))));
    }
}
