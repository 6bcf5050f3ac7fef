//! Masks over the map: speed limits, costs and keep-out areas.

pub(crate) mod cost_mask;
pub(crate) mod keep_out;
pub(crate) mod speed_mask;
