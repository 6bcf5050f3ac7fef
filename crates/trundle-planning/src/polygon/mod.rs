//! Polygonal footprints: exact gaps and the search over straight moves and turns.

pub(crate) mod lattice_planner;
pub(crate) mod robot_shape;
