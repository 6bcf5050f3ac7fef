//! The SLAM as a whole: on rendered rooms with known motion, and on a recorded sequence.

mod freiburg;
mod robustness;
mod room;
mod synthetic;
mod umeyama;
