//! Laws of the surface, by exact images of bodies whose shape is known.

#![allow(clippy::unwrap_used, reason = "tests")]

mod accuracy;
mod closed_bodies;
mod colours;
mod depths;
mod heights;
mod memory;
mod mesh_laws;
mod octree;
mod order;
mod refusals;
mod scene;
