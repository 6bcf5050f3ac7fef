//! The best particle's way as a graph of poses: what its closed loops bend, and how sure each place is.

mod reach;
mod solve;
mod sparse;
mod tie;

pub(crate) use reach::{Reached, reach};
pub(crate) use solve::solve;
pub(crate) use tie::Tie;
