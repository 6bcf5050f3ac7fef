//! One viewer: its subscriptions, and the data sent to it at its own rate.

mod feed;
mod link;

pub use link::{ShownRun, serve};
