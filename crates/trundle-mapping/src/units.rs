//! Conversion of poses and covariances between cells and metres.

use crate::particle_config::ParticleConfig;
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// Pose in cells of a pose in m.
pub(crate) fn in_cells(config: &ParticleConfig, pose: Pose2) -> Pose2 {
    let per_metre = 1.0 / config.map.resolution;
    Pose2 { x: pose.x * per_metre, y: pose.y * per_metre, ..pose }
}

/// Pose in m of a pose in cells.
pub(crate) fn in_metres(config: &ParticleConfig, pose: Pose2) -> Pose2 {
    Pose2 { x: pose.x * config.map.resolution, y: pose.y * config.map.resolution, ..pose }
}

/// Covariance (m, m, rad) of a pose whose lengths are in units of `unit` m.
pub(crate) fn scaled(covariance: Matrix3<f64>, unit: f64) -> Matrix3<f64> {
    let scale = Matrix3::from_diagonal(&Vector3::new(unit, unit, 1.0));
    scale * covariance * scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_and_metres_are_inverse_and_keep_the_heading() {
        let config = ParticleConfig::default();
        let pose = Pose2::new(3.21, -0.07, 2.5);
        let there = in_cells(&config, pose);
        assert!((there.x - 64.2).abs() < 1e-9 && there.theta == pose.theta);
        assert!(in_metres(&config, there).distance(&pose) < 1e-12);
    }

    #[test]
    fn a_covariance_scales_with_the_square_of_the_unit_and_the_heading_keeps_its_own() {
        let cells = Matrix3::new(4.0, 1.0, 0.2, 1.0, 2.0, 0.1, 0.2, 0.1, 0.5);
        let metres = scaled(cells, 0.05);
        assert!((metres[(0, 0)] - 0.01).abs() < 1e-12 && (metres[(0, 2)] - 0.01).abs() < 1e-12);
        assert_eq!(metres[(2, 2)], 0.5);
        assert!((scaled(metres, 20.0) - cells).norm() < 1e-12);
    }
}
