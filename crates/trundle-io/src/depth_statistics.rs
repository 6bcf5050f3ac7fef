//! Range of the depth images of an input, and the likely cause of unusable depth.

use crate::camera::KINECT_V2_DEPTH_SCALE;
use trundle_core::DepthImage;

/// Depth below which a depth camera has no measurement, m. Source: Kinect v1 and V2, RealSense D435.
const MIN_USABLE_M: f32 = 0.3;
/// Depth above which indoor depth is not used, m. Source: \[Li18\], Kinect V2.
const MAX_USABLE_M: f32 = 8.0;
/// Rows and columns from one pixel that counts to the next. Source: ours, 1,200 pixels of a 640 x 480 image.
const PIXEL_STEP: usize = 16;
/// Typical depth of indoor walls, m: the score of a depth scale is the difference of the mean depth from this value. Source: ours.
const TYPICAL_DEPTH_M: f64 = 2.0;
/// Depth scales in use, units per metre: metres, 0.1 mm, mm, and TUM's 0.2 mm. Source: docs/formats.md.
const KNOWN_SCALES: [f64; 4] = [1.0, 1000.0, 5000.0, 10_000.0];

/// Largest number of a 16-bit depth image. Some cameras write it for no reading. Only floats can hold a larger one. Source: the
/// range of `u16`.
const MAX_UNITS: f64 = 65_535.0;
/// Depth above which floats are in millimetres, m: no room is as large. Source: ours.
const MIN_MILLIMETRES_AS_METRES: f64 = 100.0;

/// Share of the depth beyond 8 m above which the depth scale is doubted \[1\]. Source: ours; indoor cameras measure little there, and with
/// millimetres for TUM's 0.2 mm it is all depth above 1.6 m.
const MAX_SHARE_TOO_FAR: f64 = 0.25;

/// Counts of sampled depth pixels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DepthStatistics {
    pixels: usize,
    without_depth: usize,
    too_near: usize,
    too_far: usize,
    /// Sum of the logarithms of all depths above 0.
    log_sum: f64,
    /// Largest depth, m; 0 without one.
    largest: f64,
    /// Depths that are not a whole number of metres.
    fractional: usize,
    /// Depths that differ from the largest.
    below_largest: usize,
}

impl DepthStatistics {
    /// Counts every 16th pixel of every 16th row.
    pub fn count(&mut self, depth: &DepthImage) {
        let (width, height) = (depth.width(), depth.height());
        for row in (PIXEL_STEP / 2..height).step_by(PIXEL_STEP) {
            for col in (PIXEL_STEP / 2..width).step_by(PIXEL_STEP) {
                self.count_pixel(depth.row(row)[col]);
            }
        }
    }

    fn count_pixel(&mut self, metres: f32) {
        self.pixels += 1;
        if metres > 0.0 && metres.is_finite() {
            self.log_sum += f64::from(metres).ln();
            self.fractional += usize::from(metres.fract() != 0.0);
            self.note_largest(f64::from(metres));
            self.too_near += usize::from(metres < MIN_USABLE_M);
            self.too_far += usize::from(metres > MAX_USABLE_M);
        } else {
            self.without_depth += 1;
        }
    }

    fn note_largest(&mut self, metres: f64) {
        if metres > self.largest {
            self.below_largest = self.pixels - self.without_depth - 1;
            self.largest = metres;
        } else if metres < self.largest {
            self.below_largest += 1;
        }
    }

    /// Whether the images hold floats in metres, which no depth scale divides: no 16-bit number is as large or has a fraction.
    fn is_of_floats(&self, scale: f64) -> bool {
        self.largest * scale > MAX_UNITS + 0.5 || (scale == 1.0 && self.fractional > 0)
    }

    /// Reason for unusable depth, and the likely cause; `None` if some depth is usable, or no image was counted. `scale`: depth units per
    /// metre.
    #[must_use]
    pub fn problem(&self, scale: f64) -> Option<String> {
        let with_depth = self.pixels - self.without_depth;
        if self.pixels == 0 || with_depth > self.too_near + self.too_far {
            return None;
        }
        let problem = format!("no depth image has a pixel between {MIN_USABLE_M} and {MAX_USABLE_M} m");
        if with_depth == 0 {
            return Some(format!("{problem}: all are 0 (no depth)"));
        }
        let is_maximum = (self.largest * scale - MAX_UNITS).abs() < 0.5;
        if is_maximum && self.below_largest == 0 {
            return Some(format!("{problem}: all are {MAX_UNITS}, the maximum of 16 bits (no reading)"));
        }
        let mean = (self.log_sum / with_depth as f64).exp();
        if self.is_of_floats(scale) {
            let hint = if mean > MIN_MILLIMETRES_AS_METRES { ": are the floats in millimetres?" } else { "" };
            return Some(format!(
                "{problem}: the typical depth is {mean:.3} m, expected floats in metres, to which depth_scale does not apply{hint}"
            ));
        }
        let best = likely_scale(mean * scale);
        Some(format!(
            "{problem}: the typical depth is {mean:.3} m at depth_scale = {scale}; with {best} it would be {:.2} m",
            mean * scale / best
        ))
    }

    /// The depth scale in use that makes the depth usable, if with `scale` more than a quarter of it is too far. `None` if none does, or if the
    /// images hold floats.
    #[must_use]
    pub fn fitting_scale(&self, scale: f64) -> Option<f64> {
        let with_depth = self.pixels - self.without_depth;
        if with_depth == 0
            || (self.too_far as f64) <= MAX_SHARE_TOO_FAR * with_depth as f64
            || self.is_of_floats(scale)
        {
            return None;
        }
        let units = (self.log_sum / with_depth as f64).exp() * scale;
        let best = likely_scale(units);
        let usable = f64::from(MIN_USABLE_M)..=f64::from(MAX_USABLE_M);
        (best != scale && usable.contains(&(units / best))).then_some(best)
    }
}

/// The depth scale in use with which a depth of `units` is nearest to the typical one.
fn likely_scale(units: f64) -> f64 {
    let off = |scale: &f64| (units / scale / TYPICAL_DEPTH_M).ln().abs();
    KNOWN_SCALES.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(KINECT_V2_DEPTH_SCALE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(metres: f32) -> DepthStatistics {
        let mut statistics = DepthStatistics::default();
        statistics.count(&DepthImage::filled(64, 48, metres));
        statistics
    }

    #[test]
    fn the_scale_of_unusable_depth_is_found() {
        assert_eq!(of(10.0).fitting_scale(1000.0), Some(5000.0));
        assert_eq!(of(2.0).fitting_scale(1000.0), None, "usable");
        assert_eq!(of(0.0).fitting_scale(1000.0), None, "no depth");
        assert_eq!(of(70.0).fitting_scale(1000.0), None, "floats");
        let mut mixed = of(2.0);
        (0..2).for_each(|_| mixed.count(&DepthImage::filled(64, 48, 12.0)));
        assert_eq!(mixed.fitting_scale(1000.0), Some(5000.0), "two of three pixels are too far");
        (0..5).for_each(|_| mixed.count(&DepthImage::filled(64, 48, 2.0)));
        assert_eq!(mixed.fitting_scale(1000.0), None, "a quarter is too far");
    }

    #[test]
    fn usable_depth_has_no_problem() {
        assert_eq!(of(2.0).problem(1000.0), None);
        assert_eq!(DepthStatistics::default().problem(1000.0), None);
        let mut mixed = of(0.0);
        mixed.count(&DepthImage::filled(64, 48, 1.0));
        assert_eq!(mixed.problem(1000.0), None);
    }

    #[test]
    fn floats_have_no_scale_and_the_maximum_is_not_a_reading() {
        for scale in [1.0, 1000.0, 5000.0] {
            let floats = of(1538.986).problem(scale).unwrap();
            assert!(floats.ends_with("are the floats in millimetres?"), "{floats}");
            assert!(!floats.contains("it would be"), "{floats}");
            let full = of((65_535.0 / scale) as f32).problem(scale).unwrap();
            assert!(full.ends_with("all are 65535, the maximum of 16 bits (no reading)"), "{full}");
        }
        let far = of(20.0).problem(5000.0).unwrap();
        assert!(far.ends_with("to which depth_scale does not apply"), "{far}");
    }

    #[test]
    fn the_cause_is_named() {
        assert!(of(0.0).problem(1000.0).unwrap().ends_with("all are 0 (no depth)"));
        let metres_as_mm = of(2e-3).problem(1000.0).unwrap();
        assert!(metres_as_mm.contains("with 1 it would be 2.00 m"), "{metres_as_mm}");
        let mm_as_metres = of(2000.0).problem(1.0).unwrap();
        assert!(mm_as_metres.contains("with 1000 it would be 2.00 m"), "{mm_as_metres}");
        let tum_as_mm = of(10.0).problem(1000.0).unwrap();
        assert!(tum_as_mm.contains("with 5000 it would be 2.00 m"), "{tum_as_mm}");
    }
}
