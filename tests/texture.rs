//! Textures: colours are those of an oracle in double precision, and what is baked is read back.
#![allow(missing_docs)]

mod common;

use common::Random;
use hitscan::{
    Hit, List, Mesh, Ray, Scene,
    glam::{DVec2, DVec3, Vec2, Vec3},
    primitives::{Mapped, Smooth, TexCoords},
    render::{
        Camera, Caster, Color, Filter, Material, Materials, Numbers, Renderer, Texels, Texture, TextureError, Textured,
        Textures, Wrap,
    },
};

/// sRGB in RGB565 as linear light, by the definition.
fn light(color: u16) -> DVec3 {
    let channel = |level: u16, most: f64| {
        let x = f64::from(level) / most;
        if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    };
    DVec3::new(channel(color >> 11, 31.0), channel(color >> 5 & 63, 63.0), channel(color & 31, 31.0))
}

/// A picture with every pixel spelt out.
struct Plain {
    width: usize,
    height: usize,
    colors: Vec<u16>,
}

impl Plain {
    fn at(&self, x: i64, y: i64, wrap: Wrap) -> DVec3 {
        let within = |at: i64, size: usize| match wrap {
            Wrap::Repeat => at.rem_euclid(size as i64) as usize,
            Wrap::Clamp => at.clamp(0, size as i64 - 1) as usize,
        };
        light(self.colors[within(y, self.height) * self.width + within(x, self.width)])
    }

    fn color(&self, uv: Vec2, filter: Filter, wrap: Wrap) -> DVec3 {
        let at = uv.as_dvec2() * DVec2::new(self.width as f64, self.height as f64);
        if filter == Filter::Nearest {
            return self.at(at.x.floor() as i64, at.y.floor() as i64, wrap);
        }
        let at = at - 0.5;
        let (x, y, part) = (at.x.floor() as i64, at.y.floor() as i64, at - at.floor());
        let row = |y| self.at(x, y, wrap).lerp(self.at(x + 1, y, wrap), part.x);
        row(y).lerp(row(y + 1), part.y)
    }
}

/// A number of colours, of which there are at most so many, packed as they are to be.
struct Picture {
    plain: Plain,
    palette: Vec<u16>,
    numbers: Vec<u8>,
}

impl Picture {
    fn new(random: &mut Random, colors: usize) -> Self {
        let (width, height) = (1 + random.below(9), 1 + random.below(9));
        let palette: Vec<u16> = (0..colors).map(|_| random.below(1 << 16) as u16).collect();
        let pick: Vec<u8> = (0..width * height).map(|_| random.below(colors) as u8).collect();
        let plain = Plain { width, height, colors: pick.iter().map(|&n| palette[usize::from(n)]).collect() };
        let numbers = match colors {
            ..=16 => pick.chunks(2).map(|pair| pair[0] | pair.get(1).map_or(0, |high| high << 4)).collect(),
            _ => pick,
        };
        Self { plain, palette, numbers }
    }

    fn texels(&self, kind: u32) -> Texels<'_> {
        let (palette, texels) = (&self.palette[..], &self.numbers[..]);
        match kind {
            0 => Texels::Rgb565(&self.plain.colors),
            1 => Texels::Palette8 { palette, texels },
            _ => Texels::Palette4 { palette, texels },
        }
    }

    fn texture(&self, kind: u32) -> Texture<'_> {
        Texture::new(self.plain.width as u16, self.plain.height as u16, self.texels(kind)).unwrap()
    }
}

const FILTERS: [Filter; 2] = [Filter::Bilinear, Filter::Nearest];
const WRAPS: [Wrap; 2] = [Wrap::Repeat, Wrap::Clamp];

/// Whether a coordinate is so near to where a texel ends that rounding may choose its neighbour.
fn is_edge(at: f32, size: usize) -> bool {
    let place = f64::from(at) * size as f64;
    (place - place.round()).abs() < 1.0e-4
}

#[test]
fn colours_are_those_of_double_precision() {
    let mut random = Random::new(1);
    for round in 0..600_u32 {
        let kind = round % 3;
        let picture = Picture::new(&mut random, [40, 200, 16][kind as usize]);
        let plain = &picture.plain;
        for (filter, wrap) in FILTERS.into_iter().flat_map(|filter| WRAPS.map(|wrap| (filter, wrap))) {
            let texture = picture.texture(kind).with_filter(filter).with_wrap(wrap);
            for _ in 0..40 {
                let uv = Vec2::new(random.unit() * 6.0 - 3.0, random.unit() * 6.0 - 3.0);
                let (color, expected) = (texture.color(uv).as_dvec3(), plain.color(uv, filter, wrap));
                let is_near = is_edge(uv.x, plain.width) || is_edge(uv.y, plain.height);
                if filter == Filter::Bilinear || !is_near {
                    let off = (color - expected).abs().max_element();
                    assert!(off < 1.0e-4, "{filter:?} {wrap:?} {uv}: {color} {expected}");
                }
            }
        }
    }
}

#[test]
fn any_coordinates_are_answered() {
    let mut random = Random::new(2);
    let picture = Picture::new(&mut random, 16);
    let odd = [0.0, -0.0, 1.0, -1.0, 1.0e-45, -1.0e-45, 1.0 - 1.0e-7, 1.0e30, -1.0e30, f32::MAX, f32::MIN];
    let odd = odd.into_iter().chain([f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
    for filter in FILTERS {
        for wrap in WRAPS {
            let texture = picture.texture(2).with_filter(filter).with_wrap(wrap);
            for (u, v) in odd.clone().flat_map(|u| odd.clone().map(move |v| (u, v))) {
                let color = texture.color(Vec2::new(u, v));
                assert!(color.cmpge(Vec3::ZERO).all() && color.cmple(Vec3::ONE).all(), "{u} {v}: {color}");
            }
            assert_eq!(texture.color(Vec2::NAN), texture.color(Vec2::ZERO));
        }
    }
}

#[test]
fn what_is_no_picture_is_refused() {
    let texels = [0_u16; 6];
    assert!(Texture::new(3, 2, Texels::Rgb565(&texels)).is_ok());
    assert_eq!(Texture::new(0, 2, Texels::Rgb565(&[])).unwrap_err(), TextureError::Empty);
    assert_eq!(Texture::new(2, 0, Texels::Rgb565(&[])).unwrap_err(), TextureError::Empty);
    let error = TextureError::Texels { expected: 8, found: 6 };
    assert_eq!(Texture::new(4, 2, Texels::Rgb565(&texels)).unwrap_err(), error);
    let halves = Texels::Palette4 { palette: &[], texels: &[0; 3] };
    assert!(Texture::new(5, 1, halves).is_ok() && Texture::new(3, 1, halves).is_err());
    // A palette without the colour: black.
    assert_eq!(Texture::new(5, 1, halves).unwrap().color(Vec2::ZERO), Vec3::ZERO);
}

/// A square of two triangles that lies in the picture as it lies in the plane, and one triangle without coordinates.
const VERTICES: [Vec3; 7] = [
    Vec3::ZERO,
    Vec3::X,
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::Y,
    Vec3::new(2.0, 0.0, 0.0),
    Vec3::new(3.1, 0.0, 0.0),
    Vec3::new(2.0, 1.1, 0.0),
];
const TRIANGLES: [[u16; 3]; 3] = [[0, 1, 2], [0, 2, 3], [4, 5, 6]];

fn down(x: f32, y: f32) -> Ray {
    Ray::new(Vec3::new(x, y, 1.0), Vec3::NEG_Z)
}

#[test]
fn coordinates_follow_the_surface() {
    let mesh = Mesh::new(&VERTICES, &TRIANGLES).unwrap();
    let coordinates: Vec<Vec2> = VERTICES[..4].iter().map(|at| at.truncate() * 3.0 - 1.0).collect();
    let normals = [Vec3::Z; 7];
    let smooth = Mapped::new(Smooth::new(mesh, &normals), &mesh, TexCoords::new(&coordinates));
    let (scene, plain) =
        (Scene::new(List::new(&mesh).unwrap(), smooth).unwrap(), Scene::new(List::new(&mesh).unwrap(), mesh).unwrap());
    let mut random = Random::new(4);
    for _ in 0..1000 {
        let ray = down(random.unit(), random.unit());
        let hit = scene.closest_hit(&ray).unwrap();
        assert_eq!(Some(hit), plain.closest_hit(&ray));
        let surface = scene.surface(&ray, &hit);
        let expected = ray.origin.truncate() * 3.0 - 1.0;
        assert!(surface.uv.distance(expected) < 1.0e-5, "{} {expected}", surface.uv);
    }
    let beside = down(2.25, 0.5);
    let hit = scene.closest_hit(&beside).unwrap();
    assert_eq!(scene.surface(&beside, &hit).uv, plain.surface(&beside, &hit).uv);
    assert_eq!(
        scene.surface(&beside, &Hit { t: 1.0, primitive: 99 }).uv,
        plain.surface(&beside, &Hit { t: 1.0, primitive: 99 }).uv
    );
}

#[test]
fn pictures_show_textures() {
    let mesh = Mesh::new(&VERTICES, &TRIANGLES).unwrap();
    let coordinates: Vec<Vec2> = VERTICES[..4].iter().map(|at| Vec2::new(at.x, 1.0 - at.y)).collect();
    let scene = Mapped::new(mesh, &mesh, TexCoords::new(&coordinates));
    let scene = Scene::new(List::new(&mesh).unwrap(), scene).unwrap();
    // An arrow that points up and left: neither turned nor mirrored does it look the same.
    let arrow = "##### ##... #.#.. #..#. #...#".split(' ').flat_map(str::chars);
    let texels: Vec<u8> = arrow.map(|c| u8::from(c == '#')).collect();
    let texels = Texels::Palette8 { palette: &[0x07e0, 0xf800], texels: &texels };
    let texture = Texture::new(5, 5, texels).unwrap().with_filter(Filter::Nearest);
    let textures = [None, Some(texture)];
    let palette = [Material::matte(Vec3::Z), Material::matte(Vec3::ONE)];
    let materials = Materials::new(&palette, Numbers::Narrow(&[1, 1, 0]));
    let textured = Textured::new(&scene, materials, Textures::new(&textures));
    let camera = Camera::orthographic(Vec3::new(1.5, 0.5, 5.0), Vec3::new(1.5, 0.5, 0.0), Vec3::Y, 1.0);
    let renderer = Renderer::new(&textured, camera, 15, 5).with_materials(materials);
    let renderer = renderer.with_ambient(Vec3::ONE).with_background(Vec3::ZERO, Vec3::ZERO);
    let symbol = |pixel: [u8; 3]| match pixel {
        [255, 0, 0] => '#',
        [0, 255, 0] => '.',
        [0, 0, 255] => 'o',
        [0, 0, 0] => ' ',
        other => panic!("{other:?}"),
    };
    let rows = renderer.scanlines().map(|row| renderer.colors(row).map(symbol).collect());
    let rows: Vec<String> = rows.collect();
    let expected = ["#####     o    ", "##...     oo   ", "#.#..     ooo  ", "#..#.     oooo ", "#...#     ooooo"];
    assert_eq!(rows, expected);
    // All that a decorator passes on.
    let ray = down(0.5, 0.25);
    let hit = Caster::closest_hit(&textured, &ray, 0).unwrap();
    let material = textured.material(&hit, &scene.surface(&ray, &hit)).unwrap();
    assert_eq!((material.specular, <[u8; 3]>::from_linear(material.diffuse)), (palette[1].specular, [0, 255, 0]));
    assert!(Caster::bounds(&textured) == scene.bounds() && textured.any_hit(&ray, 0));
}

#[cfg(feature = "alloc")]
mod baked {
    use hitscan::{
        Error,
        asset::{Asset, AssetError, Kind},
        bake::Baker,
    };

    use super::{common::seal::sealed, *};

    fn start(words: &[u32], kind: Kind) -> (usize, usize) {
        let asset = Asset::from_words(words).unwrap();
        let section = asset.section(kind).unwrap();
        let start = section.as_ptr() as usize - words.as_ptr() as usize;
        (start / 4, section.len())
    }

    #[test]
    fn coordinates_are_kept_to_half_a_step() {
        let mut random = Random::new(5);
        for (scale, offset) in [(1.0, 0.0), (20.0, -10.0), (1.0, 1000.0), (1.0e-6, 0.0), (0.0, 3.5)] {
            let place = |random: &mut Random| random.unit() * scale + offset;
            let coordinates: Vec<Vec2> = (0..500).map(|_| Vec2::new(place(&mut random), place(&mut random))).collect();
            let words = Baker::new().tex_coords(&coordinates).finish();
            let read: TexCoords<'_> = Asset::from_words(&words).unwrap().read().unwrap();
            assert_eq!(read.len(), 500);
            let allowed = 0.5 * scale / 65_535.0 + 2.0e-7 * (scale + offset.abs());
            for (vertex, at) in coordinates.iter().enumerate() {
                let off = (read.get(vertex as u32).unwrap() - *at).abs().max_element();
                assert!(off <= allowed, "{off} {allowed}");
            }
            assert_eq!(read.get(500), None);
        }
        // Corners of the unit square exactly; what is no number, somewhere within.
        let odd = [Vec2::ZERO, Vec2::ONE, Vec2::NAN, Vec2::new(f32::INFINITY, f32::MIN), Vec2::X];
        let words = Baker::new().tex_coords(&odd).finish();
        let read: TexCoords<'_> = Asset::from_words(&words).unwrap().read().unwrap();
        assert_eq!([0, 1, 4].map(|vertex| read.get(vertex)), [odd[0], odd[1], odd[4]].map(Some));
        assert!(
            (2..4).all(|vertex| read
                .get(vertex)
                .is_some_and(|at| at.cmpge(Vec2::ZERO).all() && at.cmple(Vec2::ONE).all()))
        );
        for none in [&[][..], &[Vec2::NAN]] {
            let words = Baker::new().tex_coords(none).finish();
            let read: TexCoords<'_> = Asset::from_words(&words).unwrap().read().unwrap();
            assert_eq!((read.len() as usize, read.get(0)), (none.len(), none.first().map(|_| Vec2::ZERO)));
        }
    }

    fn textures(random: &mut Random) -> [Picture; 3] {
        [40, 200, 16].map(|colors| Picture::new(random, colors))
    }

    #[test]
    fn textures_are_read_back_and_shared() {
        let mut random = Random::new(6);
        for _ in 0..50 {
            let pictures = textures(&mut random);
            let [a, b, c] = [0, 1, 2].map(|kind| pictures[kind as usize].texture(kind));
            let (b, c) = (b.with_filter(Filter::Nearest), c.with_wrap(Wrap::Clamp));
            let all = [Some(a), None, Some(b), Some(c), Some(a)];
            let words = Baker::new().textures(&all).finish();
            let alone = Baker::new().textures(&[Some(a), None, Some(b), Some(c)]).finish();
            assert!(words.len() <= alone.len() + 4, "the texture of two materials is there twice");
            let read: Textures<'_> = Asset::from_words(&words).unwrap().read().unwrap();
            for (material, texture) in (0..).zip(&all) {
                let stored = read.get(material);
                assert_eq!(stored.is_some(), texture.is_some());
                let Some((stored, texture)) = stored.zip(*texture) else { continue };
                assert_eq!((stored.width(), stored.height()), (texture.width(), texture.height()));
                for _ in 0..50 {
                    let uv = Vec2::new(random.unit() * 3.0 - 1.0, random.unit() * 3.0 - 1.0);
                    assert_eq!(stored.color(uv), texture.color(uv));
                }
            }
            assert!(read.get(5).is_none() && read.get(u32::MAX).is_none());
        }
    }

    #[test]
    fn damaged_sections_are_refused_or_harmless() {
        let mut random = Random::new(7);
        let pictures = textures(&mut random);
        let all = [0, 1, 2].map(|kind| Some(pictures[kind as usize].texture(kind)));
        let mesh = Mesh::new(&VERTICES, &TRIANGLES).unwrap();
        let coordinates: Vec<Vec2> = VERTICES.iter().map(|at| at.truncate()).collect();
        let good = Baker::new().mesh(&mesh).tex_coords(&coordinates).textures(&all).finish();
        let mut read = 0;
        for kind in [Kind::TexCoords, Kind::Textures] {
            let (start, length) = start(&good, kind);
            for place in start..start + length {
                for word in [
                    0,
                    1,
                    2,
                    u32::MAX,
                    good[place] ^ 1,
                    good[place] ^ 1 << 9,
                    good[place] ^ 1 << 16,
                    random.below(1 << 20) as u32,
                ] {
                    let mut words = good.clone();
                    words[place] = word;
                    let words = sealed(words);
                    let asset = Asset::from_words(&words).unwrap();
                    if let Ok(triangles) = asset.read::<Mapped<'_, Mesh<'_>>>() {
                        let scene = Scene::new(List::new(&mesh).unwrap(), triangles).unwrap();
                        let ray = down(0.3, 0.4);
                        let _ = scene.surface(&ray, &scene.closest_hit(&ray).unwrap());
                        read += 1;
                    }
                    if let Ok(textures) = asset.read::<Textures<'_>>() {
                        for material in [0, 1, 2, 3, u32::MAX] {
                            let color = textures.get(material).map(|texture| texture.color(Vec2::new(0.4, 7.7)));
                            assert!(color.is_none_or(Vec3::is_finite));
                        }
                        read += 1;
                    }
                }
            }
        }
        assert!(read > 100, "{read}");
        for (kind, at, word) in [(Kind::Textures, 0, 9), (Kind::Textures, 1, 1 << 20), (Kind::TexCoords, 0, 6)] {
            let mut words = good.clone();
            words[start(&good, kind).0 + at] = word;
            let words = sealed(words);
            let asset = Asset::from_words(&words).unwrap();
            let error = match kind {
                Kind::Textures => asset.read::<Textures<'_>>().unwrap_err(),
                _ => asset.read::<TexCoords<'_>>().unwrap_err(),
            };
            assert!(matches!(error, Error::Asset(AssetError::Shape { kind: shape, .. }) if shape == kind), "{error}");
        }
    }

    #[test]
    fn bytes_are_as_they_are_said_to_be() {
        let mut random = Random::new(8);
        let picture = Picture::new(&mut random, 16);
        let pixels = picture.plain.colors.len();
        let words = |kind| Baker::new().textures(&[Some(picture.texture(kind))]).finish();
        let (empty, [colors, halves]) = (Baker::new().textures(&[]).finish(), [0, 2].map(words));
        assert!((colors.len() - empty.len()) * 4 <= 12 + pixels.div_ceil(2) * 4, "{pixels}");
        assert!((halves.len() - empty.len()) * 4 <= 12 + 32 + pixels.div_ceil(8) * 4, "{pixels}");
        let coordinates = vec![Vec2::ONE; 100];
        assert_eq!(
            Baker::new().tex_coords(&coordinates).finish().len() - Baker::new().tex_coords(&[]).finish().len(),
            100
        );
    }
}
