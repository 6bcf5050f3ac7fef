//! Scan matching against the hits of an occupancy map: window search on a likelihood field, then refinement.

mod config;
mod information;
mod matched_map;
mod matcher;
mod refinement;
mod window_search;

pub use config::ScanMatchConfig;
pub use matched_map::MatchedMap;
pub use matcher::{ScanMatch, ScanMatcher};
