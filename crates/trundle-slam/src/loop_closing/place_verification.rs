//! Verifies that a frame shows the place of an old keyframe.

use crate::frame::observation_model::ObservationModel;
use crate::ids::{KeyframeId, LandmarkId};
use crate::loop_closing::config::LoopConfig;
use crate::map::covisibility::MIN_SHARED_LANDMARKS;
use crate::map::landmark_map::LandmarkMap;
use crate::matching::matched_pose::{MatchedPose, PosePriorKind};
use crate::matching::point_match::PointMatch;
use crate::matching::projection_search::{Projection, search};
use crate::matching::reference_frame::ReferenceFrame;
use crate::place_recognition::bow::FrameBow;
use crate::place_recognition::keyframe_index::KeyframeIndex;
use crate::place_recognition::place_hypothesis::{PlaceHypothesis, without_rival};
use crate::tracking::config::TrackingConfig;
use nalgebra::Matrix6;
use std::collections::BTreeSet;
use trundle_core::Pose3;

/// Number of keyframes covisible with a candidate whose landmarks are searched: 10. Source: \[MurArtal17\].
const COVISIBLE_KEYFRAMES: usize = 10;

/// Verifies whether a frame shows the place of a keyframe of `map`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaceVerifier<'a> {
    pub map: &'a LandmarkMap,
    pub place_index: &'a KeyframeIndex,
    pub model: &'a ObservationModel,
    pub tracking: &'a TrackingConfig,
    pub config: &'a LoopConfig,
    pub seed: u64,
}

/// A place of the map that a frame shows.
#[derive(Debug, Clone)]
pub(crate) struct RecognizedPlace {
    pub candidate: KeyframeId,
    /// The frame's camera pose by the old landmarks.
    pub visual_from_camera: Pose3,
    /// Covariance of that pose relative to the old landmarks.
    pub covariance: Matrix6<f64>,
    /// Number of points of the old place found in the frame, landmarks or depths.
    pub points: usize,
    /// The landmarks among them.
    pub landmarks: Vec<LandmarkId>,
}

impl PlaceHypothesis for RecognizedPlace {
    fn pose(&self) -> Pose3 {
        self.visual_from_camera
    }

    fn points(&self) -> usize {
        self.points
    }

    fn is_plausible(&self) -> bool {
        true
    }

    fn is_certain(&self) -> bool {
        true
    }
}

impl PlaceVerifier<'_> {
    /// The place of the candidates that the frame shows; `None` if two distant candidates fit.
    pub fn recognize(&self, own: FrameBow, candidates: &[KeyframeId]) -> Option<RecognizedPlace> {
        without_rival(candidates.iter().filter_map(|id| self.verify(own, *id)).collect())
    }

    /// The place of one keyframe, if the frame shows it.
    pub fn verify(&self, own: FrameBow, candidate: KeyframeId) -> Option<RecognizedPlace> {
        // The frame was aligned to the landmarks of its own track: the alignment is no evidence for the old landmarks.
        let frame = own.frame.clone().unaligned(self.model);
        let own = FrameBow { frame: &frame, ..own };
        let rough = self.by_bow(own, candidate)?;
        let fix = self.by_old_landmarks(own, candidate, &rough);
        let points = fix.solution.inlier_count;
        let agreement = points as f64 / fix.matches.len().max(1) as f64;
        let enough = points >= self.config.min_points && agreement >= self.config.min_agreement;
        let covariance = fix.solution.covariance.filter(|_| enough)?;
        let landmarks = fix.inliers().filter_map(|m| m.landmark).collect();
        let visual_from_camera = fix.visual_from_camera();
        Some(RecognizedPlace { candidate, visual_from_camera, covariance, points, landmarks })
    }

    /// The pose by similar features of frame and candidate.
    fn by_bow(&self, own: FrameBow, candidate: KeyframeId) -> Option<MatchedPose> {
        let pairs = self
            .place_index
            .frame_bow(self.map, candidate)?
            .matches(own, self.tracking.unwindowed_thresholds());
        let anchor: ReferenceFrame = self.map.keyframe(candidate).into();
        let (pose, matches) = anchor.localize(own.frame, &pairs, self.seed, (self.map, self.model))?;
        let fix = MatchedPose::by(
            matches,
            (pose, PosePriorKind::Unknown),
            own.frame,
            self.model,
            &self.tracking.pose,
        );
        fix.is_sound(self.tracking.min_inliers).then_some(fix)
    }

    /// The pose by these and all other landmarks of the old place, from the pose of `rough`.
    fn by_old_landmarks(&self, own: FrameBow, candidate: KeyframeId, rough: &MatchedPose) -> MatchedPose {
        let frame = own.frame;
        let pose = rough.visual_from_camera();
        let matched: BTreeSet<LandmarkId> = rough.inliers().filter_map(|m| m.landmark).collect();
        let mut sought = self.landmarks_around(candidate);
        sought.retain(|id| !matched.contains(id));
        let window = self.tracking.motion_window_px;
        let (mut ids, mut projections) = (Vec::new(), Vec::new());
        let camera_from_visual = pose.inverse();
        for (id, landmark) in sought.into_iter().filter_map(|id| Some((id, self.map.landmark(id)?))) {
            let seen = Projection::of(landmark, camera_from_visual, self.model, window);
            let Some((projection, _)) = seen else { continue };
            ids.push(id);
            projections.push(projection);
        }
        let mut matches: Vec<PointMatch> = rough.inliers().copied().collect();
        let mut free = vec![true; frame.len()];
        matches.iter().for_each(|m| free[m.feature] = false);
        let found = search(frame, &free, &projections, self.tracking.windowed_thresholds());
        let taken = |(feature, i): (usize, usize)| PointMatch::of_landmark(feature, ids[i], self.map);
        matches.extend(found.into_iter().filter_map(taken));
        MatchedPose::by(matches, (pose, PosePriorKind::Unknown), frame, self.model, &self.tracking.pose)
    }

    /// Landmarks of the candidate and of the keyframes around it, by rising id.
    fn landmarks_around(&self, candidate: KeyframeId) -> Vec<LandmarkId> {
        let around = self.map.covisible(candidate, MIN_SHARED_LANDMARKS).into_iter().map(|(id, _)| id);
        let around = around.take(COVISIBLE_KEYFRAMES).chain([candidate]);
        let mut ids: Vec<LandmarkId> =
            around.flat_map(|id| self.map.keyframe(id).landmarks.iter().flatten().copied()).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }
}
