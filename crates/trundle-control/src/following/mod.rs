//! Along a trajectory to its goal, and to rest there.
//!
//! Problem: a reference that runs by the wall clock runs away from a delayed robot, and a tracking law does not settle. Idea: the
//! reference has a clock of its own. This clock, and with it the reference's twist, slows down as the robot falls behind. At the end
//! of the trajectory point stabilisation takes over (the goal check has two tiers: arrived, settled). Cost: O(log samples).

pub(crate) mod follower;
pub(crate) mod follower_config;
pub(crate) mod reference_clock;
