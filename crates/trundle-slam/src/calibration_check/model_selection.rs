use crate::calibration_check::issue::CalibrationIssue;
use crate::calibration_check::self_calibration::{
    CalibrationFit, CalibrationOffset, FittedOffset, Pair, corrected,
};
use trundle_core::{PinholeCamera, Vector2};

/// What may be free together: nothing, focal lengths, principal point, lens.
const MODELS: [[bool; 6]; 4] = [
    [false; 6],
    [true, true, false, false, false, false],
    [false, false, true, true, false, false],
    [false, false, false, false, true, true],
];
/// Places among them.
const FOCAL: usize = 1;
const CENTRE: usize = 2;
/// Matches that are looked at in one frame, 100 ns each.
const MATCHES_PER_FRAME: usize = 10_000;
/// Standard deviations that an offset must be from zero.
const CLEAR: f64 = 4.0;
/// Standard deviations that the best focal lengths may be from the exchanged ones.
const EXCHANGED: f64 = 3.0;
/// Part of the cost that may be left once the wrong setting is put right.
const MENDED: f64 = 0.9;
/// Offsets below this, px at three quarters of the way to a corner, are no wrong setting.
const HARMLESS_PX: f64 = 4.0;

/// What pairs of frames say of the camera's settings, worked out in slices between frames.
#[derive(Debug, Clone)]
pub(crate) struct ModelSelection {
    fit: CalibrationFit,
    /// What the models before came to.
    fitted: Vec<Option<FittedOffset>>,
}

impl ModelSelection {
    pub fn of(pairs: &[Pair]) -> Self {
        Self { fit: CalibrationFit::new(pairs, CalibrationOffset::zeros(), MODELS[0]), fitted: Vec::new() }
    }

    /// Goes on over the same pairs; what is suspected, once it is through.
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

    /// What is to be fitted next: every model, then the exchanged focal lengths with nothing free, if those are suspected.
    fn next(&self, camera: &PinholeCamera) -> Option<(CalibrationOffset, [bool; 6])> {
        let done = self.fitted.len();
        if let Some(model) = MODELS.get(done) {
            return Some((CalibrationOffset::zeros(), *model));
        }
        let is_focal =
            done == MODELS.len() && self.suspected(camera).is_some_and(|(model, _)| model == FOCAL);
        is_focal.then(|| (exchange(camera), MODELS[0]))
    }

    /// The model that puts right what is wrong, by its place among them, if something is.
    fn suspected(&self, camera: &PinholeCamera) -> Option<(usize, &FittedOffset)> {
        let as_set = self.fitted[0].as_ref()?;
        let fits = (1..MODELS.len()).filter_map(|model| Some((model, self.fitted[model].as_ref()?)));
        let (model, best) = fits.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))?;
        let is_clear = best.offset.iter().zip(best.sigmas.iter()).any(|(o, s)| o.abs() > CLEAR * s);
        let is_wrong = is_clear && best.cost <= MENDED * as_set.cost && rim(best, camera) >= HARMLESS_PX;
        is_wrong.then_some((model, best))
    }

    fn verdict(&self, camera: &PinholeCamera) -> Option<CalibrationIssue> {
        let (model, best) = self.suspected(camera)?;
        let (offset, fx, fy) = (&best.offset, camera.fx(), camera.fy());
        Some(match model {
            FOCAL => CalibrationIssue::FocalLengths {
                given: (fx, fy),
                found: (fx / (1.0 + offset[0]), fy / (1.0 + offset[1])),
                swapped: self.is_swapped(best, camera),
            },
            CENTRE => CalibrationIssue::PrincipalPoint { offset: (-fx * offset[2], -fy * offset[3]) },
            _ => CalibrationIssue::Distortion { at_the_rim: rim(best, camera) },
        })
    }

    /// Whether exchanging the focal lengths mends most of what the best ones mend, and neither of the best speaks against it.
    fn is_swapped(&self, best: &FittedOffset, camera: &PinholeCamera) -> bool {
        let exchange = exchange(camera);
        let fits = |i: usize| (best.offset[i] - exchange[i]).abs() <= EXCHANGED * best.sigmas[i];
        let [Some(as_set), .., Some(exchanged)] = &self.fitted[..] else { return false };
        let mends = exchanged.cost - best.cost < 0.5 * (as_set.cost - best.cost);
        self.fitted.len() > MODELS.len() && (0..2).all(fits) && mends
    }
}

/// The offset of exchanged focal lengths.
fn exchange(camera: &PinholeCamera) -> CalibrationOffset {
    let ratio = camera.fx() / camera.fy();
    CalibrationOffset::new(ratio - 1.0, ratio.recip() - 1.0, 0.0, 0.0, 0.0, 0.0)
}

/// How far points three quarters of the way to the image's corners are off, px, at most.
fn rim(fitted: &FittedOffset, camera: &PinholeCamera) -> f64 {
    let focal = Vector2::new(camera.fx(), camera.fy());
    let n = (Vector2::new(camera.width() as f64, camera.height() as f64) * 0.375).component_div(&focal);
    (corrected(n, &fitted.offset) - n).component_mul(&focal).norm()
}
