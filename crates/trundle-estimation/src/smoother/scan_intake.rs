//! Scan matches: gate and correlation.

use super::factors::ScanFactor;
use super::fixed_lag::Smoother;
use super::intake::{self, Target};
use super::keyframe::Keyframe;
use super::measurement::{MeasurementUse, PlanarMeasurement};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// Correlation of the errors of two scan matches above which the second one is redundant. Source: ours.
const MAX_CORRELATION: f64 = 0.98;

/// Adds a scan match, `map_from_base` with a covariance that includes the map's.
///
/// Errors of neighbouring matches are correlated, because both use the visible part of the map. A match with correlation r to the previous
/// one has the information of an independent match with (1 + r) / (1 - r) times the variance (the sum over a Gauss-Markov sequence).
pub(super) fn add(smoother: &mut Smoother, scan: &PlanarMeasurement) -> MeasurementUse {
    let is_positive = (0..3).all(|i| scan.covariance[(i, i)] >= 0.0);
    if !(scan.pose.is_finite() && scan.covariance.iter().all(|v| v.is_finite()) && is_positive) {
        return MeasurementUse::Invalid;
    }
    let at = match intake::locate(smoother, scan.stamp) {
        Ok(at) => at,
        Err(rejection) => return rejection,
    };
    let Some(window) = &smoother.window else { return MeasurementUse::NoMotion };
    let has_scan = |keyframe: &Keyframe| keyframe.scan.is_some();
    let correlated = intake::path_since(smoother, window, &at, has_scan).map_or(0.0, |path| {
        (-path.distance / smoother.config.noise.scan_correlation_distance
            - path.turned / smoother.config.noise.scan_correlation_turn)
            .exp()
    });
    let is_before_another = window.keyframes[at.before + 1..].iter().any(has_scan);
    if correlated > MAX_CORRELATION || is_before_another {
        return MeasurementUse::Redundant;
    }
    let target = intake::target(smoother, window, &at, |keyframe| keyframe.scan.is_none());
    let (predicted, keyframe) = intake::predicted(smoother, window, &target, at.stamp);
    let (position, heading) =
        (smoother.config.noise.scan_position, smoother.config.noise.scan_heading_deg.to_radians());
    let own = Matrix3::from_diagonal(&Vector3::new(position, position, heading).map(|sigma| sigma * sigma));
    let noise = own + scan.covariance;
    let mut factor =
        ScanFactor { pose: scan.pose * Pose2::exp(intake::velocity(smoother) * -at.lead), noise };
    if let Target::Existing { motion, .. } = target {
        factor.pose = factor.pose * motion;
    }
    let innovation = predicted.innovation(&factor.linearise(&predicted.state), &noise);
    if innovation.squared > smoother.config.limits.gate.powi(2) {
        return MeasurementUse::Gated(innovation);
    }
    factor.noise *= (1.0 + correlated) / (1.0 - correlated);
    match (target, keyframe) {
        (Target::New { k }, Some(mut keyframe)) => {
            keyframe.scan = Some(factor);
            smoother.insert(k, keyframe);
        }
        (Target::Existing { k, .. }, _) => {
            smoother.window.iter_mut().for_each(|window| window.keyframes[k].scan = Some(factor));
            smoother.solve();
        }
        (Target::New { .. }, None) => {}
    }
    MeasurementUse::Applied(innovation)
}
