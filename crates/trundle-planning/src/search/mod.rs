//! Search on the grid: configuration space, costs, searches and graphs.

pub(crate) mod bucket_queue;
pub(crate) mod cell_points;
pub(crate) mod clearance_cost;
pub(crate) mod coarse_heuristic;
pub(crate) mod configuration_space;
pub(crate) mod escape;
pub(crate) mod free_points;
pub(crate) mod geodesic_search;
pub(crate) mod grid_path;
pub(crate) mod lattice;
pub(crate) mod potential;
pub(crate) mod string_pulling;
pub(crate) mod waypoint_graph;
