//! One planning request on one distance field.

pub(crate) mod answer;
pub(crate) mod disc_planner;
pub(crate) mod footprint_check;
pub(crate) mod grid_refinement;
pub(crate) mod path_search;
pub(crate) mod plan_query;
pub(crate) mod polygon_planner;
pub(crate) mod stage_timer;
pub(crate) mod yield_stop;
