//! A knot in flash, and in front of it a box that moves: its tree is built anew in RAM for every frame. Prints what a
//! time-of-flight sensor of 8 x 8 zones would see, and the cycles that it took.
//!
//! "Black Pill" with an STM32F411 at 100 MHz; prints by RTT.

#![no_std]
#![no_main]

use cortex_m_rt::entry;
use defmt::{info, unwrap};
use defmt_rtt as _;
use hitscan::{Arena, Error, KdTree, Mesh, Ray, Scene, asset::Asset, glam::Vec3, include_asset, kdtree::Options};
use panic_probe as _;
use stm32f4xx_hal::{dwt::DwtExt, pac, prelude::*, rcc::Config};

static SCENE: &[u8] = include_asset!(concat!(env!("OUT_DIR"), "/scene.hits"));

const ZONES: usize = 8;
const FACES: [[u16; 3]; 12] = [
    [0, 2, 1],
    [1, 2, 3],
    [4, 5, 6],
    [5, 7, 6],
    [0, 1, 4],
    [1, 5, 4],
    [2, 6, 3],
    [3, 6, 7],
    [0, 4, 2],
    [2, 4, 6],
    [1, 3, 5],
    [3, 7, 5],
];

#[entry]
fn main() -> ! {
    let device = unwrap!(pac::Peripherals::take());
    let core = unwrap!(cortex_m::Peripherals::take());
    let rcc = device.RCC.freeze(Config::hse(25.MHz()).sysclk(100.MHz()));
    let dwt = core.DWT.constrain(core.DCB, &rcc.clocks);

    let still = unwrap!(Asset::open(SCENE).map_err(Into::into).and_then(|asset| asset.scene::<KdTree, Mesh>()));
    let mut memory = [0; KdTree::words(FACES.len(), &Options::fast())];
    let mut arena = Arena::new(&mut memory);
    for frame in 0_u32.. {
        let center = Vec3::new(0.0, libm::sinf(frame as f32 * 0.1), 1.5);
        let mut ranges = [[f32::INFINITY; ZONES]; ZONES];
        let mut result = Ok(());
        let time = dwt.measure(|| result = arena.frame(|arena| look(&still, arena, center, &mut ranges)));
        unwrap!(result);
        info!("{} cycles for {} rays", time.as_ticks(), ZONES * ZONES);
        for row in &ranges {
            info!("{}", row);
        }
    }
    unreachable!()
}

/// The ranges to what is nearer: the scene in flash, or the box, whose tree is built here.
fn look(
    still: &Scene<KdTree<'_>, Mesh<'_>>,
    arena: &mut Arena<'_>,
    center: Vec3,
    ranges: &mut [[f32; ZONES]; ZONES],
) -> Result<(), Error> {
    let corners = core::array::from_fn::<_, 8, _>(|i| {
        let side = |bit: usize| if i >> bit & 1 == 0 { -0.2 } else { 0.2 };
        center + Vec3::new(side(0), side(1), side(2))
    });
    let mesh = Mesh::new(&corners, &FACES)?;
    let moving = Scene::new(KdTree::build(&mesh, arena, &Options::fast())?, mesh)?;

    for (y, row) in ranges.iter_mut().enumerate() {
        for (x, range) in row.iter_mut().enumerate() {
            let toward = |zone: usize| (zone as f32 + 0.5) / ZONES as f32 - 0.5;
            let ray = Ray::new(Vec3::new(0.0, 0.0, 4.0), Vec3::new(toward(x), -toward(y), -1.0).normalize());
            let far = still.closest_hit(&ray).map_or(f32::INFINITY, |hit| hit.t);
            *range = moving.closest_hit(&ray.up_to(far)).map_or(far, |hit| hit.t);
        }
    }
    Ok(())
}
