use hitscan::render::{Color, Renderer, Tile};

use crate::{Block, Order, View, World, heat, world::Tally};

/// A picture that is drawn a little at a time, coarse first, its edges smoothed last.
#[expect(missing_debug_implementations, reason = "scenes behind a trait have none")]
pub struct Picture<'w> {
    world: &'w World,
    view: View,
    renderer: Renderer<'w, Tally>,
    order: Order,
    /// Where the last step drew.
    tile: Tile,
    pixels: Vec<[u8; 4]>,
}

impl<'w> Picture<'w> {
    /// Nothing of it drawn yet.
    #[must_use]
    pub fn new(world: &'w World, view: View) -> Self {
        let view = view.sane();
        world.reset();
        let order = Order::new(view.width, view.height);
        let pixels = vec![[0; 4]; view.width as usize * view.height as usize];
        Self { world, view, renderer: world.renderer(&view, 1), tile: order.tile(), order, pixels }
    }

    /// Draws at most so many blocks, all of one tile; how many, 0 at the end.
    pub fn step(&mut self, blocks: u32) -> u32 {
        let Self { world, view, renderer, order, pixels, tile } = self;
        let mut draw = |block| fill(pixels, view.width, block, pixel(world, view, renderer, block));
        let drawn = order.step(blocks, &mut draw);
        if drawn > 0 {
            *tile = order.tile();
            return drawn;
        }
        if view.samples == 1 || order.size() == 0 {
            return 0;
        }
        *order = Order::again(view.width, view.height);
        *renderer = world.renderer(view, view.samples);
        self.step(blocks)
    }

    /// The colours, row by row: red, green, blue and opacity, which is 0 where nothing was drawn.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// The tile in which the last step drew.
    #[must_use]
    pub const fn tile(&self) -> Tile {
        self.tile
    }

    /// The size of the blocks that are drawn; 0 when edges are being smoothed.
    #[must_use]
    pub fn fineness(&self) -> u32 {
        self.order.size()
    }

    /// The finished picture by the library's own way, row by row: what all steps together must come to.
    #[must_use]
    pub fn at_once(world: &World, view: View) -> Vec<[u8; 4]> {
        let view = view.sane();
        world.reset();
        let renderer = world.renderer(&view, view.samples);
        let whole = Tile { x: 0, y: 0, width: view.width, height: view.height };
        if view.heat {
            return whole.pixels().map(|(x, y)| pixel(world, &view, &renderer, Block { x, y, size: 1 })).collect();
        }
        let mut pixels = vec![[0_u8; 3]; whole.area()];
        // The slice has as many pixels as the tile.
        let _ = renderer.fill(whole, &mut pixels);
        pixels.into_iter().map(|[r, g, b]| [r, g, b, 255]).collect()
    }
}

fn pixel(world: &World, view: &View, renderer: &Renderer<'_, Tally>, at: Block) -> [u8; 4] {
    let before = world.nodes();
    let color = renderer.pixel(at.x, at.y);
    if view.heat {
        return heat::color((world.nodes() - before) as f32);
    }
    let [r, g, b] = Color::from_linear(color);
    [r, g, b, 255]
}

fn fill(pixels: &mut [[u8; 4]], width: u32, block: Block, color: [u8; 4]) {
    let right = (block.x + block.size).min(width) as usize;
    for row in pixels.chunks_mut(width.max(1) as usize).skip(block.y as usize).take(block.size as usize) {
        if let Some(part) = row.get_mut(block.x as usize..right) {
            part.fill(color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BuiltIn;

    #[test]
    fn steps_of_any_size_come_to_the_same_as_all_at_once() {
        let world = World::new(BuiltIn::model(0).unwrap(), 3, 1).unwrap();
        let view = View {
            width: 45,
            height: 37,
            yaw: 0.3,
            pitch: 0.4,
            zoom: 1.0,
            terms: 31,
            bounces: 2,
            samples: 2,
            heat: false,
        };
        for view in [view, View { heat: true, ..view }, View { width: 0, ..view }, View { pitch: f32::NAN, ..view }] {
            let whole = Picture::at_once(&world, view);
            for blocks in [1, 50, u32::MAX] {
                let mut picture = Picture::new(&world, view);
                while picture.step(blocks) > 0 {}
                assert!(picture.pixels() == whole, "{view:?} in steps of {blocks}");
            }
        }
    }
}
