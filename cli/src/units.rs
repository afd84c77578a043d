//! Numbers as people read and write them.

use std::{fmt, str::FromStr};

/// The most pixels of a picture, 400 MB of them.
const MOST_PIXELS: u64 = 1 << 27;

/// The most pixels along a side.
const LONGEST_SIDE: u32 = 65_535;

/// Width and height of a picture, written `640x480`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| text.parse().ok().filter(|side| (1..=LONGEST_SIDE).contains(side));
        let size = text.split_once(['x', 'X']).and_then(|(width, height)| {
            let size = Self { width: side(width)?, height: side(height)? };
            (u64::from(size.width) * u64::from(size.height) <= MOST_PIXELS).then_some(size)
        });
        size.ok_or_else(|| {
            let most = MOST_PIXELS / 1_000_000;
            format!("give WIDTHxHEIGHT such as 640x480, 1 to {LONGEST_SIDE} pixels a side and {most} million in all")
        })
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

/// Reads a number of bytes: `65536`, `64K`, `1.5M`; K, M and G count in 1024s.
pub fn parse_bytes(text: &str) -> Result<usize, String> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[digits.len()..].to_ascii_uppercase().trim_end_matches('B').trim_end_matches('I') {
        "" => Some(1.0),
        "K" => Some(1024.0),
        "M" => Some(1_048_576.0),
        "G" => Some(1_073_741_824.0),
        _ => None,
    };
    let bytes = digits.parse::<f64>().ok().zip(unit).map(|(number, unit)| number * unit);
    match bytes {
        Some(bytes) if (1.0..9.0e15).contains(&bytes) => Ok(bytes as usize),
        _ => Err("give a number of bytes such as 64K, 1.5M or 65536".to_owned()),
    }
}

/// Reads a count: `1000`, `64k`, `4M`; k and M count in 1000s.
pub fn parse_count(text: &str) -> Result<u32, String> {
    let (digits, unit) = match text.strip_suffix(['k', 'K']) {
        Some(digits) => (digits, 1.0e3),
        None => text.strip_suffix(['m', 'M']).map_or((text, 1.0), |digits| (digits, 1.0e6)),
    };
    match digits.parse::<f64>().map(|number| number * unit) {
        Ok(count) if (1.0..1.0e9).contains(&count) => Ok(count as u32),
        _ => Err("give a count such as 1000, 64k or 4M".to_owned()),
    }
}

/// A count with its thousands apart: `1,234,567`.
pub fn count(number: impl TryInto<u64>) -> String {
    let digits = number.try_into().unwrap_or(u64::MAX).to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// So many things: `1 triangle`, `1,234 triangles`.
pub fn things(number: impl TryInto<u64>, one: &str, many: &str) -> String {
    let number = count(number);
    let what = if number == "1" { one } else { many };
    format!("{number} {what}")
}

/// A figure of which the hundreds count: `1,200`.
pub fn hundreds(figure: f64) -> String {
    count((figure / 100.0).round() as u64 * 100)
}

/// A time with three digits that count: `1.23 s`, `45.6 ms`.
pub fn seconds(seconds: f64) -> String {
    match seconds {
        s if s < 0.000_999_5 => format!("{:.0} µs", s * 1.0e6),
        s if s < 0.009_995 => format!("{:.2} ms", s * 1.0e3),
        s if s < 0.099_95 => format!("{:.1} ms", s * 1.0e3),
        s if s < 0.999_5 => format!("{:.0} ms", s * 1.0e3),
        s if s < 9.995 => format!("{s:.2} s"),
        s if s < 99.95 => format!("{s:.1} s"),
        s => format!("{s:.0} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_sensible_or_refused() {
        assert_eq!("640x480".parse(), Ok(Size { width: 640, height: 480 }));
        for bad in ["", "640", "0x0", "640x0", "-1x5", "1e3x1", "65536x1", "60000x60000", "99999999999x1", "1x1x1"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
    }

    #[test]
    fn bytes_have_units() {
        assert_eq!(parse_bytes("65536"), Ok(65536));
        for text in ["64K", "64k", "64KB", "64KiB"] {
            assert_eq!(parse_bytes(text), Ok(65536), "{text}");
        }
        assert_eq!(parse_bytes("1.5M"), Ok(1_572_864));
        for bad in ["", "K", "-1K", "64Q", "nan", "inf", "0", "1e99"] {
            assert!(parse_bytes(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn counts_have_units() {
        assert_eq!(["7", "64k", "1.5K", "4M"].map(|text| parse_count(text).unwrap()), [7, 64_000, 1500, 4_000_000]);
        for bad in ["", "k", "0", "-1", "4G", "nan", "inf", "9999M"] {
            assert!(parse_count(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_are_readable() {
        assert_eq!([0_u64, 999, 1000, 1_234_567].map(count), ["0", "999", "1,000", "1,234,567"]);
        assert_eq!([0_u8, 1, 2].map(|n| things(n, "ray", "rays")), ["0 rays", "1 ray", "2 rays"]);
        assert_eq!([49.0, 885.0, 15_572.0].map(hundreds), ["0", "900", "15,600"]);
        let texts = [0.000_012, 0.001_234, 0.0125, 0.5, 1.234, 12.34, 250.0].map(seconds);
        assert_eq!(texts, ["12 µs", "1.23 ms", "12.5 ms", "500 ms", "1.23 s", "12.3 s", "250 s"]);
    }
}
