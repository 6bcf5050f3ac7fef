//! Trajectory and goal errors: pure functions from data to numbers.
