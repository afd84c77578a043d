use std::path::Path;

use hitscan::{
    Instance, Primitives,
    asset::Asset,
    bake::Baker,
    geometry::Aabb,
    glam::Vec3,
    primitives::{Mapped, QuadMesh, Smooth, TexCoords},
    render::{Materials, Textures},
};

use super::{
    Choice, Palette, Queries, Source, StructureArgs, View, Wide, broken, normals_by_place, placed::with_world,
    source::pictures,
};
use crate::{
    failure::Failure,
    stage::{Up, glazed, plate},
    units::{count, seconds, things},
};

/// A source under its structure, ready for rays.
#[derive(Clone, Copy)]
#[allow(missing_debug_implementations, reason = "a scene of any kind shows nothing of itself")]
pub struct Subject<'a> {
    /// What rays are cast at.
    pub scene: &'a dyn Queries,
    /// How many numbers its hits can have.
    pub primitives: u32,
    pub(super) body: Body<'a>,
}

#[derive(Clone, Copy)]
pub(super) enum Body<'a> {
    Mesh { view: &'a View<'a>, structure: &'a str, time: &'a str },
    World { placed: &'a [Instance], boxes: &'a [Aabb], own: u64, bytes: usize, seconds: f64 },
}

impl Source {
    /// Opens it, under the structure that is asked for, for as long as `visit` takes.
    pub fn with_subject<R>(
        &self,
        path: &Path,
        structure: &StructureArgs,
        smooth: bool,
        visit: impl FnOnce(&Subject<'_>) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        if let Some(asset) = self.world() {
            return with_world(path, &asset, structure, smooth, visit);
        }
        let mut view = self.view(path)?;
        // As they would be baked, so that the picture of a mesh is that of its asset.
        let skin = match self {
            Self::Model(geometry) => geometry.skin.as_ref().map(|skin| skin.bake(Baker::new()).finish()),
            Self::Asset { .. } => None,
        };
        if let Some(words) = &skin {
            let skin = Asset::from_words(words).map_err(hitscan::Error::from);
            view.textures = skin.and_then(|skin| pictures(&skin)).map_err(broken)?;
        }
        // A soup knows nothing of neighbours.
        let instead = (smooth && view.soup.is_some()).then_some(Choice::Auto);
        let choice = structure.structure.or(instead);
        let normals = if smooth { normals_by_place(&view.mesh) } else { Vec::new() };
        let shaded = match view.normals {
            Some(normals) if !smooth => Smooth::packed(view.mesh, normals),
            _ => Smooth::new(view.mesh, &normals),
        };
        let coordinates = view.textures.map_or(TexCoords::new(&[]), |(_, coordinates)| coordinates);
        let mapped = Mapped::new(shaded, &view.mesh, coordinates);
        let renumbered = view.renumbered(mapped)?;
        let show = |scene: &dyn Queries, structure: &str, time: &str| {
            let body = Body::Mesh { view: &view, structure, time };
            visit(&Subject { scene, primitives: view.mesh.len(), body })
        };
        if matches!(choice, Some(Choice::Named(named)) if named.is_wide()) {
            if renumbered.is_some() {
                let what = format!("{}: its triangles stand in another order than their numbers", path.display());
                return Err(Failure::new(
                    what,
                    "name the mesh it was made from, or choose another structure than wide",
                ));
            }
            let wide = Wide::new(view.mesh, structure.preset)?;
            return show(&wide.scene(&mapped)?, &wide.describe(), &wide.time());
        }
        let built = view.build(choice, structure.preset)?;
        let pairs = (view.in_pairs && choice.is_none()).then(|| QuadMesh::new(shaded).map_err(broken)).transpose()?;
        let pairs = pairs.map(|pairs| Mapped::new(pairs, &view.mesh, coordinates));
        let scene = match (&renumbered, &view.soup) {
            _ if let Some(pairs) = &pairs => built.scene(pairs)?,
            (_, Some(soup)) if choice.is_none() => built.scene(soup)?,
            (Some(triangles), _) => built.scene(triangles)?,
            _ => built.scene(&mapped)?,
        };
        let time = format!("{} {}", built.name, built.time());
        show(&*scene, &built.describe(view.mesh.len() as usize), &time)
    }
}

impl Subject<'_> {
    /// Points, finite ones, all of which should be in a picture.
    pub fn points(&self) -> Box<dyn Iterator<Item = Vec3> + '_> {
        match &self.body {
            Body::Mesh { view, .. } => {
                let bounds = self.scene.bounds();
                Box::new(view.mesh.vertices().iter().copied().filter(move |point| bounds.contains(*point)))
            }
            Body::World { placed, boxes, .. } => Box::new(placed.iter().flat_map(|instance| {
                let bounds = boxes.get(instance.scene() as usize).copied().unwrap_or(Aabb::EMPTY);
                let corner = move |n: u32| {
                    let pick = |axis: usize| if n >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
                    Vec3::new(pick(0), pick(1), pick(2))
                };
                (0..8).map(move |n| instance.transform().point(corner(n)))
            })),
        }
    }

    /// Which axis points up, as far as can be told.
    pub fn up(&self) -> Up {
        match &self.body {
            Body::Mesh { view, .. } if view.y_up => Up::Y,
            Body::Mesh { .. } => Up::guess(&self.scene.bounds()),
            // A field is flat, but so is a shelf: worlds say how they stand, with y up.
            Body::World { .. } => Up::Y,
        }
    }

    /// The materials of all primitives and, after them, that of the plate below.
    pub fn dress(&self) -> Palette {
        let mut palette = Palette::default();
        if let Body::Mesh { view, .. } = &self.body {
            for index in 0..view.mesh.len() {
                palette.push(view.materials.map_or_else(glazed, |materials| materials.of(index)), 1);
            }
        }
        palette.push(plate(), 1);
        palette
    }

    /// The textures of its materials, if there are any.
    pub fn textures(&self) -> Option<(Materials<'_>, Textures<'_>)> {
        match &self.body {
            Body::Mesh { view, .. } => view.materials.zip(view.textures.map(|(textures, _)| textures)),
            Body::World { .. } => None,
        }
    }

    /// How many triangles there are, for people.
    pub fn size(&self) -> String {
        match &self.body {
            Body::Mesh { view, .. } => things(view.mesh.len(), "triangle", "triangles"),
            Body::World { placed, own, .. } => {
                let all = things(self.primitives, "triangle", "triangles");
                format!("{all}, {} of their own placed {}", count(*own), things(placed.len(), "time", "times"))
            }
        }
    }

    /// What there is to say of the structure.
    pub fn structure(&self) -> String {
        match &self.body {
            Body::Mesh { structure, .. } => (*structure).to_owned(),
            Body::World { bytes, seconds: took, .. } => {
                format!("two levels of the asset, {} bytes in all, checked in {}", count(*bytes), seconds(*took))
            }
        }
    }

    /// The structure's name and how long it took.
    pub fn time(&self) -> String {
        match &self.body {
            Body::Mesh { time, .. } => (*time).to_owned(),
            Body::World { seconds: took, .. } => format!("two levels checked in {}", seconds(*took)),
        }
    }
}
