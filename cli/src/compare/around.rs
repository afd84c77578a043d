//! What is put around a structure for the comparison.

use hitscan::{
    Mesh,
    accel::{Bounded, Mailbox},
    bake,
    geometry::{Bounding, BoundingVolume},
    primitives::{Order, Renumbering, Reordered},
    render::Caster,
};

use super::Made;
use crate::{
    failure::Failure,
    scene::{Built, Named, Preset, broken, unwrapped},
    trial::{self, Counts},
};

/// A structure whose walks remember what they tested last.
pub struct Remembering(Built);

impl Remembering {
    pub fn make<'m>(mesh: &Mesh<'m>, named: &'static Named, preset: Preset) -> Result<Box<dyn Made + 'm>, Failure> {
        Ok(Box::new(Self(Built::named(mesh, named, preset, None)?)))
    }
}

impl Made for Remembering {
    fn bytes(&self) -> usize {
        self.0.bytes()
    }

    fn scene<'a>(&'a self, mesh: Mesh<'a>, counts: Option<&'a Counts>) -> Result<Box<dyn Caster + 'a>, Failure> {
        unwrapped!(self.0.structure(&mesh)?, structure => trial::scene(Mailbox(structure), mesh, counts))
    }
}

/// A structure that only rays through a volume around the whole mesh are cast at.
pub struct Behind {
    volume: BoundingVolume,
    built: Built,
}

impl Behind {
    pub fn make<'m>(
        kind: Bounding,
        mesh: &Mesh<'m>,
        named: &'static Named,
        preset: Preset,
    ) -> Result<Box<dyn Made + 'm>, Failure> {
        // Vertices that no triangle uses would only make it larger.
        let corners = (0..mesh.indices().len() as u32).flat_map(|index| {
            let triangle = mesh.triangle(index);
            [triangle.a, triangle.b, triangle.c]
        });
        let nothing = || Failure::new("there is nothing to put a volume around", "name a mesh with triangles");
        let volume = kind.around(corners).ok_or_else(nothing)?;
        Ok(Box::new(Self { volume, built: Built::named(mesh, named, preset, None)? }))
    }
}

impl Made for Behind {
    fn bytes(&self) -> usize {
        self.built.bytes() + size_of_val(&self.volume)
    }

    fn scene<'a>(&'a self, mesh: Mesh<'a>, counts: Option<&'a Counts>) -> Result<Box<dyn Caster + 'a>, Failure> {
        unwrapped!(self.built.structure(&mesh)?, structure => {
            trial::scene(Bounded::new(self.volume, structure), mesh, counts)
        })
    }
}

/// A hierarchy over triangles in the order of its leaves: it holds no numbers, and the mesh is another.
pub struct Ordered {
    built: Built,
    corners: Vec<[u32; 3]>,
    numbers: Vec<u32>,
    places: Vec<u32>,
}

impl Ordered {
    pub fn make<'m>(mesh: &Mesh<'m>, named: &'static Named, preset: Preset) -> Result<Box<dyn Made + 'm>, Failure> {
        let (built, numbers) = Built::named(mesh, named, preset, None)?.ordered(mesh)?;
        let mut places = vec![0; numbers.len()];
        (0..).zip(&numbers).for_each(|(place, &number)| places[number as usize] = place);
        Ok(Box::new(Self { built, corners: bake::reorder(mesh, &numbers), numbers, places }))
    }
}

impl Made for Ordered {
    /// Without the numbers that the comparison needs to recognise the triangles.
    fn bytes(&self) -> usize {
        self.built.bytes()
    }

    fn scene<'a>(&'a self, mesh: Mesh<'a>, counts: Option<&'a Counts>) -> Result<Box<dyn Caster + 'a>, Failure> {
        let ordered = Mesh::new(mesh.vertices(), &self.corners[..]).map_err(broken)?;
        let renumbering = Renumbering::new(Order::Wide(&self.numbers), Order::Wide(&self.places)).map_err(broken)?;
        let primitives = Reordered::new(ordered, renumbering).map_err(broken)?;
        unwrapped!(self.built.structure(&primitives)?, structure => trial::scene(structure, primitives, counts))
    }
}
