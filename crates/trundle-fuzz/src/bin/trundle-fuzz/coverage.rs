//! Counters of executed code, if the program was built with them (`cargo xtask fuzz --guided`).
//!
//! LLVM's pass `sancov-module` adds a counter of 8 bits to each edge of the control flow, and registers them with the function below at the
//! program's start. Without the pass no counters exist, and no input is new.

use std::sync::Mutex;

/// The counters of a part of the program: address of the first, and their number.
static REGIONS: Mutex<Vec<(usize, usize)>> = Mutex::new(Vec::new());

/// Called once by each instrumented part of the program.
#[unsafe(no_mangle)]
extern "C" fn __sanitizer_cov_8bit_counters_init(start: *mut u8, end: *mut u8) {
    if let Ok(mut regions) = REGIONS.lock() {
        regions.push((start as usize, end as usize - start as usize));
    }
}

/// Counts of each edge reached by the inputs so far.
pub struct Coverage {
    regions: Vec<(usize, usize)>,
    seen: Vec<u8>,
}

impl Coverage {
    pub fn new() -> Self {
        let regions = REGIONS.lock().map(|regions| regions.clone()).unwrap_or_default();
        let edges = regions.iter().map(|(_, length)| length).sum();
        Self { regions, seen: vec![0; edges] }
    }

    /// Edges that any input has run through.
    pub fn edges(&self) -> usize {
        self.seen.iter().filter(|counts| **counts != 0).count()
    }

    /// Sets the counters to zero.
    pub fn reset(&self) {
        for &(start, length) in &self.regions {
            // SAFETY: the region belongs to the instrumented program, has static lifetime, and only counts.
            unsafe { std::ptr::write_bytes(start as *mut u8, 0, length) };
        }
    }

    /// Whether the input since the last reset reached a new count of an edge; records the count.
    pub fn is_new(&mut self) -> bool {
        let mut is_new = false;
        let mut seen = self.seen.iter_mut();
        for &(start, length) in &self.regions {
            for at in 0..length {
                // SAFETY: as in `reset`.
                let count = unsafe { std::ptr::read((start + at) as *const u8) };
                let Some(seen) = seen.next() else { return is_new };
                let bit = bucket(count);
                is_new |= bit & !*seen != 0;
                *seen |= bit;
            }
        }
        is_new
    }
}

/// The bit of a count: 1, 2, 3, 4 to 7, 8 to 15, 16 to 31, 32 to 127, 128 and more.
fn bucket(count: u8) -> u8 {
    match count {
        0 => 0,
        1 => 1,
        2 => 2,
        3 => 4,
        4..=7 => 8,
        8..=15 => 16,
        16..=31 => 32,
        32..=127 => 64,
        128.. => 128,
    }
}
