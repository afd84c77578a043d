//! What a time-of-flight sensor of 8 x 8 zones reports in a room with moving boxes: millimetres as CSV.

use hitscan::{Arena, Error};
use semihosting::{print, println};

use crate::{
    Board,
    baked::RANGES,
    figure,
    hash::Hash,
    room::{FRAMES, Room, ZONES},
};

/// All frames; the host has found the same.
pub fn run(board: &mut Board) -> bool {
    let (mut hash, mut instructions) = (Hash::NONE, 0);
    let mut scan = || -> Result<(), Error> {
        let room = Room::new(&mut Arena::new(board.memory))?;
        println!("frame,row,mm,mm,mm,mm,mm,mm,mm,mm");
        for frame in 0..FRAMES {
            let mut ranges = Ok([None; ZONES * ZONES]);
            instructions += board.counter.instructions(|| ranges = room.ranges(frame));
            for (row, ranges) in ranges?.chunks_exact(ZONES).enumerate() {
                print!("{frame},{row}");
                for &range in ranges {
                    hash.add(range.map_or(u32::MAX, u32::from));
                    range.map_or_else(|| print!(","), |range| print!(",{range}"));
                }
                println!();
            }
        }
        Ok(())
    };
    let scanned = scan().inspect_err(|error| println!("{error}")).is_ok();
    figure("tof_sensor", "frame", instructions / u64::from(FRAMES));
    scanned && hash == RANGES
}
