//! `hitscan compare`: all structures side by side, on the same meshes and rays.

mod around;
mod clock;
mod contest;
mod growth;
mod plot;
mod report;
mod row;
mod sheet;
mod table;
mod terrain;

use hitscan::Mesh;

use crate::{
    failure::Failure,
    scene::{Built, Named, Preset},
    stage::{CameraArg, Up, Viewpoint},
    trial::{Rays, outside},
};

pub use contest::{Contest, Entry, Outcome};
pub use growth::{SIZES, describe, growth};
pub use plot::{plot_bytes, plot_growth};
pub use report::{Report, medians};
pub use row::{Made, Row};
pub use sheet::write_csv;
pub use terrain::terrain;

/// The rays from a camera, or from one that sees the whole mesh, and those of a trial.
pub fn rays_at(mesh: &Mesh<'_>, camera: Option<CameraArg>, count: usize) -> Result<(Rays, Rays), Failure> {
    // Any structure finds the same hits.
    let built = Built::named(mesh, Named::assumed(), Preset::Small, None)?;
    let scene = built.scene(mesh)?;
    let bounds = scene.bounds();
    let all = outside(&bounds);
    let asked =
        camera.map(|camera| Viewpoint::new(Some(camera), &bounds, Up::guess(&bounds), 1.0, [].into_iter()).camera);
    Ok((Rays::new(&*scene, &asked.unwrap_or(all), count), Rays::around(&*scene)))
}
