//! Which camera setting is wrong, by fits with different settings free.

use crate::calibration_check::issue::CalibrationIssue;
use crate::calibration_check::self_calibration::{
    CalibrationFit, CalibrationOffset, FittedOffset, Pair, corrected,
};
use trundle_core::{PinholeCamera, Vector2};

/// Sets of parameters that are fitted together: none, focal lengths, principal point, lens.
const MODELS: [[bool; 6]; 4] = [
    [false; 6],
    [true, true, false, false, false, false],
    [false, false, true, true, false, false],
    [false, false, false, false, true, true],
];
/// Index of the model with free focal lengths. Source: the order of `MODELS`.
const FOCAL_MODEL: usize = 1;
/// Index of the model with a free principal point. Source: the order of `MODELS`.
const CENTRE_MODEL: usize = 2;
/// Matches that are evaluated between two frames: 10,000, of 100 ns each. Source: ours.
const MATCHES_PER_FRAME: usize = 10_000;
/// Smallest offset that counts as wrong, in standard deviations: 4. Source: ours.
const MIN_OFFSET_SIGMAS: f64 = 4.0;
/// Largest difference of the best focal lengths from the swapped ones: 3 standard deviations. Source: ours.
const MAX_SWAP_SIGMAS: f64 = 3.0;
/// Fraction of the cost that may be left after a correction: 0.9. With more left the correction explains nothing. Source: ours.
const MAX_REMAINING_COST: f64 = 0.9;
/// Smallest error at three quarters of the half diagonal that is reported: 4 px. Source: ours.
const MIN_ERROR_PX: f64 = 4.0;

/// Fits camera settings to pairs of frames, in slices between frames.
#[derive(Debug, Clone)]
pub(crate) struct ModelSelection {
    fit: CalibrationFit,
    /// Results of the models fitted so far.
    fitted: Vec<Option<FittedOffset>>,
}

impl ModelSelection {
    pub fn of(pairs: &[Pair]) -> Self {
        Self { fit: CalibrationFit::new(pairs, CalibrationOffset::zeros(), MODELS[0]), fitted: Vec::new() }
    }

    /// Continues with the same pairs; at the end, returns the suspected issue.
    pub fn advance(&mut self, pairs: &[Pair], camera: &PinholeCamera) -> Option<Option<CalibrationIssue>> {
        let matches: usize = pairs.iter().map(|pair| pair.matches.len()).sum();
        for _ in 0..(MATCHES_PER_FRAME / matches.max(1)).max(1) {
            if !self.fit.advance(pairs) {
                continue;
            }
            self.fitted.push(self.fit.result());
            match self.next(camera) {
                Some((start, free)) => self.fit = CalibrationFit::new(pairs, start, free),
                None => return Some(self.verdict(camera)),
            }
        }
        None
    }

    /// The next fit: each model in turn, then swapped focal lengths without a free parameter, if suspected.
    fn next(&self, camera: &PinholeCamera) -> Option<(CalibrationOffset, [bool; 6])> {
        let done = self.fitted.len();
        if let Some(model) = MODELS.get(done) {
            return Some((CalibrationOffset::zeros(), *model));
        }
        let is_focal =
            done == MODELS.len() && self.suspected(camera).is_some_and(|(model, _)| model == FOCAL_MODEL);
        is_focal.then(|| (exchange(camera), MODELS[0]))
    }

    /// The model that corrects the error, if there is one.
    fn suspected(&self, camera: &PinholeCamera) -> Option<(usize, &FittedOffset)> {
        let as_set = self.fitted[0].as_ref()?;
        let fits = (1..MODELS.len()).filter_map(|model| Some((model, self.fitted[model].as_ref()?)));
        let (model, best) = fits.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))?;
        let is_clear =
            best.offset.iter().zip(best.sigmas.iter()).any(|(o, s)| o.abs() > MIN_OFFSET_SIGMAS * s);
        let is_wrong =
            is_clear && best.cost <= MAX_REMAINING_COST * as_set.cost && rim(best, camera) >= MIN_ERROR_PX;
        is_wrong.then_some((model, best))
    }

    fn verdict(&self, camera: &PinholeCamera) -> Option<CalibrationIssue> {
        let (model, best) = self.suspected(camera)?;
        let (offset, fx, fy) = (&best.offset, camera.fx(), camera.fy());
        Some(match model {
            FOCAL_MODEL => CalibrationIssue::FocalLengths {
                given: (fx, fy),
                found: (fx / (1.0 + offset[0]), fy / (1.0 + offset[1])),
                swapped: self.is_swapped(best, camera),
            },
            CENTRE_MODEL => CalibrationIssue::PrincipalPoint { offset: (-fx * offset[2], -fy * offset[3]) },
            _ => CalibrationIssue::Distortion { at_the_rim: rim(best, camera) },
        })
    }

    /// Whether swapped focal lengths explain almost as much as the best ones, and agree with both of them.
    fn is_swapped(&self, best: &FittedOffset, camera: &PinholeCamera) -> bool {
        let exchange = exchange(camera);
        let fits = |i: usize| (best.offset[i] - exchange[i]).abs() <= MAX_SWAP_SIGMAS * best.sigmas[i];
        let [Some(as_set), .., Some(exchanged)] = &self.fitted[..] else { return false };
        let mends = exchanged.cost - best.cost < 0.5 * (as_set.cost - best.cost);
        self.fitted.len() > MODELS.len() && (0..2).all(fits) && mends
    }
}

/// The offset of swapped focal lengths.
fn exchange(camera: &PinholeCamera) -> CalibrationOffset {
    let ratio = camera.fx() / camera.fy();
    CalibrationOffset::new(ratio - 1.0, ratio.recip() - 1.0, 0.0, 0.0, 0.0, 0.0)
}

/// Error of points at three quarters of the half diagonal, px.
fn rim(fitted: &FittedOffset, camera: &PinholeCamera) -> f64 {
    let focal = Vector2::new(camera.fx(), camera.fy());
    let n = (Vector2::new(camera.width() as f64, camera.height() as f64) * 0.375).component_div(&focal);
    (corrected(n, &fitted.offset) - n).component_mul(&focal).norm()
}
