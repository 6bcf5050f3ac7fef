//! The fixed-lag smoother: the poses of the last seconds and the calibration, jointly estimated from all measurements.
//!
//! Problem: one pose at the rate of the wheels with a consistent covariance. Odometry drifts; measurements are late, correlated and
//! sometimes of a wrong place. Idea: the poses of a window, the error of the visual poses along it and the calibration are unknowns of one
//! least-squares problem. Late measurements enter at their stamp, correlated errors are modelled, and later data re-evaluate a recognised
//! place. Keyframes that leave the window remain as a Gaussian prior.
//!
//! The graph: a chain of keyframes, each with pose x, error e of the visual pose and bias b of the gyro. Factors between neighbours: the
//! motion by wheels and gyro, the decay of e and the walk of b. Factors on a keyframe: a visual pose (x, e, anchor of the visual map, delay
//! of the camera) and a scan match (x). A border couples with all: scale of the gyro, radii, wheelbase, delay, anchors. A prior acts on the
//! oldest keyframe and the border.
//!
//! | symbol | name here | unit |
//! |---|---|---|
//! | x, e, b | `ChainState` | m, rad; m, rad; rad/s |
//! | scale, radii, wheelbase, delay, anchors A | `BorderState` | 1, 1, 1, s, m and rad |
//! | motion D with covariance and derivatives \[Forster17\] | `Preintegrated` | m, rad |
//! | step of e, switch of a place \[Suenderhauf12\] | `ErrorStep`, `PlaceSwitch` | m, rad; 1 |
//! | prior of fixed linearisation \[Huang10\] | `Prior` | |
//! | normal equations | `trundle_optim::ArrowSystem` | |
//!
//! Cost: O(K) for K keyframes and a measurement; 0.35 ms at 100 keyframes. A full window allocates no memory. The equations are in
//! docs/algorithms/smoother.md.

pub(crate) mod calibration;
pub(crate) mod config;
mod error_process;
mod factors;
pub(crate) mod fixed_lag;
pub(crate) mod innovation;
mod inputs;
mod intake;
mod keyframe;
pub(crate) mod measurement;
mod motion_buffer;
mod prediction;
mod preintegration;
mod prior;
mod scan_intake;
mod state;
#[cfg(test)]
mod tests;
mod visual_intake;
mod visual_maps;
mod window;
