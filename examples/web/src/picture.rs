use hitscan::render::{Color, Interlaced, Patch, Renderer, Tile, Tiles};

use crate::{View, World, heat, world::Tally};

/// Pixels along a side of a tile whose edges are smoothed.
const TILE: u32 = 8;

/// A picture that is drawn a little at a time, coarse first, its edges smoothed last.
#[expect(missing_debug_implementations, reason = "scenes behind a trait have none")]
pub struct Picture<'w> {
    world: &'w World,
    view: View,
    renderer: Renderer<'w, Tally>,
    /// Each pixel once: the block that comes next, and those behind it.
    next: Option<Tile>,
    order: Interlaced,
    /// Tiles of which each pixel is drawn once more.
    again: Tiles,
    /// Where the last step drew, and where the rays of that tile begin.
    tile: Tile,
    patch: Option<Patch<'w, Tally>>,
    pixels: Vec<[u8; 4]>,
}

impl<'w> Picture<'w> {
    /// Nothing of it drawn yet.
    #[must_use]
    pub fn new(world: &'w World, view: View) -> Self {
        let view = view.sane();
        world.reset();
        let (width, height) = if view.samples > 1 { (view.width, view.height) } else { (0, 0) };
        let mut order = Interlaced::new(view.width, view.height);
        Self {
            world,
            view,
            renderer: world.renderer(&view, 1),
            next: order.next(),
            order,
            again: Tiles::new(width, height, TILE, TILE),
            tile: Tile { x: 0, y: 0, width: 0, height: 0 },
            patch: None,
            pixels: vec![[0; 4]; view.width as usize * view.height as usize],
        }
    }

    /// Draws at most so many blocks, all of one tile, or smooths the edges of a small one; how many blocks, 0 at the end.
    pub fn step(&mut self, blocks: u32) -> u32 {
        let mut drawn = 0;
        while drawn < blocks {
            let Some(block) = self.next else { break };
            if drawn > 0 && self.order.tile() != self.tile {
                return drawn;
            }
            self.enter(self.order.tile());
            self.draw(block);
            drawn += 1;
            self.next = self.order.next();
        }
        if drawn > 0 { drawn } else { self.smooth() }
    }

    /// Draws the next tile once more, with all samples; how many pixels it has.
    fn smooth(&mut self) -> u32 {
        let Some(tile) = self.again.next() else { return 0 };
        if self.renderer.samples() != self.view.samples {
            self.renderer = self.world.renderer(&self.view, self.view.samples);
            self.patch = None;
        }
        self.enter(tile);
        tile.pixels().for_each(|(x, y)| self.draw(Tile { x, y, width: 1, height: 1 }));
        tile.area() as u32
    }

    /// Finds where the rays of a tile begin; a heat map shows whole walks.
    fn enter(&mut self, tile: Tile) {
        if self.patch.is_none() || self.tile != tile {
            self.patch = (!self.view.heat).then(|| self.renderer.patch(tile));
            self.tile = tile;
        }
    }

    /// Draws a block of the tile.
    fn draw(&mut self, block: Tile) {
        let color = match &self.patch {
            Some(patch) => opaque(Color::from_linear(patch.pixel(block.x, block.y))),
            None => heat(self.world, &self.renderer, (block.x, block.y)),
        };
        let (left, right) = (block.x as usize, (block.x + block.width) as usize);
        let rows = self.pixels.chunks_mut(self.view.width.max(1) as usize);
        for row in rows.skip(block.y as usize).take(block.height as usize) {
            if let Some(part) = row.get_mut(left..right) {
                part.fill(color);
            }
        }
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

    /// How far apart the pixels are that are drawn next: 8, 4, 2 or 1; 0 when only edges are left to be smoothed.
    #[must_use]
    pub fn fineness(&self) -> u32 {
        8 >> self.order.pass().div_ceil(2)
    }

    /// The finished picture by the library's own way, row by row: what all steps together must come to.
    #[must_use]
    pub fn at_once(world: &World, view: View) -> Vec<[u8; 4]> {
        let view = view.sane();
        world.reset();
        let renderer = world.renderer(&view, view.samples);
        let whole = Tile { x: 0, y: 0, width: view.width, height: view.height };
        if view.heat {
            return whole.pixels().map(|pixel| heat(world, &renderer, pixel)).collect();
        }
        let mut pixels = vec![[0_u8; 3]; whole.area()];
        // The slice has as many pixels as the tile.
        let _ = renderer.fill(whole, &mut pixels);
        pixels.into_iter().map(opaque).collect()
    }
}

const fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

/// How many nodes a pixel takes, as a colour.
fn heat(world: &World, renderer: &Renderer<'_, Tally>, (x, y): (u32, u32)) -> [u8; 4] {
    let before = world.nodes();
    let _ = renderer.pixel(x, y);
    heat::color((world.nodes() - before) as f32)
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
                assert_eq!(picture.fineness(), 0, "{view:?} in steps of {blocks}");
                assert!(picture.pixels() == whole, "{view:?} in steps of {blocks}");
            }
        }
    }
}
