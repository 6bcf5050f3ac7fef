//! Bundle adjustment of the map, in slices between frames.

pub(crate) mod constraints;
pub(crate) mod global_bundle;
pub(crate) mod local_bundle;
pub(crate) mod map_bundle;
pub(crate) mod map_optimisation;
