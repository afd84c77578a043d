//! A heap that knows how much of it was in use at most.

use core::{
    alloc::{GlobalAlloc, Layout},
    mem::MaybeUninit,
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

use embedded_alloc::LlffHeap;

/// Bytes of the heap: half of the board's memory.
const BYTES: usize = 2 << 20;

/// Counts what a heap gives away.
struct Counting {
    heap: LlffHeap,
    live: AtomicUsize,
    peak: AtomicUsize,
}

#[global_allocator]
static HEAP: Counting = Counting { heap: LlffHeap::empty(), live: AtomicUsize::new(0), peak: AtomicUsize::new(0) };

// SAFETY: the heap's own promises; nothing but its answers is passed on.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let live = self.live.fetch_add(layout.size(), Relaxed) + layout.size();
        self.peak.fetch_max(live, Relaxed);
        // SAFETY: as the caller's.
        unsafe { self.heap.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        self.live.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller's.
        unsafe { self.heap.dealloc(place, layout) }
    }
}

/// Hands the memory to the heap; to be called once, before anything is allocated.
pub fn start() {
    static mut MEMORY: [MaybeUninit<u8>; BYTES] = [MaybeUninit::uninit(); BYTES];
    // SAFETY: only the heap uses it from now on.
    unsafe { HEAP.heap.init(&raw mut MEMORY as usize, BYTES) }
}

/// Bytes in use.
pub fn live() -> usize {
    HEAP.live.load(Relaxed)
}

/// Bytes in use at most since the last call, in which time the most begins anew.
pub fn peak() -> usize {
    HEAP.peak.swap(live(), Relaxed)
}
