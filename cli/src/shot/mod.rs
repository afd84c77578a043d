//! Pictures from the settings of the command line: whole, by rows, in parts.

mod part;
mod settings;
mod tiles;

pub use part::{Identity, Part, merge};
pub use settings::Settings;
pub use tiles::{Tiles, rows};

use std::{fmt::Write as _, iter, ops::Range, path::Path};

use hitscan::{
    Primitives,
    primitives::{Smooth, Spheres},
    render::{Camera, Caster, Materials, Renderer, Textured, Tile},
};
use rayon::prelude::*;

use crate::{
    failure::Failure,
    scene::{Built, Source, builtin::BuiltIn},
    stage::{Counted, Grounded, Lighting, Tally, Viewpoint},
    units::count,
};

/// What a picture shows, and how.
#[derive(Clone, Copy)]
pub struct Shot<'a> {
    scene: &'a (dyn Caster + Sync),
    camera: Camera,
    lighting: &'a Lighting,
    materials: Materials<'a>,
    settings: &'a Settings,
}

impl std::fmt::Debug for Shot<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shot").field("camera", &self.camera).field("settings", &self.settings).finish_non_exhaustive()
    }
}

impl Settings {
    /// Prepares a picture of a mesh or an asset, for as long as `visit` takes; `path` is for errors.
    ///
    /// # Errors
    ///
    /// What is wrong with the source, or what `visit` returns.
    pub fn shoot<R>(
        &self,
        source: &Source,
        path: &Path,
        visit: impl FnOnce(&Shot<'_>) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        with_shot(Some((source, path)), self, |shot, _| visit(shot))
    }
}

/// Prepares a picture of a source, or of the built-in scene; `visit` also gets what there is to say about it.
pub fn with_shot<R>(
    source: Option<(&Source, &Path)>,
    settings: &Settings,
    visit: impl FnOnce(&Shot<'_>, String) -> Result<R, Failure>,
) -> Result<R, Failure> {
    let Some((source, path)) = source else { return built_in(settings, visit) };
    source.with_subject(path, &settings.structure, settings.smooth, |subject| {
        let scene: &(dyn Caster + Sync) = subject.scene;
        let textured = subject.textures().map(|(materials, textures)| Textured::new(scene, materials, textures));
        let scene = textured.as_ref().map_or(scene, |textured| textured);
        let bounds = scene.bounds();
        let up = settings.up.unwrap_or_else(|| subject.up());
        let viewpoint = Viewpoint::new(settings.camera, &bounds, up, settings.aspect(), subject.points());
        let palette = subject.dress();
        let grounded = Grounded::new(scene, up as usize, subject.primitives)?;
        let shot = Shot {
            scene: if settings.no_ground { scene } else { &grounded },
            camera: viewpoint.camera,
            lighting: &Lighting::studio(&bounds, &viewpoint),
            materials: palette.as_materials(),
            settings,
        };
        visit(&shot, summary(&format!("{}: {}", path.display(), subject.size()), &subject.structure()))
    })
}

fn built_in<R>(settings: &Settings, visit: impl FnOnce(&Shot<'_>, String) -> Result<R, Failure>) -> Result<R, Failure> {
    let builtin = BuiltIn::new();
    let internal = |error: &dyn std::fmt::Display| Failure::new(error, "report this as a bug");
    let mesh = Smooth::new(builtin.geometry.mesh()?, &builtin.normals);
    let spheres = Spheres::new(&builtin.spheres).map_err(|error| internal(&error))?;
    let primitives = (mesh, spheres);
    let structure = settings.structure.structure.unwrap_or_default();
    let built = Built::new(&primitives, structure, settings.structure.preset)?;
    let scene = built.scene(&primitives)?;

    let camera = settings.camera.unwrap_or(BuiltIn::CAMERA);
    let up = settings.up.unwrap_or(crate::stage::Up::Y);
    let viewpoint = Viewpoint::new(Some(camera), &scene.bounds(), up, settings.aspect(), iter::empty());
    let shot = Shot {
        scene: &*scene,
        camera: viewpoint.camera,
        lighting: &BuiltIn::lighting(),
        materials: builtin.palette.as_materials(),
        settings,
    };
    let (triangles, spheres) = (builtin.geometry.len(), builtin.spheres.len());
    let what = format!("built-in scene: {} triangles, {spheres} spheres", count(triangles));
    visit(&shot, summary(&what, &built.describe(primitives.len() as usize)))
}

/// What is shown, under which structure.
fn summary(what: &str, structure: &str) -> String {
    let mut text = format!("{what}\n");
    let _ = writeln!(text, "  {:<18} {structure}", "structure");
    text
}

impl Shot<'_> {
    /// The colours of some rows of the picture, on all threads of the current pool.
    ///
    /// # Errors
    ///
    /// None is known.
    pub fn rows(&self, rows: Range<u32>) -> Result<Vec<[u8; 3]>, Failure> {
        self.rows_with(rows, |_| {})
    }

    /// The same, and tells of each band of so many rows that is finished.
    pub(crate) fn rows_with(&self, rows: Range<u32>, done: impl Fn(u32) + Sync) -> Result<Vec<[u8; 3]>, Failure> {
        /// Rows of pixels that a thread takes at a time: as many as a patch of a tile has.
        const BAND: u32 = 8;
        let (width, height) = self.settings.size();
        let [below, above] = self.lighting.background;
        let renderer = Renderer::new(self.scene, self.camera, width, height)
            .with_lights(&self.lighting.lights)
            .with_ambient(self.lighting.ambient)
            .with_background(below, above)
            .with_materials(self.materials)
            .with_terms(self.settings.terms())
            .with_bounces(self.settings.bounces)
            .with_samples(self.settings.samples);
        let part = Tile { x: 0, y: rows.start, width, height: rows.len() as u32 };
        let mut pixels = vec![[0; 3]; part.area()];
        // Bands of whole rows are contiguous in the picture.
        let bands: Vec<Tile> = part.parts(width, BAND).collect();
        let drawn = pixels.par_chunks_mut((width * BAND) as usize).zip(bands);
        let drawn = drawn.try_for_each(|(rows, band)| renderer.fill(band, rows).map(|()| done(band.height)));
        drawn.map_err(|error| Failure::new(error, "report this as a bug"))?;
        Ok(pixels)
    }

    /// The same with its rays counted, by so many threads of a pool.
    pub(crate) fn counted<R>(&self, threads: usize, visit: impl FnOnce(&Shot<'_>) -> R) -> (R, Tally) {
        let counted = Counted::new(self.scene, threads);
        let result = visit(&Shot { scene: &counted, ..*self });
        (result, counted.tally())
    }
}
