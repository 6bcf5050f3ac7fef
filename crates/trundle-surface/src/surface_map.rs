//! Signed distances of a scene, from RGB-D images with known poses.

use crate::depth_view::DepthView;
use crate::surface_config::SurfaceConfig;
use crate::voxel_block::{BLOCK_SIDE, BlockKey, VoxelBlock, voxel_index};
use nalgebra::Vector3;
use std::collections::HashMap;
use trundle_core::{Invalid, PinholeCamera, Pose3, RgbdImage};

/// Largest number of pixels between two rays that create blocks. Source: ours.
const MAX_RAY_STRIDE_PX: f64 = 4.0;
/// Largest number of blocks. The map then takes no new ones. Source: ours, 4 GB.
const MAX_BLOCKS: usize = 800_000;

/// The surface of a scene.
#[derive(Debug, Clone)]
pub struct SurfaceMap {
    config: SurfaceConfig,
    index: HashMap<BlockKey, usize>,
    pub(crate) keys: Vec<BlockKey>,
    pub(crate) blocks: Vec<VoxelBlock>,
}

impl SurfaceMap {
    /// An empty map.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: SurfaceConfig) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()?, index: HashMap::new(), keys: Vec::new(), blocks: Vec::new() })
    }

    /// The settings.
    #[must_use]
    pub fn config(&self) -> &SurfaceConfig {
        &self.config
    }

    /// Whether no further block is taken.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.blocks.len() >= MAX_BLOCKS
    }

    /// Memory of the voxels, bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.blocks.capacity() * size_of::<VoxelBlock>()
            + self.keys.capacity() * size_of::<BlockKey>()
            + self.index.capacity() * (size_of::<BlockKey>() + size_of::<usize>())
    }

    /// Adds an image that `camera` took at `map_from_camera`. Every voxel in view is averaged; voxels before the surface become free, so
    /// that an object that left disappears.
    ///
    /// # Errors
    /// When the image has another size than the camera, or the pose is not finite. The map is then unchanged.
    pub fn integrate(
        &mut self,
        image: &RgbdImage,
        camera: &PinholeCamera,
        map_from_camera: &Pose3,
    ) -> Result<(), Invalid> {
        let view = DepthView::new(image, camera, map_from_camera, &self.config)?;
        self.create_blocks(&view, camera.fx());
        let truncation = self.config.truncation() as f32;
        let voxel = self.config.voxel as f32;
        let (half, radius) = (BLOCK_SIDE as f32 * voxel / 2.0, BLOCK_SIDE as f32 * voxel * 0.87);
        for (key, block) in self.keys.iter().zip(&mut self.blocks) {
            let corner = Vector3::from(*key).cast::<f32>() * (BLOCK_SIDE as f32 * voxel);
            let centre = view.in_camera(corner.add_scalar(half));
            if view.may_show(centre, radius, truncation) {
                update_block(block, &view, corner, voxel, truncation);
            }
        }
        Ok(())
    }

    /// A block by its key.
    pub(crate) fn block(&self, key: BlockKey) -> Option<&VoxelBlock> {
        self.index.get(&key).map(|&index| &self.blocks[index])
    }

    /// Creates the blocks within the truncation of the surface that the view shows. Two rays, and two points of a ray, are at most half a
    /// block apart.
    fn create_blocks(&mut self, view: &DepthView<'_>, focal_px: f64) {
        let truncation = self.config.truncation();
        let side = self.config.voxel * BLOCK_SIDE as f64;
        let stride = (side / 2.0 * focal_px / self.config.max_depth).clamp(1.0, MAX_RAY_STRIDE_PX) as usize;
        let steps = (2.0 * truncation / side).ceil().max(1.0);
        for [near, far] in view.points(stride, |depth| [depth - truncation as f32, depth + truncation as f32])
        {
            for step in 0..=(2.0 * steps) as usize {
                let point = near + (far - near) * (step as f64 / (2.0 * steps));
                if self.is_full() {
                    continue;
                }
                let key = point.map(|at| (at / side).floor() as i32).into();
                if !self.index.contains_key(&key) {
                    self.index.insert(key, self.blocks.len());
                    self.keys.push(key);
                    self.blocks.push(VoxelBlock::unknown());
                }
            }
        }
    }
}

/// Averages the view into the voxels of a block whose corner is at `corner`, map frame, m.
fn update_block(
    block: &mut VoxelBlock,
    view: &DepthView<'_>,
    corner: Vector3<f32>,
    voxel: f32,
    truncation: f32,
) {
    let step = view.rotation.column(0) * voxel;
    for z in 0..BLOCK_SIDE {
        for y in 0..BLOCK_SIDE {
            let start = Vector3::new(0.5, y as f32 + 0.5, z as f32 + 0.5) * voxel;
            let mut point = view.in_camera(corner + start);
            for x in 0..BLOCK_SIDE {
                if let Some(seen) = view.observe(point) {
                    let distance = seen.depth - point.z;
                    if distance > -truncation {
                        let distance = (distance / truncation).min(1.0);
                        block.observe(voxel_index(x, y, z), distance, seen.color, seen.weight);
                    }
                }
                point += step;
            }
        }
    }
}

#[cfg(test)]
mod tests;
