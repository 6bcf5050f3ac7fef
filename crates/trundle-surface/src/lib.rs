//! Surface reconstruction from depth images: triangles with colours.
//!
//! Problem: a floor map shows where the robot can drive, and not what the rooms look like. Idea: each voxel near a surface averages the
//! signed distances that the depth images show (\[Curless96\]); voxels are stored in blocks near surfaces only (\[Niessner13\]). The surface is
//! where the average is zero; one vertex a cell is placed at the mean of the crossings on its edges (\[Gibson98\]).
//!
//! - [`SurfaceMap`]: integrates RGB-D images with known poses.
//! - [`surface_mesh`]: a [`SurfaceMesh`] with a colour and a normal at each vertex.
//! - [`OccupiedVoxels`]: free voxels along the camera's rays, and occupied voxels at their ends and on the surface, for planners in space.
//! - [`HeightMap`]: the highest surface over each cell of the floor.
//!
//! Cost: an image takes O(voxels in view); memory grows with the area of the surface, not with the number of images. The result depends on
//! images, poses and their order alone.
//!
//! ```
//! use trundle_core::{DepthImage, ColorImage, PinholeCamera, Pose3, RgbdImage, Stamp};
//! use trundle_surface::{SurfaceConfig, SurfaceMap, surface_mesh};
//!
//! // A wall 2 m before the camera, seen twice.
//! let camera = PinholeCamera::kinect_v2();
//! let (width, height) = (camera.width(), camera.height());
//! let depth = DepthImage::filled(width, height, 2.0);
//! let image = RgbdImage::new(Stamp::default(), ColorImage::filled(width, height, [200, 80, 40]), depth)?;
//! let mut map = SurfaceMap::new(SurfaceConfig::default())?;
//! for _ in 0..2 {
//!     map.integrate(&image, &camera, &Pose3::identity())?;
//! }
//! let mesh = surface_mesh(&map);
//! assert!(mesh.triangles.len() > 1000);
//! assert!(mesh.vertices.iter().all(|vertex| (vertex[2] - 2.0).abs() < 0.002));
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod depth_view;
mod height_map;
mod occupied_voxels;
mod surface_config;
mod surface_map;
mod surface_mesh;
mod surface_nets;
mod triangle_voxels;
mod voxel_block;

pub use height_map::HeightMap;
pub use occupied_voxels::{OccupiedVoxels, VoxelState};
pub use surface_config::SurfaceConfig;
pub use surface_map::SurfaceMap;
pub use surface_mesh::SurfaceMesh;
pub use surface_nets::surface_mesh;
