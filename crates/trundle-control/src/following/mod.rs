//! Follows a trajectory to its goal and comes to rest there.
//!
//! Problem: a reference by wall-clock time runs away from a delayed robot, and a tracking law does not come to rest at the goal. Idea: the
//! reference has its own clock. This clock, and with it the reference's twist, slows down if the robot falls behind. At the end of the
//! trajectory point stabilisation takes over (the goal check has two tiers: arrived, settled). Cost: O(log samples).

pub(crate) mod follower;
pub(crate) mod follower_config;
pub(crate) mod reference_clock;
