//! Laws of contact: each closed form against sampling, against rigid motions, and against the others.

#![allow(clippy::unwrap_used, reason = "tests")]

mod agreement;
mod arcs;
mod motions;
mod segments;
mod support;
