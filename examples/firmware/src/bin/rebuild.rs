//! Builds a tree on the device in a static arena, twice over, and compares it with the host's word by word.

#![no_std]
#![no_main]

use firmware::{
    Counter,
    baked::{REBUILT, REBUILT_TRIANGLES},
    entry, finish,
};
use hitscan::{Arena, KdTree, Mesh, kdtree::Options};
use semihosting::println;
use static_cell::ConstStaticCell;

/// The options of `build.rs`.
const OPTIONS: Options = Options::small();

/// As many words as always suffice.
const WORDS: usize = KdTree::words(REBUILT_TRIANGLES, &OPTIONS);

static MEMORY: ConstStaticCell<[u32; WORDS]> = ConstStaticCell::new([0; WORDS]);

#[entry]
fn main() -> ! {
    let mesh: Mesh = REBUILT.read();
    let expected = REBUILT.read::<KdTree>().as_words();
    let mut arena = Arena::new(MEMORY.take());
    println!("{REBUILT_TRIANGLES} triangles, an arena of {WORDS} words");

    // As a device would for each frame of a moving scene: what a frame took is free again.
    let counter = Counter::new();
    let mut same = true;
    for frame in 0..2 {
        let mut instructions = 0;
        arena.frame(|arena| {
            let mut built = None;
            instructions = counter.instructions(|| built = KdTree::build(&mesh, arena, &OPTIONS).ok());
            same &= built.is_some_and(|tree| tree.as_words() == expected);
        });
        println!("frame {frame}: built in {instructions} instructions, {} words free behind it", arena.available());
        same &= arena.available() == WORDS;
    }

    // To stay: the rest of the arena is left for others.
    let tree = KdTree::build(&mesh, &mut arena, &OPTIONS).expect("the words suffice");
    println!("{} nodes in {} words, {} words left", tree.node_count(), tree.as_words().len(), arena.available());
    same &= tree.as_words() == expected && arena.available() == WORDS - expected.len();
    println!("the words are {}the host's", if same { "" } else { "NOT " });
    finish(same)
}
