//! From a grid, a pose and a goal to a path and a trajectory.
