//! Minimum time over all sequences of turns in place and straight moves.

pub(crate) mod beam;
pub(crate) mod connect;
pub(crate) mod leg_search;
pub(crate) mod min_time;
pub(crate) mod polish;
pub(crate) mod rays;
pub(crate) mod shorten;
pub(crate) mod trace;
