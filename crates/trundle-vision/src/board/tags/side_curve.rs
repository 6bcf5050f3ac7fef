//! The edge of a marker as a curve.
//!
//! The curve is a parabola over the chord: a lens bends a side of 45 px by 0.3 px. Blur does not move a straight edge, but it rounds the
//! corners: the ends of the side are not used.

use crate::board::smooth_image::SmoothImage;
use nalgebra::{Matrix2, Matrix3, Vector3};
use trundle_core::Vector2;

/// An edge: `middle + along * t + outward * (c0 + c1 u + c2 u^2)`, u = t over half the length.
#[derive(Debug, Clone, Copy)]
pub(super) struct SideCurve {
    middle: Vector2,
    /// Unit vector from start to end.
    along: Vector2,
    /// Unit vector from dark to light.
    outward: Vector2,
    half_length: f64,
    coefficients: Vector3<f64>,
}

/// A place of the edge: u, and the offset outward, px.
type Sample = (f64, f64);

/// Part of the side at each end that does not count, over the length. Source: ours.
const END_RATIO: f64 = 0.08;
/// Smallest such part, px: blur reaches so far. Source: ours.
const MIN_END_PX: f64 = 2.5;
/// Largest distance of the edge from the chord, over the length: less than the border of one cell of eight. Source: ours.
const SEARCH_RATIO: f64 = 0.12;
/// Smallest such distance, px. Source: ours.
const MIN_SEARCH_PX: f64 = 3.0;
/// Distance between samples, along and across the edge, px. Source: ours.
const STEP_PX: f64 = 0.5;
/// Half width of the window in which the mean of the gradient is the edge, px. Source: ours.
const WINDOW_PX: f64 = 2.0;
/// Half width of that window as a fraction of the side's length. The border is an eighth of the side, less for a tilted marker. Source:
/// ours.
const WINDOW_RATIO: f64 = 0.05;
/// Smallest gradient of an edge, grey values per px. Source: ours.
const MIN_GRADIENT: f64 = 4.0;
/// Smallest length at which the curve is a parabola and not a line, px. Source: ours; the bend of shorter sides is below 0.1 px.
const MIN_CURVED_PX: f64 = 24.0;
/// Smallest fraction of samples with an edge that fits. Source: ours.
const MIN_SAMPLE_RATIO: f64 = 0.5;
/// Fits after the first, each by the samples near the fit before. Source: ours.
const SELECTION_COUNT: usize = 3;
/// Largest residual of a sample, px; the others are left out of the next fit. Source: ours.
const MAX_RESIDUAL_PX: f64 = 0.5;

impl SideCurve {
    /// The edge near the chord between two corners, dark on its right side in the direction from `start` to `end`; `None` without an edge.
    pub(super) fn fit(image: &SmoothImage, start: Vector2, end: Vector2) -> Option<Self> {
        let chord = end - start;
        let along = chord.normalize();
        let outward = Vector2::new(along.y, -along.x);
        let (middle, half_length) = ((start + end) / 2.0, chord.norm() / 2.0);
        let straight = Self { middle, along, outward, half_length, coefficients: Vector3::zeros() };
        let (samples, tried) = straight.samples(image);
        let needed = (MIN_SAMPLE_RATIO * tried as f64).max(4.0) as usize;
        let mut curve = straight.fitted(&samples)?;
        for _ in 0..SELECTION_COUNT {
            let is_near = |(u, offset): &&Sample| (curve.offset(*u) - offset).abs() <= MAX_RESIDUAL_PX;
            let good: Vec<Sample> = samples.iter().filter(is_near).copied().collect();
            if good.len() < needed {
                return None;
            }
            curve = straight.fitted(&good)?;
        }
        Some(curve)
    }

    /// Intersection of this curve's end with the start of the next, by Newton's method; `None` for parallel curves.
    pub(super) fn end_meets_start_of(&self, next: &Self) -> Option<Vector2> {
        let (mut u, mut v) = (1.0, -1.0);
        for _ in 0..5 {
            let gap = next.at(v) - self.at(u);
            let slopes = Matrix2::from_columns(&[self.slope(u), -next.slope(v)]);
            let step = slopes.try_inverse()? * gap;
            u += step.x;
            v += step.y;
        }
        let is_near = (u - 1.0).abs() < 0.5 && (v + 1.0).abs() < 0.5;
        is_near.then(|| self.at(u))
    }

    fn offset(&self, u: f64) -> f64 {
        self.coefficients.dot(&Vector3::new(1.0, u, u * u))
    }

    fn at(&self, u: f64) -> Vector2 {
        self.middle + self.along * (u * self.half_length) + self.outward * self.offset(u)
    }

    fn slope(&self, u: f64) -> Vector2 {
        self.along * self.half_length + self.outward * (self.coefficients.y + 2.0 * u * self.coefficients.z)
    }

    /// Points of the edge, and the number of attempts.
    fn samples(&self, image: &SmoothImage) -> (Vec<Sample>, usize) {
        let length = 2.0 * self.half_length;
        let end = (END_RATIO * length).max(MIN_END_PX);
        let count = (((length - 2.0 * end) / STEP_PX) as usize).max(4);
        let u = |i: usize| (1.0 - end / self.half_length) * (2.0 * i as f64 / (count - 1) as f64 - 1.0);
        let samples = (0..count).filter_map(|i| Some((u(i), self.edge_offset(image, u(i))?)));
        (samples.collect(), count)
    }

    /// The offset of the strongest step from dark to light: the mean of the gradient about its peak.
    fn edge_offset(&self, image: &SmoothImage, u: f64) -> Option<f64> {
        let length = 2.0 * self.half_length;
        let search = (SEARCH_RATIO * length).max(MIN_SEARCH_PX);
        let window = (WINDOW_RATIO * length).min(WINDOW_PX);
        let from = self.middle + self.along * (u * self.half_length);
        if !image.contains(from, search + window + 1.0) {
            return None;
        }
        let gradient = |offset: f64| {
            let value = |offset: f64| image.sample(from + self.outward * offset);
            value(offset + 0.5) - value(offset - 0.5)
        };
        let steps = (search / STEP_PX) as i64;
        let offsets = (-steps..=steps).map(|k| k as f64 * STEP_PX);
        let (mut edge, peak) = offsets
            .map(|at| (at, gradient(at)))
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.total_cmp(&a.0)))?;
        if peak < MIN_GRADIENT {
            return None;
        }
        // The window moves to the mean, which makes both sides equally long.
        for _ in 0..3 {
            let steps = (window / (0.5 * STEP_PX)) as i64;
            let (mut sum, mut moment) = (0.0, 0.0);
            for k in -steps..=steps {
                let at = edge + k as f64 * 0.5 * STEP_PX;
                let weight = gradient(at).max(0.0);
                sum += weight;
                moment += weight * at;
            }
            edge = if sum > 0.0 { moment / sum } else { return None };
        }
        Some(edge)
    }

    /// Least squares.
    fn fitted(&self, samples: &[Sample]) -> Option<Self> {
        let is_curved = 2.0 * self.half_length >= MIN_CURVED_PX;
        let (mut information, mut vector) = (Matrix3::zeros(), Vector3::zeros());
        for (u, offset) in samples {
            let row = Vector3::new(1.0, *u, if is_curved { u * u } else { 0.0 });
            information += row * row.transpose();
            vector += row * *offset;
        }
        if !is_curved {
            information[(2, 2)] = 1.0;
        }
        let coefficients = information.try_inverse()? * vector;
        coefficients.iter().all(|value| value.is_finite()).then_some(Self { coefficients, ..*self })
    }
}
