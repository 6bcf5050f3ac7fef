//! The pose of a frame, and the evidence for it.

use crate::frame::aligned_feature::Aligned;
use crate::ids::{KeyframeId, LandmarkId};
use crate::matching::alignment::agreeing_matches;
use crate::matching::matched_pose::{MatchedPose, PosePriorKind};
use crate::matching::point_match::PointMatch;
use crate::matching::projection_search::Projection;
use crate::matching::reference_frame::ReferenceFrame;
use crate::place_recognition::place_hypothesis::{PlaceHypothesis, is_same_place};
use crate::tracking::config::TrackingConfig;
use crate::tracking::tracker::Tracker;
use crate::tracking::tracking_status::Tracking;
use std::collections::{BTreeMap, BTreeSet};
use trundle_core::{Pose3, Vector2};
use trundle_optim::CORRELATED_POINTS;

/// Side of the image cells in which landmarks are counted: 40 px. Source: ours, a few times the distance between features.
const CELL_PX: f64 = 40.0;
/// Fewest expected landmarks of a counted cell: 3. Source: ours.
const MIN_EXPECTED_IN_CELL: usize = 3;

/// The pose of a frame and the matches that support it.
#[derive(Debug)]
pub(crate) struct LocalizedFrame {
    pub pose: MatchedPose,
    /// The matches that agree with the pose, with aligned features if the patches fit.
    pub seen: Vec<PointMatch>,
    /// Number of matches before alignment. The place is evaluated by all of them, since fewer can be aligned.
    pub matches: usize,
    /// Number of matches that agreed before alignment.
    pub points: usize,
    /// Whether the agreeing points contradict the odometry.
    points_contradict: bool,
    /// The expected landmarks with their projections.
    pub visible: Vec<(LandmarkId, Projection)>,
    /// Whether the pose agrees with the landmark map, not only with the last frame.
    pub by_map: bool,
    /// The similar keyframe of a relocalisation.
    pub recognized: Option<KeyframeId>,
    /// Whether enough of the view matches the place.
    pub is_plausible: bool,
    /// Whether the pose is also certain.
    pub is_certain: bool,
    /// Whether the landmarks determine the pose, however small their part of the view.
    is_determined: bool,
}

impl LocalizedFrame {
    /// Tracks from the last frame, whose reference keyframe is `reference`, to the map. With too few landmarks, in a blurred or new view,
    /// points of a fixed map's keyframes are used as well. If these do not suffice, the last frame alone gives the pose: drift is better
    /// than a lost camera.
    pub fn from_last(
        tracker: &Tracker,
        last: ReferenceFrame,
        reference: Option<KeyframeId>,
        predicted: Pose3,
    ) -> Option<Self> {
        let rough = tracker.by_last(last, reference, predicted)?;
        let (pose, visible) = tracker.by_map(&rough, tracker.tracked_prior());
        if let Some(pose) = Self::by_keyframe_points(tracker, [&pose, &rough]) {
            return Some(Self::by_matches(pose, visible));
        }
        let by_map = pose.is_sound(tracker.config.min_inliers);
        let pose = if by_map { pose } else { rough };
        let localized = Self::by_matches(pose, visible);
        Some(if by_map {
            localized.aligned(tracker, tracker.tracked_prior())
        } else {
            Self { by_map, ..localized }
        })
    }

    /// The pose by landmarks and points of keyframes, for a fixed map with few landmarks in view. `candidates` are poses by the landmarks
    /// and by the last frame; the search starts at the first sound one. Features are not aligned, since these points have no reference
    /// patches.
    fn by_keyframe_points(tracker: &Tracker, candidates: [&MatchedPose; 2]) -> Option<MatchedPose> {
        let TrackingConfig { min_inliers, weak_inliers, .. } = *tracker.config;
        let is_due = tracker.is_map_fixed && !candidates[0].is_sound(weak_inliers);
        let start = candidates.into_iter().find(|pose| is_due && pose.is_sound(min_inliers))?;
        let nearly = tracker.by_keyframe_points(start, tracker.tracked_prior());
        let pose = tracker.by_keyframe_points(&nearly, tracker.tracked_prior());
        pose.is_sound(weak_inliers).then_some(pose)
    }

    /// Relocalizes from a keyframe to the map. A certain relocalisation needs more agreeing landmarks, and some in a large part of the
    /// view: a picture may hang in two rooms. The landmarks must also determine the pose, including the common errors of one image's
    /// points.
    pub fn from_keyframe(tracker: &Tracker, keyframe: KeyframeId) -> Option<Self> {
        let rough = tracker.by_bow(keyframe, PosePriorKind::Unknown)?;
        let (nearly, _) = tracker.searching_wider().by_map(&rough, PosePriorKind::Unknown);
        let (pose, visible) = tracker.by_map(&nearly, PosePriorKind::Unknown);
        let config = tracker.config;
        (pose.is_sound(config.min_inliers) && pose.has_majority()).then_some(())?;
        let found = pose.inliers().map(|m| tracker.frame.pixels[m.feature]);
        let seen = seen_fraction(visible.iter().map(|(_, seen)| seen.pixel), found);
        let covariance = pose.solution.covariance? * CORRELATED_POINTS;
        let sigma = covariance.fixed_view::<3, 3>(0, 0).trace().sqrt();
        let is_plausible = pose.is_sound(config.weak_inliers) && seen >= config.recognised_part;
        let is_determined = sigma <= config.recognised_sigma;
        let is_certain = is_plausible && is_determined;
        let localized = Self::by_matches(with_correlated_errors(pose), visible);
        Some(Self { recognized: Some(keyframe), is_plausible, is_certain, is_determined, ..localized })
    }

    /// A pose by the map, tracked there.
    fn by_matches(pose: MatchedPose, visible: Vec<(LandmarkId, Projection)>) -> Self {
        Self {
            seen: pose.inliers().copied().collect(),
            matches: pose.matches.len(),
            points: pose.solution.inlier_count,
            points_contradict: pose.solution.contradicts_prior,
            pose,
            visible,
            by_map: true,
            recognized: None,
            is_plausible: true,
            is_certain: true,
            is_determined: true,
        }
    }

    /// Accepts a relocalisation by a small part of the view: no look-alike place is within reach.
    pub fn accept_partial_view(&mut self) {
        (self.is_plausible, self.is_certain) = (true, self.is_determined);
    }

    /// This frame with aligned features, if enough can be aligned and the pose stays at its place.
    pub fn aligned(self, tracker: &Tracker, prior: PosePriorKind) -> Self {
        let Some(pose) = tracker.aligned(&self.pose, prior) else { return self };
        let pose = if self.recognized.is_some() { with_correlated_errors(pose) } else { pose };
        if !is_same_place(pose.visual_from_camera(), self.pose.visual_from_camera()) {
            return self;
        }
        Self { seen: agreeing_matches(&self.pose, &pose, tracker.frame), pose, ..self }
    }

    /// Number of points that contradict the odometry; `None` if the pose agrees with it.
    pub fn points_against_odometry(&self) -> Option<usize> {
        let solution = &self.pose.solution;
        let points = if self.points_contradict { self.points } else { solution.inlier_count };
        solution.contradicts_prior.then_some(points)
    }

    /// Whether the odometry since the last keyframe is wrong: the wheels slipped, or the robot was carried.
    pub fn contradicts_odometry(&self) -> bool {
        self.pose.solution.contradicts_prior || self.recognized.is_some()
    }

    /// The landmark of each feature.
    pub fn landmarks(&self, features: usize) -> Vec<Option<LandmarkId>> {
        let mut landmarks = vec![None; features];
        for seen in &self.seen {
            landmarks[seen.feature] = seen.landmark;
        }
        landmarks
    }

    /// Aligned features with their positions.
    pub fn aligned_features(&self) -> impl Iterator<Item = (usize, Aligned)> + '_ {
        self.seen.iter().filter_map(|m| Some((m.feature, m.aligned?)))
    }

    /// The landmarks that should have been found.
    pub fn findable(&self) -> impl Iterator<Item = LandmarkId> + '_ {
        self.visible.iter().filter(|(_, seen)| seen.is_findable).map(|(id, _)| *id)
    }

    /// Status of the localization.
    pub fn tracking(&self, config: &TrackingConfig) -> Tracking {
        if self.by_map && self.points >= config.weak_inliers { Tracking::Ok } else { Tracking::Weak }
    }
}

impl PlaceHypothesis for LocalizedFrame {
    fn pose(&self) -> Pose3 {
        self.pose.visual_from_camera()
    }

    fn points(&self) -> usize {
        self.points
    }

    fn is_plausible(&self) -> bool {
        self.is_plausible
    }

    fn is_certain(&self) -> bool {
        self.is_certain
    }
}

/// The pose with a covariance that includes the common errors of one image's points.
fn with_correlated_errors(mut pose: MatchedPose) -> MatchedPose {
    pose.solution.covariance = pose.solution.covariance.map(|covariance| covariance * CORRELATED_POINTS);
    pose
}

/// Fraction of the image's cells with landmarks expected in which one is found, 0 to 1. Unlike the number of found landmarks, this fraction
/// does not depend on the number of features.
fn seen_fraction(expected: impl Iterator<Item = Vector2>, found: impl Iterator<Item = Vector2>) -> f64 {
    let cell = |pixel: Vector2| ((pixel.x / CELL_PX).floor() as i32, (pixel.y / CELL_PX).floor() as i32);
    let mut counts: BTreeMap<(i32, i32), usize> = BTreeMap::new();
    expected.for_each(|pixel| *counts.entry(cell(pixel)).or_default() += 1);
    counts.retain(|_, count| *count >= MIN_EXPECTED_IN_CELL);
    let seen: BTreeSet<(i32, i32)> = found.map(cell).filter(|cell| counts.contains_key(cell)).collect();
    seen.len() as f64 / counts.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::sub_map::SubMap;
    use crate::frame::rgbd_frame::Frame;
    use crate::ids::MapId;
    use crate::local_mapping::reference_patch_storage::store_reference_patches;
    use crate::map::landmark_map::LandmarkMap;
    use crate::testing::{model, painted_frame, painted_map, painted_points};
    use crate::tracking::config::TrackingConfig;
    use crate::tracking::local_map::LocalMapQuery;
    use nalgebra::Vector6;
    use std::cell::OnceCell;
    use trundle_core::DepthImage;
    use trundle_optim::PosePrior;
    use trundle_vision::Vocabulary;

    /// Checks the localization of a frame of the painted wall by correct matches, for a camera with this prior.
    fn with_found(frame: &Frame, prior: PosePriorKind, check: impl FnOnce(LocalizedFrame, &Tracker)) {
        let (model, (mut map, keyframe)) = (model(), painted_map());
        store_reference_patches(&mut map, keyframe, &model);
        with_tracker(map, frame, |tracker| {
            let Tracker { map, model, config, .. } = *tracker;
            let ids = map.landmarks().enumerate();
            let matches = ids.map(|(i, (id, _))| PointMatch::of_landmark(i, id, map).unwrap()).collect();
            let pose = MatchedPose::by(matches, (Pose3::identity(), prior), frame, model, &config.pose);
            check(LocalizedFrame::by_matches(pose, vec![]), tracker);
        });
    }

    /// The tracker of a frame in a map.
    fn with_tracker(map: LandmarkMap, frame: &Frame, check: impl FnOnce(&Tracker)) {
        let (model, config) = (model(), TrackingConfig::default());
        let SubMap { map, place_index, .. } = SubMap::new(MapId(0), map, &Vocabulary::builtin());
        let image = DepthImage::filled(320, 240, 0.0);
        let depth = Default::default();
        let local_map = LocalMapQuery::new(&model, (&image, &depth), &config);
        let bow = OnceCell::new();
        let (map, place_index, model, config) = (&map, &place_index, &model, &config);
        let tracker = Tracker {
            is_map_fixed: false,
            map,
            place_index,
            model,
            local_map,
            config,
            frame,
            odometry_prior: None,
            bow: &bow,
            seed: 0,
        };
        check(&tracker);
    }

    fn frame_of_the_wall() -> Frame {
        painted_frame(Pose3::identity(), &painted_points(), Vector2::new(0.2, -0.1))
    }

    #[test]
    fn correlated_errors_are_counted_once_aligned_or_not() {
        let (mut frame, recognized) = (frame_of_the_wall(), Some(KeyframeId::from_index(0)));
        with_found(&frame, PosePriorKind::Unknown, |found, tracker| {
            let aligned =
                tracker.aligned(&found.pose, PosePriorKind::Unknown).unwrap().solution.covariance.unwrap();
            let found = LocalizedFrame { recognized, pose: with_correlated_errors(found.pose), ..found };
            let found = found.aligned(tracker, PosePriorKind::Unknown);
            assert_eq!(found.pose.solution.covariance, Some(aligned * CORRELATED_POINTS));
            assert!(found.seen.iter().all(|m| m.aligned.is_some()));
        });
        frame.drop_image();
        with_found(&frame, PosePriorKind::Unknown, |found, tracker| {
            let plain = found.pose.solution.covariance.unwrap();
            let found = LocalizedFrame { recognized, pose: with_correlated_errors(found.pose), ..found };
            let found = found.aligned(tracker, PosePriorKind::Unknown);
            assert_eq!(
                found.pose.solution.covariance,
                Some(plain * CORRELATED_POINTS),
                "nothing could be aligned"
            );
        });
    }

    /// Landmarks with a single observer are removed, and the last frame has drifted.
    #[test]
    fn points_of_keyframes_locate_a_frame_in_a_fixed_map_without_landmarks() {
        let (mut map, _) = painted_map();
        let landmarks: Vec<LandmarkId> = map.landmarks().map(|(id, _)| id).collect();
        landmarks.into_iter().for_each(|id| map.forget(id));
        let drifted = Pose3::exp(Vector6::new(0.02, -0.01, 0.0, 0.0, 0.0, 0.0));
        let last = painted_frame(Pose3::identity(), &painted_points(), Vector2::zeros());
        let unknown = vec![None; last.len()];
        let last = ReferenceFrame { frame: &last, landmarks: &unknown, visual_from_camera: drifted };
        let truth = Pose3::exp(Vector6::new(0.004, 0.0, 0.003, 0.0, 0.002, 0.0));
        let frame = painted_frame(truth, &painted_points(), Vector2::zeros());
        with_tracker(map, &frame, |tracker| {
            let off = |found: &LocalizedFrame| (truth.inverse() * found.pose()).translation.norm();
            let drifting = LocalizedFrame::from_last(tracker, last, None, drifted).unwrap();
            assert!(
                !drifting.by_map && off(&drifting) > 0.015,
                "by the last frame alone: {}",
                off(&drifting)
            );
            let fixed = Tracker { is_map_fixed: true, ..*tracker };
            let found = LocalizedFrame::from_last(&fixed, last, None, drifted).unwrap();
            assert!(found.by_map && off(&found) < 0.002, "by the keyframe: {}", off(&found));
            assert_eq!(found.tracking(tracker.config), Tracking::Ok);
        });
    }

    #[test]
    fn only_points_that_contradict_the_odometry_count_against_it() {
        let frame = frame_of_the_wall();
        let elsewhere = PosePrior {
            world_from_camera: Pose3::exp(Vector6::new(0.5, 0.0, 0.0, 0.0, 0.2, 0.0)),
            covariance: nalgebra::Matrix6::identity() * 1e-6,
        };
        with_found(&frame, PosePriorKind::Tracked(Some(&elsewhere)), |found, _| {
            assert_eq!(found.points_against_odometry(), Some(found.points));
            let aligned_only = LocalizedFrame { points_contradict: false, points: 1000, ..found };
            let aligned = aligned_only.pose.solution.inlier_count;
            assert_eq!(aligned_only.points_against_odometry(), Some(aligned), "the many did not say so");
        });
        with_found(&frame, PosePriorKind::Tracked(None), |found, _| {
            assert_eq!(found.points_against_odometry(), None)
        });
    }

    #[test]
    fn landmarks_in_one_corner_are_a_small_fraction_of_the_view() {
        let grid = |columns: usize| {
            (0..columns * 100).map(|i| Vector2::new((i / 10) as f64, (i % 10) as f64 * 20.0))
        };
        assert_eq!(seen_fraction(grid(40), grid(40)), 1.0);
        assert_eq!(seen_fraction(grid(40), grid(12)), 0.3);
        assert_eq!(seen_fraction(grid(12), grid(40)), 1.0, "what is not expected does not count");
        assert_eq!(seen_fraction(grid(0), grid(40)), 0.0);
    }
}
