//! Laws of the particle filter's scan matcher.

mod cloud_match;
mod motion_prior;
mod room;
