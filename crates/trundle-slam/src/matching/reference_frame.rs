//! Locates a frame from another frame with a known pose.

use crate::frame::depth::MAX_RELATIVE_SIGMA;
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::ids::LandmarkId;
use crate::map::keyframe::Keyframe;
use crate::map::landmark_map::LandmarkMap;
use crate::matching::point_match::PointMatch;
use crate::matching::projection_search::{MatchThresholds, Projection, search};
use trundle_core::{Pose3, Vector2, Vector3};
use trundle_vision::{Match, RansacConfig, estimate_pose_pnp, estimate_rigid_motion};

/// A frame with a known pose, from which another frame can be located: the last one, or a keyframe.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReferenceFrame<'a> {
    pub frame: &'a Frame,
    /// The landmark of each feature.
    pub landmarks: &'a [Option<LandmarkId>],
    pub visual_from_camera: Pose3,
}

impl<'a> From<&'a Keyframe> for ReferenceFrame<'a> {
    fn from(keyframe: &'a Keyframe) -> Self {
        let Keyframe { frame, landmarks, visual_from_camera, .. } = keyframe;
        Self { frame, landmarks, visual_from_camera: *visual_from_camera }
    }
}

impl ReferenceFrame<'_> {
    /// The point of feature `i`: its landmark, else its own depth. `feature` of the match is the index in the reference frame.
    fn point(&self, i: usize, map: &LandmarkMap, model: &ObservationModel) -> Option<PointMatch> {
        let landmark = self.landmarks[i].and_then(|id| PointMatch::of_landmark(i, id, map));
        if landmark.is_some() {
            return landmark;
        }
        let depth = self.frame.depths[i]?;
        (depth.sigma <= MAX_RELATIVE_SIGMA * depth.value).then_some(())?;
        let point = self.visual_from_camera.transform(self.frame.point(i, model)?);
        let landmark = None;
        Some(PointMatch { feature: i, point, landmark, sigma_factor: 2.0_f64.sqrt(), aligned: None })
    }

    /// Searches the points of the reference frame in `frame`, within `window_px` (of octave 0) of their projection by `predicted`.
    pub fn match_by_motion(
        &self,
        frame: &Frame,
        predicted: Pose3,
        window_px: f64,
        thresholds: MatchThresholds,
        (map, model): (&LandmarkMap, &ObservationModel),
    ) -> Vec<PointMatch> {
        let camera_from_visual = predicted.inverse();
        let (mut points, mut projections) = (Vec::new(), Vec::new());
        for point in (0..self.frame.len()).filter_map(|i| self.point(i, map, model)) {
            let p_camera = camera_from_visual.transform(point.point);
            let Some((pixel, _)) = model.project(p_camera) else { continue };
            let octave = self.frame.octave(point.feature);
            projections.push(Projection {
                pixel,
                depth: p_camera.z,
                radius: window_px * model.scale(octave),
                octaves: (octave.saturating_sub(1), octave + 1),
                descriptor: *self.frame.descriptor(point.feature),
                is_findable: true,
            });
            points.push(point);
        }
        let found = search(frame, &vec![true; frame.len()], &projections, thresholds);
        found.into_iter().map(|(feature, i)| PointMatch { feature, ..points[i] }).collect()
    }

    /// Locates `frame` without a prediction, by pairs of similar features (`a` of the reference frame, `b` of the frame): RANSAC over the
    /// pairs with depth in both frames, else over the pixels of all pairs. Returns the pose and every match of a known point.
    pub fn localize(
        &self,
        frame: &Frame,
        pairs: &[Match],
        seed: u64,
        (map, model): (&LandmarkMap, &ObservationModel),
    ) -> Option<(Pose3, Vec<PointMatch>)> {
        let known = |pair: &Match| Some(PointMatch { feature: pair.b, ..self.point(pair.a, map, model)? });
        let matches: Vec<PointMatch> = pairs.iter().filter_map(known).collect();
        let camera_from_visual = self.visual_from_camera.inverse();
        let both =
            |m: &PointMatch| Some((camera_from_visual.transform(m.point), frame.point(m.feature, model)?));
        let (here, there): (Vec<Vector3>, Vec<Vector3>) = matches.iter().filter_map(both).unzip();
        let (camera, config) = (&model.camera, RansacConfig::default());
        let by_pixels = || {
            let points: Vec<Vector3> =
                matches.iter().map(|m| camera_from_visual.transform(m.point)).collect();
            let pixels: Vec<Vector2> = matches.iter().map(|m| frame.pixels[m.feature]).collect();
            estimate_pose_pnp(&points, &pixels, camera, &config, seed)
        };
        let motion = estimate_rigid_motion(&here, &there, camera, &config, seed).or_else(by_pixels)?;
        Some((self.visual_from_camera * motion.b_from_a.inverse(), matches))
    }
}
