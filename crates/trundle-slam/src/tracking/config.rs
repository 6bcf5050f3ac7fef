//! Settings of visual tracking.

use crate::matching::projection_search::MatchThresholds;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in, require_positive};
use trundle_optim::PoseConfig;

/// How the pose of a frame is found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrackingConfig {
    /// Standard deviation of a keypoint of the finest octave, px, 0.01 to 100. Default 1 \[MurArtal17\].
    pub pixel_sigma: f64,
    /// Radius of the search for a point of the last frame around its prediction, px of its octave, above 0; twice as large at
    /// the second try. Default 15 \[MurArtal17\].
    pub motion_window_px: f64,
    /// Radius of the search for a landmark of the map, px of its octave, once the pose is known from the last frame. Default 6: three standard
    /// deviations of a keypoint and as much for the map.
    pub map_window_px: f64,
    /// Highest distance of descriptors within a window, bits of 256. Default 80: unlike points differ by 128 on average.
    pub window_distance: u32,
    /// Highest quotient of the best and the next best distance within a window, above 0 to 1. Default 0.9.
    pub window_ratio: f32,
    /// Highest distance of descriptors without a window, bits. Default 64.
    pub free_distance: u32,
    /// Highest quotient of the best and the next best distance without a window, above 0 to 1. Default 0.8.
    pub free_ratio: f32,
    /// Landmarks of the map that are searched in one frame. Default 4000.
    pub max_landmarks: usize,
    /// Fewer inliers than this and the frame is not located, 6 or more. Default 20.
    pub min_inliers: usize,
    /// Fewer inliers than this and it is located weakly; a relocalisation needs as many. Default 40.
    pub weak_inliers: usize,
    /// Keyframes that a lost camera is compared with in one frame, 1 or more, and as many of those similar to the one found.
    /// Default 5: some 20 ms, 40 when another map is tried as well.
    pub relocalisation_keyframes: usize,
    /// Fraction of the view, of its cells with expected landmarks, in which a relocalisation must find some, 0 to 1. Default
    /// 0.6: of 400 views of a simulated office with look-alike rooms, wrong ones without a competitor reached 0.56; pictures that
    /// hang in two rooms reach 0.45.
    pub recognised_part: f64,
    /// Largest standard deviation of a relocalisation's position, m, above 0, with the errors counted that points of one image
    /// share. Default 0.05: two of them are 0.1 m. Views of little but points beyond 6 m exceed it, and had errors up to 0.3 m;
    /// 97 of 100 other views do not (docs/results.md).
    pub recognised_sigma: f64,
    /// Frames without success after which a map is begun: at the dead-reckoned pose, or without a prior as another map. Default
    /// 30: a second.
    pub patience: usize,
    /// The solver.
    pub pose: PoseConfig,
}

impl Default for TrackingConfig {
    fn default() -> Self {
        Self {
            pixel_sigma: 1.0,
            motion_window_px: 15.0,
            map_window_px: 6.0,
            window_distance: 80,
            window_ratio: 0.9,
            free_distance: 64,
            free_ratio: 0.8,
            max_landmarks: 4000,
            min_inliers: 20,
            weak_inliers: 40,
            relocalisation_keyframes: 5,
            recognised_part: 0.6,
            recognised_sigma: 0.05,
            patience: 30,
            pose: PoseConfig::default(),
        }
    }
}

impl TrackingConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        require_in("tracking.pixel_sigma", self.pixel_sigma, "px", 0.01, 100.0)?;
        require_positive("tracking.motion_window_px", self.motion_window_px, "px")?;
        require_positive("tracking.map_window_px", self.map_window_px, "px")?;
        require_in("tracking.window_ratio", f64::from(self.window_ratio), "", 0.01, 1.0)?;
        require_in("tracking.free_ratio", f64::from(self.free_ratio), "", 0.01, 1.0)?;
        require_in("tracking.recognised_part", self.recognised_part, "", 0.0, 1.0)?;
        require_positive("tracking.recognised_sigma", self.recognised_sigma, "m")?;
        let counts = [
            ("tracking.min_inliers", self.min_inliers, 6),
            ("tracking.weak_inliers", self.weak_inliers, self.min_inliers),
            ("tracking.max_landmarks", self.max_landmarks, self.weak_inliers),
            ("tracking.relocalisation_keyframes", self.relocalisation_keyframes, 1),
        ];
        for (name, value, least) in counts {
            if value < least {
                return Err(Invalid::new(name, value, "", format!("{least} or more")));
            }
        }
        self.pose = self.pose.validated()?;
        Ok(self)
    }

    pub(crate) fn windowed_thresholds(&self) -> MatchThresholds {
        MatchThresholds { max_distance: self.window_distance, ratio: self.window_ratio }
    }

    pub(crate) fn unwindowed_thresholds(&self) -> MatchThresholds {
        MatchThresholds { max_distance: self.free_distance, ratio: self.free_ratio }
    }
}
