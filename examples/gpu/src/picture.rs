use anyhow::{Result, ensure};
use hitscan::{
    asset::{Asset, Kind},
    glam::Vec3,
    render::{Camera, Caster, Color, Light, Material, Materials, Numbers, Renderer},
};
use rayon::prelude::*;
use wgpu::BufferUsages;

use crate::{Uploaded, World, layout::place, shader::Purpose};

/// Samples per dispatch.
const BATCH: usize = 1 << 18;

/// Rows of a workgroup, as the shader has it.
const GROUP: u32 = 8;

/// What a picture is of, and in which light.
#[derive(Clone, Debug)]
pub struct Stage {
    /// From where.
    pub camera: Camera,
    /// The lights.
    pub lights: Vec<Light>,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Rays per pixel along each side.
    pub samples: u32,
    /// The most mirror images within mirror images.
    pub bounces: u32,
    /// The material of everything, where an asset names none.
    pub material: Material,
}

/// A picture, and how it came about.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The pixels, row by row.
    pub pixels: Vec<[u8; 3]>,
    /// Pixels that the library drew again, because the shader was not certain of a ray.
    pub finished: usize,
    /// Rays that the shader cast.
    pub rays: u64,
    /// Seconds that the shader took.
    pub seconds: f64,
}

/// Three numbers of the shader's `Stage`, and the one in the fourth place.
fn row(v: Vec3, fourth: u32) -> [u32; 4] {
    let [x, y, z] = v.to_array().map(f32::to_bits);
    [x, y, z, fourth]
}

/// Where in the words materials are looked up, and the materials themselves.
struct Lookup {
    palette: Vec<Material>,
    /// Words at which material numbers and numbers of old begin, or 0.
    numbers: u32,
    order: u32,
    order_is_narrow: u32,
}

impl Lookup {
    fn of(asset: &Asset<'_>, otherwise: Material) -> Self {
        let start = |kind| asset.section(kind).ok().map(|words| (place(asset.as_words(), words), words));
        let palette = match start(Kind::Materials) {
            Some((_, words)) if !words.is_empty() => bytemuck::cast_slice(words).to_vec(),
            _ => vec![otherwise],
        };
        let numbers = start(Kind::MaterialNumbers).map_or(0, |(at, _)| at + 1);
        let (order, count) = start(Kind::Numbers).map_or((0, 0), |(at, words)| (at + 1, words[0]));
        Self { palette, numbers, order, order_is_narrow: u32::from(count <= 1 << 16) }
    }
}

impl Stage {
    /// The library's renderer of the same picture.
    pub fn renderer<'a, S: Caster + ?Sized>(&'a self, scene: &'a S, materials: Materials<'a>) -> Renderer<'a, S> {
        Renderer::new(scene, self.camera, self.width, self.height)
            .with_lights(&self.lights)
            .with_materials(materials)
            .with_bounces(self.bounces)
            .with_samples(self.samples)
            .with_ambient(AMBIENT)
            .with_background(BELOW, ABOVE)
    }

    /// The materials of an asset, or the same one for all.
    pub fn materials<'a>(&'a self, asset: &Asset<'a>) -> Materials<'a> {
        let everything = Materials::new(std::slice::from_ref(&self.material), Numbers::First);
        asset.read().unwrap_or(everything)
    }

    /// What the shader reads.
    fn words(&self, asset: &Asset<'_>) -> Vec<u32> {
        let lookup = Lookup::of(asset, self.material);
        let (width, height) = (self.width as f32, self.height as f32);
        let ray = |x, y| self.camera.ray(x, y, self.width, self.height);
        let (corner, right, bottom) = (ray(0.0, 0.0), ray(width, 0.0), ray(0.0, height));
        let lights = self.lights.iter().flat_map(|light| {
            let (place, kind) = match light {
                Light::Point { position, .. } => (*position, 1.0_f32),
                Light::Directional { direction, .. } => (*direction, 0.0),
            };
            [row(place, kind.to_bits()), row(light.color(), 0)]
        });
        let rows = [
            row(corner.origin, self.width),
            row((right.origin - corner.origin) / width, self.height),
            row((bottom.origin - corner.origin) / height, self.samples),
            row(corner.direction, self.bounces),
            row((right.direction - corner.direction) / width, self.lights.len() as u32),
            row((bottom.direction - corner.direction) / height, 0),
            row(self.camera.up(), lookup.palette.len() as u32),
            row(AMBIENT, lookup.numbers),
            row(BELOW, lookup.order),
            row(ABOVE, lookup.order_is_narrow),
        ];
        let materials: &[[u32; 4]] = bytemuck::cast_slice(&lookup.palette);
        rows.into_iter().chain(lights).chain(materials.iter().copied()).flatten().collect()
    }
}

/// Bytes of the shader's `Stage` before the row to begin with.
const ROW: u64 = 5 * 16 + 12;

/// Light from everywhere, and the sky below and above: those of the library's renderer.
const AMBIENT: Vec3 = Vec3::splat(0.15);
const BELOW: Vec3 = Vec3::splat(0.8);
const ABOVE: Vec3 = Vec3::new(0.25, 0.4, 0.7);

impl Picture {
    /// Draws an asset that was uploaded: what shaders are certain of, they draw; pixels with any other ray, the library.
    ///
    /// # Errors
    ///
    /// If the picture is too large for the GPU.
    pub fn draw(uploaded: &Uploaded, asset: &Asset<'_>, world: &World<'_, '_>, stage: &Stage) -> Result<Self> {
        let area = stage.width as usize * stage.height as usize;
        let room = uploaded.device.binding() as usize / 16;
        ensure!(area <= room, "{area} pixels are more than the {room} that this GPU takes: make the picture smaller");
        let words = stage.words(asset);
        let input = uploaded.buffer(size_of_val(&*words), BufferUsages::STORAGE | BufferUsages::COPY_DST);
        let output = uploaded.buffer(area * 16, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        uploaded.device.queue.write_buffer(&input, 0, bytemuck::cast_slice(&words));
        let shader = uploaded.compiled(Purpose::Render);
        let a_row = (stage.width * stage.samples * stage.samples).max(1) as usize;
        let rows = (BATCH / a_row).max(1).next_multiple_of(GROUP as usize) as u32;
        let begun = std::time::Instant::now();
        for first in (0..stage.height).step_by(rows as usize) {
            uploaded.device.queue.write_buffer(&input, ROW, bytemuck::bytes_of(&first));
            let groups = (stage.width.div_ceil(GROUP), rows.min(stage.height - first).div_ceil(GROUP));
            uploaded.run(&shader, &input, &output, groups);
        }
        let seconds = begun.elapsed().as_secs_f64();
        let bytes = uploaded.read(&output);
        let drawn: &[[f32; 4]] = bytemuck::cast_slice(&bytes);
        let renderer = stage.renderer(world.as_caster(), stage.materials(asset));
        let finish = |(index, &[r, g, b, rays]): (usize, &[f32; 4])| {
            if rays > 0.0 {
                return (<[u8; 3]>::from_linear(Vec3::new(r, g, b)), 0);
            }
            let (x, y) = (index as u32 % stage.width, index as u32 / stage.width);
            (<[u8; 3]>::from_linear(renderer.pixel(x, y)), 1)
        };
        let finished: Vec<([u8; 3], usize)> = drawn.par_iter().enumerate().map(finish).collect();
        let rays = drawn.iter().map(|pixel| pixel[3].abs() as u64).sum();
        let count = finished.iter().map(|(_, count)| count).sum();
        Ok(Self { pixels: finished.into_iter().map(|(pixel, _)| pixel).collect(), finished: count, rays, seconds })
    }
}
