//! Blocks of voxels: signed distance, weight and colour.

/// Voxels along a side of a block. Source: \[Niessner13\].
pub(crate) const BLOCK_SIDE: usize = 8;
/// Voxels of a block.
pub(crate) const BLOCK_VOXELS: usize = BLOCK_SIDE * BLOCK_SIDE * BLOCK_SIDE;
/// Largest sum of weights: beyond it the average follows changes. Source: ours, 256 images at 2 m.
const MAX_WEIGHT: u16 = 256;
/// Stored distance of one truncation. Source: ours.
const DISTANCE_SCALE: f32 = 32_000.0;
/// Stored colour of one step of a channel. Source: ours.
const COLOR_SCALE: f32 = 256.0;

/// Key of a block: its corner in units of blocks.
pub(crate) type BlockKey = [i32; 3];

/// Averages of the voxels of a block, x fastest.
#[derive(Debug, Clone)]
pub(crate) struct VoxelBlock {
    distance: [i16; BLOCK_VOXELS],
    weight: [u16; BLOCK_VOXELS],
    color: [[u16; 3]; BLOCK_VOXELS],
}

impl VoxelBlock {
    pub(crate) fn unknown() -> Self {
        Self { distance: [0; BLOCK_VOXELS], weight: [0; BLOCK_VOXELS], color: [[0; 3]; BLOCK_VOXELS] }
    }

    /// Adds an observation: signed distance in truncations (-1 to 1), sRGB, weight above 0.
    pub(crate) fn observe(&mut self, voxel: usize, distance: f32, color: [u8; 3], weight: u16) {
        let old = self.weight[voxel];
        let part = f32::from(weight) / f32::from(old + weight);
        let mean = |old: f32, new: f32| old + (new - old) * part;
        let stored = mean(f32::from(self.distance[voxel]), distance * DISTANCE_SCALE);
        self.distance[voxel] = stored as i16;
        for (stored, new) in self.color[voxel].iter_mut().zip(color) {
            *stored = mean(f32::from(*stored), f32::from(new) * COLOR_SCALE) as u16;
        }
        self.weight[voxel] = (old + weight).min(MAX_WEIGHT);
    }

    /// Mean signed distance in truncations.
    pub(crate) fn distance(&self, voxel: usize) -> f32 {
        f32::from(self.distance[voxel]) / DISTANCE_SCALE
    }

    pub(crate) fn weight(&self, voxel: usize) -> u16 {
        self.weight[voxel]
    }

    /// Mean colour, sRGB.
    pub(crate) fn color(&self, voxel: usize) -> [u8; 3] {
        self.color[voxel].map(|channel| (f32::from(channel) / COLOR_SCALE).round().min(255.0) as u8)
    }
}

/// Index of a voxel in its block.
pub(crate) fn voxel_index(x: usize, y: usize, z: usize) -> usize {
    (z * BLOCK_SIDE + y) * BLOCK_SIDE + x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn observations_are_averaged_by_their_weights() {
        let mut block = VoxelBlock::unknown();
        block.observe(7, 0.5, [100, 0, 255], 3);
        block.observe(7, -0.5, [200, 0, 255], 1);
        assert!((block.distance(7) - 0.25).abs() < 1e-3, "{}", block.distance(7));
        assert_eq!((block.color(7), block.weight(7)), ([125, 0, 255], 4));
        assert_eq!(block.weight(6), 0);
    }

    #[test]
    fn after_many_images_a_change_is_followed() {
        let mut block = VoxelBlock::unknown();
        (0..5_000).for_each(|_| block.observe(0, 1.0, [0; 3], 16));
        (0..100).for_each(|_| block.observe(0, -1.0, [255; 3], 16));
        assert!(block.distance(0) < -0.9 && block.color(0)[0] > 240, "{}", block.distance(0));
    }
}
