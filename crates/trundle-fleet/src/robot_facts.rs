//! Facts of a robot that the network gets once.

use std::f64::consts::TAU;
use trundle_app::RunSetup;
use trundle_core::{DriveLimits, Footprint, Invalid, Vector2};

/// Number of corners of the polygon that approximates a disc. Source: ours.
const DISC_CORNERS: u32 = 16;

/// Facts of a robot that the network gets once.
#[derive(Debug, Clone)]
pub struct RobotFacts {
    /// Name of the run: `demo: house`.
    pub title: String,
    /// Outline of the robot.
    pub footprint: Footprint,
    /// Limits of the robot's speed.
    pub limits: DriveLimits,
    /// Height of the robot \[m\]: the upper edge of the band in which obstacles count.
    pub height_m: f64,
}

impl RobotFacts {
    /// The facts of a setup.
    ///
    /// # Errors
    /// When the footprint of the robot cannot be used.
    pub fn of(setup: &RunSetup) -> Result<Self, Invalid> {
        Ok(Self {
            title: format!("{}: {}", setup.command, setup.scene),
            footprint: setup.robot.footprint()?,
            limits: setup.robot.limits,
            height_m: setup.robot.scan.band_high,
        })
    }

    /// Corners of the outline, counter-clockwise, base frame \[m\].
    #[must_use]
    pub fn outline(&self) -> Vec<Vector2> {
        match &self.footprint {
            Footprint::Polygon { corners } => corners.clone(),
            Footprint::Disc { radius } => (0..DISC_CORNERS)
                .map(|i| {
                    let (sin, cos) = (TAU * f64::from(i) / f64::from(DISC_CORNERS)).sin_cos();
                    Vector2::new(radius * cos, radius * sin)
                })
                .collect(),
        }
    }

    /// Length and width of the outline \[m\].
    #[must_use]
    pub fn size(&self) -> (f64, f64) {
        let outline = self.outline();
        let span = |of: fn(&Vector2) -> f64| {
            let values = || outline.iter().map(of);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        };
        (span(|corner| corner.x), span(|corner| corner.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_size_is_that_of_the_outline() {
        let facts = RobotFacts {
            title: String::new(),
            footprint: Footprint::KOBUKI,
            limits: DriveLimits::KOBUKI,
            height_m: 1.0,
        };
        let (length, width) = facts.size();
        assert!((length - 0.351).abs() < 1e-9 && (width - 0.351).abs() < 1e-9);
    }
}
