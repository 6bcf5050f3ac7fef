//! Loops: where the robot comes back to after a long way, found by search within what it may have drifted, and proved.

mod candidates;
mod closer;
mod submap;
mod verify;

pub(crate) use closer::{Closer, PROOF, Tools};
pub(crate) use verify::{Finder, Found};
