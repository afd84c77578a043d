use std::time::Duration;

use clap::ValueEnum;
use hitscan::{Arena, Error, KdTree, Mesh, Ray, Scene, kdtree::Options};

use super::{Engine, shadow};
use crate::clock::time;

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

    /// Words of memory for [`Kd::build`].
    pub fn words(self, mesh: &Mesh<'_>) -> usize {
        KdTree::words(mesh.indices().len(), &self.options())
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
    preset: Preset,
    scene: Scene<KdTree<'a>, &'a Mesh<'a>>,
}

impl<'a> Kd<'a> {
    /// Builds it in `memory`, twice: the first time pays for fresh pages.
    pub fn build(preset: Preset, mesh: &'a Mesh<'a>, memory: &'a mut [u32]) -> Result<(Self, Duration), Error> {
        let options = preset.options();
        let (_, first) = time(|| KdTree::build(mesh, &mut Arena::new(memory), &options).map(drop));
        let (tree, second) = time(|| KdTree::build(mesh, &mut Arena::new(memory), &options));
        Ok((Self { preset, scene: Scene::new(tree?, mesh)? }, first.min(second)))
    }

    /// The tree and the mesh.
    pub const fn scene(&self) -> &Scene<KdTree<'a>, &'a Mesh<'a>> {
        &self.scene
    }
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
