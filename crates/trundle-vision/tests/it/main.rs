//! Features and motion through the public interface: drawn textures and real recordings.

#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr, reason = "tests")]

mod board;
mod board_renderer;
mod determinism;
mod invariance;
mod localisation;
mod real_frames;
mod spread;
mod tag_board;
mod texture;
mod tum;
mod view;
