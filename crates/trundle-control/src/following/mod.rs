//! Along a trajectory to its goal, and to rest there.
//!
//! Problem: a reference that runs by the clock runs away from a robot that is held up, and a tracking law does not
//! settle. Idea: the reference has a clock of its own, which slows down as the robot falls behind, and its twist with it;
//! where the trajectory arrives, point stabilisation takes over (the goal check has two tiers: arrived, settled).
//! Cost: O(log samples).

pub(crate) mod follower;
pub(crate) mod follower_config;
pub(crate) mod reference_clock;
