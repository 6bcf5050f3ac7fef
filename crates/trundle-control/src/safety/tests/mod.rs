//! Tests of the safety monitor: its decisions, and the laws of docs/explanation/safety-case.md.

mod decisions;
mod one_dimension;
mod swept_footprint;

use super::obstacles::SafetyScan;
use super::safety_config::SafetyConfig;
use super::safety_input::{MotionSense, SafetyInput};
use super::safety_monitor::SafetyMonitor;
use trundle_core::{Beam, Footprint, Pose2, Scan, Stamp, Twist2, Vector2};

fn monitor() -> SafetyMonitor {
    SafetyMonitor::new(SafetyConfig::default(), &Footprint::KOBUKI).unwrap()
}

fn fresh(twist: Twist2) -> SafetyInput<'static> {
    let now = Stamp::default();
    SafetyInput {
        now,
        twist,
        scan: None,
        memory: None,
        touched: false,
        over_edge: false,
        hold: None,
        image: Some(now),
        wheels: Some(now),
        motion: MotionSense::Wheels,
        station: None,
    }
}

fn scan(angle_min: f64, increment: f64, ranges: &[f64]) -> Scan {
    let beams = ranges.iter().map(|&range| Beam::Hit { range }).collect();
    Scan::new(Stamp::default(), Vector2::zeros(), angle_min, increment, beams).unwrap()
}

fn seen(scan: &Scan) -> Option<SafetyScan<'_>> {
    Some(SafetyScan { scan, odom_at_scan: Pose2::IDENTITY, odom_now: Pose2::IDENTITY })
}

/// An outline of 0.6 x 0.4 m, the axle behind its centre.
fn cart_outline() -> Footprint {
    let corners = [(0.4, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.4, -0.2)];
    Footprint::polygon(corners.iter().map(|&(x, y)| Vector2::new(x, y)).collect()).unwrap()
}

fn cart() -> SafetyMonitor {
    SafetyMonitor::new(SafetyConfig::default(), &cart_outline()).unwrap()
}
