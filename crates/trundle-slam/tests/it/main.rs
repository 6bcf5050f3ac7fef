//! The SLAM as a whole: on rendered rooms with known motion, and on a recorded sequence.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr, reason = "tests, helpers included")]

mod freiburg;
mod maps;
mod robustness;
mod room;
<<<<<<< HEAD
mod saving;
=======
mod settings;
>>>>>>> c5c83a5 (Wrong settings are noticed from the images: depth range, travel, focal lengths, lens, registration)
mod synthetic;
mod umeyama;
mod walks;
