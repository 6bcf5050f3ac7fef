use super::Suspicion;
use super::calibration::{Matched, Pair};
use super::depth_range::DepthRange;
use super::judgement::Judgement;
use super::registration::Registration;
use super::travel::Travel;
use crate::depth::DepthConfig;
use crate::frame::Frame;
use crate::sensor::Sensor;
use trundle_core::{DepthImage, GrayImage, PinholeCamera, Pose3, Vector2, Vector3};
use trundle_vision::{RansacConfig, estimate_rigid_motion, match_mutual};

/// Every so many frames one is looked at.
const EVERY: usize = 5;
/// Two frames are compared when the camera turned by this between them, rad.
const TURN: f64 = 0.08;
/// Or went so far, m.
const WAY: f64 = 0.1;
/// Pairs of frames before the camera is judged.
const LEAST_PAIRS: usize = 6;
/// Pairs of frames after which it is believed.
const MOST_PAIRS: usize = 18;
/// How far off matches may be at first, px and m: wrong settings bend the picture by some.
const LOOSE: (f64, f64) = (10.0, 0.03);
/// Matches that a motion must explain.
const LEAST_MATCHES: usize = 40;

/// Looks at the first images of a run for traces of wrong settings. Says each suspicion once.
#[derive(Debug, Clone, Default)]
pub(crate) struct SettingsCheck {
    frames: usize,
    anchor: Option<Frame>,
    /// Camera motion since the anchor by the prior, as long as there is one.
    moved: Option<Pose3>,
    pairs: Vec<Pair>,
    /// The camera as the first of these pairs see it, while that is being worked out.
    judgement: Option<Judgement>,
    /// How many pairs the last judgement had.
    judged: usize,
    camera_judged: bool,
    range: DepthRange,
    travel: Travel,
    registration: Registration,
    suspicions: Vec<Suspicion>,
}

impl SettingsCheck {
    /// What was found so far.
    pub fn suspicions(&self) -> &[Suspicion] {
        &self.suspicions
    }

    /// Looks at picture and depth.
    pub fn note_image(&mut self, gray: &GrayImage, depth: &DepthImage) {
        if self.frames.is_multiple_of(EVERY) {
            self.suspicions.extend(self.registration.note(gray, depth));
        }
    }

    /// Looks at a frame's features, the depth image they come from, and the prior of the motion since the last frame.
    pub fn note_frame(
        &mut self,
        frame: &Frame,
        depth: &DepthImage,
        prior: Option<Pose3>,
        sensor: &Sensor,
        config: &DepthConfig,
    ) {
        self.moved = self.moved.zip(prior).map(|(moved, prior)| moved * prior);
        if self.frames.is_multiple_of(EVERY) {
            self.suspicions.extend(self.range.note(depth, config));
            if !self.camera_judged && self.pairs.len() < MOST_PAIRS {
                self.compare(frame, sensor);
            }
        }
        self.judge(&sensor.camera);
        self.frames += 1;
    }

    /// Matches a frame with the anchor; where the camera moved enough between, the pair is kept.
    fn compare(&mut self, frame: &Frame, sensor: &Sensor) {
        let pair = self.anchor.as_ref().and_then(|anchor| pair_of(anchor, frame, sensor));
        if let Some(pair) = pair {
            let (turn, way) = (pair.b_from_a.angle(), pair.b_from_a.translation.norm());
            if turn < TURN && way < WAY {
                return;
            }
            let said = self.moved.map(|moved| moved.translation.norm());
            self.suspicions.extend(said.and_then(|said| self.travel.note(way, said)));
            self.pairs.push(pair);
        }
        self.anchor = Some(frame.clone());
        self.moved = Some(Pose3::identity());
    }

    /// Goes on judging the camera, some rounds a frame, again whenever there are three more pairs.
    fn judge(&mut self, camera: &PinholeCamera) {
        let count = self.pairs.len() / 3 * 3;
        if self.judgement.is_none() && count >= LEAST_PAIRS && count > self.judged {
            self.judgement = Some(Judgement::of(&self.pairs[..count]));
            self.judged = count;
        }
        let pairs = &self.pairs[..self.judged];
        let Some(suspicion) = self.judgement.as_mut().and_then(|j| j.advance(pairs, camera)) else { return };
        self.judgement = None;
        self.camera_judged = suspicion.is_some() || self.judged >= MOST_PAIRS;
        self.suspicions.extend(suspicion);
        if self.camera_judged {
            (self.pairs, self.anchor, self.judged) = (Vec::new(), None, 0);
        }
    }
}

/// The matches of two frames that a motion explains, loosely.
fn pair_of(a: &Frame, b: &Frame, sensor: &Sensor) -> Option<Pair> {
    let camera = &sensor.camera;
    let normal =
        |p: Vector2| Vector2::new((p.x - camera.cx()) / camera.fx(), (p.y - camera.cy()) / camera.fy());
    let (mut points, mut matches): ((Vec<Vector3>, Vec<Vector3>), Vec<Matched>) = Default::default();
    for pair in match_mutual(&a.features.descriptors, &b.features.descriptors, 50, 0.8) {
        let (Some(here), Some(there)) = (sensor.point(a, pair.a), sensor.point(b, pair.b)) else { continue };
        points.0.push(here);
        points.1.push(there);
        matches.push(Matched {
            a: normal(a.pixels[pair.a]),
            depth_a: here.z,
            b: normal(b.pixels[pair.b]),
            inverse_b: b.depths[pair.b].map(|d| (d.value, d.sigma)),
            sigma: 1.5 * sensor.scale(a.octave(pair.a).max(b.octave(pair.b))) / camera.fx(),
        });
    }
    let (pixel_sigma, depth_sigma) = LOOSE;
    let config = RansacConfig { pixel_sigma, depth_sigma, min_inliers: LEAST_MATCHES, ..Default::default() };
    let motion = estimate_rigid_motion(&points.0, &points.1, camera, &config, 0)?;
    Some(Pair { b_from_a: motion.b_from_a, matches })
}
