//! The guard against a lack of progress: one potential, one patience.

pub(crate) mod followed_path;
pub(crate) mod guard;
pub(crate) mod rest;
