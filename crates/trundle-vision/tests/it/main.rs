//! The features and the motion as a user of the crate meets them: drawn textures and real recordings.

mod determinism;
mod invariance;
mod real_frames;
mod spread;
mod texture;
mod tum;
