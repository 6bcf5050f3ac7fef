//! Worlds from files: glTF scenes, and maps raised to walls.

mod blocks;
mod error;
mod gltf;
mod notes;
mod raised_map;

pub use error::{ImportError, ImportFault};
pub use gltf::{GltfOptions, ImportedScene, UpAxis, gltf, gltf_from_bytes};
pub use notes::ImportNote;
pub use raised_map::{RaisedMap, raise_map};
