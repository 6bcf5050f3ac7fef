use super::Suspicion;
use super::calibration::{Fitted, Matched, Offset, Pair, corrected, fit};
use super::depth_range::DepthRange;
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
/// Standard deviations that an offset must be from zero.
const CLEAR: f64 = 4.0;
/// Standard deviations that the best focal lengths may be from the exchanged ones.
const EXCHANGED: f64 = 3.0;
/// Part of the cost that may be left once the wrong setting is put right.
const MENDED: f64 = 0.9;
/// Offsets below this, px at three quarters of the way to a corner, are no wrong setting.
const HARMLESS_PX: f64 = 4.0;
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
            if !self.camera_judged {
                self.compare(frame, sensor);
            }
        }
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
            self.judge(&sensor.camera);
        }
        self.anchor = Some(frame.clone());
        self.moved = Some(Pose3::identity());
    }

    fn judge(&mut self, camera: &PinholeCamera) {
        if self.pairs.len() < LEAST_PAIRS || !self.pairs.len().is_multiple_of(3) {
            return;
        }
        let suspicion = suspicion_of(&self.pairs, camera);
        self.camera_judged = suspicion.is_some() || self.pairs.len() >= MOST_PAIRS;
        self.suspicions.extend(suspicion);
        if self.camera_judged {
            (self.pairs, self.anchor) = (Vec::new(), None);
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

/// What may be free together: focal lengths, principal point, lens.
const MODELS: [[bool; 6]; 3] = [
    [true, true, false, false, false, false],
    [false, false, true, true, false, false],
    [false, false, false, false, true, true],
];

/// The setting that the pairs say is wrong, if one is.
fn suspicion_of(pairs: &[Pair], camera: &PinholeCamera) -> Option<Suspicion> {
    let as_set = fit(pairs, Offset::zeros(), [false; 6])?;
    let fits = MODELS.iter().filter_map(|model| Some((*model, fit(pairs, Offset::zeros(), *model)?)));
    let (model, best) = fits.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))?;
    let sigmas = spread(pairs, model)?;
    let clear = best.offset.iter().zip(sigmas.iter()).any(|(o, s)| o.abs() > CLEAR * s);
    if !clear || best.cost > MENDED * as_set.cost || rim(&best, camera).abs() < HARMLESS_PX {
        return None;
    }
    let Fitted { offset, .. } = best;
    let (fx, fy) = (camera.fx(), camera.fy());
    Some(if model[0] {
        let found = (fx / (1.0 + offset[0]), fy / (1.0 + offset[1]));
        Suspicion::FocalLengths {
            given: (fx, fy),
            found,
            swapped: is_swapped(pairs, camera, &as_set, (&best, &sigmas)),
        }
    } else if model[2] {
        Suspicion::PrincipalPoint { offset: (-fx * offset[2], -fy * offset[3]) }
    } else {
        Suspicion::Distortion { at_the_rim: rim(&best, camera) }
    })
}

/// Whether exchanging the focal lengths mends most of what the best ones mend, and neither of the best speaks against it.
fn is_swapped(
    pairs: &[Pair],
    camera: &PinholeCamera,
    as_set: &Fitted,
    (best, sigmas): (&Fitted, &Offset),
) -> bool {
    let ratio = camera.fx() / camera.fy();
    let exchange = Offset::new(ratio - 1.0, ratio.recip() - 1.0, 0.0, 0.0, 0.0, 0.0);
    if (0..2).any(|i| (best.offset[i] - exchange[i]).abs() > EXCHANGED * sigmas[i]) {
        return false;
    }
    let exchanged = fit(pairs, exchange, [false; 6]);
    exchanged.is_some_and(|exchanged| exchanged.cost - best.cost < 0.5 * (as_set.cost - best.cost))
}

/// Standard deviations of the offsets by leaving out each pair in turn (jackknife): what is wrong with a whole pair, as
/// by a rolling shutter, is in them.
fn spread(pairs: &[Pair], model: [bool; 6]) -> Option<Offset> {
    let without = |i: usize| {
        let others: Vec<Pair> =
            pairs.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, p)| p.clone()).collect();
        Some(fit(&others, Offset::zeros(), model)?.offset)
    };
    let offsets: Vec<Offset> = (0..pairs.len()).map(without).collect::<Option<_>>()?;
    let n = offsets.len() as f64;
    let mean = offsets.iter().sum::<Offset>() / n;
    let squares: Offset = offsets.iter().map(|o| (o - mean).map(|d| d * d)).sum();
    Some((squares * ((n - 1.0) / n)).map(f64::sqrt))
}

/// How far points three quarters of the way to the image's corners are off, px, at most.
fn rim(fitted: &Fitted, camera: &PinholeCamera) -> f64 {
    let focal = Vector2::new(camera.fx(), camera.fy());
    let n = (Vector2::new(camera.width() as f64, camera.height() as f64) * 0.375).component_div(&focal);
    (corrected(n, &fitted.offset) - n).component_mul(&focal).norm()
}
