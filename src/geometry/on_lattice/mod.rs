//! Rays and triangles in whole numbers, for chips that have no floating point.
//!
//! Coordinates are numbers of a [`Lattice`](super::Lattice)'s planes, 0 to 65,535 along each axis. After a ray is made,
//! everything but the last step, from a depth to `t`, is done in integers of 32 bits, in products that fit them too: the same bits everywhere, and on a Cortex-M0
//! an instruction each. Only triangles larger than an eighth of the lattice take products of 64 bits.
//!
//! # The ray
//!
//! Along its *major axis*, the one that it crosses most planes of, a [`LatticeRay`] is what is left of the real ray after
//! two roundings: where it crosses the other axes' planes at the middle of the lattice, and how many of them per plane of
//! the major one, both in 2^-14. Inside the lattice it is within one and a bit of a plane's distance of the real one.
//!
//! # The triangle
//!
//! Each corner is projected along the ray to where the ray is the point 0, and rounded to the middle of a half step: a
//! function of ray and corner alone, so shared corners stay shared. From there on everything about hit or miss is exact, as
//! in the float test: edge functions are integers, and a shared edge gives exactly the negative. No ray passes between two
//! triangles. The depth is the mean of the corners' planes by weights that are the edge functions to 15 bits.
//!
//! # Why a structure loses nothing
//!
//! Let a ray hit a triangle at depth D, counted in planes of the major axis. The point P of the triangle that has the exact
//! weights lies within 1/4 step of the ray along both minor axes, at a depth that differs from D by less than 3 · 65,535 ·
//! 2^-15 + 2^-8 < 6.1, because each weight was cut by less than one unit in 2^15. So where D says the ray is, it is within
//! 6.1 + 1/4 steps of P. The half-spaces that a structure bounds P by are numbers of planes that are at most 8 steps off
//! ([`LatticeRay`] has the sum). To the exact depth at which the ray crosses such a plane, a ray's view of an axis adds or takes off what
//! it may be wrong by, so that no box that P lies in is entered behind D or left before it, and nothing is pruned that ends
//! a search at D. Nested boxes only take the greatest entry and the least exit, and depths of hits are compared as they are.
//!
//! # The rays of a tile
//!
//! Rays from one point, of one major axis, are walked at once: between the rays through the outer corners of the tile all
//! others lie, farther from them than directions are rounded by, and the depth at which a plane across an axis is passed only
//! rises or only falls from corner to corner. So the steepest line's entries and the flattest one's exits bound those of
//! all; what the roundings of a second ray add is within a slack of eight more steps. Where rays go both ways along an axis, those that
//! rise bound the entries, and what lies below the lowest of all at the last plane is never met.
//!
//! A triangle's corners are projected to the tile. What a ray hits lies within a few steps of its line, as it is seen from the eye
//! a fraction of a pixel; that, and what else is rounded, is a number per triangle. A ray farther outside of the projected
//! triangle than this hits nothing; the others take the test.

mod fixed;
mod path;
mod pencil;
mod projection;
mod ray;
mod rays;
mod sight;
mod space;
mod triangle;

pub use path::LatticePath;
pub(crate) use pencil::LatticePencil;
pub use ray::LatticeRay;
pub use rays::LatticeRays;
pub(crate) use sight::Sight;
pub use space::LatticeSpace;
pub(crate) use triangle::Depth;
