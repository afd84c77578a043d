use std::{collections::BTreeSet, io::Cursor};

use hitscan::{
    glam::Vec3,
    render::{Color, Levels, Texels, Texture},
};
use image::{GenericImageView, ImageError, ImageReader, Limits, Rgb, RgbImage, imageops};

use crate::model;

/// A picture in as few bytes as its colours in 16 bits take.
#[derive(Clone, Debug)]
pub struct Picture {
    width: u16,
    height: u16,
    texels: Stored,
}

#[derive(Clone, Debug)]
enum Stored {
    Colors(Vec<u16>),
    Bytes { palette: Vec<u16>, numbers: Vec<u8> },
    Halves { palette: Vec<u16>, numbers: Vec<u8> },
}

impl Picture {
    /// The most pixels that a file may have along a side: what those of one take is less than a gigabyte.
    const SIDE: u32 = 8192;

    /// The picture of a file's bytes, with at most so many pixels along a side; what is wrong with it and how to mend that
    /// otherwise.
    pub fn decode(bytes: &[u8], most: u16) -> Result<Self, String> {
        let decoded = model::caught(move || {
            let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
            let mut limits = Limits::default();
            limits.max_image_width = Some(Self::SIDE);
            limits.max_image_height = Some(Self::SIDE);
            reader.limits(limits);
            Ok(shrunk(&reader.decode()?.into_rgb8(), most.into()))
        });
        let (width, height, colors) = match decoded {
            Some(Ok(shrunk)) => shrunk,
            Some(Err(ImageError::Limits(_))) => {
                return Err(format!("too large: make it at most {} pixels wide and high", Self::SIDE));
            }
            Some(Err(ImageError::Unsupported(_))) => return Err("neither PNG nor JPEG: convert it to one".to_owned()),
            Some(Err(error)) => {
                return Err(format!("damaged ({}): save it again", crate::one_line(&error.to_string())));
            }
            None => return Err("damaged: save it again".to_owned()),
        };
        Ok(Self { width, height, texels: Stored::new(colors) })
    }

    /// The same as the library has it.
    pub fn texture(&self) -> Option<Texture<'_>> {
        let texels = match &self.texels {
            Stored::Colors(colors) => Texels::Rgb565(colors),
            Stored::Bytes { palette, numbers } => Texels::Palette8 { palette, texels: numbers },
            Stored::Halves { palette, numbers } => Texels::Palette4 { palette, texels: numbers },
        };
        Texture::new(self.width, self.height, texels).ok()
    }
}

/// A picture as the light that it is, which is what can be averaged.
struct Light<'a>(&'a RgbImage);

impl GenericImageView for Light<'_> {
    type Pixel = Rgb<f32>;

    fn dimensions(&self) -> (u32, u32) {
        self.0.dimensions()
    }

    fn get_pixel(&self, x: u32, y: u32) -> Rgb<f32> {
        Rgb(self.0.get_pixel(x, y).0.map(|level| Levels::BITS_8.light(level)))
    }
}

/// A picture of at most so many pixels along a side, and its colours in 16 bits.
fn shrunk(pixels: &RgbImage, most: u32) -> (u16, u16, Vec<u16>) {
    let (width, height) = pixels.dimensions();
    let largest = width.max(height);
    if largest <= most {
        let nearest: Vec<u16> =
            (0..=255).map(|level| u16::from_linear(Vec3::splat(Levels::BITS_8.light(level)))).collect();
        let color = |rgb: [u8; 3]| {
            let [r, g, b] = rgb.map(|level| nearest[usize::from(level)]);
            r & 0xf800 | g & 0x07e0 | b & 0x001f
        };
        return (width as u16, height as u16, pixels.pixels().map(|pixel| color(pixel.0)).collect());
    }
    let side = |length: u32| (length * most / largest).max(1);
    let small = imageops::resize(&Light(pixels), side(width), side(height), imageops::FilterType::Triangle);
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

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A PNG of these pixels.
    pub fn png(width: u32, height: u32, pixels: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header().unwrap().write_image_data(pixels).unwrap();
        bytes
    }

    #[test]
    fn pictures_are_refused_by_what_is_wrong_with_them() {
        let refused = |bytes: &[u8]| Picture::decode(bytes, 256).unwrap_err();
        for (width, height) in [(8193, 1), (1, 8193)] {
            let error = refused(&png(width, height, &vec![0; 3 * 8193]));
            assert_eq!(error, "too large: make it at most 8192 pixels wide and high");
        }
        let widest = Picture::decode(&png(8192, 1, &[0; 3 * 8192]), 256).unwrap();
        assert_eq!((widest.width, widest.height), (256, 1));
        // What it says of itself is all that there is of it.
        let mut huge = png(1, 1, &[0; 3]);
        huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
        let mut crc = flate2::Crc::new();
        crc.update(&huge[12..29]);
        huge[29..33].copy_from_slice(&crc.sum().to_be_bytes());
        assert!(refused(&huge).starts_with("too large: "));
        for other in [&b""[..], b"P6 1 1 255 abc", b"GIF89a"] {
            assert_eq!(refused(other), "neither PNG nor JPEG: convert it to one");
        }
        let whole = png(9, 9, &[0; 243]);
        for end in 8..whole.len() - 12 {
            let error = refused(&whole[..end]);
            assert!(
                error.starts_with("damaged") && error.ends_with(": save it again") && !error.contains('\n'),
                "{error}"
            );
        }
    }

    /// A colour that is the same everywhere is the same at all sizes, the nearest there is.
    #[test]
    fn colours_are_rounded_alike_shrunk_and_as_they_are() {
        for level in 0..=255_u8 {
            let most = |most: u16| (u16::from(level) * most + 127) / 255;
            let nearest = most(31) << 11 | most(63) << 5 | most(31);
            for side in [2, 1] {
                let Picture { texels, .. } = Picture::decode(&png(2, 2, &[level; 12]), side).unwrap();
                let Stored::Colors(colors) = texels else { panic!("{texels:?}") };
                assert!(colors.iter().all(|&color| color == nearest), "{level}: {colors:?}");
            }
        }
    }
}
