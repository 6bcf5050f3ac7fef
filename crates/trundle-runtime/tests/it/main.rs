//! The robot as a whole, fed by hand: no simulator here.

mod config;
mod robot;
