//! Coefficients that classify the pixels of a depth image.

use super::{DepthScanConfig, FloorFit, range_bins::BINS};
use trundle_core::Pose3;

/// The numbers by which pixels are sorted, f32 as the images are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SortModel {
    /// x, y and z (base frame) of a ray one m deep, as sums of its u, its v, and 1.
    pub(super) ahead: [f32; 3],
    pub(super) left: [f32; 3],
    pub(super) rise: [f32; 3],
    /// Above the floor, m.
    pub(super) camera_height: f32,
    pub(super) low: f32,
    pub(super) high: f32,
    pub(super) min_depth: f32,
    pub(super) max_depth: f32,
    pub(super) max_range: f32,
    pub(super) noise_base: f32,
    pub(super) noise_growth: f32,
    pub(super) floor_sigmas: f32,
    /// Rise of the floor that may be unknown, m/m.
    pub(super) tilt: f32,
    pub(super) drop_depth: f32,
    pub(super) bins_per_metre: f32,
    pub(super) hit_support: u32,
    pub(super) free_support: u32,
}

/// Points count as one surface when their depths differ by fewer noises than this.
pub(super) const SURFACE_SIGMAS: f32 = 4.0;
/// Or by less than this, m.
pub(super) const SURFACE_LEAST: f32 = 0.03;

impl SortModel {
    pub(super) fn new(config: &DepthScanConfig, base_from_camera: &Pose3) -> Self {
        let base_from_lens = base_from_camera.rotation_matrix();
        let row = |i: usize| [0, 1, 2].map(|k| base_from_lens[(i, k)] as f32);
        Self {
            ahead: row(0),
            left: row(1),
            rise: row(2),
            camera_height: base_from_camera.translation.z as f32,
            low: config.band_low as f32,
            high: config.band_high as f32,
            min_depth: config.min_depth as f32,
            max_depth: config.max_depth as f32,
            max_range: config.max_range as f32,
            noise_base: config.noise_base as f32,
            noise_growth: config.noise_growth as f32,
            floor_sigmas: config.floor_sigmas as f32,
            tilt: config.tilt_error_deg.to_radians().tan() as f32,
            drop_depth: config.drop_depth as f32,
            bins_per_metre: (BINS as f64 / config.max_range) as f32,
            hit_support: u32::from(config.hit_support_px),
            free_support: u32::from(config.free_support_px),
        }
    }

    /// The same with heights above a fitted floor.
    pub(super) fn above(&self, floor: &FloorFit) -> Self {
        let (ahead, left) = (floor.rise_ahead as f32, floor.rise_left as f32);
        let rise = [0, 1, 2].map(|k| self.rise[k] - ahead * self.ahead[k] - left * self.left[k]);
        let tilt = self.tilt.min(floor.rise_error as f32);
        Self { rise, tilt, camera_height: self.camera_height - floor.height as f32, ..*self }
    }

    /// One sigma of a depth, m.
    pub(super) fn noise(&self, depth: f32) -> f32 {
        self.noise_base + self.noise_growth * depth * depth
    }

    /// How far behind the nearest point of a surface others still belong to it, m.
    pub(super) fn surface_window(&self, depth: f32) -> f32 {
        (SURFACE_SIGMAS * self.noise(depth)).max(SURFACE_LEAST)
    }

    /// The highest point that may be floor, m, for a ray with this rise a metre of depth.
    pub(super) fn floor_edge(&self, rise: f32, depth: f32, range: f32) -> f32 {
        self.low.max(self.floor_sigmas * rise.abs() * self.noise(depth) + self.tilt * range)
    }

    /// Which part of a floor point's range its ray still was above the band's lower edge: what is nearer than the rest could
    /// hide nothing that reaches into the band.
    pub(super) fn floor_share(&self) -> f32 {
        (1.0 - self.low / self.camera_height).max(0.0)
    }
}
