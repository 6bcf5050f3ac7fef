//! A lower bound of the time of any manoeuvre, by branch and bound over its turning positions.
//!
//! Problem: legs found by sampling may be far from the optimum. Idea: a manoeuvre of n legs is determined by its n - 1 turning positions.
//! Let each be anywhere in a box. The minimum lengths of the legs, the minimum turns between their directions and the pauses bound the time
//! from below. A hull shrunk by the boxes' size excludes turns and legs that are never free. The box with the smallest bound is split.
//! Longer chains of legs are bounded by the time of two legs without obstacles and their pauses. For given headings the sum of concave
//! times under two linear equations is minimal with two legs, and consecutive turns are not faster than one. Cost: about a microsecond per
//! box, more with contact queries.

pub(crate) mod boxes;
pub(crate) mod branch_and_bound;
pub(crate) mod chain;
pub(crate) mod leg_feasibility;
pub(crate) mod ranges;

#[cfg(test)]
mod tests;
