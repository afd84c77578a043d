//! [`Difference`]: how two answers to the same rays differ.

use std::fmt;

use crate::hits::HitRecord;

/// How many differing rays [`Difference`] keeps to show.
const SHOWN: usize = 10;

/// How two lists of hits differ. A ray counts under one heading at most.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Difference {
    /// Rays that both lists answer.
    pub rays: usize,
    /// Answers beyond the end of the other list.
    pub unpaired: usize,
    /// Hits in A that B misses.
    pub only_a: usize,
    /// Hits in B that A misses.
    pub only_b: usize,
    /// Hits on different primitives.
    pub primitive: usize,
    /// Those of `primitive` at the same t: ties, decided differently.
    pub tied: usize,
    /// The same answer but for the bits of t.
    pub t: usize,
    /// The largest |a - b| / max(|a|, |b|) over the rays that hit in both.
    pub largest_relative_t: f64,
    /// The first differing rays: number, A's answer, B's answer.
    pub first: Vec<(usize, HitRecord, HitRecord)>,
}

/// Compares two answers bit for bit.
pub fn diff(a: &[HitRecord], b: &[HitRecord]) -> Difference {
    let mut difference =
        Difference { rays: a.len().min(b.len()), unpaired: a.len().abs_diff(b.len()), ..Difference::default() };
    for (ray, (a, b)) in a.iter().copied().zip(b.iter().copied()).enumerate() {
        let same_t = a.t.to_bits() == b.t.to_bits();
        if same_t && a.primitive == b.primitive {
            continue;
        }
        match (a.is_miss(), b.is_miss()) {
            (false, true) => difference.only_a += 1,
            (true, false) => difference.only_b += 1,
            _ if a.primitive == b.primitive => difference.t += 1,
            _ => {
                difference.primitive += 1;
                difference.tied += usize::from(same_t);
            }
        }
        if !a.is_miss() && !b.is_miss() && !same_t {
            let relative = relative(a.t.into(), b.t.into());
            difference.largest_relative_t = difference.largest_relative_t.max(relative);
        }
        if difference.first.len() < SHOWN {
            difference.first.push((ray, a, b));
        }
    }
    difference
}

/// 0 for 0 and -0; infinity where one of them is not finite.
fn relative(a: f64, b: f64) -> f64 {
    let gap = (a - b).abs();
    match gap {
        0.0 => 0.0,
        _ if gap.is_finite() => gap / a.abs().max(b.abs()),
        _ => f64::INFINITY,
    }
}

impl Difference {
    /// Whether the lists are equal bit for bit.
    pub fn is_none(&self) -> bool {
        self.unpaired + self.differing() == 0
    }

    /// How many of `rays` differ.
    pub fn differing(&self) -> usize {
        self.only_a + self.only_b + self.primitive + self.t
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_none() {
            return writeln!(f, "{} rays, no difference", self.rays);
        }
        writeln!(f, "{} rays, {} differ", self.rays, self.differing())?;
        if self.unpaired > 0 {
            writeln!(f, "  unpaired rays        {}", self.unpaired)?;
        }
        writeln!(f, "  hit only in A        {}", self.only_a)?;
        writeln!(f, "  hit only in B        {}", self.only_b)?;
        writeln!(f, "  different primitive  {} ({} at the same t)", self.primitive, self.tied)?;
        writeln!(f, "  different t          {}", self.t)?;
        writeln!(f, "  largest relative t   {:.3e}", self.largest_relative_t)?;
        for (ray, a, b) in &self.first {
            writeln!(f, "ray {ray}: {} | {}", answer(*a), answer(*b))?;
        }
        Ok(())
    }
}

/// A hit in words.
pub fn answer(hit: HitRecord) -> String {
    match hit.is_miss() {
        true => "miss".to_owned(),
        false => format!("{} at t = {}", hit.primitive, hit.t),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(t: f32, primitive: u32) -> HitRecord {
        HitRecord { t, primitive }
    }

    #[test]
    fn equal_lists_do_not_differ() {
        let hits = [hit(f32::NAN, 1), HitRecord::MISS, hit(-0.0, 0)];
        let none = diff(&hits, &hits);
        assert!(none.is_none() && none.first.is_empty());
        assert_eq!(none.to_string(), "3 rays, no difference\n");
        assert!(!diff(&hits, &hits[..2]).is_none());
    }

    #[test]
    fn each_ray_counts_once() {
        let a = [hit(1.0, 0), HitRecord::MISS, hit(2.0, 1), hit(2.0, 1), hit(4.0, 3), hit(0.0, 4)];
        let b = [HitRecord::MISS, hit(1.0, 0), hit(2.0, 2), hit(1.0, 2), hit(5.0, 3), hit(-0.0, 4)];
        let found = diff(&a, &b);
        assert_eq!((found.only_a, found.only_b, found.primitive, found.tied), (1, 1, 2, 1));
        assert_eq!((found.t, found.differing(), found.largest_relative_t), (2, 6, 0.5));
        assert_eq!(found.first[1], (1, a[1], b[1]));
        assert!(found.to_string().contains("ray 0: 0 at t = 1 | miss\n"));
        assert_eq!(diff(&a.repeat(9), &b.repeat(9)).first.len(), SHOWN);
    }
}
