//! Readout time of a rolling shutter, from the images of a turning camera.
//!
//! Problem: many camera files hold no readout time, and with a wrong one the images of a turning camera fit no pose. Idea: the rows of an
//! image are taken at different times, so the matches of two images fit one motion only if each point is first turned to the time of the
//! middle row. The readout time that makes the matches of many image pairs agree best is found together with the motions, without a map: a
//! map of distorted images is distorted as well, and gives too small a time (docs/experiments/slam-rolling-shutter.md). Equations, with the
//! turn rates w of two images and the rows u of a match, as fractions of the height from the middle row:
//!
//! ```text
//! b = project(exp(-T u_b w_b) M exp(T u_a w_a) a)        unknowns: T, and a motion M for each pair
//! ```
//!
//! Cost: two comparisons of the features of two images per image, some ms.

mod estimator;
mod fit;

pub use estimator::ReadoutEstimator;
pub use fit::ReadoutEstimate;
