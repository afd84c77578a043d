//! Memory for structures: a borrowed slice of words, handed out from the front.

use core::{fmt, mem};

/// The arena is too small for what was asked of it; what it held before is untouched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Full {
    /// Words without which it certainly does not go; more may be needed.
    pub at_least: usize,
    /// Words that were free.
    pub available: usize,
}

impl fmt::Display for Full {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the arena has {} words free, at least {} are needed", self.available, self.at_least)
    }
}

impl core::error::Error for Full {}

/// Hands out parts of a borrowed slice of words.
///
/// A `static mut`-free `[u32; N]`, a `heapless::Vec<u32, N>` or a `Vec<u32>` backs it; what it hands out lives as long as
/// that memory, so several structures can stand in one arena. A builder uses all that is free as scratch and keeps only
/// what it built.
///
/// ```
/// use hitscan::{Arena, KdTree, Mesh, Scene, glam::Vec3, kdtree::Options};
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let mut memory = [0; KdTree::words(1, &Options::small())];
/// let mut arena = Arena::new(&mut memory);
/// let before = arena.available();
/// let tree = KdTree::build(&mesh, &mut arena, &Options::small())?;
/// assert_eq!(before - arena.available(), tree.as_words().len());
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Debug)]
pub struct Arena<'m> {
    free: &'m mut [u32],
}

impl<'m> Arena<'m> {
    /// An arena over all of `memory`.
    #[must_use]
    pub const fn new(memory: &'m mut [u32]) -> Self {
        Self { free: memory }
    }

    /// How many words are free.
    #[must_use]
    pub const fn available(&self) -> usize {
        self.free.len()
    }

    /// Runs `frame` with an arena over what is free, and frees all that it took: for structures rebuilt every frame.
    ///
    /// ```
    /// # use hitscan::{Arena, KdTree, Mesh, glam::Vec3, kdtree::Options};
    /// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// # let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
    /// let mut memory = [0; 1000];
    /// let mut arena = Arena::new(&mut memory);
    /// for _ in 0..3 {
    ///     arena.frame(|arena| KdTree::build(&mesh, arena, &Options::fast()).map(|tree| tree.node_count()))?;
    ///     assert_eq!(arena.available(), 1000);
    /// }
    /// # Ok::<(), hitscan::Error>(())
    /// ```
    pub fn frame<R>(&mut self, frame: impl FnOnce(&mut Arena<'_>) -> R) -> R {
        frame(&mut Arena { free: self.free })
    }

    /// Lets `build` write into all free words and keeps as many from the front as it says it used.
    pub(crate) fn build<E>(&mut self, build: impl FnOnce(&mut [u32]) -> Result<usize, E>) -> Result<&'m [u32], E> {
        let used = build(self.free)?;
        let free = mem::take(&mut self.free);
        match free.split_at_mut_checked(used) {
            Some((kept, rest)) => {
                self.free = rest;
                Ok(kept)
            }
            None => Ok(&[]),
        }
    }
}
