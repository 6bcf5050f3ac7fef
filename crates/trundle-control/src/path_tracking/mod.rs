//! Tracking a moving reference (docs/methods.md A6; \[Kanayama90\], \[Li18\]).
//!
//! Problem: follow a reference pose that moves with a known twist. Idea: express the error in the robot's frame. The command is the twist
//! of the reference plus feedback on the errors along the path and in heading. A lateral error turns the robot towards the reference, in
//! proportion to the speed. A Lyapunov function proves that the error falls. Cost: O(1).
//!
//! | paper | name here | unit |
//! |---|---|---|
//! | e_x, e_y, e_theta | [`TrackingError`] `along`, `cross`, `heading` | m, m, rad |
//! | v_d, omega_d | the reference's twist | m/s, rad/s |
//! | k1, k2 | the gains by [`PathTrackingConfig`]'s rule | 1/s |
//! | 1 (of e_y) | [`PathTrackingConfig::k_cross`] | 1/m^2 |

pub(crate) mod path_tracker;
pub(crate) mod path_tracking_config;
pub(crate) mod tracking_error;
pub(crate) mod tracking_law;
