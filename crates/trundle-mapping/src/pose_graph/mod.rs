//! Pose graph of one trajectory: constraints, their least-squares solution, and the uncertainty of each pose.

mod constraint;
mod equations;
mod solver;
mod uncertainty_paths;

pub(crate) use constraint::Constraint;
pub(crate) use equations::PoseEquations;
pub(crate) use solver::solve;
pub(crate) use uncertainty_paths::{RelativeUncertainty, reach};

#[cfg(test)]
mod tests;
