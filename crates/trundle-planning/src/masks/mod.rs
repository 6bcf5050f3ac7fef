//! Masks over the map: speed limits, costs and keep-out areas, of files and of zones.

pub(crate) mod cost_mask;
pub(crate) mod keep_out;
pub(crate) mod speed_mask;
pub(crate) mod zone_cells;
