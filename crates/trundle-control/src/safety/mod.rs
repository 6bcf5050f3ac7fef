//! The last check before the wheels: it passes only twists from which the robot can still stop.
//!
//! Problem: a plan depends on a map and an estimate, and both can be wrong. Idea: sweep the footprint along the commanded arc against the
//! last scan, moved by odometry, and against the near map (the camera is blind below 0.5 m). The allowed speed is that from which the robot
//! stops before the first contact. Obstacles outside the swept area have no effect, such as a wall next to the robot. A disc may always
//! turn on the spot; a polygon only at a rate from which it stops before a corner meets an obstacle. The monitor uses no plan and no goal.
//! Cost: O(beams + cells within reach), without allocation after the first call.
//!
//! Reaction and braking over the free distance s: v t + v^2 / (2 a) <= s, so v = -a t + sqrt(a^2 t^2 + 2 a s).

mod free_motion;
pub(crate) mod hold;
pub(crate) mod obstacles;
pub(crate) mod safety_action;
pub(crate) mod safety_config;
pub(crate) mod safety_input;
pub(crate) mod safety_monitor;
pub(crate) mod station_motion;

#[cfg(test)]
mod tests;
