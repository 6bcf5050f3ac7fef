//! The method of \[Hong24\], as a baseline.

pub(crate) mod config;
pub(crate) mod decide;
pub(crate) mod plan;

pub use config::Hong24Config;

#[cfg(test)]
mod tests;
