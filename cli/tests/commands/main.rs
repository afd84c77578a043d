//! The program as its users meet it: arguments in, files, lines and exit codes out.

mod bake;
mod cast;
mod compare;
mod failures;
mod folder;
mod packing;
mod parts;
mod render;
mod textures;
mod world;
