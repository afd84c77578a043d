use hitscan::{Mesh, geometry::Bounding, render::Caster};

use super::around::{Behind, Ordered, Remembering};
use crate::{
    failure::Failure,
    scene::{Built, Named, Preset, Wide, unwrapped},
    trial::{self, Counts},
};

/// A line of the comparison: a name and a way to make a scene of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// What it is called.
    pub name: &'static str,
    /// The structure that it is, or that something is put around.
    pub named: &'static Named,
    /// Builds it.
    make: Make,
}

/// What builds a row.
type Make = for<'m> fn(&Mesh<'m>, &'static Named, Preset) -> Result<Box<dyn Made + 'm>, Failure>;

/// What a row has built.
pub trait Made {
    /// Its bytes, those of the mesh not counted.
    fn bytes(&self) -> usize;

    /// Its bytes once it is baked.
    fn baked_bytes(&self, _mesh: &Mesh<'_>) -> Result<usize, Failure> {
        Ok(self.bytes())
    }

    /// The seconds that building it took, if those of this thread do not tell.
    fn seconds(&self) -> Option<f64> {
        None
    }

    /// Whether what rays take can be counted.
    fn is_counted(&self) -> bool {
        true
    }

    /// The scene of the mesh that it was built over, ready for rays; what they take is added to `counts`, if there are any.
    fn scene<'a>(&'a self, mesh: Mesh<'a>, counts: Option<&'a Counts>) -> Result<Box<dyn Caster + 'a>, Failure>;
}

/// A structure as it is.
impl Made for Built {
    fn bytes(&self) -> usize {
        self.bytes()
    }

    fn baked_bytes(&self, mesh: &Mesh<'_>) -> Result<usize, Failure> {
        Self::baked_bytes(self, mesh)
    }

    fn scene<'a>(&'a self, mesh: Mesh<'a>, counts: Option<&'a Counts>) -> Result<Box<dyn Caster + 'a>, Failure> {
        unwrapped!(self.structure(&mesh)?, structure => trial::scene(structure, mesh, counts))
    }
}

/// The one for hosts.
impl Made for Wide<'_> {
    fn bytes(&self) -> usize {
        self.bytes()
    }

    fn seconds(&self) -> Option<f64> {
        Some(self.seconds)
    }

    fn is_counted(&self) -> bool {
        false
    }

    fn scene<'a>(&'a self, mesh: Mesh<'a>, _counts: Option<&'a Counts>) -> Result<Box<dyn Caster + 'a>, Failure> {
        Ok(Box::new(self.scene(mesh)?))
    }
}

impl Row {
    /// What is put around structures: the name of the row, that of the structure, and how.
    const AROUND: &[(&str, &str, Make)] = &[
        ("list behind a sphere", "list", |mesh, named, preset| {
            Behind::make(Bounding::WelzlSphere, mesh, named, preset)
        }),
        ("list behind an AABB", "list", |mesh, named, preset| Behind::make(Bounding::Aabb, mesh, named, preset)),
        ("list behind an OBB", "list", |mesh, named, preset| Behind::make(Bounding::DitoObb, mesh, named, preset)),
        ("grid, mailbox", "grid", Remembering::make),
        ("octree, mailbox", "octree", Remembering::make),
        ("kdtree, mailbox", "kdtree", Remembering::make),
        ("bvh in order", "bvh", Ordered::make),
        ("bvh-ploc in order", "bvh-ploc", Ordered::make),
        ("dual-split in order", "dual-split", Ordered::make),
    ];

    /// All rows: each structure, and behind it what is put around it.
    pub fn all() -> Vec<Self> {
        let plain = |named: &'static Named| Self {
            name: named.name,
            named,
            make: |mesh, named, preset| match named.is_wide() {
                true => Ok(Box::new(Wide::alone(*mesh, preset)?)),
                false => Ok(Box::new(Built::named(mesh, named, preset, None)?)),
            },
        };
        let around = |named: &'static Named| {
            let rows = Self::AROUND.iter().filter(move |(_, inner, _)| *inner == named.name);
            rows.map(move |&(name, _, make)| Self { name, named, make })
        };
        Named::ALL.iter().flat_map(|named| std::iter::once(plain(named)).chain(around(named))).collect()
    }

    /// The structures themselves: what is put around them does not grow otherwise.
    pub fn plain() -> Vec<Self> {
        Self::all().into_iter().filter(|row| row.name == row.named.name).collect()
    }

    /// Whether it is a structure with nothing around it that `auto` may choose.
    pub fn is_candidate(&self) -> bool {
        self.named.is_candidate && self.name == self.named.name
    }

    /// Builds it over a mesh.
    pub fn make<'m>(&self, mesh: &Mesh<'m>, preset: Preset) -> Result<Box<dyn Made + 'm>, Failure> {
        (self.make)(mesh, self.named, preset)
    }
}
