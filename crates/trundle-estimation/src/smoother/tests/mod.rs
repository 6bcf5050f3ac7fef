//! The smoother against numeric differences and a dense batch solution.

mod batch;
mod derivatives;
mod fixture;
