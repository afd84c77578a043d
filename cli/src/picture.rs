//! Pictures of 8-bit RGB pixels, rows from the top: PNG files and a preview in the terminal.

use std::fmt::Write as _;
use std::io;
use std::ops::Range;
use std::path::Path;

use crate::output::{OutputError, write_atomically};

/// Writes `pixels` as a PNG; there must be `width * height` of them and one at least.
///
/// # Errors
///
/// What the system says of the file.
pub fn write_png(path: &Path, width: u32, height: u32, pixels: &[[u8; 3]]) -> Result<(), OutputError> {
    write_png_with(path, width, height, pixels, &[])
}

/// As [`write_png`], with texts under keywords.
pub fn write_png_with(
    path: &Path,
    width: u32,
    height: u32,
    pixels: &[[u8; 3]],
    texts: &[(&str, String)],
) -> Result<(), OutputError> {
    write_atomically(path, |file| {
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        for (keyword, text) in texts {
            encoder.add_text_chunk((*keyword).to_owned(), text.clone()).map_err(to_io)?;
        }
        let mut writer = encoder.write_header().map_err(to_io)?;
        writer.write_image_data(pixels.as_flattened()).map_err(to_io)?;
        writer.finish().map_err(to_io)
    })
}

/// Keeps the kind of an error of the disk, which decides how to mend it.
fn to_io(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        error => io::Error::other(error),
    }
}

/// What a PNG holds.
#[derive(Debug)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The pixels.
    pub pixels: Vec<[u8; 3]>,
    /// Texts under keywords.
    pub texts: Vec<(String, String)>,
}

/// Reads a PNG of 8-bit RGB pixels.
pub fn read_png(file: impl io::BufRead + io::Seek) -> Result<Image, String> {
    let mut reader = png::Decoder::new(file).read_info().map_err(explain)?;
    let other = || "its pixels are not 8-bit RGB".to_owned();
    let size = reader.output_buffer_size().ok_or_else(other)?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(explain)?;
    if (frame.color_type, frame.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
        return Err(other());
    }
    reader.finish().map_err(explain)?;
    let texts = reader.info().uncompressed_latin1_text.iter();
    let texts = texts.map(|chunk| (chunk.keyword.clone(), chunk.text.clone())).collect();
    Ok(Image { width: frame.width, height: frame.height, pixels: bytes.as_chunks().0.to_vec(), texts })
}

/// What is wrong with the bytes.
fn explain(error: png::DecodingError) -> String {
    match error {
        png::DecodingError::IoError(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            "it ends too early".to_owned()
        }
        png::DecodingError::IoError(error) => error.to_string(),
        _ => "it is no PNG, or a damaged one".to_owned(),
    }
}

/// Draws `pixels` with half blocks of 24-bit colour, two pixels to a character, shrunk to `columns`
/// characters where they are wider.
pub fn preview(width: u32, height: u32, pixels: &[[u8; 3]], columns: u32) -> String {
    if pixels.is_empty() {
        return String::new();
    }
    let columns = columns.clamp(1, width);
    let rows = (u64::from(height) * u64::from(columns)).div_ceil(u64::from(width)) as u32;
    let mean = |column, row| {
        let (x, y) = (share(column, columns, width), share(row, rows, height));
        box_mean(pixels, width as usize, x, y)
    };
    let mut text = String::new();
    for row in (0..rows).step_by(2) {
        for column in 0..columns {
            let [r, g, b] = mean(column, row);
            let _ = write!(text, "\x1b[38;2;{r};{g};{b}");
            if row + 1 < rows {
                let [r, g, b] = mean(column, row + 1);
                let _ = write!(text, ";48;2;{r};{g};{b}");
            }
            text.push_str("m▀");
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// The pixels, one at least, that fall to the `n`th of `parts` equal parts.
fn share(n: u32, parts: u32, pixels: u32) -> Range<usize> {
    let edge = |n: u32| (u64::from(n) * u64::from(pixels) / u64::from(parts)) as usize;
    let start = edge(n).min((pixels as usize).saturating_sub(1));
    start..edge(n + 1).max(start + 1)
}

/// The mean colour of a rectangle of pixels.
fn box_mean(pixels: &[[u8; 3]], width: usize, x: Range<usize>, y: Range<usize>) -> [u8; 3] {
    let count = (x.len() * y.len()) as u64;
    let mut sum = [0_u64; 3];
    for pixel in y.flat_map(|y| &pixels[y * width..][x.clone()]) {
        for (sum, channel) in sum.iter_mut().zip(pixel) {
            *sum += u64::from(*channel);
        }
    }
    sum.map(|sum| ((sum + count / 2) / count) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_png_reads_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let pixels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [1, 2, 3], [4, 5, 6], [7, 8, 9]];
        write_png(&path, 3, 2, &pixels).unwrap();
        let file = io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!((info.width, info.height, info.color_type), (3, 2, png::ColorType::Rgb));
        assert_eq!(bytes, pixels.as_flattened());
    }

    #[test]
    fn a_png_of_the_wrong_size_is_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        for (width, height) in [(0, 0), (2, 2)] {
            let error = write_png(&path, width, height, &[[0; 3]; 3]).unwrap_err().to_string();
            assert!(!error.contains('\n') && !path.exists(), "{error}");
        }
    }

    #[test]
    fn a_preview_stacks_two_pixels_in_a_character() {
        let pixels = [[1, 2, 3], [9, 9, 9], [4, 5, 6], [8, 8, 8], [7, 7, 7], [0, 0, 0]];
        let expected = "\x1b[38;2;1;2;3;48;2;4;5;6m▀\x1b[38;2;9;9;9;48;2;8;8;8m▀\x1b[0m\n\
                        \x1b[38;2;7;7;7m▀\x1b[38;2;0;0;0m▀\x1b[0m\n";
        assert_eq!(preview(2, 3, &pixels, 80), expected);
    }

    #[test]
    fn a_preview_averages_what_it_shrinks() {
        let pixels = [[0; 3], [10; 3], [20; 3], [30; 3]];
        assert_eq!(preview(2, 2, &pixels, 1), "\x1b[38;2;15;15;15m▀\x1b[0m\n");
        for (width, height) in [(1, 1), (7, 5), (5, 7), (64, 3), (3, 64), (0, 0), (0, 5), (5, 0)] {
            let picture = vec![[7; 3]; (width * height) as usize];
            let lines = (1..100).map(|columns| preview(width, height, &picture, columns));
            assert!(lines.into_iter().all(|text| text.lines().count() <= 32));
        }
    }
}
