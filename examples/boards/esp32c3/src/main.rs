//! A scene in flash, turning, as a picture of characters on the serial console, and the microseconds per ray.

#![no_std]
#![no_main]

use core::convert::Infallible;

use esp_backtrace as _;
use esp_hal::{clock::CpuClock, main, time::Instant};
use esp_println::{print, println};
use hitscan::{
    Error, KdTree, Mesh,
    asset::Asset,
    glam::Vec3,
    include_asset,
    render::{Camera, Light, Renderer},
};

esp_bootloader_esp_idf::esp_app_desc!();

static SCENE: &[u8] = include_asset!(concat!(env!("OUT_DIR"), "/scene.hits"));

const SHADES: &[u8] = b" .:-=+*#%@";
const WIDTH: u32 = 64;
const HEIGHT: u32 = 28;

#[main]
fn main() -> ! {
    esp_hal::init(esp_hal::Config::default().with_cpu_clock(CpuClock::max()));
    let Err(error) = turn();
    panic!("{error}")
}

fn turn() -> Result<Infallible, Error> {
    let scene = Asset::open(SCENE)?.scene::<KdTree, Mesh>()?;
    let lights = [Light::directional(Vec3::new(-1.0, -2.0, -1.5), Vec3::ONE)];
    let mut angle = 0.0;
    loop {
        angle += 0.1;
        let camera = Camera::framing(&scene.bounds(), Vec3::new(libm::sinf(angle), 0.6, libm::cosf(angle)), Vec3::Y);
        let renderer = Renderer::new(&scene, camera, WIDTH, HEIGHT).with_lights(&lights);
        let mut picture = [0_u8; (WIDTH * HEIGHT) as usize];
        let begun = Instant::now();
        for (pixel, luminance) in
            picture.iter_mut().zip(renderer.scanlines().flat_map(|row| renderer.colors::<u8>(row)))
        {
            *pixel = luminance;
        }
        let micros = begun.elapsed().as_micros();
        for row in picture.chunks(WIDTH as usize) {
            row.iter().for_each(|&pixel| print!("{}", SHADES[usize::from(pixel) * SHADES.len() / 256] as char));
            println!();
        }
        println!("{} us per pixel", micros / u64::from(WIDTH * HEIGHT));
    }
}
