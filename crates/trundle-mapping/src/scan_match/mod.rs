//! Alignment of a scan with a map: searches, likelihoods, refinement, and the directions without information.

pub(crate) mod branch_and_bound;
pub(crate) mod cloud_match;
pub(crate) mod coarse_search;
pub(crate) mod global_search;
pub(crate) mod held_directions;
mod kernel_density;
pub(crate) mod likelihood;
pub(crate) mod motion_prior;
pub(crate) mod normal_equations;
pub(crate) mod point_spread;
pub(crate) mod pose_optimizer;
pub(crate) mod scan_points;

pub use global_search::Lost;
pub use kernel_density::{MatchedMap, ScanMatch, ScanMatchConfig, ScanMatcher};

#[cfg(test)]
pub(crate) mod tests;
