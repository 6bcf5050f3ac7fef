//! Segments of the heading measured by both camera and gyro.

use crate::calibration::gyro_calibration::VisualTurn;
use nalgebra::UnitQuaternion;
use trundle_core::{Hypotenuse, Stamp, wrap_angle};

/// Splits the camera's heading into segments for comparison with the gyro.
#[derive(Debug, Clone, Default)]
pub(crate) struct VisualYawSegments {
    segment: Option<Segment>,
    interrupted: Option<Stamp>,
}

/// Turns by camera and odometry since the segment's start.
#[derive(Debug, Clone, Copy)]
struct Segment {
    newest: VisualHeading,
    start: Stamp,
    /// Length of the path at the start, m.
    start_path_length: f64,
    by_odometry: f64,
    by_camera: f64,
}

/// Heading of the base at the stamp of an image.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VisualHeading {
    pub(crate) stamp: Stamp,
    /// Heading by the odometry, rad.
    pub(crate) by_odometry: f64,
    /// Orientation by the camera, in a fixed frame.
    pub(crate) by_camera: UnitQuaternion<f64>,
    /// Length of the path by the wheels, m.
    pub(crate) path_length: f64,
}

/// Turn at which a segment may end, rad. Shorter segments measure the scale poorly. Source: ours.
const MIN_SEGMENT_TURN_RAD: f64 = 0.8;
/// Time at which a segment may end, s. Shorter segments measure the bias poorly. Source: ours.
const MIN_SEGMENT_S: f64 = 3.0;
/// Largest turn rate at a segment's end, rad/s: the camera's error of a fast turn then counts once per turn. Source: ours.
const MAX_END_TURN_RATE_RAD_S: f64 = 0.2;
/// Longest segment, s: a robot that turns without pause ends its segment here. Source: ours.
const MAX_SEGMENT_S: f64 = 10.0;
/// Noise of the camera's turn (one sigma), rad. Source: ours.
const VISUAL_TURN_SIGMA_RAD: f64 = 0.003;
/// Noise of the camera's turn per metre of path (one sigma), rad / m: a drift of 0.3 % at a range of 4 m. Source: ours.
const VISUAL_DRIFT_SIGMA_RAD_PER_M: f64 = 0.002;

impl VisualYawSegments {
    /// Ends the segment at `now`: after a rest, a slip, a turn without a gyro, or an image without a pose.
    pub(crate) fn interrupt(&mut self, now: Stamp) {
        self.segment = None;
        // A late image may carry an older stamp.
        self.interrupted = self.interrupted.max(Some(now));
    }

    /// Adds the heading of an image, which may be late; returns the turn of the completed segment.
    pub(crate) fn add(&mut self, heading: VisualHeading) -> Option<VisualTurn> {
        if self.interrupted.is_some_and(|since| heading.stamp <= since) {
            return None;
        }
        let Some(segment) = &mut self.segment else {
            self.segment = Some(Segment::from(heading));
            return None;
        };
        let rate = segment.extend(heading);
        let duration = heading.stamp - segment.start;
        let distance = heading.path_length - segment.start_path_length;
        let is_long = segment.by_odometry.abs() >= MIN_SEGMENT_TURN_RAD || duration >= MIN_SEGMENT_S;
        if !is_long || rate > MAX_END_TURN_RATE_RAD_S && duration < MAX_SEGMENT_S {
            return None;
        }
        let camera_sigma = VISUAL_TURN_SIGMA_RAD.hypotenuse(VISUAL_DRIFT_SIGMA_RAD_PER_M * distance);
        let (by_camera, by_gyro) = (segment.by_camera, segment.by_odometry);
        self.segment = Some(Segment::from(heading));
        Some(VisualTurn { by_camera, camera_sigma, by_gyro, duration })
    }
}

impl Segment {
    fn from(heading: VisualHeading) -> Self {
        let (start, start_path_length) = (heading.stamp, heading.path_length);
        Self { newest: heading, start, start_path_length, by_odometry: 0.0, by_camera: 0.0 }
    }

    /// Extends the segment to a heading and returns the turn rate, rad/s.
    fn extend(&mut self, heading: VisualHeading) -> f64 {
        let previous = std::mem::replace(&mut self.newest, heading);
        let turned = wrap_angle(heading.by_odometry - previous.by_odometry);
        self.by_odometry += turned;
        self.by_camera += (previous.by_camera.inverse() * heading.by_camera).scaled_axis().z;
        turned.abs() / (heading.stamp - previous.stamp).max(1e-3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(nanos: i64, by_odometry: f64, by_camera: f64) -> VisualHeading {
        let by_camera = UnitQuaternion::from_euler_angles(0.0, 0.0, by_camera);
        VisualHeading { stamp: Stamp::from_nanos(nanos), by_odometry, by_camera, path_length: 0.0 }
    }

    #[test]
    fn a_segment_ends_after_a_turn_or_after_a_time() {
        let mut segments = VisualYawSegments::default();
        assert!(segments.add(heading(0, 3.0, 0.0)).is_none());
        assert!(segments.add(heading(500_000_000, -2.9, 0.4)).is_none(), "0.38 rad across the seam");
        assert!(segments.add(heading(1_000_000_000, -2.4, 0.9)).is_none(), "still turning");
        let turn = segments.add(heading(1_100_000_000, -2.4, 0.9)).unwrap();
        assert!((turn.by_gyro - (std::f64::consts::TAU - 5.4)).abs() < 1e-12);
        assert!((turn.by_camera - 0.9).abs() < 1e-12 && (turn.duration - 1.1).abs() < 1e-12);
        assert!(segments.add(heading(4_000_000_000, -2.4, 0.9)).is_none());
        assert!(segments.add(heading(4_100_000_000, -2.4, 0.9)).is_some_and(|turn| turn.by_gyro == 0.0));
        let mut ends = (0..20_i64)
            .filter_map(|i| segments.add(heading(5_000_000_000 + i * 1_000_000_000, i as f64, i as f64)));
        assert!(ends.next().is_some_and(|turn| turn.duration >= MAX_SEGMENT_S), "a turn without pause");
    }

    #[test]
    fn a_late_image_from_before_an_interruption_starts_no_segment() {
        let mut segments = VisualYawSegments::default();
        segments.add(heading(0, 0.0, 0.0));
        segments.interrupt(Stamp::from_nanos(100_000_000));
        segments.interrupt(Stamp::from_nanos(40_000_000));
        assert!(segments.add(heading(60_000_000, 0.0, 0.0)).is_none());
        assert!(segments.add(heading(160_000_000, 0.5, 0.5)).is_none());
        segments.add(heading(260_000_000, 1.4, 1.4));
        let turn = segments.add(heading(360_000_000, 1.4, 1.4)).unwrap();
        assert!((turn.by_gyro - 0.9).abs() < 1e-12, "from the first image after the interruption");
    }
}
