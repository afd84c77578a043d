//! Dithering: bright as the light was, the same bytes, any bits in.
#![allow(missing_docs)]

use hitscan::{
    List, Scene,
    geometry::Sphere,
    glam::Vec3,
    primitives::Spheres,
    render::{Camera, Channels, Color, Diffusion, Dither, Levels, Light, Nearest, Ordered, Renderer, Tile, TooShort},
};

/// A display in black and white of one's own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Bit(u8);

impl Color for Bit {
    fn from_linear(rgb: Vec3) -> Self {
        Self(u8::from_linear(rgb) >> 7)
    }
}

impl Channels for Bit {
    const CHANNELS: usize = 1;

    fn from_channels(rgb: Vec3, mut choose: impl FnMut(usize, f32, Levels) -> u8) -> Self {
        Self(choose(0, rgb.y, Levels::BITS_1))
    }
}

const SPHERES: [Sphere; 3] = [
    Sphere::new(Vec3::ZERO, 1.0),
    Sphere::new(Vec3::new(1.4, 0.3, 0.6), 0.4),
    Sphere::new(Vec3::new(0.0, -101.0, 0.0), 100.0),
];

fn with_renderer<R>(width: u32, height: u32, show: impl FnOnce(&Renderer<'_, Scene<List, Spheres>>) -> R) -> R {
    let spheres = Spheres::new(&SPHERES).unwrap();
    let scene = Scene::new(List::new(&spheres).unwrap(), spheres).unwrap();
    let lights = [Light::point(Vec3::new(4.0, 5.0, 3.0), Vec3::ONE)];
    let camera = Camera::pinhole(Vec3::new(1.0, 1.0, 5.0), Vec3::new(0.3, 0.0, 0.0), Vec3::Y, 0.6);
    show(&Renderer::new(&scene, camera, width, height).with_lights(&lights).with_background(Vec3::ZERO, Vec3::ZERO))
}

/// The picture in these tiles; every pixel is there once.
fn drawn<C: Channels>(
    renderer: &Renderer<'_, Scene<List, Spheres>>,
    (width, height): (u32, u32),
    mut dither: impl Dither,
) -> Vec<C> {
    let mut picture = vec![None; (renderer.width() * renderer.height()) as usize];
    for tile in renderer.tiles(width, height) {
        for ((x, y), color) in tile.pixels().zip(renderer.dithered(tile, &mut dither)) {
            assert!(picture[(y * renderer.width() + x) as usize].replace(color).is_none(), "written twice");
        }
    }
    picture.into_iter().map(Option::unwrap).collect()
}

fn rows(picture: &[Bit], width: usize) -> Vec<String> {
    picture.chunks(width).map(|row| row.iter().map(|bit| [' ', '#'][usize::from(bit.0)]).collect()).collect()
}

/// `width` x `height` pixels of the same light.
fn even<C: Channels>(light: f32, (width, height): (u32, u32), mut dither: impl Dither) -> Vec<C> {
    let tile = Tile { x: 0, y: 0, width, height };
    tile.pixels().map(|pixel| dither.color(pixel, Vec3::splat(light))).collect()
}

/// sRGB as linear light.
fn linear(level: u8, most: u8) -> f64 {
    let x = f64::from(level) / f64::from(most);
    if x > 0.040_45 { ((x + 0.055) / 1.055).powf(2.4) } else { x / 12.92 }
}

fn mean(lights: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = lights.fold((0.0, 0), |(sum, count), light| (sum + light, count + 1));
    sum / f64::from(count)
}

#[test]
fn pictures_are_those_they_always_were() {
    with_renderer(32, 20, |renderer| {
        let shown = rows(&drawn(renderer, (32, 20), Ordered), 32);
        assert_eq!(shown, ORDERED, "\n{}", shown.join("\n"));
        let shown = rows(&drawn(renderer, (32, 20), Diffusion::new(&mut [0; 32])), 32);
        assert_eq!(shown, DIFFUSED, "\n{}", shown.join("\n"));
    });
}

#[test]
fn an_even_area_is_as_bright_as_its_light() {
    for step in 0..=100_u8 {
        let light = f32::from(step) / 100.0;
        let expected = f64::from(light);
        for way in 0..2 {
            let close = |mean: f64, step: f64| {
                assert!((mean - expected).abs() <= step / 100.0, "{light} became {mean}, way {way}");
            };
            let size = (64, 64);
            // The greatest step of each is that to full light.
            let mut errors = [0; 3 * 64];
            let mut diffusion = Diffusion::new(&mut errors);
            let bits = if way == 0 { even(light, size, Ordered) } else { even(light, size, &mut diffusion) };
            close(mean(bits.iter().map(|bit: &Bit| linear(bit.0, 1))), 1.0);
            diffusion.restart();
            let greys = if way == 0 { even(light, size, Ordered) } else { even(light, size, &mut diffusion) };
            close(mean(greys.iter().map(|&grey: &u8| linear(grey, 255))), 1.0 - linear(254, 255));
            diffusion.restart();
            let colors = if way == 0 { even(light, size, Ordered) } else { even(light, size, &mut diffusion) };
            let step = 1.0 - linear(30, 31);
            close(mean(colors.iter().map(|&rgb: &u16| linear((rgb >> 11) as u8, 31))), step);
            close(mean(colors.iter().map(|&rgb: &u16| linear((rgb >> 5 & 63) as u8, 63))), step);
            close(mean(colors.iter().map(|&rgb: &u16| linear((rgb & 31) as u8, 31))), step);
        }
    }
}

#[test]
fn a_picture_is_as_bright_in_black_and_white() {
    with_renderer(96, 64, |renderer| {
        let expected = mean(
            renderer
                .colors::<Vec3>(Tile { x: 0, y: 0, width: 96, height: 64 })
                .map(|light| f64::from(light.y.clamp(0.0, 1.0))),
        );
        let bright = |picture: Vec<Bit>| mean(picture.iter().map(|bit| f64::from(bit.0)));
        assert!((bright(drawn(renderer, (8, 8), Ordered)) - expected).abs() < 0.005);
        // Even if tiles are not rows, little light is lost: at the lower edge and where it comes to columns that are done.
        for tile in [(96, 64), (96, 1), (8, 8), (7, 5), (16, 64), (1, 1)] {
            let got = bright(drawn(renderer, tile, Diffusion::new(&mut [0; 96])));
            assert!((got - expected).abs() < 0.005, "{got} for {expected} with {tile:?}");
        }
        let plain = bright(drawn(renderer, (96, 64), Nearest));
        assert!((plain - expected).abs() > 0.05, "what dithering is for: {plain} for {expected}");
    });
}

#[test]
fn black_and_white_stay_pure() {
    for (light, bit, grey, rgb) in [(0.0, 0, 0, 0), (-1.0, 0, 0, 0), (1.0, 1, 255, 0xffff), (9.0, 1, 255, 0xffff)] {
        fn pure<C: Channels + PartialEq + core::fmt::Debug>(light: f32, color: C) {
            assert_eq!(even::<C>(light, (16, 16), Ordered), [color; 256]);
            assert_eq!(even::<C>(light, (16, 16), Diffusion::new(&mut [0; 3 * 16])), [color; 256]);
        }
        pure(light, Bit(bit));
        pure(light, [grey; 3]);
        pure::<u16>(light, rgb);
    }
}

#[test]
fn tiles_do_not_matter() {
    with_renderer(33, 21, |renderer| {
        let ordered: Vec<u16> = drawn(renderer, (33, 21), Ordered);
        for tile in [(1, 1), (8, 8), (7, 5), (33, 1), (64, 64), (0, 0)] {
            assert_eq!(drawn::<u16>(renderer, tile, Ordered), ordered, "{tile:?}");
        }
        let diffused: Vec<u16> = drawn(renderer, (33, 21), Diffusion::new(&mut [0; 99]));
        for rows in [1, 2, 5, 8, 20] {
            let strips: Vec<u16> = drawn(renderer, (33, rows), Diffusion::new(&mut [0; 99]));
            assert_eq!(strips, diffused, "{rows}");
        }
        let mut errors = [0; 99];
        let mut diffusion = Diffusion::new(&mut errors);
        for _ in 0..2 {
            assert_eq!(drawn::<u16>(renderer, (33, 8), &mut diffusion), diffused);
            diffusion.restart();
        }
        let bytes: Vec<[u8; 2]> = drawn(renderer, (8, 8), Ordered);
        assert!(bytes.iter().zip(&ordered).all(|(bytes, color)| u16::from_be_bytes(*bytes) == *color));
    });
}

#[test]
fn any_bits_have_a_colour() {
    let lights = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -0.0, 1.0e-40, 0.3];
    for length in [0, 1, 2, 4, 7] {
        let mut errors = vec![i16::MIN; length];
        let mut diffusion = Diffusion::new(&mut errors);
        for y in [0, 0, 7, u32::MAX] {
            for x in [0, 1, 2, 3, 2, 2, u32::MAX - 1, u32::MAX, 0] {
                for (i, light) in lights.iter().enumerate() {
                    let rgb = Vec3::new(*light, lights[(i + 1) % 7], lights[(i + 3) % 7]);
                    let _: [u8; 3] = diffusion.color((x, y), rgb);
                    let _: Bit = diffusion.color((x, y), rgb);
                    let _: u16 = Ordered.color((x, y), rgb);
                }
            }
        }
    }
    assert_eq!(Ordered.color::<[u8; 3]>((0, 0), Vec3::NAN), [0; 3]);
}

#[test]
fn a_line_too_short_keeps_the_light_of_its_rows() {
    let bits: Vec<Bit> = even(0.3, (400, 1), Diffusion::new(&mut []));
    assert_eq!(bits.iter().filter(|bit| bit.0 == 1).count(), 120);
}

#[test]
fn buffers_go_by_turns() {
    with_renderer(20, 13, |renderer| {
        let expected: Vec<u16> = drawn(renderer, (20, 13), Ordered);
        let (mut first, mut second) = ([1_u16; 60], [2_u16; 60]);
        let (mut waiting, mut sent, mut addresses) = (Some(&mut second), vec![], vec![]);
        let left = renderer.stream((20, 3), Ordered, &mut first, |tile, full: &mut [u16; 60]| {
            addresses.push(full.as_ptr() as usize);
            sent.extend_from_slice(&full[..tile.area()]);
            waiting.replace(full).ok_or(())
        });
        assert!(left.unwrap().is_ok());
        assert_eq!(sent, expected);
        assert!(addresses.len() == 5 && addresses.windows(3).all(|three| three[0] == three[2] && three[0] != three[1]));

        let mut lines = 0;
        let line = renderer.stream((u32::MAX, 1), Ordered, vec![0_u16; 20], |tile, line| {
            assert_eq!(line, expected[20 * tile.y as usize..][..20]);
            lines += 1;
            Ok::<_, ()>(line)
        });
        assert_eq!((line.unwrap().map(|line| line.len()), lines), (Ok(20), 13));

        let short = renderer.stream((20, 3), Nearest, [0_u8; 59], |_, _| -> Result<_, ()> {
            unreachable!("nothing was drawn that could be sent")
        });
        assert_eq!(short, Err(TooShort { needed: 60, available: 59 }));
        let broken = renderer.stream((20, 3), Nearest, [0_u8; 60], |tile, _| Err(tile.y));
        assert_eq!(broken, Ok(Err(0)));
    });
}

/// The scene in order.
const ORDERED: [&str; 20] = [
    "                                ",
    "                                ",
    "                                ",
    "                                ",
    "            #####               ",
    "           # # # #              ",
    "          # # #####   ###       ",
    "           # # # # #   # #      ",
    "        # # ######### # ###     ",
    " #   #       # # #       #   #  ",
    "# # # #   # # # # # # #   # # # ",
    "   #   #       # #   #   # # # #",
    "# # #   #   # # # # ### ### ### ",
    " #                 # # # # # # #",
    "#     #       #    ## ### ### ##",
    " #                   # # # # # #",
    "### #   #   #   #   # ##########",
    " # # # # # # # # # # # # # # # #",
    "# ### ### ### ### ### ##########",
    " # # # # # # # # # # # # # # # #",
];

/// The scene with its errors spread.
const DIFFUSED: [&str; 20] = [
    "                                ",
    "                                ",
    "                                ",
    "                                ",
    "            #####               ",
    "           # # # ##             ",
    "          # # ####    # #       ",
    "           # # #####   ###      ",
    "         # # ## # #   # # #     ",
    "   #  #     # # ### #    #   #  ",
    "# # #  #  #  # # #      # # # ##",
    " # # # #    #  # #  ##    ## #  ",
    "# # #         #  #  # ### # # ##",
    " #             #   ### # ### ## ",
    "#     #  #  #    # # ## # # ## #",
    " ##                  # ##### ###",
    "# ###                 ## # ## # ",
    "# # ################## #### ####",
    " # # # # # # # # # # ## # ### # ",
    "### # # ### ####### ###### #####",
];
