use glam::Vec2;

use crate::{
    asset::{Asset, AssetError, Kind, Stored},
    error::Error,
};

/// Where in a picture each vertex of a mesh lies: texture coordinates, of which (0, 0) is the upper left corner of the
/// picture and (1, 1) the lower right one.
///
/// In memory as they are, 8 bytes a vertex; in an [asset](crate::asset) 4, each coordinate one of 65,536 steps between the
/// least and the greatest: `bake::Baker::tex_coords` stores them.
#[derive(Clone, Copy, Debug)]
pub struct TexCoords<'a>(Source<'a>);

/// Where they are.
#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    Plain(&'a [Vec2]),
    Packed(Packed<'a>),
}

/// Those of an asset.
#[derive(Clone, Copy, Debug)]
struct Packed<'a> {
    /// One each, the first coordinate in the lower half.
    words: &'a [u32],
    least: Vec2,
    step: Vec2,
}

/// Words before those of the vertices: how many of them, the least coordinates, and the steps.
const HEADER: usize = 5;

impl<'a> TexCoords<'a> {
    /// One for each vertex; a vertex beyond the last has none.
    #[must_use]
    pub const fn new(coordinates: &'a [Vec2]) -> Self {
        Self(Source::Plain(coordinates))
    }

    /// How many there are.
    #[must_use]
    pub const fn len(&self) -> u32 {
        match self.0 {
            Source::Plain(coordinates) => coordinates.len() as u32,
            Source::Packed(Packed { words, .. }) => words.len() as u32,
        }
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Those of a vertex.
    #[must_use]
    pub fn get(&self, vertex: u32) -> Option<Vec2> {
        match self.0 {
            Source::Plain(coordinates) => coordinates.get(vertex as usize).copied(),
            Source::Packed(Packed { words, least, step }) => {
                let word = words.get(vertex as usize)?;
                Some(least + step * Vec2::new((word & 0xffff) as f32, (word >> 16) as f32))
            }
        }
    }

    /// The words of a section that holds these; what is no number, or beyond 2^60, is at an end.
    #[cfg(feature = "alloc")]
    pub(crate) fn packed(coordinates: &[Vec2]) -> impl Iterator<Item = u32> {
        /// Steps from the least to the greatest.
        const STEPS: f32 = 65_535.0;
        const LARGEST: Vec2 = Vec2::splat((1_u64 << 60) as f32);
        let usable = || coordinates.iter().copied().filter(|at| at.abs().cmple(LARGEST).all());
        let least = usable().reduce(Vec2::min).unwrap_or_default();
        let greatest = usable().reduce(Vec2::max).unwrap_or_default();
        let step = ((greatest - least) / STEPS).max(Vec2::splat(f32::MIN_POSITIVE));
        let header = [least.x, least.y, step.x, step.y].map(f32::to_bits);
        let number = |steps: f32| u32::from(crate::math::floor(steps + 0.5) as u16);
        let words = coordinates.iter().map(move |&at| {
            let steps = (at - least) / step;
            number(steps.x) | number(steps.y) << 16
        });
        core::iter::once(coordinates.len() as u32).chain(header).chain(words)
    }
}

/// The section of texture coordinates.
impl<'a> Stored<'a> for TexCoords<'a> {
    fn read(asset: &Asset<'a>) -> Result<Self, Error> {
        let words = asset.section(Kind::TexCoords)?;
        let error = AssetError::Shape { kind: Kind::TexCoords, words: words.len() };
        let (&[count, header @ ..], words) = words.split_first_chunk::<HEADER>().ok_or(error)?;
        let [least_x, least_y, step_x, step_y] = header.map(f32::from_bits);
        let (least, step) = (Vec2::new(least_x, least_y), Vec2::new(step_x, step_y));
        if count as usize != words.len() || !(least.is_finite() && step.is_finite()) {
            return Err(error.into());
        }
        Ok(Self(Source::Packed(Packed { words, least, step })))
    }
}
