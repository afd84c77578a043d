//! Triangles and rays of whole numbers against exact arithmetic, and the same scaled by powers of two.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

mod common;

use common::{Random, bits, meshes::separate, plans, rays, seed};
use hitscan::{Hit, List, Mesh, Ray, Scene, accel::Structure, glam::Vec3};

/// A point or a direction.
type Whole = [i64; 3];

/// A scene of whole numbers of a size.
struct Case {
    triangles: Vec<[Whole; 3]>,
    size: usize,
}

fn whole(random: &mut Random, size: usize) -> Whole {
    [0; 3].map(|_| random.below(2 * size + 1) as i64 - size as i64)
}

fn difference(a: Whole, b: Whole) -> Whole {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a · (b × c)`; of numbers up to 2^21 it needs 66 bits.
fn determinant(a: Whole, b: Whole, c: Whole) -> i128 {
    let [a, b, c] = [a, b, c].map(|v| v.map(i128::from));
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Where a line meets a closed triangle, as a quotient; lines in its plane do not.
fn crossing(triangle: [Whole; 3], origin: Whole, direction: Whole) -> Option<(i128, i128)> {
    let [a, b, c] = triangle.map(|corner| difference(corner, origin));
    let edges = [determinant(direction, b, c), determinant(direction, c, a), determinant(direction, a, b)];
    let divisor: i128 = edges.iter().sum();
    let one_sided = edges.iter().all(|edge| *edge >= 0) || edges.iter().all(|edge| *edge <= 0);
    (one_sided && divisor != 0).then(|| (determinant(a, b, c), divisor))
}

impl Case {
    fn new(random: &mut Random, most: usize) -> Self {
        let size = random.pick(&[1, 2, 3, 7, 100, 5000, most]);
        let pool: Vec<Whole> = (0..3 + random.below(9)).map(|_| whole(random, size)).collect();
        let pooled = random.one_in(2);
        let corner = |random: &mut Random| if pooled { random.pick(&pool) } else { whole(random, size) };
        let triangles = (0..1 + random.below(40)).map(|_| [(); 3].map(|()| corner(random))).collect();
        Self { triangles, size }
    }

    /// A ray at a corner, at an edge, along axes or anywhere.
    fn ray(&self, random: &mut Random) -> [Whole; 2] {
        let [a, b, c] = random.pick(&self.triangles);
        let origin = if random.one_in(3) { a } else { whole(random, self.size) };
        let middle = [0, 1, 2].map(|k| b[k] + c[k] - 2 * origin[k]);
        let axes = whole(random, 1);
        let choice = [difference(a, origin), middle, difference(whole(random, self.size), origin), axes];
        [origin, random.pick(&choice)]
    }

    /// The primitives that a ray from `t = 0` meets, and where.
    fn hits(&self, origin: Whole, direction: Whole) -> Vec<(u32, f64)> {
        let crossings = self.triangles.iter().zip(0..).filter_map(|(&triangle, number)| {
            let (above, below) = crossing(triangle, origin, direction)?;
            // A quotient of two roundings, far better than the 2^-17 that are promised.
            (above == 0 || (above > 0) == (below > 0)).then(|| (number, above as f64 / below as f64))
        });
        crossings.collect()
    }

    /// The triangles, each length multiplied by a power of two.
    fn scaled(&self, factor: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        separate(self.triangles.iter().flatten().map(|&corner| float(corner) * factor).collect())
    }
}

/// Whole numbers up to 2^23 are floats.
fn float(whole: Whole) -> Vec3 {
    Vec3::from_array(whole.map(|x| x as f32))
}

fn power(exponent: i32) -> f32 {
    2.0_f32.powi(exponent)
}

/// Whether `t` is as near to the exact one as is promised.
fn near(t: f32, exact: f64) -> bool {
    (f64::from(t) - exact).abs() <= exact.abs() * 2.0_f64.powi(-17)
}

#[test]
fn hits_are_those_of_exact_arithmetic() {
    let wanted = rays(100_000);
    let mut random = Random::new(31 + 100 * seed());
    let mut memory = vec![0; 1 << 16];
    let (mut cast, mut met) = (0, 0);
    while cast < wanted {
        let case = Case::new(&mut random, 1 << 20);
        let (vertices, triangles) = case.scaled(1.0);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let kind = random.below(plans::KINDS);
        let Some((plan, built)) = plans::build(&mut random, kind, &mesh, &mut memory) else { continue };
        let (list, scene) = (Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap(), Scene::new(built, &mesh).unwrap());
        for _ in 0..40 {
            let [origin, direction] = case.ray(&mut random);
            let ray = Ray::new(float(origin), float(direction));
            if ray.prepare().is_none() {
                continue;
            }
            cast += 1;
            let expected = case.hits(origin, direction);
            met += usize::from(!expected.is_empty());
            // All primitives that are met and no other, each where it is.
            let mut hits: Vec<Hit> = list.hits(&ray).collect();
            assert!(scene.hits(&ray).eq(hits.iter().copied()), "{plan:?} {ray:?} {vertices:?}");
            assert_eq!(bits(scene.closest_hit(&ray)), bits(hits.first().copied()), "{plan:?} {ray:?} {vertices:?}");
            hits.sort_unstable_by_key(|hit| hit.primitive);
            let same = hits.len() == expected.len()
                && hits.iter().zip(&expected).all(|(hit, &(number, t))| hit.primitive == number && near(hit.t, t));
            assert!(same, "{ray:?} {vertices:?}: {hits:?} instead of {expected:?}");
        }
    }
    assert!(met * 4 > cast && met < cast, "{met} of {cast}");
}

#[test]
fn powers_of_two_change_nothing() {
    let wanted = rays(100_000);
    let mut random = Random::new(32 + 100 * seed());
    let mut memory = vec![0; 1 << 16];
    let (mut cast, mut met) = (0, 0);
    while cast < wanted {
        let case = Case::new(&mut random, 1 << 16);
        let (vertices, triangles) = case.scaled(1.0);
        let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let rays: Vec<Ray> = (0..8).map(|_| case.ray(&mut random).map(float)).map(|[o, d]| Ray::new(o, d)).collect();
        let expected: Vec<Option<Hit>> = rays.iter().map(|ray| list.closest_hit(ray)).collect();
        for exponent in -40..=40 {
            let factor = power(exponent);
            let (vertices, triangles) = case.scaled(factor);
            let mesh = Mesh::new(&vertices, &triangles[..]).unwrap();
            let plan = plans::random(&mut random, exponent.unsigned_abs() as usize % plans::KINDS);
            let built = Structure::build(&mesh, &mut hitscan::Arena::new(&mut memory), &plan);
            let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
            for (ray, hit) in rays.iter().zip(&expected) {
                // The scene and the ray scaled, and the scene alone, where `t` is as many times as large.
                for (along, t) in [(factor, 1.0), (1.0, factor)] {
                    let scaled = Ray::new(ray.origin * factor, ray.direction * along);
                    let hit = hit.map(|hit| Hit { t: hit.t * t, ..hit });
                    assert_eq!(bits(list.closest_hit(&scaled)), bits(hit), "2^{exponent} {ray:?} {vertices:?}");
                    if let Ok(built) = &built {
                        let scene = Scene::new(*built, &mesh).unwrap();
                        assert_eq!(bits(scene.closest_hit(&scaled)), bits(hit), "2^{exponent} {plan:?} {ray:?}");
                    }
                }
                cast += 1;
                met += usize::from(hit.is_some());
            }
        }
    }
    assert!(met * 4 > cast && met < cast, "{met} of {cast}");
}
