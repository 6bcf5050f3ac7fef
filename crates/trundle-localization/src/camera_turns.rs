use crate::gyro_errors::SeenTurn;
use nalgebra::UnitQuaternion;
use trundle_core::{Stamp, wrap_angle};

/// Cuts what the camera sees of the heading into turns that can be compared with the gyro's.
#[derive(Debug, Clone, Default)]
pub(crate) struct CameraTurns {
    turn: Option<Turn>,
    interrupted: Option<Stamp>,
}

/// What base and odometry did since a turn began.
#[derive(Debug, Clone, Copy)]
struct Turn {
    newest: SeenHeading,
    /// When it began, and the way that wheels had told of by then, m.
    from: (Stamp, f64),
    by_odometry: f64,
    by_camera: f64,
}

/// Where the base looked when an image was taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenHeading {
    pub(crate) stamp: Stamp,
    /// Heading by the odometry, rad.
    pub(crate) by_odometry: f64,
    /// Orientation by the camera, in a frame that rests.
    pub(crate) by_camera: UnitQuaternion<f64>,
    /// The way that wheels have told of, m.
    pub(crate) way: f64,
}

/// A stretch is measured when it turned so far, rad, or took so long, s.
const LEAST: (f64, f64) = (0.8, 3.0);
/// Not while the robot turns faster than this, rad/s: what the camera has wrong counts once for a turn, however large.
const TURNING: f64 = 0.2;
/// But it ends then, s: robots that turn and turn.
const LONGEST: f64 = 10.0;
/// Noise of a turn that the camera saw (one sigma): rad, and rad / m of way: 0.3 % of drift at 4 m.
const NOISE: (f64, f64) = (0.003, 0.002);

impl CameraTurns {
    /// What came before `now` does not belong to what comes: a rest, a slip, a turn that the gyro did not tell, a camera that saw
    /// nothing.
    pub(crate) fn interrupt(&mut self, now: Stamp) {
        self.turn = None;
        // An image that comes late may tell of an older one.
        self.interrupted = self.interrupted.max(Some(now));
    }

    /// Takes in what an image showed, late as it may come; the turn that ends with it, if one does.
    pub(crate) fn see(&mut self, heading: SeenHeading) -> Option<SeenTurn> {
        if self.interrupted.is_some_and(|since| heading.stamp <= since) {
            return None;
        }
        let Some(turn) = &mut self.turn else {
            self.turn = Some(Turn::from(heading));
            return None;
        };
        let rate = turn.go_on(heading);
        let (time, way) = (heading.stamp - turn.from.0, heading.way - turn.from.1);
        let is_enough = turn.by_odometry.abs() >= LEAST.0 || time >= LEAST.1;
        if !is_enough || rate > TURNING && time < LONGEST {
            return None;
        }
        let sigma = NOISE.0.hypot(NOISE.1 * way);
        let seen = SeenTurn { by_camera: (turn.by_camera, sigma), by_gyro: turn.by_odometry, time };
        self.turn = Some(Turn::from(heading));
        Some(seen)
    }
}

impl Turn {
    fn from(heading: SeenHeading) -> Self {
        Self { newest: heading, from: (heading.stamp, heading.way), by_odometry: 0.0, by_camera: 0.0 }
    }

    /// Takes in where the base looks now; how fast it turned, rad/s.
    fn go_on(&mut self, heading: SeenHeading) -> f64 {
        let before = std::mem::replace(&mut self.newest, heading);
        let turned = wrap_angle(heading.by_odometry - before.by_odometry);
        self.by_odometry += turned;
        self.by_camera += (before.by_camera.inverse() * heading.by_camera).scaled_axis().z;
        turned.abs() / (heading.stamp - before.stamp).max(1e-3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(nanos: i64, by_odometry: f64, by_camera: f64) -> SeenHeading {
        let by_camera = UnitQuaternion::from_euler_angles(0.0, 0.0, by_camera);
        SeenHeading { stamp: Stamp::from_nanos(nanos), by_odometry, by_camera, way: 0.0 }
    }

    #[test]
    fn a_stretch_ends_behind_a_turn_or_after_a_while() {
        let mut turns = CameraTurns::default();
        assert!(turns.see(heading(0, 3.0, 0.0)).is_none());
        assert!(turns.see(heading(500_000_000, -2.9, 0.4)).is_none(), "0.38 rad across the seam");
        assert!(turns.see(heading(1_000_000_000, -2.4, 0.9)).is_none(), "it goes on turning");
        let turn = turns.see(heading(1_100_000_000, -2.4, 0.9)).unwrap();
        assert!((turn.by_gyro - (std::f64::consts::TAU - 5.4)).abs() < 1e-12);
        assert!((turn.by_camera.0 - 0.9).abs() < 1e-12 && (turn.time - 1.1).abs() < 1e-12);
        assert!(turns.see(heading(4_000_000_000, -2.4, 0.9)).is_none());
        assert!(turns.see(heading(4_100_000_000, -2.4, 0.9)).is_some_and(|turn| turn.by_gyro == 0.0));
        let mut ends = (0..20_i64)
            .filter_map(|i| turns.see(heading(5_000_000_000 + i * 1_000_000_000, i as f64, i as f64)));
        assert!(ends.next().is_some_and(|turn| turn.time >= LONGEST), "one that turns and turns");
    }

    #[test]
    fn an_image_of_before_an_interruption_begins_no_turn() {
        let mut turns = CameraTurns::default();
        turns.see(heading(0, 0.0, 0.0));
        turns.interrupt(Stamp::from_nanos(100_000_000));
        turns.interrupt(Stamp::from_nanos(40_000_000));
        assert!(turns.see(heading(60_000_000, 0.0, 0.0)).is_none());
        assert!(turns.see(heading(160_000_000, 0.5, 0.5)).is_none());
        turns.see(heading(260_000_000, 1.4, 1.4));
        let turn = turns.see(heading(360_000_000, 1.4, 1.4)).unwrap();
        assert!((turn.by_gyro - 0.9).abs() < 1e-12, "from the first image after it");
    }
}
