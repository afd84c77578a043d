use hitscan::{
    glam::{Quat, Vec3},
    render::Material,
};

use super::places::Chance;
use crate::scene::{Geometry, Palette};

/// How often branches divide.
const LEVELS: u32 = 3;

/// Branches that a branch divides into.
const FORKS: u32 = 5;

/// Leaves at each of the last branches.
const LEAVES: u32 = 14;

/// Pieces along a branch, and sides of it.
const PIECES: u32 = 5;
const SIDES: u32 = 6;

/// Pieces along a leaf.
const STRIPS: u32 = 7;

/// What has grown so far.
#[derive(Default)]
struct Growth {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    palette: Palette,
}

/// A branch that has not grown yet.
struct Bud {
    level: u32,
    base: Vec3,
    along: Vec3,
    length: f32,
    thickness: f32,
}

/// A shrub about as high as 1 that stands at the origin, y up: another one for every seed, always of the same number of
/// triangles. After Prusinkiewicz and Lindenmayer, *The algorithmic beauty of plants*, 1990.
pub fn grow(seed: u64) -> Geometry {
    let mut chance = Chance(seed);
    let mut plant = Growth::default();
    let (green, blossom) = (chance.number(), chance.point());
    let mut buds = vec![Bud { level: 0, base: Vec3::ZERO, along: Vec3::Y, length: 0.3, thickness: 0.02 }];
    while let Some(bud) = buds.pop() {
        let path = plant.branch(&bud, &mut chance);
        let tip = path[PIECES as usize];
        let along = (tip - path[PIECES as usize - 1]).normalize_or(Vec3::Y);
        if bud.level == LEVELS {
            for n in 0..LEAVES {
                let base = path[(1 + n % PIECES) as usize];
                let away = Quat::from_axis_angle(along, n as f32 * 2.4) * along.any_orthonormal_vector();
                plant.leaf(base, (away + along * 0.6 + Vec3::Y * 0.25).normalize(), green, &mut chance);
            }
            plant.blossom(tip, along, blossom);
            continue;
        }
        for n in 0..FORKS {
            let away = Quat::from_axis_angle(along, (n as f32 + chance.number() * 0.7) * 1.2566) * sideways(along);
            let spread = 0.55 + 0.5 * chance.number();
            buds.push(Bud {
                level: bud.level + 1,
                base: if n % 2 == 0 { tip } else { path[PIECES as usize - 1] },
                along: (along + away * spread).normalize(),
                length: bud.length * (0.62 + 0.25 * chance.number()),
                thickness: bud.thickness * 0.55,
            });
        }
    }
    Geometry::new(plant.vertices, plant.triangles, plant.palette)
}

/// Some direction across another.
fn sideways(along: Vec3) -> Vec3 {
    along.any_orthonormal_vector()
}

impl Growth {
    /// Adds a branch that strives upwards; its path from base to tip.
    fn branch(&mut self, bud: &Bud, chance: &mut Chance) -> Vec<Vec3> {
        let first = self.vertices.len() as u32;
        let (mut at, mut along) = (bud.base, bud.along);
        let mut path = Vec::new();
        for piece in 0..=PIECES {
            path.push(at);
            let thickness = bud.thickness * (1.0 - 0.45 * piece as f32 / PIECES as f32);
            let across = sideways(along);
            for side in 0..SIDES {
                let turn = Quat::from_axis_angle(along, side as f32 / SIDES as f32 * std::f32::consts::TAU);
                self.vertices.push(at + turn * across * thickness);
            }
            at += along * (bud.length / PIECES as f32);
            along = (along + Vec3::Y * 0.08 + (chance.point() - 0.5) * 0.25).normalize();
        }
        let before = self.triangles.len();
        for piece in 0..PIECES {
            for side in 0..SIDES {
                let corner = |piece: u32, side: u32| first + piece * SIDES + side % SIDES;
                let [a, b] = [corner(piece, side), corner(piece, side + 1)];
                let [c, d] = [corner(piece + 1, side), corner(piece + 1, side + 1)];
                self.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        let bark = Material::matte(Vec3::new(0.13, 0.085, 0.05));
        self.palette.push(bark, self.triangles.len() - before);
        path
    }

    /// Adds a strip that widens, narrows and bends down.
    fn leaf(&mut self, base: Vec3, along: Vec3, green: f32, chance: &mut Chance) {
        let across = along.cross(Vec3::Y).normalize_or(Vec3::X);
        let length = 0.075 * (0.7 + 0.6 * chance.number());
        let points = (0..=STRIPS).flat_map(|strip| {
            let at = strip as f32 / STRIPS as f32;
            let middle = base + along * (at * length) - Vec3::Y * (at * at * length * 0.4);
            let half = across * (length * 0.9 * at * (1.0 - at) + length * 0.01);
            let fold = Vec3::Y * (half.length() * 0.35);
            [middle - half + fold, middle, middle + half + fold]
        });
        let tint = (chance.number() * 8.0).floor() / 8.0;
        let color = Vec3::new(0.05 + 0.10 * green + 0.05 * tint, 0.16 + 0.14 * tint + 0.05 * green, 0.03);
        let leaf = Material::matte(color).with_highlights(0.08, 20.0);
        self.strips(points.collect(), 3, leaf);
    }

    /// Adds petals around a tip.
    fn blossom(&mut self, tip: Vec3, along: Vec3, color: Vec3) {
        const PETALS: u32 = 6;
        let material = Material::matte(Vec3::new(0.55, 0.1, 0.2) + color * Vec3::new(0.4, 0.5, 0.4));
        for petal in 0..PETALS {
            let turn = Quat::from_axis_angle(along, petal as f32 / PETALS as f32 * std::f32::consts::TAU);
            let (out, across) = (turn * sideways(along), along.cross(turn * sideways(along)));
            let points = (0..=3).flat_map(|strip| {
                let at = strip as f32 / 3.0;
                let middle = tip + (out * at + along * (at * (1.2 - at))) * 0.026;
                let half = across * (0.026 * (0.15 + at * (1.25 - at)));
                [middle - half, middle + half]
            });
            self.strips(points.collect(), 2, material);
        }
    }

    /// Adds rows of points, so many in each, joined by triangles.
    fn strips(&mut self, points: Vec<Vec3>, row: u32, material: Material) {
        let (first, before) = (self.vertices.len() as u32, self.triangles.len());
        let rows = points.len() as u32 / row;
        self.vertices.extend(points);
        for (strip, column) in (0..rows - 1).flat_map(|strip| (0..row - 1).map(move |column| (strip, column))) {
            let a = first + strip * row + column;
            self.triangles.extend([[a, a + 1, a + row], [a + 1, a + row + 1, a + row]]);
        }
        self.palette.push(material, self.triangles.len() - before);
    }
}

#[cfg(test)]
mod tests {
    use hitscan::{Primitives, geometry::Aabb};

    use super::*;

    #[test]
    fn plants_stand_upright_and_differ() {
        let [one, again, other] = [1, 1, 2].map(grow);
        assert!(one.vertices == again.vertices && one.vertices != other.vertices);
        assert_eq!(one.len(), other.len());
        assert!(one.len() > 40_000, "{}", one.len());
        for plant in [&one, &other] {
            assert_eq!(plant.mesh().unwrap().len() as usize, plant.len());
            let bounds = Aabb::around(plant.vertices.iter().copied());
            assert!(bounds.min.y > -0.2 && (0.6..1.6).contains(&bounds.max.y), "{bounds:?}");
            assert!(plant.palette.materials.len() > 5);
        }
    }
}
