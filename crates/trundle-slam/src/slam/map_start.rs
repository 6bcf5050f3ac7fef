//! Whether a frame that was not located begins a map.

use crate::config::SlamConfig;
use crate::frame::rgbd_frame::{Frame, with_depth};
use crate::map::landmark_map::LandmarkMap;
use crate::matching::projection_search::MatchThresholds;
use crate::tracking::last_frame::LastFrame;
use crate::tracking::tracking_state::TrackingState;
use trundle_vision::match_mutual;

/// Fewest features of a frame, and fewest expected landmarks, for a discontinuity of the view when no landmark is found: 200. Fewer can be
/// missing by blur. Source: ours.
const MIN_DISCONTINUITY_FEATURES: usize = 200;
/// Longest time since the last located frame for a discontinuity of the view: 0.5 s. After a longer gap the view may have changed by
/// motion. Source: ours.
const MAX_DISCONTINUITY_GAP_S: f64 = 0.5;

/// Action for a frame that was not located.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MapStart {
    /// No map begins: a known landmark may be seen again.
    Wait,
    /// The first keyframe of the map.
    FirstMap,
    /// A keyframe at the dead-reckoned pose.
    Continue,
    /// Another map, since the camera's pose in this one is unknown.
    NewMap,
}

/// Number of a frame's features, and of the landmarks expected in it.
#[derive(Clone, Copy)]
pub(super) struct Visibility<'a> {
    pub frame: &'a Frame,
    pub expected: &'a dyn Fn() -> usize,
}

impl Visibility<'_> {
    /// Whether a frame right after a located one has many features but none of many expected landmarks: the camera made a motion that the
    /// wheels did not measure.
    pub fn is_discontinuous(&self, state: &TrackingState) -> bool {
        let is_next = |last: &LastFrame| self.frame.stamp - last.frame.stamp < MAX_DISCONTINUITY_GAP_S;
        state.lost_frames == 1
            && self.frame.len() >= MIN_DISCONTINUITY_FEATURES
            && state.last.as_ref().is_some_and(is_next)
            && (self.expected)() >= MIN_DISCONTINUITY_FEATURES
    }
}

/// Inputs of the decision.
#[derive(Clone, Copy)]
pub(super) struct MapStartQuery<'a> {
    pub visibility: Visibility<'a>,
    pub config: &'a SlamConfig,
    pub map: &'a LandmarkMap,
    pub tracking: &'a TrackingState,
    /// Whether odometry measured the last step.
    pub has_prior: bool,
}

impl MapStartQuery<'_> {
    /// The action for the frame.
    pub fn decide(&self) -> MapStart {
        let (config, state) = (self.config, self.tracking);
        if with_depth(self.visibility.frame).count() < config.mapping.min_points {
            MapStart::Wait
        } else if self.map.keyframe_count() == 0 {
            MapStart::FirstMap
        } else if state.is_lost() {
            if state.lost_frames >= config.tracking.patience { MapStart::NewMap } else { MapStart::Wait }
        } else if self.has_prior
            && !state.odometry_conflict.is_active()
            && self.is_outside_map()
            && self.repeats_last_frame()
        {
            if state.is_too_uncertain() { MapStart::NewMap } else { MapStart::Continue }
        } else {
            MapStart::Wait
        }
    }

    /// Whether no known landmark will be seen again: none is expected in view, or none was found for too long.
    fn is_outside_map(&self) -> bool {
        let config = &self.config.tracking;
        (self.visibility.expected)() < config.min_inliers || self.tracking.lost_frames >= config.patience
    }

    /// Whether the frame matches the previous frame, which was not located either. Corners of noise on a bare wall are not in the next
    /// frame, and a keyframe of such corners is useless.
    fn repeats_last_frame(&self) -> bool {
        let config = &self.config.tracking;
        let MatchThresholds { max_distance, ratio } = config.unwindowed_thresholds();
        let own = &self.visibility.frame.features.descriptors;
        let repeated =
            |before: &Frame| match_mutual(&before.features.descriptors, own, max_distance, ratio).len();
        let before = self.tracking.lost_frame.as_ref();
        before.is_some_and(|before| repeated(before) >= config.weak_inliers)
    }
}
