//! Exposure of the colour image: fixed gain or auto exposure.

use super::View;
use super::srgb::linear_from_srgb;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Stamp, require_in};

/// Columns and rows between the pixels that auto exposure uses. Source: ours.
const METERING_STRIDE_PX: usize = 7;

/// Brightness of images: a gain on linear light, fixed or automatic.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Exposure {
    /// Whether the gain adapts to the scene. Default true, as in the cameras of both Kinects.
    pub auto: bool,
    /// The gain while it is fixed, 0.01 to 100. Default 1: the colours that the scene's lights make.
    pub gain: f64,
    /// Mean light (linear, white = 1) that auto exposure aims at, 0.01 to 0.9. Default 0.18, the grey that light meters
    /// take for the mean of a scene.
    pub target: f64,
    /// Auto exposure closes 63 % of a gap in this time, s, 0 to 60. Default 0.3.
    pub time_constant: f64,
    /// Lowest gain of auto exposure, 0.01 to 1. Default 0.25.
    pub min_gain: f64,
    /// Highest gain of auto exposure, 1 to 100. Default 8.
    pub max_gain: f64,
}

impl Default for Exposure {
    fn default() -> Self {
        Self { auto: true, gain: 1.0, target: 0.18, time_constant: 0.3, min_gain: 0.25, max_gain: 8.0 }
    }
}

impl Exposure {
    /// The same gain for every image.
    pub fn fixed(gain: f64) -> Self {
        Self { auto: false, gain, ..Self::default() }
    }

    /// Passes a valid exposure through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let check = |field: &str, value, unit, low, high| {
            require_in(&format!("color_noise.exposure.{field}"), value, unit, low, high).map(|_| ())
        };
        check("gain", self.gain, "", 0.01, 100.0)?;
        check("target", self.target, "", 0.01, 0.9)?;
        check("time_constant", self.time_constant, "s", 0.0, 60.0)?;
        check("min_gain", self.min_gain, "", 0.01, 1.0)?;
        check("max_gain", self.max_gain, "", 1.0, 100.0)?;
        Ok(self)
    }
}

/// The automatic gain.
#[derive(Debug, Clone)]
pub(super) struct ExposureMeter {
    exposure: Exposure,
    gain: f64,
    last: Option<Stamp>,
}

impl ExposureMeter {
    pub(super) fn new(exposure: Exposure) -> Self {
        Self { gain: exposure.gain, exposure, last: None }
    }

    pub(super) fn gain(&self) -> f64 {
        self.gain
    }

    /// Adapts to the view at `stamp`; the first call sets the gain without delay.
    pub(super) fn measure(&mut self, view: &View, stamp: Stamp) {
        if !self.exposure.auto {
            return;
        }
        let wanted = self.exposure.target / mean_light(view).max(1e-4);
        let wanted = wanted.clamp(self.exposure.min_gain, self.exposure.max_gain);
        let elapsed = self.last.map_or(f64::INFINITY, |last| (stamp - last).max(0.0));
        let kept = (-elapsed / self.exposure.time_constant.max(1e-9)).exp();
        // In stops, as brightening and darkening take the same time.
        self.gain = wanted * (self.gain / wanted).powf(kept);
        self.last = Some(stamp);
    }
}

/// Mean of the channels in linear light, white = 1.
fn mean_light(view: &View) -> f64 {
    let rows = view.color.chunks(view.width.max(1)).step_by(METERING_STRIDE_PX);
    let (mut sum, mut count) = (0.0_f64, 0_u32);
    for color in rows.flat_map(|row| row.iter().step_by(METERING_STRIDE_PX)) {
        sum += color.iter().map(|&level| f64::from(linear_from_srgb(level))).sum::<f64>();
        count += 3;
    }
    if count == 0 { 1.0 } else { sum / f64::from(count) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(level: u8) -> View {
        View { width: 8, height: 8, depth: vec![1.0; 64], color: vec![[level; 3]; 64], cosine: vec![1.0; 64] }
    }

    #[test]
    fn the_gain_follows_with_its_time_constant() {
        let mut meter = ExposureMeter::new(Exposure::default());
        let bright = f64::from(linear_from_srgb(200));
        meter.measure(&grey(200), Stamp::default());
        assert!((meter.gain() - 0.18 / bright).abs() < 1e-6);
        // The light goes out; after one time constant 63 % of the difference in stops is compensated.
        meter.measure(&grey(20), Stamp::from_nanos(300_000_000));
        let (from, to) = ((0.18 / bright).ln(), 8_f64.ln());
        assert!((meter.gain().ln() - (to + (from - to) * (-1.0_f64).exp())).abs() < 1e-6);
        let mut fixed = ExposureMeter::new(Exposure::fixed(2.0));
        fixed.measure(&grey(5), Stamp::default());
        assert_eq!(fixed.gain(), 2.0);
        assert!(Exposure { target: 0.0, ..Exposure::default() }.validated().is_err());
    }
}
