use super::locate::Sighting;
use super::{Located, RgbdSlam, doubts::Doubts};
use crate::closing::Search;
use crate::found::Found;
use crate::frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::motion::carried;
use crate::report::{MapId, MapMerge, Mode, TrackReport, Tracking};
use crate::search::Projection;
use nalgebra::Matrix6;
use trundle_core::Pose3;

/// A frame that became a keyframe, and what came of it.
struct Kept {
    reference: KeyframeId,
    merged: Option<MapMerge>,
}

impl RgbdSlam {
    /// Takes a found pose over: counts landmarks, makes a keyframe where one is wanted.
    pub(super) fn accept(&mut self, frame: Frame, Sighting { map, found }: Sighting) -> TrackReport {
        let before = self.last.as_ref().filter(|_| self.misses == 0 && map == self.active.id);
        let before = before.map(|last| last.anchored.visual_from_camera(&self.active.map));
        self.enter(map);
        let mut landmarks = vec![None; frame.len()];
        for seen in &found.seen {
            landmarks[seen.feature] = seen.landmark;
        }
        if found.fix.solution.contradicts_prior || found.recognised.is_some() {
            // The wheels slipped, or the robot was carried.
            self.rolled = None;
        }
        let aligned = found.seen.iter().filter_map(|m| Some((m.feature, m.aligned?)));
        let frame = frame.with_aligned(aligned, &self.sensor);
        self.show(&frame, &landmarks);
        let mut pose = found.fix.visual_from_camera();
        let mut reference = self.reference(&landmarks);
        let mut covariance = self.covariance(&found, reference);
        let kept = self.map_by(&frame, &found, &landmarks, covariance);
        if let Some(kept) = &kept {
            reference = kept.reference;
            let keyframe = self.active.map.keyframe(reference);
            covariance = keyframe.covariance;
            (pose, landmarks) = (keyframe.visual_from_camera, keyframe.landmarks.clone());
        }
        let enough = found.by_map && found.points >= self.config.tracking.weak_inliers;
        let tracking = if enough { Tracking::Ok } else { Tracking::Weak };
        let is_one_frame = kept.as_ref().is_none_or(|kept| kept.merged.is_none());
        self.belief.located(frame.stamp, pose, covariance, before.filter(|_| is_one_frame));
        (self.misses, self.placed, self.doubts) = (0, true, Doubts::default());
        (self.blind, self.torn) = (false, false);
        let anchored = self.remember(frame.stamp, Some(reference), tracking);
        let report = TrackReport {
            matches: found.matches,
            inliers: found.points,
            relocalised: found.recognised.is_some(),
            new_keyframe: kept.is_some(),
            merged: kept.and_then(|kept| kept.merged),
            ..self.report(frame.len())
        };
        self.go_on_from(Located { frame, landmarks, anchored });
        self.missed = None;
        report
    }

    /// Makes `map` the active one.
    fn enter(&mut self, map: MapId) {
        if let Some(entered) = self.resting.iter_mut().find(|resting| resting.id == map) {
            std::mem::swap(entered, &mut self.active);
            self.resting.sort_by_key(|resting| resting.id);
            (self.last, self.recognition, self.surprise) = (None, None, None);
            self.forget_the_way();
        }
    }

    /// Lets the map learn from a located frame, unless it is to stay as it is.
    fn map_by(
        &mut self,
        frame: &Frame,
        found: &Found,
        landmarks: &[Option<LandmarkId>],
        covariance: Matrix6<f64>,
    ) -> Option<Kept> {
        if self.mode == Mode::Localisation {
            return None;
        }
        self.count(&found.visible, landmarks);
        let pose = found.fix.visual_from_camera();
        let tracked = landmarks.iter().flatten().count();
        let shown = found.visible.iter().map(|(_, projection)| projection.pixel);
        let wanted = self.config.keyframes.wants(frame, pose, tracked, shown, &self.active.map);
        wanted.then(|| self.keep(frame, pose, landmarks, covariance))
    }

    fn keep(
        &mut self,
        frame: &Frame,
        pose: Pose3,
        landmarks: &[Option<LandmarkId>],
        covariance: Matrix6<f64>,
    ) -> Kept {
        let reference = self.insert(frame.clone(), pose, landmarks);
        self.active.map.set_covariance(reference, covariance);
        self.searches.push_back(Search::of(reference));
        let merged = self.merge_maps(reference);
        let reference = merged.map_or(reference, |merged| merged.keyframe);
        Kept { reference, merged }
    }

    /// Counts which landmarks should have been found, and which were.
    fn count(&mut self, visible: &[(LandmarkId, Projection)], found: &[Option<LandmarkId>]) {
        for (id, _) in visible.iter().filter(|(_, seen)| seen.is_findable) {
            if let Some(landmark) = self.active.map.landmark_mut(*id) {
                landmark.visible = landmark.visible.saturating_add(1);
            }
        }
        for id in found.iter().flatten() {
            if let Some(landmark) = self.active.map.landmark_mut(*id) {
                landmark.found = landmark.found.saturating_add(1);
            }
        }
    }

    /// Of a found pose: that against the points, and that of the points around the keyframe that sees most of them.
    fn covariance(&self, found: &Found, reference: KeyframeId) -> Matrix6<f64> {
        let keyframe = self.active.map.keyframe(reference);
        let offset = keyframe.visual_from_camera.inverse() * found.fix.visual_from_camera();
        let local = found.fix.solution.covariance.unwrap_or_else(Matrix6::identity);
        carried(&keyframe.ground, offset) + local
    }

    /// The keyframe that shares most landmarks with the frame; the last one's where none does.
    fn reference(&self, landmarks: &[Option<LandmarkId>]) -> KeyframeId {
        let map = &self.active.map;
        let seeing = map.keyframes_seeing(landmarks.iter().flatten().copied());
        let last = || Some(map.resolve(self.last.as_ref()?.anchored.reference?).0);
        let newest = || map.newest_keyframe().expect("invariant: what is tracked was mapped");
        seeing.first().map(|(id, _)| *id).or_else(last).unwrap_or_else(newest)
    }
}
