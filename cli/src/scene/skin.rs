use std::{
    collections::{BTreeSet, HashMap},
    io::Cursor,
};

use hitscan::{
    bake::Baker,
    glam::{Vec2, Vec3},
    render::{Color, Filter, Texels, Texture, Wrap},
};
use image::{ImageReader, RgbImage, imageops};

use crate::model::{self, Mapping, Model};

/// The pictures on a mesh, as an asset stores them.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Where in its picture each vertex lies.
    coordinates: Vec<Vec2>,
    /// One for each material, if it has one.
    pictures: Vec<Option<Picture>>,
    /// Both as the sections of an asset.
    words: Vec<u32>,
}

/// A picture in as few bytes as its colours in 16 bits take.
#[derive(Clone, Debug)]
struct Picture {
    width: u16,
    height: u16,
    filter: Filter,
    wrap: Wrap,
    texels: Stored,
}

#[derive(Clone, Debug)]
enum Stored {
    Colors(Vec<u16>),
    Bytes { palette: Vec<u16>, numbers: Vec<u8> },
    Halves { palette: Vec<u16>, numbers: Vec<u8> },
}

impl Skin {
    /// That of a model, whose vertices are divided where pictures have seams; none if no material has a picture that
    /// can be read. Pictures have at most so many pixels along a side; what is wrong with one is said to `warn`.
    pub fn of_model(model: &mut Model, most: u16, mut warn: impl FnMut(String)) -> Option<Self> {
        let mut known: HashMap<String, Option<Picture>> = HashMap::new();
        let mut read = |image: &model::Image| match Picture::read(image, most) {
            Ok(picture) => Some(picture),
            Err(why) => {
                warn(format!("texture {image}: {why}: drawn without it"));
                None
            }
        };
        let pictures = model.materials.iter().map(|material| {
            let image = material.image.as_ref()?;
            match &image.contents {
                // Many materials may have the same.
                model::Contents::File(_) => known.entry(format!("{image:?}")).or_insert_with(|| read(image)).clone(),
                model::Contents::Here(_) => read(image),
            }
        });
        let pictures: Vec<Option<Picture>> = pictures.collect();
        if pictures.iter().all(Option::is_none) {
            return None;
        }
        let coordinates = unfold(model);
        let words = Baker::new().tex_coords(&coordinates).textures(&textures(&pictures)).finish();
        Some(Self { coordinates, pictures, words })
    }

    /// An asset of its sections alone.
    pub fn as_words(&self) -> &[u32] {
        &self.words
    }

    /// Adds its sections to those of a mesh.
    pub fn bake(&self, baker: Baker) -> Baker {
        baker.tex_coords(&self.coordinates).textures(&textures(&self.pictures))
    }
}

fn textures(pictures: &[Option<Picture>]) -> Vec<Option<Texture<'_>>> {
    pictures.iter().map(|picture| picture.as_ref()?.texture()).collect()
}

/// The coordinates of a model's vertices. A vertex that has several, because a picture ends there, becomes several
/// vertices; triangles stay where they are.
fn unfold(model: &mut Model) -> Vec<Vec2> {
    let mut coordinates = vec![None; model.vertices.len()];
    let mut copies = HashMap::new();
    for triangle in 0..model.triangles.len() {
        let Some(places) = model.mapping.of(triangle) else { continue };
        for (corner, at) in places.into_iter().enumerate() {
            let vertex = &mut model.triangles[triangle][corner];
            let first = *coordinates[*vertex as usize].get_or_insert(at);
            if first == at {
                continue;
            }
            *vertex = *copies.entry((*vertex, at.map(f32::to_bits))).or_insert_with(|| {
                model.vertices.push(model.vertices[*vertex as usize]);
                coordinates.push(Some(at));
                model.vertices.len() as u32 - 1
            });
        }
    }
    model.mapping = Mapping::default();
    // Where no picture is, those of another vertex, which do not widen the range.
    let usual = coordinates.iter().flatten().next().copied().unwrap_or_default();
    coordinates.into_iter().map(|at| Vec2::from(at.unwrap_or(usual))).collect()
}

impl Picture {
    fn read(image: &model::Image, most: u16) -> Result<Self, String> {
        let bytes = image.read().map_err(|error| crate::input::explain(&error))?;
        let decoded = model::caught(move || {
            let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
            reader.map_err(|error| error.to_string())?.decode().map_err(|error| error.to_string())
        });
        let decoded = decoded.unwrap_or_else(|| Err("damaged".to_owned()));
        let pixels = decoded.map_err(|why| crate::one_line(&why))?.into_rgb8();
        let filter = if image.nearest { Filter::Nearest } else { Filter::Bilinear };
        let wrap = if image.clamp { Wrap::Clamp } else { Wrap::Repeat };
        let (width, height, colors) = shrunk(&pixels, most);
        if colors.is_empty() {
            return Err("it has no pixels".to_owned());
        }
        Ok(Self { width, height, filter, wrap, texels: Stored::new(colors) })
    }

    fn texture(&self) -> Option<Texture<'_>> {
        let texels = match &self.texels {
            Stored::Colors(colors) => Texels::Rgb565(colors),
            Stored::Bytes { palette, numbers } => Texels::Palette8 { palette, texels: numbers },
            Stored::Halves { palette, numbers } => Texels::Palette4 { palette, texels: numbers },
        };
        let texture = Texture::new(self.width, self.height, texels).ok()?;
        Some(texture.with_filter(self.filter).with_wrap(self.wrap))
    }
}

/// A picture of at most so many pixels along a side, and its colours in 16 bits.
fn shrunk(pixels: &RgbImage, most: u16) -> (u16, u16, Vec<u16>) {
    let (width, height) = pixels.dimensions();
    let most = u32::from(most.max(1));
    if width <= most && height <= most {
        let nearest = |level: u8, most: u16| (u16::from(level) * most + 127) / 255;
        let color = |rgb: [u8; 3]| nearest(rgb[0], 31) << 11 | nearest(rgb[1], 63) << 5 | nearest(rgb[2], 31);
        return (width as u16, height as u16, pixels.pixels().map(|pixel| color(pixel.0)).collect());
    }
    // Light is what can be averaged.
    let light = |level: u8| {
        let level = f32::from(level) / 255.0;
        if level <= 0.040_45 { level / 12.92 } else { ((level + 0.055) / 1.055).powf(2.4) }
    };
    let light: Vec<f32> = (0..=255).map(light).collect();
    let levels = pixels.as_raw().iter().map(|&level| light[usize::from(level)]).collect();
    let Some(linear) = image::Rgb32FImage::from_raw(width, height, levels) else { return (0, 0, Vec::new()) };
    let largest = width.max(height);
    let side = |length: u32| (length * most / largest).max(1);
    let small = imageops::resize(&linear, side(width), side(height), imageops::FilterType::Triangle);
    let colors = small.pixels().map(|pixel| u16::from_linear(Vec3::from(pixel.0)));
    (side(width) as u16, side(height) as u16, colors.collect())
}

impl Stored {
    /// With a palette where that takes fewer bytes.
    fn new(colors: Vec<u16>) -> Self {
        let palette: BTreeSet<u16> = colors.iter().copied().collect();
        let palette: Vec<u16> = palette.into_iter().collect();
        let numbers = || colors.iter().map(|color| palette.partition_point(|other| other < color) as u8);
        let plain = colors.len() * 2;
        match palette.len() {
            ..=16 if colors.len() / 2 + 32 < plain => {
                let numbers: Vec<u8> = numbers().collect();
                let numbers =
                    numbers.chunks(2).map(|pair| pair[0] | pair.get(1).map_or(0, |right| right << 4)).collect();
                Self::Halves { palette, numbers }
            }
            ..=256 if colors.len() + 512 < plain => {
                let numbers = numbers().collect();
                Self::Bytes { palette, numbers }
            }
            _ => Self::Colors(colors),
        }
    }
}
