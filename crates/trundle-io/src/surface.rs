//! Surfaces and voxels on disk: PLY, binary glTF, OctoMap, and a height picture.

mod glb;
mod height;
mod octomap;
mod ply;

pub use glb::glb_bytes;
pub use height::{HeightFiles, HeightGrid, height_files};
pub use octomap::octomap_bytes;
pub use ply::ply_bytes;

/// A surface to write: m, z up, one normal and one sRGB colour a vertex. Without triangles it is a cloud of points.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceData<'a> {
    /// Positions, m.
    pub vertices: &'a [[f32; 3]],
    /// Unit normals.
    pub normals: &'a [[f32; 3]],
    /// sRGB.
    pub colors: &'a [[u8; 3]],
    /// Indices of the corners among the vertices.
    pub triangles: &'a [[u32; 3]],
}

#[cfg(test)]
mod tests;
