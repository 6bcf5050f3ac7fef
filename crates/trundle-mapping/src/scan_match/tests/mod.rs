//! Laws of the particle filter's scan matcher.

mod cloud_match;
mod held_directions;
mod likelihood;
mod motion_prior;
pub(crate) mod room;
