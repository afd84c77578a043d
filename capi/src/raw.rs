//! Pointers from C: the only unsafe code. Each is checked for null and for its alignment before it is followed.
//!
//! None of these types can be made in Rust: values come from C, whose side of the contract is in the header. A pointer that
//! passes the checks points to as many values as its length says, which live and do not move for as long as the function's
//! documentation asks; what is written through it is not read through another at the same time.

#![allow(unsafe_code)]

use core::{mem::MaybeUninit, slice};

use crate::{scene::View, status::Status};

/// A value, or an array, that C lends for reading.
#[repr(transparent)]
#[derive(Clone, Copy)]
pub struct In<T>(*const T);

/// Memory that C lends for writing; it need not be initialised.
#[repr(transparent)]
pub struct Out<T>(*mut T);

/// Whether a pointer can be one to `count` values.
fn check<T>(pointer: *const T, count: usize) -> Result<(), Status> {
    if pointer.is_null() {
        Err(Status::Null)
    } else if !pointer.is_aligned() {
        Err(Status::Misaligned)
    } else if count.checked_mul(size_of::<T>()).is_none_or(|bytes| bytes > isize::MAX as usize) {
        Err(Status::Length)
    } else {
        Ok(())
    }
}

impl<T: 'static> In<T> {
    /// Whether it is the null pointer.
    pub fn is_null(&self) -> bool {
        self.0.is_null()
    }

    /// The value.
    pub fn get(&self) -> Result<&'static T, Status> {
        check(self.0, 1)?;
        // SAFETY: not null, aligned, and by the contract a value that outlives its use.
        Ok(unsafe { &*self.0 })
    }

    /// The same place as one of another type.
    pub fn cast<U>(&self) -> In<U> {
        In(self.0.cast())
    }

    /// The array of `count` values; of none the pointer may be null.
    pub fn array(&self, count: usize) -> Result<&'static [T], Status> {
        if count == 0 {
            return Ok(&[]);
        }
        check(self.0, count)?;
        // SAFETY: not null, aligned, at most `isize::MAX` bytes, and by the contract `count` values that outlive their use.
        Ok(unsafe { slice::from_raw_parts(self.0, count) })
    }
}

impl<T: 'static> Out<T> {
    /// The place of one value.
    pub fn place(&self) -> Result<&'static mut MaybeUninit<T>, Status> {
        check(self.0, 1)?;
        // SAFETY: not null, aligned, and by the contract memory for a value that no one else uses meanwhile.
        Ok(unsafe { &mut *self.0.cast() })
    }

    /// The places of `count` values; of none the pointer may be null.
    pub fn places(&self, count: usize) -> Result<&'static mut [MaybeUninit<T>], Status> {
        if count == 0 {
            return Ok(&mut []);
        }
        check(self.0, count)?;
        // SAFETY: not null, aligned, at most `isize::MAX` bytes, and by the contract memory for `count` values that no one
        // else uses meanwhile.
        Ok(unsafe { slice::from_raw_parts_mut(self.0.cast(), count) })
    }

    /// The value, which C has initialised.
    pub fn get(&self) -> Result<&'static mut T, Status> {
        check(self.0, 1)?;
        // SAFETY: not null, aligned, and by the contract a value that no one else uses meanwhile.
        Ok(unsafe { &mut *self.0 })
    }

    /// The array of `count` values, which C has initialised; of none the pointer may be null.
    pub fn array(&self, count: usize) -> Result<&'static mut [T], Status> {
        if count == 0 {
            return Ok(&mut []);
        }
        check(self.0, count)?;
        // SAFETY: not null, aligned, at most `isize::MAX` bytes, and by the contract `count` values that no one else uses
        // as long as they are borrowed.
        Ok(unsafe { slice::from_raw_parts_mut(self.0, count) })
    }
}

impl Out<u32> {
    /// The words behind the first `count`.
    pub fn skip(&self, count: usize) -> Self {
        Self(self.0.wrapping_add(count))
    }
}

/// A scene: what rays are cast at. The caller's to place: on the stack, in a static variable, in a structure.
///
/// Open one with hitscan_open or hitscan_build. It borrows the asset, or the mesh and the arena, which must outlive it and
/// stay as they are. It may be copied, needs no closing, and never changes by queries: any number of threads may share it.
/// One of zeros is closed.
#[repr(C)]
pub struct Scene {
    /// Not for you.
    state: usize,
    /// Not for you.
    opaque: [MaybeUninit<usize>; 106],
}

/// The state of an open scene; whatever else it is, the scene is closed.
const OPEN: usize = 0x7374_6968;

// Room for the largest view, whatever features are on, so that the header is the same for all.
const _: () = assert!(size_of::<View>() <= size_of::<[usize; 106]>() && align_of::<View>() <= align_of::<usize>());

impl Scene {
    /// A scene on which every query fails.
    pub const CLOSED: Self = Self { state: 0, opaque: [MaybeUninit::uninit(); 106] };

    /// The scene of this view.
    pub fn open(view: View) -> Self {
        let mut scene = Self { state: OPEN, ..Self::CLOSED };
        // SAFETY: there is room, and the alignment is right, see above.
        unsafe { scene.opaque.as_mut_ptr().cast::<View>().write(view) };
        scene
    }

    /// The view, if the scene is open.
    pub fn view(&self) -> Result<&View, Status> {
        if self.state != OPEN {
            return Err(Status::Closed);
        }
        // SAFETY: only `open` sets the state, together with the view.
        Ok(unsafe { &*self.opaque.as_ptr().cast() })
    }
}
