//! Checks the first images of a run for wrong settings.

use crate::calibration_check::depth_range::DepthRange;
use crate::calibration_check::issue::CalibrationIssue;
use crate::calibration_check::model_selection::ModelSelection;
use crate::calibration_check::registration::Registration;
use crate::calibration_check::self_calibration::{FeaturePair, Pair};
use crate::calibration_check::travelled_distance::TravelledDistance;
use crate::frame::depth::DepthConfig;
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::{Frame, row_fraction};
use trundle_core::{DepthImage, GrayImage, PinholeCamera, Pose3, Vector2, Vector3};
use trundle_vision::{RansacConfig, estimate_rigid_motion, match_mutual};

/// Number of frames between two checks: 5. Source: ours.
const FRAME_STRIDE: usize = 5;
/// Smallest rotation between two frames that are compared: 0.08 rad. Source: ours.
const MIN_PAIR_TURN_RAD: f64 = 0.08;
/// Smallest translation between two frames that are compared: 0.1 m. Source: ours.
const MIN_PAIR_DISTANCE_M: f64 = 0.1;
/// Fewest frame pairs for a decision about the camera: 6. Source: ours.
const MIN_PAIRS: usize = 6;
/// Frame pairs after which the camera counts as right: 18. Source: ours.
const MAX_PAIRS: usize = 18;
/// Standard deviation of a match in the first motion of a pair: 10 px, since wrong settings distort the image. Source: ours.
const LOOSE_PIXEL_SIGMA_PX: f64 = 10.0;
/// Standard deviation of a depth in the first motion of a pair: 0.03 m. Source: ours.
const LOOSE_DEPTH_SIGMA_M: f64 = 0.03;
/// Fewest matches that the motion of a pair must explain: 40. Source: ours.
const MIN_MATCHES: usize = 40;

/// Checks the first images of a run for traces of wrong settings. Each suspicion is reported once.
#[derive(Debug, Clone, Default)]
pub(crate) struct CalibrationCheck {
    frames: usize,
    anchor: Option<Frame>,
    /// Camera motion since the anchor frame by the priors; `None` after a frame without a prior.
    moved: Option<Pose3>,
    pairs: Vec<Pair>,
    /// The running fit of the camera settings to the first pairs.
    camera_fit: Option<ModelSelection>,
    /// Number of pairs in the last evaluation.
    evaluated_pairs: usize,
    is_camera_evaluated: bool,
    range: DepthRange,
    travel: TravelledDistance,
    registration: Registration,
    calibration_issues: Vec<CalibrationIssue>,
}

impl CalibrationCheck {
    /// The issues found.
    pub fn issues(&self) -> &[CalibrationIssue] {
        &self.calibration_issues
    }

    /// Records the edges of a grey image and its depth image.
    pub fn record_image(&mut self, gray: &GrayImage, depth: &DepthImage) {
        if self.frames.is_multiple_of(FRAME_STRIDE) {
            self.calibration_issues.extend(self.registration.record(gray, depth));
        }
    }

    /// Adds the evidence of a frame's features, its depth image, and the prior of the motion since the last frame.
    pub fn record_frame(
        &mut self,
        frame: &Frame,
        depth: &DepthImage,
        prior: Option<Pose3>,
        model: &ObservationModel,
        config: &DepthConfig,
    ) {
        self.moved = self.moved.zip(prior).map(|(moved, prior)| moved * prior);
        if self.frames.is_multiple_of(FRAME_STRIDE) {
            self.calibration_issues.extend(self.range.record(depth, config));
            if !self.is_camera_evaluated && self.pairs.len() < MAX_PAIRS {
                self.compare(frame, model);
            }
        }
        self.evaluate(&model.camera);
        self.frames += 1;
    }

    /// Matches a frame with the anchor frame, and keeps the pair if the camera moved enough.
    fn compare(&mut self, frame: &Frame, model: &ObservationModel) {
        let pair = self.anchor.as_ref().and_then(|anchor| pair_of(anchor, frame, model));
        if let Some(pair) = pair {
            let (turn, distance) = (pair.b_from_a.angle(), pair.b_from_a.translation.norm());
            if turn < MIN_PAIR_TURN_RAD && distance < MIN_PAIR_DISTANCE_M {
                return;
            }
            let reported = self.moved.map(|moved| moved.translation.norm());
            self.calibration_issues
                .extend(reported.and_then(|reported| self.travel.record(distance, reported)));
            self.pairs.push(pair);
        }
        self.anchor = Some(frame.clone());
        self.moved = Some(Pose3::identity());
    }

    /// Evaluates the camera settings in some rounds per frame, and again after every three new pairs.
    fn evaluate(&mut self, camera: &PinholeCamera) {
        let count = self.pairs.len() / 3 * 3;
        if self.camera_fit.is_none() && count >= MIN_PAIRS && count > self.evaluated_pairs {
            self.camera_fit = Some(ModelSelection::of(&self.pairs[..count]));
            self.evaluated_pairs = count;
        }
        let pairs = &self.pairs[..self.evaluated_pairs];
        let Some(suspicion) = self.camera_fit.as_mut().and_then(|j| j.advance(pairs, camera)) else { return };
        self.camera_fit = None;
        self.is_camera_evaluated = suspicion.is_some() || self.evaluated_pairs >= MAX_PAIRS;
        self.calibration_issues.extend(suspicion);
        if self.is_camera_evaluated {
            (self.pairs, self.anchor, self.evaluated_pairs) = (Vec::new(), None, 0);
        }
    }
}

/// The matches of two frames that one motion explains with loose tolerances.
pub(crate) fn pair_of(a: &Frame, b: &Frame, model: &ObservationModel) -> Option<Pair> {
    let camera = &model.camera;
    let normal =
        |p: Vector2| Vector2::new((p.x - camera.cx()) / camera.fx(), (p.y - camera.cy()) / camera.fy());
    let row = |frame: &Frame, i: usize| row_fraction(&frame.features.keypoints[i], camera);
    let (mut points, mut matches): ((Vec<Vector3>, Vec<Vector3>), Vec<FeaturePair>) = Default::default();
    for pair in match_mutual(&a.features.descriptors, &b.features.descriptors, 50, 0.8) {
        let (Some(here), Some(there)) = (a.point(pair.a, model), b.point(pair.b, model)) else { continue };
        points.0.push(here);
        points.1.push(there);
        matches.push(FeaturePair {
            a: normal(a.pixels[pair.a]),
            depth_a: here.z,
            b: normal(b.pixels[pair.b]),
            inverse_b: b.depths[pair.b].map(|d| (d.value, d.sigma)),
            sigma: 1.5 * model.scale(a.octave(pair.a).max(b.octave(pair.b))) / camera.fx(),
            rows: (row(a, pair.a), row(b, pair.b)),
        });
    }
    let (pixel_sigma, depth_sigma) = (LOOSE_PIXEL_SIGMA_PX, LOOSE_DEPTH_SIGMA_M);
    let mut config = RansacConfig::default();
    config.pixel_sigma = pixel_sigma;
    config.depth_sigma = depth_sigma;
    config.min_inliers = MIN_MATCHES;
    let motion = estimate_rigid_motion(&points.0, &points.1, camera, &config, 0)?;
    Some(Pair { b_from_a: motion.b_from_a, matches })
}
