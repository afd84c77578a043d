//! Draws what the page shows with the library on the host, by its own order, and writes the bytes: for `check` to compare.
//!
//! `picture MODEL STRUCTURE PRESET WIDTH HEIGHT YAW PITCH ZOOM TERMS BOUNCES SAMPLES HEAT`

use std::io::{self, Write};

use hitscan_web::{BuiltIn, Picture, View, World};

fn main() -> Result<(), String> {
    let numbers: Vec<f32> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let &[model, structure, preset, width, height, yaw, pitch, zoom, terms, bounces, samples, heat] =
        numbers.as_slice()
    else {
        return Err("give twelve numbers".to_owned());
    };
    let model = BuiltIn::model(model as u32).ok_or("no such model")?;
    let world = World::new(model, structure as u32, preset as u32)?;
    let [width, height, terms, bounces, samples] = [width, height, terms, bounces, samples].map(|number| number as u32);
    let view = View { width, height, yaw, pitch, zoom, terms, bounces, samples, heat: heat != 0.0 };
    let pixels = Picture::at_once(&world, view);
    io::stdout().write_all(pixels.as_flattened()).map_err(|error| error.to_string())
}
