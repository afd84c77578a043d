//! What the page calls. Numbers go in and out; whatever is longer lies in memory, where a function says.
#![allow(unsafe_code, reason = "the names of exports are an unsafe attribute; there is no unsafe block")]

use std::cell::RefCell;

use crate::{BuiltIn, Message, Model, Picture, View, World};

/// All that an instance holds.
#[derive(Default)]
struct Instance {
    input: Vec<u32>,
    model: Option<Model>,
    world: Option<&'static World>,
    picture: Option<Picture<'static>>,
    text: String,
}

thread_local! {
    static INSTANCE: RefCell<Instance> = RefCell::default();
}

fn with<R>(answer: impl FnOnce(&mut Instance) -> R) -> R {
    INSTANCE.with_borrow_mut(answer)
}

/// Room for a [`Message`] of so many words; where it is.
#[unsafe(no_mangle)]
extern "C" fn input(words: usize) -> *mut u32 {
    with(|instance| {
        instance.input = vec![0; words];
        instance.input.as_mut_ptr()
    })
}

/// Takes the message in the input as the model; 0, or 1 if [`text`] says what is wrong with it.
#[unsafe(no_mangle)]
extern "C" fn take_message() -> u32 {
    with(|instance| {
        let words = std::mem::take(&mut instance.input);
        let model = Message::read(&words);
        instance.keep(model)
    })
}

/// Takes a built-in model; 0, or 1 if there is none of this number.
#[unsafe(no_mangle)]
extern "C" fn take_built_in(number: u32) -> u32 {
    with(|instance| {
        let model = BuiltIn::model(number).ok_or_else(|| "There is no such model.".to_owned());
        instance.keep(model)
    })
}

impl Instance {
    fn keep(&mut self, model: Result<Model, String>) -> u32 {
        match model {
            Ok(model) => {
                self.model = Some(model);
                0
            }
            Err(error) => self.refuse(error),
        }
    }

    fn refuse(&mut self, error: String) -> u32 {
        self.text = error;
        1
    }
}

/// Builds a structure over the model, once; 0, or 1 if [`text`] says why not.
#[unsafe(no_mangle)]
extern "C" fn build(structure: u32, preset: u32) -> u32 {
    with(|instance| match World::new(instance.model.take().unwrap_or_default(), structure, preset) {
        Ok(world) => {
            instance.world = Some(Box::leak(Box::new(world)));
            0
        }
        Err(error) => instance.refuse(error),
    })
}

/// Begins a picture; nonsense is made harmless.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments, reason = "numbers are all that can cross")]
extern "C" fn begin(
    width: u32,
    height: u32,
    yaw: f32,
    pitch: f32,
    zoom: f32,
    terms: u32,
    bounces: u32,
    samples: u32,
    heat: u32,
) {
    let view = View { width, height, yaw, pitch, zoom, terms, bounces, samples, heat: heat != 0 };
    with(|instance| instance.picture = instance.world.map(|world| Picture::new(world, view)));
}

/// Draws at most so many blocks, all of one tile; how many, 0 at the end.
#[unsafe(no_mangle)]
extern "C" fn step(blocks: u32) -> u32 {
    with(|instance| instance.picture.as_mut().map_or(0, |picture| picture.step(blocks)))
}

/// Where the pixels are, four bytes each, row by row.
#[unsafe(no_mangle)]
extern "C" fn pixels() -> *const u8 {
    with(|instance| instance.picture.as_ref().map_or(std::ptr::null(), |picture| picture.pixels().as_ptr().cast()))
}

/// Columns left of the tile that [`step`] drew in.
#[unsafe(no_mangle)]
extern "C" fn tile_x() -> u32 {
    with(|instance| instance.picture.as_ref().map_or(0, |picture| picture.tile().x))
}

/// Rows above it.
#[unsafe(no_mangle)]
extern "C" fn tile_y() -> u32 {
    with(|instance| instance.picture.as_ref().map_or(0, |picture| picture.tile().y))
}

/// Its columns.
#[unsafe(no_mangle)]
extern "C" fn tile_width() -> u32 {
    with(|instance| instance.picture.as_ref().map_or(0, |picture| picture.tile().width))
}

/// Its rows.
#[unsafe(no_mangle)]
extern "C" fn tile_height() -> u32 {
    with(|instance| instance.picture.as_ref().map_or(0, |picture| picture.tile().height))
}

/// How fine the picture is: 8, 4, 2, 1, and 0 while edges are smoothed and after.
#[unsafe(no_mangle)]
extern "C" fn fineness() -> u32 {
    with(|instance| instance.picture.as_ref().map_or(0, Picture::fineness))
}

/// Rays cast since the picture began.
#[unsafe(no_mangle)]
extern "C" fn rays() -> f64 {
    with(|instance| instance.world.map_or(0.0, |world| world.rays() as f64))
}

/// Nodes visited since the picture began.
#[unsafe(no_mangle)]
extern "C" fn nodes() -> f64 {
    with(|instance| instance.world.map_or(0.0, |world| world.nodes() as f64))
}

/// How many triangles and spheres there are.
#[unsafe(no_mangle)]
extern "C" fn primitives() -> u32 {
    with(|instance| instance.world.map_or(0, World::primitives))
}

/// Bytes of the structure.
#[unsafe(no_mangle)]
extern "C" fn structure_bytes() -> usize {
    with(|instance| instance.world.map_or(0, World::structure_bytes))
}

/// Where the last error's sentence is.
#[unsafe(no_mangle)]
extern "C" fn text() -> *const u8 {
    with(|instance| instance.text.as_ptr())
}

/// Bytes of the last error's sentence.
#[unsafe(no_mangle)]
extern "C" fn text_length() -> usize {
    with(|instance| instance.text.len())
}
