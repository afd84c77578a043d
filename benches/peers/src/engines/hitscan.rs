use std::{cell::RefCell, rc::Rc, time::Duration};

use clap::ValueEnum;
use hitscan::{
    Accelerator, Arena, Error, Hit, KdTree, List, Mesh, Ray, Scene,
    accel::{Plan, Structure},
    bvh, kdtree,
    wide::{self, WideBvh},
};

use super::{Contender, Engine, Wanted, shadow};
use crate::clock::time_build;

/// hitscan's structures as they are compared.
const PLANS: [(&str, Plan); 5] = [
    ("hitscan kD-tree fast", Plan::KdTree(kdtree::Options::fast())),
    ("hitscan kD-tree balanced", Plan::KdTree(kdtree::Options::balanced())),
    ("hitscan kD-tree small", Plan::KdTree(kdtree::Options::small())),
    ("hitscan BVH fast", Plan::Bvh(bvh::Options::fast())),
    ("hitscan BVH balanced", Plan::Bvh(bvh::Options::balanced())),
];

/// And its structure for hosts.
const WIDE: [(&str, wide::Options); 3] = [
    ("hitscan wide best", wide::Options::best()),
    ("hitscan wide balanced", wide::Options::balanced()),
    ("hitscan wide fast", wide::Options::fast()),
];

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
    /// What hitscan calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Small => "small",
            Self::Balanced => "balanced",
            Self::Fast => "fast",
        }
    }

    /// The CPU time of building the kD-tree.
    pub fn build_time(self, mesh: &Mesh<'_>) -> Result<Duration, Error> {
        let options = match self {
            Self::Small => kdtree::Options::small(),
            Self::Balanced => kdtree::Options::balanced(),
            Self::Fast => kdtree::Options::fast(),
        };
        let mut memory = vec![0; KdTree::words(mesh.indices().len(), &options)];
        let (built, time) = time_build(|| KdTree::build(mesh, &mut Arena::new(&mut memory), &options).map(drop));
        built?;
        Ok(time)
    }
}

/// Room for the structures that are wanted.
#[derive(Debug)]
pub struct Memory(Vec<(&'static str, Plan, Vec<u32>)>);

impl Memory {
    /// As much as building them over so many triangles can take.
    pub fn new(triangles: usize, wanted: &Wanted) -> Self {
        let wanted = PLANS.into_iter().filter(|(name, _)| wanted.has(name));
        Self(wanted.map(|(name, plan)| (name, plan, vec![0; plan.words(triangles)])).collect())
    }
}

/// Builds the structures that are wanted; those in `memory` read the mesh's `bytes`, too.
pub fn hitscan<'a>(
    mesh: &'a Mesh<'a>,
    bytes: usize,
    memory: &'a mut Memory,
    wanted: &Wanted,
) -> Result<Vec<Contender<'a>>, Error> {
    let small = memory.0.iter_mut().map(|(name, plan, words)| contender(name, plan, mesh, bytes, words));
    let mut contenders = small.collect::<Result<Vec<_>, _>>()?;
    for (name, options) in WIDE {
        let batch = format!("{name}, batch");
        if !wanted.has(name) && !wanted.has(&batch) {
            continue;
        }
        let (tree, build) = time_build(|| WideBvh::new(mesh, &options));
        let tree = Rc::new(tree?);
        let single = Box::new(Wide(Rc::clone(&tree)));
        contenders.push(Contender { name: name.to_owned(), role: None, build, engine: single });
        let engine = Box::new(Batch { tree, hits: RefCell::default(), any: RefCell::default() });
        contenders.push(Contender { name: batch, role: None, build, engine });
    }
    Ok(contenders)
}

fn contender<'a>(
    name: &str,
    plan: &Plan,
    mesh: &'a Mesh<'a>,
    bytes: usize,
    words: &'a mut [u32],
) -> Result<Contender<'a>, Error> {
    let (length, build) =
        time_build(|| Structure::build(mesh, &mut Arena::new(words), plan).map(|structure| structure.as_words().len()));
    let words = &words[..length?];
    let structure = match plan.kind() {
        Some(kind) => Structure::open(kind, words)?,
        None => Structure::List(List::new(mesh)?),
    };
    let bytes = bytes + size_of_val(words);
    let engine: Box<dyn Engine + 'a> = match structure {
        Structure::KdTree(tree) => Box::new(Built { scene: Scene::new(tree, mesh)?, bytes }),
        Structure::Bvh(tree) => Box::new(Built { scene: Scene::new(tree, mesh)?, bytes }),
        any => Box::new(Built { scene: Scene::new(any, mesh)?, bytes }),
    };
    Ok(Contender { name: name.to_owned(), role: None, build, engine })
}

/// A structure over the mesh.
struct Built<'a, A> {
    scene: Scene<A, &'a Mesh<'a>>,
    bytes: usize,
}

impl<A: Accelerator> Engine for Built<'_, A> {
    fn bytes(&self) -> usize {
        self.bytes
    }

    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|ray| parameter(self.scene.closest_hit(ray))));
    }

    fn any(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|ray| shadow(self.scene.any_hit(ray))));
    }
}

/// The structure for hosts, one ray at a time; it keeps the triangles it reads.
struct Wide<'a>(Rc<WideBvh<&'a Mesh<'a>>>);

impl Engine for Wide<'_> {
    fn bytes(&self) -> usize {
        self.0.bytes()
    }

    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|ray| parameter(self.0.closest_hit(ray))));
    }

    fn any(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|ray| shadow(self.0.any_hit(ray))));
    }
}

/// The same, all rays at once; the answers go where those of the last set were.
struct Batch<'a> {
    tree: Rc<WideBvh<&'a Mesh<'a>>>,
    hits: RefCell<Vec<Option<Hit>>>,
    any: RefCell<Vec<bool>>,
}

impl Engine for Batch<'_> {
    fn bytes(&self) -> usize {
        self.tree.bytes()
    }

    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>) {
        let mut hits = self.hits.borrow_mut();
        hits.resize(rays.len(), None);
        self.tree.closest_hits(rays, &mut hits);
        t.extend(hits.iter().map(|&hit| parameter(hit)));
    }

    fn any(&self, rays: &[Ray], t: &mut Vec<f32>) {
        let mut hits = self.any.borrow_mut();
        hits.resize(rays.len(), false);
        self.tree.any_hits(rays, &mut hits);
        t.extend(hits.iter().map(|&hit| shadow(hit)));
    }
}

/// The `t` of a hit, infinite for a miss.
fn parameter(hit: Option<Hit>) -> f32 {
    hit.map_or(f32::INFINITY, |hit| hit.t)
}
