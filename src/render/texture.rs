use core::fmt;

use glam::{Vec2, Vec3};

use super::Levels;
use crate::math;

/// The colours of a picture, row by row from the upper left: sRGB in RGB565, red in the upper 5 bits.
///
/// What a palette has no colour for is black.
#[derive(Clone, Copy, Debug)]
pub enum Texels<'a> {
    /// A colour each, 2 bytes.
    Rgb565(&'a [u16]),
    /// The number of a colour each, 1 byte.
    Palette8 {
        /// At most 256 colours.
        palette: &'a [u16],
        /// Their numbers.
        texels: &'a [u8],
    },
    /// The number of a colour each, half a byte: the lower half is the left one.
    Palette4 {
        /// At most 16 colours.
        palette: &'a [u16],
        /// Their numbers, two a byte, one row after the other without gaps.
        texels: &'a [u8],
    },
}

impl Texels<'_> {
    /// Pixels, in the units of which the slice has this many.
    fn len(&self) -> usize {
        match self {
            Self::Rgb565(texels) => texels.len(),
            Self::Palette8 { texels, .. } | Self::Palette4 { texels, .. } => texels.len(),
        }
    }

    /// How long the slice of so many pixels is.
    const fn needed(&self, pixels: usize) -> usize {
        match self {
            Self::Rgb565(_) | Self::Palette8 { .. } => pixels,
            Self::Palette4 { .. } => pixels.div_ceil(2),
        }
    }

    /// The linear light of a pixel.
    fn light(&self, index: usize) -> Vec3 {
        let color = |palette: &[u16], number: u8| palette.get(usize::from(number)).copied();
        let color = match self {
            Self::Rgb565(texels) => texels.get(index).copied(),
            Self::Palette8 { palette, texels } => texels.get(index).and_then(|&number| color(palette, number)),
            Self::Palette4 { palette, texels } => {
                let pair = texels.get(index / 2).copied();
                pair.and_then(|pair| color(palette, if index.is_multiple_of(2) { pair & 15 } else { pair >> 4 }))
            }
        };
        let color = color.unwrap_or(0);
        let light = |levels: Levels, level: u16| levels.light(level as u8);
        let (red, green) = (light(Levels::BITS_5, color >> 11), light(Levels::BITS_6, color >> 5 & 63));
        Vec3::new(red, green, light(Levels::BITS_5, color & 31))
    }
}

/// What lies between the middles of texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Filter {
    /// A blend of the four around.
    #[default]
    Bilinear,
    /// The nearest.
    Nearest,
}

/// What lies beside the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// Its edge.
    Clamp,
}

/// Why texels are no texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TextureError {
    /// It has no width or no height.
    Empty,
    /// The slice is not as long as so many pixels are.
    Texels {
        /// Elements that the slice should have.
        expected: usize,
        /// Elements that it has.
        found: usize,
    },
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the texture has no pixels"),
            Self::Texels { expected, found } => {
                write!(f, "the texture's slice should have {expected} elements, not {found}")
            }
        }
    }
}

impl core::error::Error for TextureError {}

/// A picture on a surface, of borrowed texels, of any size up to 65,535 x 65,535; there are no smaller copies of it for
/// distant surfaces.
///
/// ```
/// use hitscan::{glam::{Vec2, Vec3}, render::{Filter, Texels, Texture}};
/// // Black and white: 4 x 2 pixels in 4 bytes and a palette.
/// let texels = Texels::Palette4 { palette: &[0x0000, 0xffff], texels: &[0x10, 0x10, 0x01, 0x01] };
/// let checker = Texture::new(4, 2, texels)?;
/// assert_eq!(checker.color(Vec2::new(0.25, 0.25)), Vec3::splat(0.5));
/// assert_eq!(checker.with_filter(Filter::Nearest).color(Vec2::new(0.3, 0.2)), Vec3::ONE);
/// # Ok::<(), hitscan::render::TextureError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Texture<'a> {
    width: u16,
    height: u16,
    filter: Filter,
    wrap: Wrap,
    texels: Texels<'a>,
}

impl<'a> Texture<'a> {
    /// A picture of this size.
    ///
    /// # Errors
    ///
    /// [`TextureError`] if it has no pixels, or more or fewer than there are texels.
    pub fn new(width: u16, height: u16, texels: Texels<'a>) -> Result<Self, TextureError> {
        let (pixels, found) = (usize::from(width) * usize::from(height), texels.len());
        let expected = texels.needed(pixels);
        if pixels == 0 {
            Err(TextureError::Empty)
        } else if found != expected {
            Err(TextureError::Texels { expected, found })
        } else {
            Ok(Self { width, height, filter: Filter::default(), wrap: Wrap::default(), texels })
        }
    }

    /// The same with this between its texels.
    #[must_use]
    pub const fn with_filter(self, filter: Filter) -> Self {
        Self { filter, ..self }
    }

    /// The same with this beside it.
    #[must_use]
    pub const fn with_wrap(self, wrap: Wrap) -> Self {
        Self { wrap, ..self }
    }

    /// Pixels in a row.
    #[must_use]
    pub const fn width(&self) -> u16 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> u16 {
        self.height
    }

    /// What lies between its texels.
    #[must_use]
    pub const fn filter(&self) -> Filter {
        self.filter
    }

    /// What lies beside it.
    #[must_use]
    pub const fn wrap(&self) -> Wrap {
        self.wrap
    }

    /// Its texels.
    #[must_use]
    pub const fn texels(&self) -> Texels<'a> {
        self.texels
    }

    /// The linear light at texture coordinates: (0, 0) is the upper left corner, (1, 1) the lower right one.
    ///
    /// Coordinates that are no numbers are taken for 0.
    #[must_use]
    pub fn color(&self, uv: Vec2) -> Vec3 {
        let (width, height) = (i32::from(self.width), i32::from(self.height));
        let (x, y) = (self.within(uv.x) * width as f32, self.within(uv.y) * height as f32);
        if self.filter == Filter::Nearest {
            return self.texel(x as i32, y as i32);
        }
        // From the middle of one texel to that of the next.
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (math::floor(x), math::floor(y));
        let (right, lower) = (x - left, y - top);
        let (left, top) = (left as i32, top as i32);
        let row = |y| {
            let (a, b) = (self.texel(left, y), self.texel(left + 1, y));
            a + (b - a) * right
        };
        let (a, b) = (row(top), row(top + 1));
        a + (b - a) * lower
    }

    /// A coordinate within the picture, 0 to 1.
    fn within(&self, at: f32) -> f32 {
        let within = match self.wrap {
            Wrap::Repeat => at - math::floor(at),
            Wrap::Clamp => math::least(1.0, at),
        };
        // Written so that NaN becomes 0.
        if within > 0.0 { within } else { 0.0 }
    }

    /// The texel of a pixel that may be one beside the picture.
    fn texel(&self, x: i32, y: i32) -> Vec3 {
        let within = |at: i32, size: u16| {
            let last = i32::from(size) - 1;
            let (below, above) = if self.wrap == Wrap::Repeat { (last, 0) } else { (0, last) };
            (if at < 0 {
                below
            } else if at > last {
                above
            } else {
                at
            }) as usize
        };
        self.texels.light(within(y, self.height) * usize::from(self.width) + within(x, self.width))
    }
}
