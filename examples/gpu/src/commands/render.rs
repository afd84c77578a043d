use std::{fs::File, io::BufWriter, path::PathBuf};

use anyhow::{Context, Result, anyhow};
use hitscan::{
    glam::Vec3,
    render::{Camera, Light, Material},
};

use super::Source;
use crate::{Picture, Stage};

/// Draws an asset.
#[derive(Debug, clap::Args)]
pub struct Render {
    #[command(flatten)]
    source: Source,
    /// PNG to write
    #[arg(short, long, default_value = "picture.png")]
    output: PathBuf,
    /// Pixels of the picture
    #[arg(long, value_name = "WxH", default_value = "960x640", value_parser = parse_size)]
    size: (u32, u32),
    /// Rays per pixel along each side: 3 makes 9
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=16))]
    samples: u32,
    /// The most mirror images within mirror images
    #[arg(short, long, default_value_t = 3)]
    bounces: u32,
    /// The share of light that is mirrored, where the asset has no materials
    #[arg(long, default_value_t = 0.3)]
    mirror: f32,
    /// Where to look from, relative to the middle: X,Y,Z
    #[arg(long, value_name = "X,Y,Z", default_value = "0.6,0.5,1", allow_hyphen_values = true, value_parser = parse_vector)]
    from: Vec3,
    /// The direction that is up
    #[arg(long, value_name = "X,Y,Z", default_value = "0,1,0", allow_hyphen_values = true, value_parser = parse_vector)]
    up: Vec3,
}

fn parse_size(text: &str) -> Result<(u32, u32)> {
    let parts = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    parts.filter(|&(w, h)| w > 0 && h > 0).ok_or_else(|| anyhow!("give a size such as 960x640"))
}

fn parse_vector(text: &str) -> Result<Vec3> {
    let parts: Vec<f32> = text.split(',').filter_map(|part| part.parse().ok()).collect();
    <[f32; 3]>::try_from(parts).map(Vec3::from_array).map_err(|_| anyhow!("give three numbers such as 0,1,0"))
}

impl Render {
    pub fn run(&self) -> Result<()> {
        self.source.open(|uploaded, asset, world| {
            let bounds = world.as_caster().bounds();
            let stage = Stage {
                camera: Camera::framing(&bounds, self.from, self.up),
                lights: vec![
                    Light::directional(-self.from - self.up * 2.0, Vec3::splat(0.6)),
                    Light::point(bounds.center() + self.up * bounds.size().length() * 2.0, Vec3::splat(0.2)),
                ],
                width: self.size.0,
                height: self.size.1,
                samples: self.samples,
                bounces: self.bounces,
                material: Material::default().with_reflectivity(self.mirror),
            };
            let picture = Picture::draw(uploaded, asset, world, &stage)?;
            self.write(&picture).with_context(|| self.output.display().to_string())?;
            let (rays, pixels) = (picture.rays, picture.pixels.len());
            eprintln!(
                "{rays} rays in {:.3} s, {:.2} Mrays/s; {} of {pixels} pixels ({:.2} %) were finished on the CPU",
                picture.seconds,
                rays as f64 / picture.seconds * 1.0e-6,
                picture.finished,
                100.0 * picture.finished as f64 / pixels as f64
            );
            Ok(())
        })
    }

    fn write(&self, picture: &Picture) -> Result<()> {
        let mut encoder = png::Encoder::new(BufWriter::new(File::create(&self.output)?), self.size.0, self.size.1);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        Ok(encoder.write_header()?.write_image_data(picture.pixels.as_flattened())?)
    }
}
