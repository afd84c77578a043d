//! A scene in flash on a 240 x 240 SPI display: while DMA sends one tile, the next is computed.
//!
//! ST7789 on SPI0: SCK 18, MOSI 19, CS 17, DC 16, RST 20.

#![no_std]
#![no_main]

use defmt::{info, unwrap};
use defmt_rtt as _;
use embassy_executor::Spawner;
use embassy_futures::join::join;
use embassy_rp::{
    bind_interrupts, dma,
    gpio::{Level, Output},
    peripherals::DMA_CH0,
    spi::{Config, Spi},
};
use embassy_time::{Delay, Instant};
use embedded_hal::digital::OutputPin;
use embedded_hal_async::spi::SpiDevice;
use embedded_hal_bus::spi::ExclusiveDevice;
use hitscan::{
    KdTree, Mesh,
    asset::Asset,
    glam::Vec3,
    include_asset,
    render::{Camera, Light, Renderer, Tile},
};
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use panic_probe as _;

const SIZE: u32 = 240;
const ROWS: u32 = 8;

static SCENE: &[u8] = include_asset!(concat!(env!("OUT_DIR"), "/scene.hits"));

bind_interrupts!(struct Interrupts {
    DMA_IRQ_0 => dma::InterruptHandler<DMA_CH0>;
});

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let p = embassy_rp::init(Default::default());
    let mut config = Config::default();
    config.frequency = 62_500_000;
    let bus = Spi::new_txonly(p.SPI0, p.PIN_18, p.PIN_19, p.DMA_CH0, Interrupts, config);
    let device = unwrap!(ExclusiveDevice::new(bus, Output::new(p.PIN_17, Level::High), Delay).ok());

    // The driver wakes the display, then hands the bus back: tiles go around it, by DMA.
    let mut buffer = [0; 64];
    let display = Builder::new(ST7789, SpiInterface::new(device, Output::new(p.PIN_16, Level::Low), &mut buffer))
        .reset_pin(Output::new(p.PIN_20, Level::High))
        .display_size(SIZE as u16, SIZE as u16)
        .invert_colors(ColorInversion::Inverted)
        .init(&mut Delay);
    let (mut device, mut dc) = unwrap!(display.ok()).release().0.release();

    let scene = unwrap!(Asset::open(SCENE).map_err(Into::into).and_then(|asset| asset.scene::<KdTree, Mesh>()));
    let lights = [Light::directional(Vec3::new(-1.0, -2.0, -1.5), Vec3::ONE)];
    let mut tiles = [[0_u16; (SIZE * ROWS) as usize]; 2];
    for frame in 0_u32.. {
        let angle = frame as f32 * 0.05;
        let camera = Camera::framing(&scene.bounds(), Vec3::new(libm::sinf(angle), 0.6, libm::cosf(angle)), Vec3::Y);
        let renderer = Renderer::new(&scene, camera, SIZE, SIZE).with_lights(&lights);
        let begun = Instant::now();
        let mut sent = Tile { x: 0, y: 0, width: SIZE, height: 0 };
        let [ready, next] = &mut tiles;
        for tile in renderer.tiles(SIZE, ROWS) {
            let render = async {
                unwrap!(renderer.fill(tile, next).ok());
                next.iter_mut().for_each(|pixel| *pixel = pixel.to_be());
            };
            unwrap!(join(send(&mut device, &mut dc, sent, ready), render).await.0.ok());
            core::mem::swap(ready, next);
            sent = tile;
        }
        unwrap!(send(&mut device, &mut dc, sent, ready).await.ok());
        info!("frame {}: {} ms", frame, begun.elapsed().as_millis());
    }
}

/// Sends the pixels of a tile to its place on the display; nothing if it has none.
async fn send<D: SpiDevice>(
    device: &mut D,
    dc: &mut impl OutputPin,
    tile: Tile,
    pixels: &[u16],
) -> Result<(), D::Error> {
    let Some(pixels) = pixels.get(..tile.area()).filter(|pixels| !pixels.is_empty()) else { return Ok(()) };
    let range = |from: u32, count: u32| {
        let ([a, b], [c, d]) = ((from as u16).to_be_bytes(), ((from + count - 1) as u16).to_be_bytes());
        [a, b, c, d]
    };
    let (columns, rows) = (range(tile.x, tile.width), range(tile.y, tile.height));
    // Set column address, set row address, memory write.
    for (command, data) in [(0x2a, columns.as_slice()), (0x2b, &rows), (0x2c, bytemuck::cast_slice(pixels))] {
        // Pins of this chip cannot fail.
        let _ = dc.set_low();
        device.write(&[command]).await?;
        let _ = dc.set_high();
        device.write(data).await?;
    }
    Ok(())
}
