use std::collections::HashMap;

use hitscan::{
    geometry::Transform,
    glam::{Mat3, Vec3},
};

use super::file::{File, Place};

/// The most instances, 100 MB of them to a million, and the most steps to find them: some may come to nothing.
const MOST: usize = 1 << 24;

/// A linear map, then a translation.
type Affine = (Mat3, Vec3);

/// The meshes of a world, and which of them stands where.
pub type Places<'a> = (Vec<&'a str>, Vec<(u32, Transform)>);

/// Lists all places of meshes one by one.
pub fn expand(file: &File) -> Result<Places<'_>, String> {
    let mut meshes = Vec::new();
    let mut known = HashMap::new();
    let mut placed = Vec::new();
    let mut steps = 0;
    let mut work = vec![(&file.place[..], (Mat3::IDENTITY, Vec3::ZERO), 0)];
    while let Some((places, outer, depth)) = work.pop() {
        for place in places {
            steps += 1;
            let part = file.part.get(&place.part).ok_or_else(|| format!("there is no part {:?}", place.part))?;
            // Without a circle no part can lie deeper than there are parts.
            if depth > file.part.len() {
                return Err(format!("part {:?} is a part of itself", place.part));
            }
            let number = match (&part.mesh, part.place.is_empty()) {
                (Some(mesh), true) => Some(*known.entry(mesh.as_str()).or_insert_with(|| {
                    meshes.push(mesh.as_str());
                    meshes.len() as u32 - 1
                })),
                (None, false) => None,
                _ => return Err(format!("part {:?} must have either a mesh or places", place.part)),
            };
            for inner in spread(place)? {
                let at = compose(&outer, &inner);
                match number {
                    Some(number) => {
                        let transform = Transform::new(at.0, at.1)
                            .map_err(|error| format!("a place of part {:?}: {error}", place.part))?;
                        placed.push((number, transform));
                    }
                    None => work.push((&part.place, at, depth + 1)),
                }
                steps += 1;
                if steps > MOST {
                    return Err(format!("more than {MOST} places"));
                }
            }
        }
    }
    if placed.is_empty() { Err("places nothing".to_owned()) } else { Ok((meshes, placed)) }
}

/// All places that one entry stands for.
fn spread(place: &Place) -> Result<impl Iterator<Item = Affine> + use<'_>, String> {
    let [x, y, z] = place.grid.unwrap_or([1; 3]).map(u64::from);
    let cells = x.saturating_mul(y).saturating_mul(z);
    let count = match (place.grid, place.scatter) {
        (Some(_), Some(_)) => return Err("a place is either a grid or scattered".to_owned()),
        (None, Some(count)) => count.into(),
        _ => cells,
    };
    if count > MOST as u64 {
        return Err(format!("more than {MOST} places"));
    }
    let (from, to, step) = (Vec3::from(place.from), Vec3::from(place.to), Vec3::from(place.step));
    let whole = (turn(Vec3::from(place.turn)) * place.scale, Vec3::from(place.at));
    let mut chance = Chance(place.seed);
    Ok((0..count).map(move |n| {
        let at = match place.scatter {
            Some(_) => from + (to - from) * chance.point(),
            None => step * Vec3::new((n % x) as f32, (n / x % y) as f32, (n / x / y) as f32),
        };
        let turned = turn(Vec3::from(place.turns) * chance.point());
        let [grown, larger] = [1.0 + place.scales * chance.number(), chance.number()];
        let factor = if larger < 0.5 { grown } else { 1.0 / grown };
        compose(&whole, &(turned * factor, at))
    }))
}

fn compose(outer: &Affine, inner: &Affine) -> Affine {
    (outer.0 * inner.0, outer.0 * inner.1 + outer.1)
}

fn turn(degrees: Vec3) -> Mat3 {
    let angle = |axis: usize| degrees[axis].to_radians();
    Mat3::from_rotation_z(angle(2)) * Mat3::from_rotation_y(angle(1)) * Mat3::from_rotation_x(angle(0))
}

/// Numbers that look like chance and are the same everywhere: Steele, Lea, Flood, *Fast splittable pseudorandom number
/// generators*, 2014.
#[derive(Debug)]
pub struct Chance(pub u64);

impl Chance {
    /// From 0 to before 1.
    pub fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) >> 40) as f32 / (1 << 24) as f32
    }

    /// Anywhere in the unit cube.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn world(text: &str) -> Result<(usize, Vec<Vec3>), String> {
        let file: File = toml::from_str(text).unwrap();
        let (meshes, places) = expand(&file)?;
        Ok((meshes.len(), places.iter().map(|(_, transform)| transform.point(Vec3::X)).collect()))
    }

    #[test]
    fn the_example_of_the_help_is_a_world() {
        let (meshes, points) = world(super::super::EXAMPLE).unwrap();
        assert_eq!((meshes, points.len()), (1, 1009));
    }

    #[test]
    fn grids_of_groups_are_laid_out() {
        let text = "[part.a]\nmesh = \"a.obj\"\n[part.b]\nmesh = \"a.obj\"\n\
                    [[part.row.place]]\npart = \"a\"\ngrid = [2, 1, 1]\nstep = [10, 0, 0]\n\
                    [[place]]\npart = \"row\"\nat = [0, 5, 0]\nturn = [0, 0, 90]\nscale = 2\n\
                    [[place]]\npart = \"b\"\n";
        let (meshes, points) = world(text).unwrap();
        assert_eq!(meshes, 1);
        let expected = [Vec3::X, Vec3::new(0.0, 7.0, 0.0), Vec3::new(0.0, 27.0, 0.0)];
        assert_eq!(points.len(), 3);
        assert!(points.iter().zip(expected).all(|(a, b)| a.distance(b) < 1.0e-4), "{points:?}");
    }

    #[test]
    fn chance_repeats_itself_and_stays_in_its_box() {
        let text = "[part.a]\nmesh = \"a.obj\"\n[[place]]\npart = \"a\"\nscatter = 500\nfrom = [5, 0, 5]\nto = [9, 0, 9]\n\
                    turns = [0, 360, 0]\nscales = 0.5\nseed = 3\n";
        let (_, points) = world(text).unwrap();
        assert_eq!(points, world(text).unwrap().1);
        assert_ne!(points, world(&text.replace("seed = 3", "seed = 4")).unwrap().1);
        assert_eq!(points.len(), 500);
        assert!(points.iter().all(|p| p.y == 0.0 && (3.5..=10.5).contains(&p.x) && (3.5..=10.5).contains(&p.z)));
        let mean = points.iter().sum::<Vec3>() / 500.0;
        assert!((mean - Vec3::new(7.0, 0.0, 7.0)).length() < 0.3, "{mean}");
    }

    #[test]
    fn circles_gaps_and_crowds_are_refused() {
        let part = "[part.a]\nmesh = \"a.obj\"\n[[part.b.place]]\npart = \"a\"\n";
        for (text, why) in [
            ("[[place]]\npart = \"c\"\n", "no part \"c\""),
            ("", "places nothing"),
            ("[part.c]\n[[place]]\npart = \"c\"\n", "either a mesh or places"),
            ("[[part.c.place]]\npart = \"c\"\n[[place]]\npart = \"c\"\n", "part of itself"),
            ("[[place]]\npart = \"a\"\ngrid = [1000000, 1000000, 1000000]\n", "more than"),
            ("[[place]]\npart = \"a\"\nscatter = 5\ngrid = [1, 1, 1]\n", "either a grid"),
            ("[[place]]\npart = \"a\"\nscale = 0\n", "cannot be inverted"),
            ("[[place]]\npart = \"a\"\ngrid = [0, 1, 1]\n", "places nothing"),
        ] {
            let error = world(&format!("{part}{text}")).unwrap_err();
            assert!(error.contains(why), "{text}: {error}");
        }
    }
}
