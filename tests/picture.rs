//! Pictures: every pixel once, the same bytes whoever computes them.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

use hitscan::{
    KdTree, Mesh, Scene,
    accel::Plan,
    bake,
    geometry::Sphere,
    glam::Vec3,
    kdtree::Options,
    primitives::Spheres,
    render::{Camera, Light, Material, Materials, Numbers, Renderer, Terms, Tile, TooShort},
};

const FLOOR: [Vec3; 4] =
    [Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 0.0, -3.0), Vec3::new(3.0, 0.0, 3.0), Vec3::new(-3.0, 0.0, 3.0)];
const SPHERES: [Sphere; 2] = [Sphere::new(Vec3::new(0.0, 1.0, 0.0), 1.0), Sphere::new(Vec3::new(1.2, 0.4, 1.2), 0.4)];
const LIGHTS: [Light; 2] = [
    Light::point(Vec3::new(4.0, 6.0, 5.0), Vec3::splat(0.7)),
    Light::directional(Vec3::new(1.0, -2.0, -0.5), Vec3::new(0.3, 0.25, 0.2)),
];
const NUMBERS: [u8; 4] = [0, 0, 1, 2];

/// Two spheres on a floor, one of them a mirror.
fn with_renderer<R>(
    width: u32,
    height: u32,
    show: impl FnOnce(&Renderer<'_, Scene<KdTree, (Mesh, Spheres)>>) -> R,
) -> R {
    let primitives = (Mesh::new(&FLOOR, &[[0_u16, 2, 1], [0, 3, 2]]).unwrap(), Spheres::new(&SPHERES).unwrap());
    let words = bake::build(&primitives, &Plan::KdTree(Options::fast())).unwrap();
    let scene = Scene::new(KdTree::open(&words).unwrap(), primitives).unwrap();
    let palette = [
        Material::matte(Vec3::new(0.6, 0.6, 0.5)),
        Material::matte(Vec3::splat(0.2)).with_highlights(0.8, 60.0).with_reflectivity(0.6),
        Material::matte(Vec3::new(0.8, 0.2, 0.1)).with_highlights(0.3, 20.0),
    ];
    let camera = Camera::pinhole(Vec3::new(3.0, 2.5, 5.0), Vec3::new(0.3, 0.7, 0.0), Vec3::Y, 0.7);
    let renderer = Renderer::new(&scene, camera, width, height)
        .with_lights(&LIGHTS)
        .with_materials(Materials::new(&palette, Numbers::Narrow(&NUMBERS)))
        .with_background(Vec3::splat(0.005), Vec3::splat(0.02))
        .with_bounces(2);
    show(&renderer)
}

fn whole<C: hitscan::render::Color + Default>(renderer: &Renderer<'_, Scene<KdTree, (Mesh, Spheres)>>) -> Vec<C> {
    let (width, height) = (renderer.width(), renderer.height());
    let tile = Tile { x: 0, y: 0, width, height };
    let mut pixels = vec![C::default(); tile.area()];
    renderer.fill(tile, &mut pixels).unwrap();
    pixels
}

#[test]
fn samples_are_the_pixels_of_a_larger_picture() {
    with_renderer(12, 8, |small| {
        with_renderer(36, 24, |large| {
            let fine = small.with_samples(3);
            for (x, y) in (0..96).map(|i| (i % 12, i / 12)) {
                let within = (0..9).map(|i| large.pixel(3 * x + i % 3, 3 * y + i / 3));
                let mean = within.sum::<Vec3>() / 9.0;
                assert!((fine.pixel(x, y) - mean).abs().max_element() < 1.0e-4, "{x} {y}");
            }
        });
    });
}

/// FNV-1a.
fn hash(pixels: &[[u8; 3]]) -> u32 {
    pixels.iter().flatten().fold(0x811c_9dc5, |sum: u32, &byte| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[test]
fn the_picture_is_the_one_it_always_was() {
    with_renderer(64, 48, |renderer| {
        let rows: Vec<String> = whole::<u8>(renderer)
            .chunks(64)
            .step_by(3)
            .map(|row| row.iter().step_by(2).map(|&grey| b" .:-=+*#%@"[usize::from(grey) * 10 / 256] as char).collect())
            .collect();
        assert_eq!(rows, PICTURE, "\n{}", rows.join("\n"));
        assert_eq!(hash(&whole(renderer)), HASH);
    });
}

/// What the grey values look like.
const PICTURE: [&str; 16] = [
    "................................",
    "................................",
    "................................",
    ".............:--................",
    "...........-------:.............",
    "..........:-------::............",
    ".........:::---=-:::............",
    ".........:::::::::::............",
    ".....####+*****=-***#######.....",
    ".########++****==++*############",
    "##########++-++++*++****########",
    "#############**++**+=**#########",
    "###############-====:###########",
    "###############+:::-***#########",
    "###################**###########",
    "###############################.",
];

/// Of the picture in sRGB, on every target.
const HASH: u32 = 2_967_874_399;

#[test]
fn tiles_hold_every_pixel_once() {
    for (width, height) in [(0, 0), (0, 5), (5, 0), (1, 1), (33, 17), (64, 1)] {
        with_renderer(width, height, |renderer| {
            let expected: Vec<[u8; 3]> = whole(renderer);
            for (tile_width, tile_height) in [(0, 0), (1, 1), (7, 7), (7, 1), (64, 64), (u32::MAX, 2)] {
                let mut picture = vec![None; expected.len()];
                for tile in renderer.tiles(tile_width, tile_height) {
                    for ((x, y), color) in tile.pixels().zip(renderer.colors::<[u8; 3]>(tile)) {
                        let place = &mut picture[(y * width + x) as usize];
                        assert_eq!(place.replace(color), None, "written twice");
                    }
                }
                let picture: Option<Vec<[u8; 3]>> = picture.into_iter().collect();
                assert_eq!(picture, Some(expected.clone()), "{width} {height} {tile_width} {tile_height}");
            }
            let rows: usize = renderer.scanlines().map(|tile| tile.area()).sum();
            assert_eq!(rows, expected.len());
        });
    }
}

#[test]
fn short_slices_are_refused_and_untouched() {
    with_renderer(8, 8, |renderer| {
        let mut pixels = [7_u8; 63];
        let tile = Tile { x: 0, y: 0, width: 8, height: 8 };
        assert_eq!(renderer.fill(tile, &mut pixels), Err(TooShort { needed: 64, available: 63 }));
        assert_eq!(pixels, [7; 63]);
    });
}

#[test]
fn each_term_of_light_can_be_on_alone() {
    with_renderer(32, 24, |renderer| {
        let light = |terms| -> f32 {
            let renderer = renderer.with_terms(terms).with_background(Vec3::ZERO, Vec3::ZERO);
            whole::<Vec3>(&renderer).iter().map(|rgb| rgb.element_sum()).sum()
        };
        let none = Terms::NONE;
        let (ambient, diffuse, specular) = (
            light(Terms { ambient: true, ..none }),
            light(Terms { diffuse: true, ..none }),
            light(Terms { specular: true, ..none }),
        );
        assert_eq!(light(none), 0.0);
        assert!(ambient > 0.0 && diffuse > 0.0 && specular > 0.0);
        let sum = light(Terms { ambient: true, diffuse: true, specular: true, ..none });
        assert!((sum / (ambient + diffuse + specular) - 1.0).abs() < 1.0e-4);
        assert!(light(Terms { diffuse: true, shadows: true, ..none }) < diffuse * 0.99);
        let all = light(Terms::ALL);
        assert!((light(Terms { reflections: false, ..Terms::ALL }) - all).abs() > all * 1.0e-3);
    });
}

#[test]
fn cameras_that_make_no_sense_give_pictures_of_nothing() {
    with_renderer(4, 4, |_| {});
    let mesh = Mesh::new(&FLOOR, &[[0_u16, 2, 1]]).unwrap();
    let scene = Scene::new(hitscan::List::new(&mesh).unwrap(), mesh).unwrap();
    for eye in [Vec3::NAN, Vec3::INFINITY, Vec3::ZERO] {
        let renderer = Renderer::new(&scene, Camera::pinhole(eye, Vec3::ZERO, Vec3::Y, f32::NAN), 4, 4);
        for tile in renderer.tiles(2, 2) {
            assert_eq!(renderer.colors::<[u8; 3]>(tile).count(), 4);
        }
    }
}

#[cfg(feature = "std")]
#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    with_renderer(61, 43, |renderer| {
        let expected: Vec<[u8; 3]> = whole(renderer);
        for threads in [1, 2, 3, 7, 64] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut picture = vec![[0; 3]; expected.len()];
            pool.install(|| hitscan::parallel::render(renderer, &mut picture)).unwrap();
            assert_eq!(picture, expected, "{threads} threads");
        }
        let short = hitscan::parallel::render(renderer, &mut [[0_u8; 3]; 5]);
        assert_eq!(short, Err(TooShort { needed: 61 * 43, available: 5 }));
    });
}

#[cfg(feature = "graphics")]
mod display {
    use core::convert::Infallible;

    use embedded_graphics_core::{
        Pixel,
        draw_target::DrawTarget,
        geometry::{Dimensions, Point, Size},
        pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, GrayColor, PixelColor, Rgb565, Rgb666, Rgb888, RgbColor},
        primitives::Rectangle,
    };

    use hitscan::{
        display::{self, Strip},
        render::{Channels, Diffusion, Dither, Nearest, Ordered},
    };

    use super::*;

    /// A display that does not bear overdraw.
    struct Screen<C> {
        width: u32,
        pixels: Vec<Option<C>>,
    }

    impl<C> Dimensions for Screen<C> {
        fn bounding_box(&self) -> Rectangle {
            Rectangle::new(Point::zero(), Size::new(self.width, self.pixels.len() as u32 / self.width))
        }
    }

    impl<C: PixelColor> DrawTarget for Screen<C> {
        type Color = C;
        type Error = Infallible;

        fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
            for Pixel(point, color) in pixels {
                let place = &mut self.pixels[point.y as usize * self.width as usize + point.x as usize];
                assert!(place.replace(color).is_none(), "drawn twice at {point}");
            }
            Ok(())
        }
    }

    fn shown<C: Channels + PixelColor>(dither: impl Dither) -> Vec<C> {
        with_renderer(32, 24, |renderer| {
            let mut screen = Screen { width: 40, pixels: vec![None; 40 * 30] };
            display::draw(renderer, &mut screen, Point::new(5, 3), (7, 5), dither).unwrap();
            let drawn: Vec<C> = screen.pixels.into_iter().flatten().collect();
            assert_eq!(drawn.len(), 32 * 24);
            drawn
        })
    }

    #[test]
    fn displays_show_the_picture_in_their_colors() {
        let rgb: Vec<[u8; 3]> = with_renderer(32, 24, whole);
        let rgb565: Vec<u16> = with_renderer(32, 24, whole);
        let grey: Vec<u8> = with_renderer(32, 24, whole);
        assert!(shown::<Rgb888>(Nearest).iter().zip(&rgb).all(|(a, b)| [a.r(), a.g(), a.b()] == *b));
        assert!(shown::<Rgb565>(Nearest).iter().zip(&rgb565).all(|(a, b)| packed(*a) == *b));
        assert!(shown::<Gray8>(Nearest).iter().zip(&grey).all(|(a, b)| *a == Gray8::new(*b)));
        assert!(shown::<Gray4>(Nearest).iter().zip(&grey).all(|(a, b)| a.luma() == (b + 8) / 17));
        assert!(shown::<Gray2>(Nearest).iter().zip(&grey).all(|(a, b)| a.luma() == (b / 2 + 21) / 43));
        assert!(shown::<BinaryColor>(Nearest).iter().zip(&grey).all(|(a, b)| a.is_on() == (*b > 127)));
    }

    fn packed(color: Rgb565) -> u16 {
        u16::from(color.r()) << 11 | u16::from(color.g()) << 5 | u16::from(color.b())
    }

    #[test]
    fn displays_show_few_colors_as_memory_does() {
        let tile = Tile { x: 0, y: 0, width: 32, height: 24 };
        let dithered: Vec<u16> = with_renderer(32, 24, |renderer| renderer.dithered(tile, Ordered).collect());
        let shown565: Vec<Rgb565> = shown(Ordered);
        assert!(shown565.iter().zip(&dithered).all(|(a, b)| packed(*a) == *b));
        let mut errors = [0; 3 * 32];
        // Six bits are nearer than five.
        let distance = |picture: Vec<[f32; 3]>| -> f32 {
            let rgb: Vec<[u8; 3]> = with_renderer(32, 24, whole);
            let pairs = picture.iter().flatten().zip(rgb.iter().flatten());
            pairs.map(|(a, &b)| (a - f32::from(b) / 255.0).abs()).sum()
        };
        let six = shown::<Rgb666>(Diffusion::new(&mut errors));
        let six = distance(six.iter().map(|c| [c.r(), c.g(), c.b()].map(|level| f32::from(level) / 63.0)).collect());
        let eight = shown::<Rgb888>(Diffusion::new(&mut errors));
        let eight =
            distance(eight.iter().map(|c| [c.r(), c.g(), c.b()].map(|level| f32::from(level) / 255.0)).collect());
        assert!(eight * 2.0 < six && six < 32.0 * 24.0 * 3.0 / 63.0, "{eight} {six}");
    }

    #[test]
    fn strips_are_drawn_on_within_their_tile() {
        let tile = Tile { x: 3, y: 4, width: 5, height: 2 };
        let mut pixels = [7_u8; 10];
        let mut strip = Strip::new(tile, &mut pixels);
        assert_eq!(strip.bounding_box(), Rectangle::new(Point::new(3, 4), Size::new(5, 2)));
        let area = Rectangle::new(Point::new(6, -3), Size::new(100, 8));
        strip.fill_solid(&area, Gray8::WHITE).unwrap();
        assert_eq!(pixels, [7, 7, 7, 255, 255, 7, 7, 7, 7, 7]);
        // Less memory than the tile has pixels, and tiles beyond all points.
        Strip::new(tile, &mut pixels[..4]).fill_solid(&area, Gray8::BLACK).unwrap();
        assert_eq!(pixels, [7, 7, 7, 0, 255, 7, 7, 7, 7, 7]);
        let far = Tile { x: u32::MAX, y: u32::MAX, width: u32::MAX, height: u32::MAX };
        Strip::new(far, &mut pixels).fill_solid(&area, Gray8::BLACK).unwrap();
        assert_eq!(pixels, [7, 7, 7, 0, 255, 7, 7, 7, 7, 7]);
    }
}
