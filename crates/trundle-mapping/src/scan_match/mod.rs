//! Where a scan fits the map best: correlative search, then refinement, with the directions nobody can tell left alone.

mod config;
mod degeneracy;
mod field;
mod matcher;
mod refine;
mod search;
mod sites;

pub use config::ScanMatchConfig;
pub use matcher::{ScanMatch, ScanMatcher};
