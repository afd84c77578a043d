#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};
#[cfg(feature = "alloc")]
use core::ops::Range;

use super::{Filter, Texels, Texture, Wrap};
use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
};

/// The textures of materials, by their numbers.
///
/// In an [asset](crate::asset) a texture takes the bytes of its texels, 2, 1 or half a one each, those of its palette (512
/// or 32) and 12 more: `bake::Baker::textures` stores them.
#[derive(Clone, Copy, Debug)]
pub struct Textures<'a>(Source<'a>);

/// Where they are.
#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    Plain(&'a [Option<Texture<'a>>]),
    /// How many materials, where the texture of each begins or 0, and the textures.
    Packed(&'a [u32]),
}

/// Texels of a palette's kind, in the second word of a texture.
const RGB565: u32 = 0;
const PALETTE_8: u32 = 1;
const PALETTE_4: u32 = 2;
/// What else is in it.
const NEAREST: u32 = 1 << 8;
const CLAMP: u32 = 1 << 9;

/// Words of a palette of 256 and of 16 colours.
const COLORS_8: usize = 128;
const COLORS_4: usize = 8;

impl<'a> Textures<'a> {
    /// One for each material, if it has one.
    #[must_use]
    pub const fn new(textures: &'a [Option<Texture<'a>>]) -> Self {
        Self(Source::Plain(textures))
    }

    /// That of a material.
    #[must_use]
    pub fn get(&self, material: u32) -> Option<Texture<'a>> {
        match self.0 {
            Source::Plain(textures) => *textures.get(material as usize)?,
            Source::Packed(words) => Some(stored(words, material)??.0),
        }
    }

    /// The words of a section that holds these.
    #[cfg(feature = "alloc")]
    pub(crate) fn packed(textures: &[Option<Texture<'_>>]) -> Vec<u32> {
        let mut words = vec![0; 1 + textures.len()];
        words[0] = textures.len() as u32;
        // Where in the words those are that are not the same as one before.
        let mut known: Vec<Range<usize>> = Vec::new();
        for (material, texture) in textures.iter().enumerate() {
            let Some(texture) = texture else { continue };
            let place = words.len();
            words.extend(packed(texture));
            let same = known.iter().find(|other| words.get((*other).clone()) == words.get(place..)).cloned();
            match &same {
                Some(_) => words.truncate(place),
                None => known.push(place..words.len()),
            }
            words[1 + material] = same.map_or(place, |other| other.start) as u32;
        }
        words
    }
}

/// The words of a texture.
#[cfg(feature = "alloc")]
fn packed(texture: &Texture<'_>) -> Vec<u32> {
    let mut bytes = Vec::new();
    let mut push = |palette: &[u16], colors: usize, texels: &[u8]| {
        let palette = palette.iter().chain(core::iter::repeat(&0)).take(colors);
        bytes.extend(palette.flat_map(|color| color.to_le_bytes()));
        bytes.extend(texels);
    };
    let kind = match texture.texels() {
        Texels::Rgb565(texels) => {
            push(texels, texels.len(), &[]);
            RGB565
        }
        Texels::Palette8 { palette, texels } => {
            push(palette, COLORS_8 * 2, texels);
            PALETTE_8
        }
        Texels::Palette4 { palette, texels } => {
            push(palette, COLORS_4 * 2, texels);
            PALETTE_4
        }
    };
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let nearest = if texture.filter() == Filter::Nearest { NEAREST } else { 0 };
    let clamp = if texture.wrap() == Wrap::Clamp { CLAMP } else { 0 };
    let size = u32::from(texture.width()) | u32::from(texture.height()) << 16;
    let (chunks, _) = bytes.as_chunks();
    [size, kind | nearest | clamp].into_iter().chain(chunks.iter().copied().map(u32::from_le_bytes)).collect()
}

/// The texture of a material and where its words end, in a section's words; none of a material without one, and nothing if
/// the words are wrong.
fn stored(words: &[u32], material: u32) -> Option<Option<(Texture<'_>, usize)>> {
    let (&count, materials) = words.split_first()?;
    let place = *materials.get(..count as usize)?.get(material as usize)? as usize;
    if place == 0 {
        return Some(None);
    }
    let (&[size, kind], words) = words.get(place..)?.split_first_chunk()?;
    let (width, height) = (size as u16, (size >> 16) as u16);
    let pixels = usize::from(width) * usize::from(height);
    let (filter, wrap) = (kind & NEAREST != 0, kind & CLAMP != 0);
    let colors = match kind & !(NEAREST | CLAMP) {
        RGB565 => 0,
        PALETTE_8 => COLORS_8,
        PALETTE_4 => COLORS_4,
        _ => return None,
    };
    let (palette, texels) = words.split_at_checked(colors)?;
    let palette: &[u16] = bytemuck::try_cast_slice(palette).ok()?;
    let (texels, used) = match colors {
        0 => {
            let texels: &[u16] = bytemuck::try_cast_slice(texels).ok()?;
            (Texels::Rgb565(texels.get(..pixels)?), pixels.div_ceil(2))
        }
        COLORS_8 => {
            let texels = bytemuck::try_cast_slice(texels).ok()?;
            (Texels::Palette8 { palette, texels: texels.get(..pixels)? }, pixels.div_ceil(4))
        }
        _ => {
            let texels = bytemuck::try_cast_slice(texels).ok()?;
            (Texels::Palette4 { palette, texels: texels.get(..pixels.div_ceil(2))? }, pixels.div_ceil(8))
        }
    };
    let texture = Texture::new(width, height, texels).ok()?;
    let texture = texture.with_filter(if filter { Filter::Nearest } else { Filter::Bilinear });
    let texture = texture.with_wrap(if wrap { Wrap::Clamp } else { Wrap::Repeat });
    Some(Some((texture, place + 2 + colors + used)))
}

/// The section of textures.
impl<'a> Stored<'a> for Textures<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::Textures)?;
        let error = AssetError::Shape { kind: Kind::Textures, words: words.len() };
        let count = *words.first().ok_or(error)?;
        let mut end = (count as usize).saturating_add(1);
        for material in 0..count {
            if let Some((_, behind)) = stored(words, material).ok_or(error)? {
                end = end.max(behind);
            }
        }
        if end == words.len() { Ok(Self(Source::Packed(words))) } else { Err(error.into()) }
    }
}
