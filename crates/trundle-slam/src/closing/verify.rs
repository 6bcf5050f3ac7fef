use super::LoopConfig;
use super::candidates::Drift;
use crate::anchor::Anchor;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::LandmarkMap;
use crate::refine::{Fix, PointMatch};
use crate::search::{Projection, search};
use crate::sensor::Sensor;
use crate::tracker::TrackingConfig;
use std::collections::BTreeSet;
use trundle_core::Pose3;

/// Tells whether a keyframe shows what an old one saw.
#[derive(Debug, Clone, Copy)]
pub(super) struct Verifier<'a> {
    pub map: &'a LandmarkMap,
    pub sensor: &'a Sensor,
    pub tracking: &'a TrackingConfig,
    pub config: &'a LoopConfig,
    pub seed: u64,
}

/// An old place that a keyframe shows.
#[derive(Debug, Clone)]
pub(super) struct Recognised {
    pub candidate: KeyframeId,
    /// Where the keyframe is by the old landmarks.
    pub visual_from_camera: Pose3,
    /// Points of the old place found in it, landmarks or depths.
    pub points: usize,
    /// The landmarks among them.
    pub landmarks: Vec<LandmarkId>,
}

impl Verifier<'_> {
    pub fn verify(&self, keyframe: KeyframeId, candidate: KeyframeId) -> Option<Recognised> {
        let rough = self.by_likeness(keyframe, candidate)?;
        let fix = self.by_old_landmarks(keyframe, candidate, &rough);
        let points = fix.solution.inlier_count;
        let agreement = points as f64 / fix.matches.len().max(1) as f64;
        let enough = points >= self.config.min_points && agreement >= self.config.min_agreement;
        let pose = fix.visual_from_camera();
        let correction = self.map.keyframe(keyframe).visual_from_camera.inverse() * pose;
        let drift = Drift::between(self.map, candidate, keyframe, self.config);
        let believed = enough && fix.solution.covariance().is_some() && drift.allows(correction);
        let landmarks = fix.inliers().filter_map(|m| m.landmark).collect();
        believed.then_some(Recognised { candidate, visual_from_camera: pose, points, landmarks })
    }

    /// The pose by what looks alike in both keyframes.
    fn by_likeness(&self, keyframe: KeyframeId, candidate: KeyframeId) -> Option<Fix> {
        let frame = &self.map.keyframe(keyframe).frame;
        let anchor: Anchor = self.map.keyframe(candidate).into();
        let likeness = self.tracking.free_likeness();
        let (pose, matches) =
            anchor.match_by_likeness(frame, likeness, self.seed, (self.map, self.sensor))?;
        let fix = Fix::by(matches, pose, frame, self.sensor, &self.tracking.pose);
        fix.is_sound(self.tracking.min_inliers).then_some(fix)
    }

    /// The pose by these and all other landmarks of the old place.
    fn by_old_landmarks(&self, keyframe: KeyframeId, candidate: KeyframeId, rough: &Fix) -> Fix {
        let frame = &self.map.keyframe(keyframe).frame;
        let pose = rough.visual_from_camera();
        let matched: BTreeSet<LandmarkId> = rough.inliers().filter_map(|m| m.landmark).collect();
        let mut sought = self.landmarks_around(candidate);
        sought.retain(|id| !matched.contains(id));
        let window = self.tracking.motion_window_px;
        let (mut ids, mut projections) = (Vec::new(), Vec::new());
        for (id, projection) in
            sought.into_iter().filter_map(|id| Some((id, self.project(id, pose, window)?)))
        {
            ids.push(id);
            projections.push(projection);
        }
        let mut matches: Vec<PointMatch> = rough.inliers().copied().collect();
        let mut free = vec![true; frame.len()];
        matches.iter().for_each(|m| free[m.feature] = false);
        let found = search(frame, &free, &projections, self.tracking.window_likeness());
        let point_match = |(feature, i): (usize, usize)| {
            let landmark = self.map.landmark(ids[i])?;
            let (point, sigma_factor) = (landmark.position, landmark.sigma_factor());
            Some(PointMatch { feature, point, landmark: Some(ids[i]), sigma_factor })
        };
        matches.extend(found.into_iter().filter_map(point_match));
        Fix::by(matches, pose, frame, self.sensor, &self.tracking.pose)
    }

    /// What the candidate and those around it see, by rising id.
    fn landmarks_around(&self, candidate: KeyframeId) -> Vec<LandmarkId> {
        let around =
            self.map.covisible(candidate, 15).into_iter().map(|(id, _)| id).take(10).chain([candidate]);
        let mut ids: Vec<LandmarkId> =
            around.flat_map(|id| self.map.keyframe(id).landmarks.iter().flatten().copied()).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }

    fn project(&self, id: LandmarkId, visual_from_camera: Pose3, window: f64) -> Option<Projection> {
        let landmark = self.map.landmark(id)?;
        let p_camera = visual_from_camera.inverse().transform(landmark.position);
        let (pixel, _) = self.sensor.project(p_camera)?;
        let octave = self.sensor.octave_of(landmark.distance_at_octave_0 / p_camera.norm());
        Some(Projection {
            pixel,
            depth: p_camera.z,
            radius: window * self.sensor.scale(octave),
            octaves: (octave.saturating_sub(1), octave + 1),
            descriptor: landmark.descriptor,
        })
    }
}
