//! Worlds from files: glTF scenes, and maps raised to walls.

mod blocks;
mod error;
mod gltf;
mod raised_map;

pub use error::{ImportError, ImportFault};
pub use gltf::{GltfOptions, UpAxis, gltf, gltf_from_bytes};
pub use raised_map::{RaisedMap, raise_map};
