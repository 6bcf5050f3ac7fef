//! Tracking a moving reference (docs/methods.md A6; \[Kanayama90\], \[Li18\]).
//!
//! Problem: stay at a reference pose that moves with a known twist. Idea: see the error in the robot's frame; drive what
//! the reference drives, plus feedback on the error along and in heading; turn towards the reference where it stands
//! beside, in proportion to the speed. A Lyapunov function proves that the error falls. Cost: O(1).
//!
//! | paper | name here | unit |
//! |---|---|---|
//! | e_x, e_y, e_theta | [`TrackingError`] `along`, `cross`, `heading` | m, m, rad |
//! | v_d, omega_d | the reference's twist | m/s, rad/s |
//! | k1, k2 | the gains by [`TrackingConfig`]'s rule | 1/s |
//! | 1 (of e_y) | [`TrackingConfig::k_cross`] | 1/m^2 |

mod config;
mod error;
mod law;
mod tracker;

pub use config::TrackingConfig;
pub use error::TrackingError;
pub use tracker::{ControlReport, Tracker};
