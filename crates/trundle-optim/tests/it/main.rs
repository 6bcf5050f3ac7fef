//! Laws of the least-squares problems: frames, order, weights, and refused input.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod bundles;
mod graphs;
mod poses;
mod priors;
mod residuals;
mod support;
