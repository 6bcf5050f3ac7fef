//! Connectivity of poses: the free headings over every cell of a grid of positions.
//!
//! Problem: prove that *no* motion leads from one pose to another. Idea: over a cell of side e, shrink the hull by the cell's half
//! diagonal. Every motion of the true hull in the cell is one of the shrunk hull at the cell's centre; the shrunk hull's free headings have
//! a closed form. Neighbouring cells are connected if their free headings overlap. Without a connection of start and goal, no motion of any
//! kind exists. Cost: the reachable cells, times the segments near them.

pub(crate) mod free_headings;
pub(crate) mod proof;
pub(crate) mod time_estimate;
