//! A time that no manoeuvre beats, by branch and bound over the places where the robot turns.
//!
//! Problem: legs found by sampling may be far from the best. Idea: a manoeuvre of n legs is fixed by the n - 1 places where
//! it turns. Let each be anywhere in a box: the legs' least lengths, the least turns between their directions and the
//! pauses bound the time from below; a hull shrunk by the boxes' size shows where no turn or no leg is free. The box that
//! promises most is split. What n is too great to be split this way is bounded by the free two-leg time and its pauses:
//! for given headings the sum of concave times under two linear equations is least with two legs, and turns that follow
//! each other are not faster than one. Cost: boxes, about a microsecond each, more where contact is asked for.

mod boxes;
mod chain;
mod queue;
mod ranges;
mod tests_of_legs;

pub use queue::improve;
