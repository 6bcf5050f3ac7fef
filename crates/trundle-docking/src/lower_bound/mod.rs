//! A lower bound of the time of any manoeuvre, by branch and bound over the positions where the robot turns.
//!
//! Problem: legs found by sampling may be far from the optimum. Idea: a manoeuvre of n legs is determined by the n - 1 positions
//! where it turns. Let each be anywhere in a box. The minimum lengths of the legs, the minimum turns between their directions and
//! the pauses bound the time from below; a hull shrunk by the boxes' size shows where no turn or no leg is free. The box with the
//! smallest bound is split. More legs than can be split are bounded by the time of two legs without obstacles and their pauses: for
//! given headings the sum of concave times under two linear equations is minimal with two legs, and consecutive turns are not
//! faster than one. Cost: about a microsecond per box, more with contact queries.

pub(crate) mod boxes;
pub(crate) mod branch_and_bound;
pub(crate) mod chain;
pub(crate) mod leg_feasibility;
pub(crate) mod ranges;

#[cfg(test)]
mod tests;
