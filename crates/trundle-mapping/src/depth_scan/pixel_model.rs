//! Coefficients that classify the pixels of a depth image.

use super::{DepthScanConfig, FloorFit, range_bins::BIN_COUNT};
use trundle_core::Pose3;

/// Coefficients that classify pixels, in f32 as the depths of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PixelModel {
    pub(super) ray: RayForms,
    /// Height of the camera above the floor, m.
    pub(super) camera_height: f32,
    /// Lower edge of the height band, m above the floor.
    pub(super) low: f32,
    /// Upper edge of the height band, m above the floor.
    pub(super) high: f32,
    pub(super) min_depth: f32,
    pub(super) max_depth: f32,
    pub(super) max_range: f32,
    pub(super) noise: DepthNoise,
    pub(super) floor_sigmas: f32,
    /// Unknown rise of the floor, m/m.
    pub(super) tilt: f32,
    /// Smallest depth below the floor at which a point counts as a hole, m.
    pub(super) drop_depth: f32,
    pub(super) bins_per_metre: f32,
    pub(super) min_support: NeighbourSupport,
}

/// Base-frame x, y and z of a ray 1 m deep, each a linear form of (u, v, 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RayForms {
    pub(super) ahead: [f32; 3],
    pub(super) left: [f32; 3],
    pub(super) rise: [f32; 3],
}

/// Sigma of a depth z: base + growth z^2, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DepthNoise {
    pub(super) base: f32,
    pub(super) growth: f32,
}

/// Minimum number of the eight neighbours on one surface with a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NeighbourSupport {
    /// Number for an obstacle.
    pub(super) hit: u32,
    /// Number for free space.
    pub(super) free: u32,
}

/// Maximum difference of depth on one surface [sigmas of the depth noise]. Deeper points are another surface. Source: ours.
pub(super) const SURFACE_SIGMAS: f32 = 4.0;
/// Minimum of that difference \[m\]: sensors quantise depths. Source: ours.
pub(super) const MIN_SURFACE_DEPTH_M: f32 = 0.03;

impl PixelModel {
    pub(super) fn new(config: &DepthScanConfig, base_from_camera: &Pose3) -> Self {
        let base_from_lens = base_from_camera.rotation_matrix();
        let row = |i: usize| [0, 1, 2].map(|k| base_from_lens[(i, k)] as f32);
        Self {
            ray: RayForms { ahead: row(0), left: row(1), rise: row(2) },
            camera_height: base_from_camera.translation.z as f32,
            low: config.band_low as f32,
            high: config.band_high as f32,
            min_depth: config.min_depth as f32,
            max_depth: config.max_depth as f32,
            max_range: config.max_range as f32,
            noise: DepthNoise { base: config.noise_base as f32, growth: config.noise_growth as f32 },
            floor_sigmas: config.floor_sigmas as f32,
            tilt: config.tilt_error_deg.to_radians().tan() as f32,
            drop_depth: config.drop_depth as f32,
            bins_per_metre: (BIN_COUNT as f64 / config.max_range) as f32,
            min_support: NeighbourSupport {
                hit: u32::from(config.hit_support_px),
                free: u32::from(config.free_support_px),
            },
        }
    }

    /// Model with heights above a fitted floor.
    pub(super) fn above(&self, floor: &FloorFit) -> Self {
        let (ahead, left) = (floor.rise_ahead as f32, floor.rise_left as f32);
        let ray = self.ray;
        let rise = [0, 1, 2].map(|k| ray.rise[k] - ahead * ray.ahead[k] - left * ray.left[k]);
        let tilt = self.tilt.min(floor.rise_error as f32);
        Self {
            ray: RayForms { rise, ..ray },
            tilt,
            camera_height: self.camera_height - floor.height as f32,
            ..*self
        }
    }

    /// Difference of depth up to which points belong to the surface of the nearest one, m.
    pub(super) fn surface_window(&self, depth: f32) -> f32 {
        (SURFACE_SIGMAS * self.noise.sigma(depth)).max(MIN_SURFACE_DEPTH_M)
    }

    /// Maximum height of a floor point, m, on a ray with this rise per metre of depth.
    pub(super) fn floor_edge(&self, rise: f32, depth: f32, range: f32) -> f32 {
        self.low.max(self.floor_sigmas * rise.abs() * self.noise.sigma(depth) + self.tilt * range)
    }

    /// Fraction of a floor point's range at which its ray enters the height band from above. From this range on the ray proves free space:
    /// an obstacle in the band would block the ray.
    pub(super) fn floor_share(&self) -> f32 {
        (1.0 - self.low / self.camera_height).max(0.0)
    }
}

impl DepthNoise {
    /// Standard deviation of a depth, m.
    #[inline(always)]
    pub(super) fn sigma(self, depth: f32) -> f32 {
        self.base + self.growth * depth * depth
    }
}
