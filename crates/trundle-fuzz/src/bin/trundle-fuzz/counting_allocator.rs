//! The system's allocator, with a count of the memory in use and its peak.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Memory at which an allocation is refused \[bytes\]: 3 GB. The process then ends, and its input is a finding. Source: ours.
const MAX_BYTES_IN_USE: usize = 3 << 30;

/// The system's allocator, with a count of the memory in use and its peak.
pub struct CountingAllocator {
    in_use: AtomicUsize,
    peak: AtomicUsize,
}

impl CountingAllocator {
    pub const fn new() -> Self {
        Self { in_use: AtomicUsize::new(0), peak: AtomicUsize::new(0) }
    }

    /// Begins a measurement: the bytes in use.
    pub fn start(&self) -> usize {
        let in_use = self.in_use.load(Relaxed);
        self.peak.store(in_use, Relaxed);
        in_use
    }

    /// Maximum number of bytes in use since [`CountingAllocator::start`], above the number returned by it.
    pub fn peak_above(&self, start: usize) -> usize {
        self.peak.load(Relaxed).saturating_sub(start)
    }

    /// Whether the limit leaves room for this number of bytes.
    fn take(&self, bytes: usize) -> bool {
        let in_use = self.in_use.fetch_add(bytes, Relaxed) + bytes;
        self.peak.fetch_max(in_use, Relaxed);
        in_use <= MAX_BYTES_IN_USE
    }

    fn give_back(&self, bytes: usize) {
        self.in_use.fetch_sub(bytes, Relaxed);
    }
}

// SAFETY: every call is passed to the system's allocator with the same arguments; a refused one returns null, as allowed.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !self.take(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the caller's layout.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if !self.take(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the caller's layout.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if !self.take(size) {
            return std::ptr::null_mut();
        }
        self.give_back(layout.size());
        // SAFETY: the caller's pointer and layout.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        self.give_back(layout.size());
        // SAFETY: the caller's pointer and layout.
        unsafe { System.dealloc(pointer, layout) }
    }
}
