//! Finds the pose of one frame in one map.

use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::covisibility::nearest_keyframes;
use crate::map::landmark_map::LandmarkMap;
use crate::matching::alignment::{aligned, inflate_sigmas};
use crate::matching::matched_pose::{MatchedPose, PosePriorKind};
use crate::matching::point_match::PointMatch;
use crate::matching::projection_search::{MatchThresholds, Projection, search};
use crate::matching::reference_frame::ReferenceFrame;
use crate::place_recognition::bow::{Bow, FrameBow};
use crate::place_recognition::keyframe_index::KeyframeIndex;
use crate::tracking::config::TrackingConfig;
use crate::tracking::local_map::LocalMapQuery;
use std::cell::OnceCell;
use trundle_core::Pose3;
use trundle_optim::PosePrior;
use trundle_vision::{Match, RansacConfig, match_mutual};

/// Number of nearest keyframes whose points are matched when landmarks are few: 2. Others show less of the view. Source:
/// docs/experiments/localise-only.md.
const POINT_KEYFRAMES: usize = 2;

/// Finds the pose of one frame in the map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tracker<'a> {
    pub map: &'a LandmarkMap,
    pub place_index: &'a KeyframeIndex,
    pub model: &'a ObservationModel,
    pub local_map: LocalMapQuery<'a>,
    pub config: &'a TrackingConfig,
    pub frame: &'a Frame,
    /// The camera's pose by odometry since the newest keyframe.
    pub odometry_prior: Option<PosePrior>,
    /// The frame's bag of words, computed on demand.
    pub bow: &'a OnceCell<Bow>,
    pub seed: u64,
    /// Whether the map is fixed and gets no new landmarks.
    pub is_map_fixed: bool,
}

impl Tracker<'_> {
    /// The pose from the last frame, by several searches: its points around their projections by `predicted`, then in wider windows; then
    /// similar features of its reference keyframe, and its own, anywhere in the image. Returns the first pose that a majority of the
    /// matches agrees with, else the pose with the largest number of inliers.
    pub fn by_last(
        &self,
        last: ReferenceFrame,
        reference: Option<KeyframeId>,
        predicted: Pose3,
    ) -> Option<MatchedPose> {
        let tries: [&dyn Fn() -> Option<MatchedPose>; 4] = [
            &|| self.by_motion(last, predicted, 1.0),
            &|| self.by_motion(last, predicted, 2.0),
            &|| self.by_bow(reference?, self.tracked_prior()),
            &|| self.by_descriptors(last),
        ];
        let mut best: Option<MatchedPose> = None;
        for attempt in tries {
            let Some(pose) = attempt() else { continue };
            if pose.has_majority() {
                return Some(pose);
            }
            if best.as_ref().is_none_or(|b| pose.solution.inlier_count > b.solution.inlier_count) {
                best = Some(pose);
            }
        }
        best.filter(|pose| pose.is_sound(self.config.weak_inliers))
    }

    /// The prior of a camera that was tracked from frame to frame.
    pub fn tracked_prior(&self) -> PosePriorKind<'_> {
        PosePriorKind::Tracked(self.odometry_prior.as_ref())
    }

    /// The frame's bag of words.
    pub fn bow(&self) -> &Bow {
        self.bow.get_or_init(|| Bow::of(self.frame, self.place_index.vocabulary()))
    }

    fn by_motion(&self, last: ReferenceFrame, predicted: Pose3, wider: f64) -> Option<MatchedPose> {
        let thresholds = self.config.windowed_thresholds();
        let window = wider * self.config.motion_window_px;
        let matches = last.match_by_motion(self.frame, predicted, window, thresholds, (self.map, self.model));
        self.refined(matches, predicted, self.tracked_prior())
    }

    /// The pose by features similar to those of a keyframe, compared under the same node of the vocabulary.
    pub fn by_bow(&self, keyframe: KeyframeId, prior: PosePriorKind) -> Option<MatchedPose> {
        let own = FrameBow { frame: self.frame, bow: self.bow() };
        let pairs =
            self.place_index.frame_bow(self.map, keyframe)?.matches(own, self.config.unwindowed_thresholds());
        self.located(self.map.keyframe(keyframe).into(), &pairs, prior)
    }

    /// The pose by features similar to those of `last`, anywhere in the image.
    fn by_descriptors(&self, last: ReferenceFrame) -> Option<MatchedPose> {
        let MatchThresholds { max_distance, ratio } = self.config.unwindowed_thresholds();
        let (there, here) = (&last.frame.features.descriptors, &self.frame.features.descriptors);
        let pairs = match_mutual(there, here, max_distance, ratio);
        self.located(last, &pairs, self.tracked_prior())
    }

    fn located(&self, anchor: ReferenceFrame, pairs: &[Match], prior: PosePriorKind) -> Option<MatchedPose> {
        let (pose, matches) = anchor.localize(self.frame, pairs, self.seed, (self.map, self.model))?;
        self.refined(matches, pose, prior)
    }

    /// The final pose by all landmarks expected in the view at the pose of `rough`, with these landmarks. Features that `rough` matched
    /// with a landmark stay matched.
    pub fn by_map(
        &self,
        rough: &MatchedPose,
        prior: PosePriorKind,
    ) -> (MatchedPose, Vec<(LandmarkId, Projection)>) {
        let pose = rough.visual_from_camera();
        let mut matches: Vec<PointMatch> =
            rough.inliers().filter(|m| m.landmark.is_some()).copied().collect();
        let mut free = vec![true; self.frame.len()];
        matches.iter().for_each(|m| free[m.feature] = false);
        let mut matched: Vec<LandmarkId> = matches.iter().filter_map(|m| m.landmark).collect();
        matched.sort_unstable();
        let visible = self.local_map.landmarks(self.map, pose);
        let is_sought =
            |(id, seen): &&(LandmarkId, Projection)| seen.is_findable && matched.binary_search(id).is_err();
        let sought: Vec<_> = visible.iter().filter(is_sought).collect();
        let projections: Vec<Projection> = sought.iter().map(|(_, projection)| *projection).collect();
        let found = search(self.frame, &free, &projections, self.config.windowed_thresholds());
        let taken = |(feature, i): (usize, usize)| PointMatch::of_landmark(feature, sought[i].0, self.map);
        matches.extend(found.into_iter().filter_map(taken));
        let pose = MatchedPose::by(matches, (pose, prior), self.frame, self.model, &self.config.pose);
        (pose, visible)
    }

    /// The pose by the landmarks that agree with `found`, and by measured points of the nearest keyframes that are not landmarks. Landmarks
    /// with a single observer are removed from the map, but the keyframe still has their features and depths.
    pub fn by_keyframe_points(&self, found: &MatchedPose, prior: PosePriorKind) -> MatchedPose {
        let pose = found.visual_from_camera();
        let mut matches: Vec<PointMatch> =
            found.inliers().filter(|m| m.landmark.is_some()).copied().collect();
        let mut free = vec![true; self.frame.len()];
        matches.iter().for_each(|m| free[m.feature] = false);
        for id in nearest_keyframes(self.map, pose, POINT_KEYFRAMES) {
            let is_new =
                |m: &PointMatch| m.landmark.is_none() && std::mem::replace(&mut free[m.feature], false);
            matches.extend(self.matches_of_keyframe(id, pose).into_iter().filter(is_new));
        }
        MatchedPose::by(matches, (pose, prior), self.frame, self.model, &self.config.pose)
    }

    /// The features that show points of a keyframe, for a camera near `pose`.
    fn matches_of_keyframe(&self, keyframe: KeyframeId, pose: Pose3) -> Vec<PointMatch> {
        let keyframe = ReferenceFrame::from(self.map.keyframe(keyframe));
        let (window, thresholds) = (self.config.map_window_px, self.config.windowed_thresholds());
        keyframe.match_by_motion(self.frame, pose, window, thresholds, (self.map, self.model))
    }

    /// The pose of `found` refined with aligned features; `None` if too few can be aligned.
    pub fn aligned(&self, found: &MatchedPose, prior: PosePriorKind) -> Option<MatchedPose> {
        let solve = |matches, start| {
            MatchedPose::by(matches, (start, prior), self.frame, self.model, &self.config.pose)
        };
        let start = found.visual_from_camera();
        let matches = aligned(&found.matches, start, self.frame, (self.map, self.model))?;
        let mut pose = solve(matches, start);
        let spread = pose.spread(self.model);
        if inflate_sigmas(&mut pose.matches, spread, self.frame, self.model) {
            let start = pose.visual_from_camera();
            pose = solve(pose.matches, start);
        }
        pose.is_sound(self.config.min_inliers).then_some(pose)
    }

    /// This tracker with a wider search window, for a roughly known pose.
    pub fn searching_wider(&self) -> Self {
        Self {
            local_map: LocalMapQuery { window_px: self.config.motion_window_px, ..self.local_map },
            ..*self
        }
    }

    fn refined(&self, matches: Vec<PointMatch>, start: Pose3, prior: PosePriorKind) -> Option<MatchedPose> {
        let min_inliers = match prior {
            PosePriorKind::Tracked(_) => self.config.min_inliers,
            // RANSAC matches do not agree by chance, and matching with the map follows.
            PosePriorKind::Unknown => RansacConfig::default().min_inliers,
        };
        if matches.len() < min_inliers {
            return None;
        }
        let pose = MatchedPose::by(matches, (start, prior), self.frame, self.model, &self.config.pose);
        pose.is_sound(min_inliers).then_some(pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_sigma_out_of_range_is_refused() {
        let is_valid =
            |pixel_sigma| TrackingConfig { pixel_sigma, ..TrackingConfig::default() }.validated().is_ok();
        let expected = [(0.0, false), (0.009, false), (0.01, true), (100.0, true), (101.0, false)];
        expected.iter().for_each(|(sigma, valid)| assert_eq!(is_valid(*sigma), *valid, "{sigma}"));
        assert!(!is_valid(f64::NAN));
    }
}
