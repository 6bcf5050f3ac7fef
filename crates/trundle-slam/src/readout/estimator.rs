//! Collects image pairs of a turning camera.

use super::fit::{ReadoutEstimate, TurningPair, fit};
use crate::SlamConfig;
use crate::calibration_check::check::pair_of;
use crate::frame::front_end::FrontEnd;
use crate::frame::rgbd_frame::Frame;
use trundle_core::{Invalid, PinholeCamera, RgbdImage, Vector3};

/// Number of images between the two images of a pair: 5. Source: ours.
const PAIR_STRIDE: usize = 5;
/// Longest time between two successive images whose motion gives a turn rate: 0.12 s. In a longer time the rate changes. Source: ours.
const MAX_STEP_S: f64 = 0.12;

/// Estimates the readout time of a camera, whose own readout time is ignored, from successive images.
#[derive(Debug)]
pub struct ReadoutEstimator {
    front_end: FrontEnd,
    config: SlamConfig,
    images: usize,
    last: Option<LastFrame>,
    anchor: Option<Anchor>,
    pairs: Vec<TurningPair>,
}

/// The last image, and the turn rate up to it.
#[derive(Debug)]
struct LastFrame {
    frame: Frame,
    rate_before: Option<Vector3>,
}

/// The first image of the next pair, and its turn rate.
#[derive(Debug)]
struct Anchor {
    frame: Frame,
    rate: Vector3,
}

impl ReadoutEstimator {
    /// # Errors
    /// When the configuration is invalid.
    pub fn new(camera: PinholeCamera, config: SlamConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let front_end = FrontEnd::new(camera.with_readout(0.0)?, &config)?;
        Ok(Self { front_end, config, images: 0, last: None, anchor: None, pairs: Vec::new() })
    }

    /// Adds the next image.
    pub fn record(&mut self, image: &RgbdImage) {
        let (gray, depth) = self.front_end.reduced(image);
        let features = self.front_end.extract(&gray);
        let frame =
            self.front_end.frame(image.stamp(), features, &depth, Vector3::zeros(), &self.config.depth);
        let rate_before = self.last.as_ref().and_then(|last| self.turn_rate(&last.frame, &frame));
        let last = self.last.replace(LastFrame { frame, rate_before });
        if self.images % PAIR_STRIDE == 1
            && let Some(last) = last
        {
            self.add_anchor(last, rate_before);
        }
        self.images += 1;
    }

    /// The readout time by the images so far; `None` with too few pairs of images.
    #[must_use]
    pub fn estimate(&self) -> Option<ReadoutEstimate> {
        fit(&self.pairs)
    }

    /// Pairs an image with the one [`PAIR_STRIDE`] before, if both have a turn rate: the mean of the rates before and after the image.
    fn add_anchor(&mut self, LastFrame { frame, rate_before }: LastFrame, rate_after: Option<Vector3>) {
        let anchor = match (rate_before, rate_after) {
            (Some(before), Some(after)) => Some(Anchor { frame, rate: (before + after) / 2.0 }),
            _ => None,
        };
        let before = std::mem::replace(&mut self.anchor, anchor);
        if let (Some(a), Some(b)) = (before, &self.anchor)
            && let Some(pair) = pair_of(&a.frame, &b.frame, &self.front_end.model)
        {
            self.pairs.push(TurningPair { pair, rates: (a.rate, b.rate) });
        }
    }

    /// Turn rate between two successive images, rad/s, camera frame.
    fn turn_rate(&self, before: &Frame, after: &Frame) -> Option<Vector3> {
        let seconds = after.stamp - before.stamp;
        let motion = || Some(pair_of(before, after, &self.front_end.model)?.b_from_a.inverse());
        let is_step = seconds > 0.0 && seconds <= MAX_STEP_S;
        is_step.then(motion)?.map(|motion| motion.log().fixed_rows::<3>(3) / seconds)
    }
}
