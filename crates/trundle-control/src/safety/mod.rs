//! The last word before the wheels: only twists from which the robot can still stop.
//!
//! Problem: a plan rests on a map and an estimate, and both can be wrong. Idea: sweep the robot's outline along the
//! commanded arc against what the sensors saw last, carried forward by odometry, and against the map near by (the camera
//! is blind below 0.5 m); allow the speed at which it still stops before the first contact. What the outline does not
//! sweep does not matter: a wall beside or behind stops nobody. A disc may always turn on the spot; a polygon as fast as it
//! can stop before a corner swings into something.
//! It knows no plan and no goal. Cost: O(beams + cells within reach), without allocation after the first call.
//!
//! Reaction and braking over the free way s: v t + v^2 / (2 a) <= s, so v = -a t + sqrt(a^2 t^2 + 2 a s).

mod config;
mod monitor;
mod obstacles;
mod reason;

pub use config::SafetyConfig;
pub use monitor::{MotionSense, SafetyInput, SafetyMonitor, SafetyReport};
pub use obstacles::{SafetyMemory, SafetyScan};
pub use reason::{SafetyAction, SlowReason, StopReason};
