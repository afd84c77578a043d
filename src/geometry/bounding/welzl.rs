use glam::Vec3;

use super::{
    sphere::centered,
    wide::{Wide, add, cross, dot, scale, square, sub, wide},
};
use crate::geometry::Sphere;

/// The most passes over the points; 26 real meshes need three to nine.
const PASSES: u32 = 64;

/// How far outside, in parts of the squared radius, a point counts as inside: 2^-40, far below the rounding of the
/// centre.
const TOLERANCE: f64 = 1.0 + 1.0 / 1_099_511_627_776.0;

/// A centre and a squared radius.
#[derive(Clone, Copy)]
struct Ball {
    center: Wide,
    square: f64,
}

impl Ball {
    /// The least ball with `first` and all of `others`, of which there are up to three, on its surface; `None` if there
    /// is none, because they lie on a line or in a plane.
    fn through(first: Wide, others: &[Wide]) -> Option<Self> {
        let way = |p: &Wide| (sub(*p, first), square(sub(*p, first)));
        let offset = match others {
            [] => [0.0; 3],
            [p] => scale(way(p).0, 0.5),
            [p, q] => {
                let ((p, pp), (q, qq)) = (way(p), way(q));
                let normal = cross(p, q);
                let toward = cross(sub(scale(q, pp), scale(p, qq)), normal);
                divided(toward, 2.0 * square(normal))?
            }
            [p, q, r, ..] => {
                let ((p, pp), (q, qq), (r, rr)) = (way(p), way(q), way(r));
                let sum = add(add(scale(cross(q, r), pp), scale(cross(r, p), qq)), scale(cross(p, q), rr));
                divided(sum, 2.0 * dot(p, cross(q, r)))?
            }
        };
        Some(Self { center: add(first, offset), square: square(offset) })
    }

    fn contains(&self, point: Wide) -> bool {
        square(sub(point, self.center)) <= self.square * TOLERANCE
    }

    /// The least ball around `pivot` and `border` that has `pivot` on its surface, and which of `border` it touches.
    fn least(pivot: Wide, border: &[Wide]) -> Option<(Self, heapless::Vec<Wide, 4>)> {
        let mut best: Option<(Self, heapless::Vec<Wide, 4>)> = None;
        for chosen in 0_u32..1 << border.len().min(4) {
            if chosen.count_ones() > 3 {
                continue;
            }
            let mut surface: heapless::Vec<Wide, 4> = heapless::Vec::new();
            for (_, point) in border.iter().enumerate().filter(|(i, _)| chosen >> i & 1 == 1) {
                // Cannot fail: there are three at most, and the pivot.
                let _ = surface.push(*point);
            }
            let Some(ball) = Self::through(pivot, &surface) else { continue };
            let smaller = best.as_ref().is_none_or(|(best, _)| ball.square < best.square);
            if smaller && border.iter().all(|p| ball.contains(*p)) {
                let _ = surface.push(pivot);
                best = Some((ball, surface));
            }
        }
        best
    }
}

fn divided(v: Wide, by: f64) -> Option<Wide> {
    let v = v.map(|x| x / by);
    v.iter().all(|x| x.is_finite()).then_some(v)
}

/// The point farthest from `center`, and the square of how far.
fn farthest(center: Wide, points: impl Iterator<Item = Wide>) -> Option<(Wide, f64)> {
    points.fold(None, |found, p| {
        let away = square(sub(p, center));
        if found.is_none_or(|(_, least)| away > least) { Some((p, away)) } else { found }
    })
}

impl Sphere {
    /// The least sphere, up to the rounding of its centre.
    ///
    /// Welzl, *Smallest enclosing disks (balls and ellipsoids)*, 1991, as Gärtner, *Fast and robust smallest enclosing
    /// balls*, 1999, moves points to the front: always the one farthest outside. The front is then never longer than
    /// the at most four points that the ball rests on, so the points need not be moved, or copied, at all, and instead
    /// of a recursion the fifteen balls through parts of the front are looked at.
    ///
    /// Each pass makes the ball larger. There are at most 66, and ten at most on 26 real meshes; were they not enough,
    /// the sphere would be made larger than it need be.
    #[must_use]
    pub fn welzl(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        // Seen from one of them, so that those far from the origin keep their digits.
        let origin = wide(points.clone().next()?);
        let seen = points.clone().map(|p| sub(wide(p), origin));
        let mut ball = Ball { center: [0.0; 3], square: 0.0 };
        let mut front: heapless::Vec<Wide, 4> = heapless::Vec::new();
        for _ in 0..PASSES {
            let (pivot, away) = farthest(ball.center, seen.clone())?;
            if away <= ball.square * TOLERANCE {
                break;
            }
            match Ball::least(pivot, &front) {
                Some((larger, surface)) if larger.square > ball.square || front.is_empty() => {
                    (ball, front) = (larger, surface);
                }
                // Nothing but roundings is left to gain.
                _ => break,
            }
        }
        centered(add(origin, ball.center), points)
    }
}
