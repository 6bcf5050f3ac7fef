//! Fuzz targets: one function per reader, each with seeds and words. No input makes a target panic, hang or allocate unbounded memory.
//!
//! [`TARGETS`] is the list. `cargo xtask fuzz` runs it on the stable toolchain, `fuzz/` under libFuzzer, and the tests of this
//! crate on all seeds and on the inputs of `fuzz/corpus`. A new reader is one function in [`targets`] and one line in [`TARGETS`].

pub mod corpus;
mod scratch;
pub mod seeds;
mod target;
pub mod targets;

pub use target::{FuzzTarget, TARGETS};
