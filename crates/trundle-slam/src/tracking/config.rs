//! Settings of visual tracking.

use crate::matching::projection_search::MatchThresholds;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};
use trundle_optim::PoseConfig;

/// Search for the pose of a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct TrackingConfig {
    /// Standard deviation of a keypoint of the finest octave, px, 0.01 to 100. A larger value trusts depth and odometry more than pixels.
    /// Default 1 \[MurArtal17\].
    pub pixel_sigma: f64,
    /// Radius of the search for a point of the last frame around its prediction, px of its octave, above 0, to 1000. The second try doubles it. A
    /// larger window tolerates faster motion and takes longer. Default 15 \[MurArtal17\].
    pub motion_window_px: f64,
    /// Radius of the search for a landmark of the map after tracking from the last frame, px of its octave, above 0, to 1000. Default 6: three standard
    /// deviations of a keypoint and as much for the map.
    pub map_window_px: f64,
    /// Largest distance of descriptors in a match within a window, bits, 0 to 256. A larger value gives more, and more wrong, matches. Default
    /// 80: unlike points differ by 128 on average.
    pub window_distance: u32,
    /// Largest quotient of the best and the second-best distance within a window, above 0 to 1. A smaller value drops ambiguous matches.
    /// Default 0.9 (ours).
    pub window_ratio: f32,
    /// Largest distance of descriptors in a match without a window, bits, 0 to 256. Default 64 (ours).
    pub free_distance: u32,
    /// Largest quotient of the best and the second-best distance without a window, above 0 to 1. Default 0.8 (ours).
    pub free_ratio: f32,
    /// Maximum number of landmarks that are searched in one frame, `weak_inliers` or more. Default 4000 (ours).
    pub max_landmarks: usize,
    /// Number of inliers below which a frame is not located, 6 or more. A smaller number locates frames of bare walls, less reliably.
    /// Default 20 (ours).
    pub min_inliers: usize,
    /// Number of inliers below which a frame is located weakly, and below which a relocalisation is refused, `min_inliers` or more.
    /// Default 40 (ours).
    pub weak_inliers: usize,
    /// Number of keyframes that a lost camera is compared with per frame, 1 or more, and of keyframes similar to the one found. More find a
    /// place sooner and take longer. Default 5: some 20 ms, 40 ms with a try in an inactive map.
    pub relocalisation_keyframes: usize,
    /// Smallest fraction of the image cells with expected landmarks in which a relocalisation finds some, 0 to 1. A smaller value accepts
    /// look-alike rooms. Default 0.6: in 400 views of a simulated office with look-alike rooms, wrong relocalisations without a competitor
    /// reached 0.56, and pictures that hang in two rooms 0.45.
    pub recognised_part: f64,
    /// Largest standard deviation of a relocalisation's position, m, above 0, to 10, including the common errors of one image's points. Default
    /// 0.05. Views with almost all points beyond 6 m exceed it, with errors up to 0.3 m; 97 of 100 other views do not (docs/results.md).
    pub recognised_sigma: f64,
    /// Number of frames in a row without a pose, 0 or more, after which mapping restarts: at the dead-reckoned pose, or without odometry in a new map.
    /// Default 30: a second.
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
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        require_in("tracking.pixel_sigma", self.pixel_sigma, "px", 0.01, 100.0)?;
        require_in("tracking.motion_window_px", self.motion_window_px, "px", 1e-3, 1e3)?;
        require_in("tracking.map_window_px", self.map_window_px, "px", 1e-3, 1e3)?;
        require_in("tracking.window_ratio", f64::from(self.window_ratio), "", 0.01, 1.0)?;
        require_in("tracking.free_ratio", f64::from(self.free_ratio), "", 0.01, 1.0)?;
        require_in("tracking.recognised_part", self.recognised_part, "", 0.0, 1.0)?;
        require_in("tracking.recognised_sigma", self.recognised_sigma, "m", 1e-6, 10.0)?;
        let counts = [
            ("tracking.min_inliers", self.min_inliers, 6),
            ("tracking.weak_inliers", self.weak_inliers, self.min_inliers),
            ("tracking.max_landmarks", self.max_landmarks, self.weak_inliers),
            ("tracking.relocalisation_keyframes", self.relocalisation_keyframes, 1),
        ];
        for (name, value, min) in counts {
            if value < min {
                return Err(Invalid::new(name, value, "", format!("{min} or more")));
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
