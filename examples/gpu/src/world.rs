use anyhow::{Result, bail};
use hitscan::{
    Hit, Instance, Instances, LatticeMesh, Mesh, Primitives, Ray, Scene,
    accel::Structure,
    asset::{Asset, Kind},
    geometry::{Aabb, PreparedRay},
    primitives::{Renumbering, Reordered, Span, Surface},
    render::Caster,
};

use crate::{
    alone::{Alone, PlacedAlone},
    layout::Unfit,
};

/// The triangles of an asset.
#[derive(Clone, Copy, Debug)]
pub enum Triangles<'a> {
    /// Between vertices of `f32`.
    Plain(Mesh<'a>),
    /// Between vertices on a lattice.
    OnLattice(LatticeMesh<'a>),
}

impl<'a> Triangles<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self> {
        let on_lattice = asset.sections().any(|section| section.kind == Kind::LatticeVertices);
        Ok(if on_lattice { Self::OnLattice(asset.read()?) } else { Self::Plain(asset.read()?) })
    }
}

impl Primitives for Triangles<'_> {
    fn len(&self) -> u32 {
        match self {
            Self::Plain(mesh) => mesh.len(),
            Self::OnLattice(mesh) => mesh.len(),
        }
    }

    fn bounds(&self, index: u32) -> Aabb {
        match self {
            Self::Plain(mesh) => mesh.bounds(index),
            Self::OnLattice(mesh) => mesh.bounds(index),
        }
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        match self {
            Self::Plain(mesh) => mesh.intersect(index, ray, span),
            Self::OnLattice(mesh) => mesh.intersect(index, ray, span),
        }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        match self {
            Self::Plain(mesh) => mesh.surface(ray, hit),
            Self::OnLattice(mesh) => mesh.surface(ray, hit),
        }
    }

    fn is_certified(&self, _index: u32) -> bool {
        true
    }
}

/// A structure over triangles.
type Part<'a> = Scene<Structure<'a>, Triangles<'a>>;

/// The parts that an asset places, checked; none if it is triangles itself.
#[derive(Clone, Debug)]
pub struct Parts<'a>(Vec<Part<'a>>);

impl<'a> Parts<'a> {
    /// Those of `asset`.
    ///
    /// # Errors
    ///
    /// What is wrong with the first that is not right.
    pub fn read(asset: &Asset<'a>) -> Result<Self> {
        let part = |asset: Asset<'a>| Ok(Scene::new(asset.read()?, Triangles::read(&asset)?)?);
        Ok(Self(asset.parts().map(|asset| part(asset?)).collect::<Result<_>>()?))
    }
}

/// An asset as the library sees it.
#[derive(Clone, Copy, Debug)]
pub enum World<'p, 'a> {
    /// Triangles.
    Flat(Part<'a>),
    /// Triangles that had other numbers.
    Numbered(Scene<Structure<'a>, Reordered<'a, Triangles<'a>>>),
    /// Placed parts.
    Placed(Scene<Structure<'a>, Instances<'p, Structure<'a>, Triangles<'a>>>),
}

impl<'p, 'a> World<'p, 'a> {
    /// The scene in `asset`, whose parts were read before; everything is checked.
    ///
    /// # Errors
    ///
    /// What is wrong with it, or that there are spheres or pairs of triangles in it.
    pub fn read(asset: &Asset<'a>, parts: &'p Parts<'a>) -> Result<Self>
    where
        'a: 'p,
    {
        let has = |kind| asset.sections().any(|section| section.kind == kind);
        if has(Kind::Spheres) {
            bail!("there are spheres in it: bake triangles only");
        }
        if has(Kind::Quads) {
            return Err(Unfit::Pairs.into());
        }
        let structure: Structure<'a> = asset.read()?;
        if has(Kind::Instances) {
            let placed: &'a [Instance] = asset.read()?;
            return Ok(Self::Placed(Scene::new(structure, Instances::new(&parts.0, placed)?)?));
        }
        let triangles = Triangles::read(asset)?;
        if has(Kind::Numbers) {
            let numbers: Renumbering<'a> = asset.read()?;
            return Ok(Self::Numbered(Scene::new(structure, Reordered::new(triangles, numbers)?)?));
        }
        Ok(Self::Flat(Scene::new(structure, triangles)?))
    }

    /// The hit with the primitive that a shader found, which counts places in the asset.
    #[must_use]
    pub fn hit_with(&self, ray: &Ray, place: u32) -> Option<Hit> {
        match self {
            Self::Flat(scene) => Alone::new(scene.primitives(), place).hit(ray),
            Self::Numbered(scene) => Alone::new(scene.primitives(), place).hit(ray),
            Self::Placed(scene) => PlacedAlone::new(scene.primitives(), place)?.hit(ray),
        }
    }

    /// The scene itself, for queries and pictures.
    #[must_use]
    pub fn as_caster(&self) -> &(dyn Caster + Sync) {
        match self {
            Self::Flat(scene) => scene,
            Self::Numbered(scene) => scene,
            Self::Placed(scene) => scene,
        }
    }
}
