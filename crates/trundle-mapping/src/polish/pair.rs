//! Normal equations of the relative pose of two scans.

use crate::polish::surface_scan::{SurfaceHit, SurfaceScan};
use crate::scan_match::point_spread::PointSpread;
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Hypotenuse, Pose2, Vector2};

/// Smallest cosine between the normals of two hits of one surface \[1\]. Source: ours, 37 deg.
const MIN_NORMAL_COSINE: f64 = 0.8;
/// Reach of a match in scales of the kernel \[1\]. A hit there has a weight of 1 %. Source: ours.
const REACH_SCALES: f64 = 3.0;
/// Smallest length of observed free space behind a hit that contradicts a scan \[m\]. Source: ours, a person.
const MIN_CONTRADICTION_M: f64 = 0.3;
/// Minimum lever of the matched hits \[m\]. Hits nearer to each other do not determine the heading. Source: ours.
const MIN_LEVER_M: f64 = 0.1;

/// Parameters of a match.
#[derive(Debug, Clone, Copy)]
pub(super) struct MatchModel {
    /// Scale of the robust kernel, m. A residual of this length has a quarter of the full weight.
    pub(super) scale: f64,
    /// Smallest scale of a hit's kernel, in sigmas of its range.
    pub(super) min_scale_sigmas: f64,
    /// Number of hits with correlated errors.
    pub(super) correlation: f64,
    /// Fraction of the hits' information below which a direction is degenerate.
    pub(super) degenerate_below: f64,
}

/// Equations of a displacement of the relative pose `to_from_from`, as a left perturbation, and the agreement of the hits.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct PairEquations {
    /// Information about the displacement, m and rad; zero in degenerate directions.
    pub(super) information: Matrix3<f64>,
    pub(super) rhs: Vector3<f64>,
    /// Sum of the information of the matched hits, 1/m^2.
    weight: f64,
    /// Number of matched hits, each by its weight in the kernel.
    pub(super) matched: f64,
    /// Number of hits in front of surfaces of the other scan.
    pub(super) contradicted: f64,
}

impl PairEquations {
    /// The equations of the hits of `from` on the surfaces of `to` at a relative pose (m, rad).
    pub(super) fn new(from: &SurfaceScan, to: &SurfaceScan, to_from_from: Pose2, model: &MatchModel) -> Self {
        let mut sum = Self::default();
        let mut matched = Vec::with_capacity(from.hits.len());
        let (s, c) = to_from_from.theta.sin_cos();
        let turn = |v: Vector2| Vector2::new(c * v.x - s * v.y, s * v.x + c * v.y);
        for hit in &from.hits {
            let end = turn(hit.end()) + to_from_from.position();
            let scale = model.scale.max(model.min_scale_sigmas * hit.sigma());
            let counterpart = counterpart(to, hit, end, turn(hit.normal()), REACH_SCALES * scale);
            match counterpart.map(|other| sum.add_match(hit, other, end, (scale, model.correlation))) {
                Some(true) => matched.push(end),
                Some(false) => {}
                None => sum.add_unmatched(to, end, REACH_SCALES * scale),
            }
        }
        sum.without_degenerate(&matched, model.degenerate_below)
    }

    /// Adds the residual of a hit at `end` from its counterpart. Returns whether it is within the reach of the kernel.
    fn add_match(
        &mut self,
        hit: &SurfaceHit,
        other: &SurfaceHit,
        end: Vector2,
        (scale, correlation): (f64, f64),
    ) -> bool {
        let normal = other.normal();
        let off =
            if hit.is_straight() { normal * (other.offset() - normal.dot(&end)) } else { other.end() - end };
        let square = off.norm_squared();
        if square > (REACH_SCALES * scale).powi(2) {
            return false;
        }
        // The kernel of Geman and McClure.
        let share = (scale * scale / (scale * scale + square)).powi(2);
        self.matched += share;
        if hit.is_straight() {
            self.add(normal, off, end, share / (correlation * hit.sigma() * hit.sigma()));
        } else {
            // The edge is somewhere between two beams.
            let sigma =
                (correlation.sqrt() * hit.sigma()).hypotenuse(0.5 * hit.spacing().max(other.spacing()));
            self.add(Vector2::x(), off, end, share / (sigma * sigma));
            self.add(Vector2::y(), off, end, share / (sigma * sigma));
        }
        true
    }

    fn add(&mut self, normal: Vector2, off: Vector2, end: Vector2, weight: f64) {
        let row = Vector3::new(normal.x, normal.y, normal.y * end.x - normal.x * end.y);
        self.information += row * row.transpose() * weight;
        self.rhs += row * (weight * normal.dot(&off));
        self.weight += weight;
    }

    fn add_unmatched(&mut self, to: &SurfaceScan, end: Vector2, reach: f64) {
        let contradicts = |free: f64| free > reach.max(MIN_CONTRADICTION_M);
        self.contradicted += f64::from(u8::from(to.free_beyond(end).is_some_and(contradicts)));
    }

    /// The equations without the directions that hold less than the fraction `min` of the information of the matched hits.
    fn without_degenerate(mut self, matched: &[Vector2], min: f64) -> Self {
        let spread = PointSpread::new(matched.iter().copied(), MIN_LEVER_M);
        let pose_from_y = spread.pose_from_centroid(spread.centroid);
        let y_from_pose = pose_from_y.try_inverse().expect("invariant: a lever is positive");
        let eigen = (pose_from_y.transpose() * self.information * pose_from_y).symmetric_eigen();
        let directions = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
        let held: Matrix3<f64> = directions
            .filter(|(value, _)| **value >= min * self.weight)
            .map(|(_, direction)| direction * direction.transpose())
            .sum();
        let projection = pose_from_y * held * y_from_pose;
        self.information = projection.transpose() * self.information * projection;
        self.rhs = projection.transpose() * self.rhs;
        self
    }
}

/// The nearest hit of `to` on the same kind of surface as a hit at `end` with this normal, within `reach` m and the spacing of its beams.
fn counterpart<'a>(
    to: &'a SurfaceScan,
    hit: &SurfaceHit,
    end: Vector2,
    normal: Vector2,
    reach: f64,
) -> Option<&'a SurfaceHit> {
    let mut best: Option<(f64, &SurfaceHit)> = None;
    for other in to.around(end) {
        let is_alike = if hit.is_straight() {
            normal.dot(&other.normal()) > MIN_NORMAL_COSINE
        } else {
            !other.is_straight()
        };
        let square = (other.end() - end).norm_squared();
        if is_alike && best.is_none_or(|(min, _)| square < min) {
            best = Some((square, other));
        }
    }
    best.filter(|(square, other)| *square < (reach + other.spacing()).powi(2)).map(|(_, other)| other)
}
