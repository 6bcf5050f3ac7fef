use crate::{OdometryConfig, learnt::Learnt};
use nalgebra::UnitQuaternion;
use trundle_core::wrap_angle;

/// How much larger the true turns are than the gyro's, learnt of turns that the camera saw.
#[derive(Debug, Clone)]
pub(crate) struct GyroScale {
    scale: Learnt,
    turn: Option<Turn>,
}

/// What base and odometry did since a turn began.
#[derive(Debug, Clone, Copy)]
struct Turn {
    /// The newest heading by the odometry, rad, and the orientation that the camera saw with it.
    last: (f64, UnitQuaternion<f64>),
    /// The way that wheels had told of when it began, m.
    from: f64,
    by_odometry: f64,
    by_camera: f64,
}

/// A turn is measured when it is so large, rad.
const LEAST_TURN: f64 = 0.8;
/// And begun anew when the robot has gone so far without, m: the camera's heading drifts with the way.
const FARTHEST: f64 = 2.0;
/// Noise of a turn that the camera saw (one sigma): rad, and rad / m of way: 0.3 % of drift at 4 m.
const TURN_NOISE: (f64, f64) = (0.003, 0.002);

impl GyroScale {
    pub(crate) fn new(config: &OdometryConfig) -> Self {
        Self { scale: Learnt::new(1.0, config.gyro_scale_sigma), turn: None }
    }

    /// True turns over the gyro's.
    pub(crate) fn value(&self) -> f64 {
        self.scale.value()
    }

    /// What came before does not belong to what comes: a slip, a turn that the gyro did not tell, a camera that saw nothing.
    pub(crate) fn interrupt(&mut self) {
        self.turn = None;
    }

    /// The camera saw the base turned so when the odometry had it at `heading` (rad), after `way` m.
    pub(crate) fn seen(&mut self, heading: f64, orientation: UnitQuaternion<f64>, way: f64) {
        let now = (heading, orientation);
        let begun = Turn { last: now, from: way, by_odometry: 0.0, by_camera: 0.0 };
        let Some(turn) = &mut self.turn else {
            self.turn = Some(begun);
            return;
        };
        turn.by_odometry += wrap_angle(heading - turn.last.0);
        turn.by_camera += (turn.last.1.inverse() * orientation).scaled_axis().z;
        turn.last = now;
        let (turned, gone) = (turn.by_odometry, way - turn.from);
        if turned.abs() >= LEAST_TURN {
            let sigma = TURN_NOISE.0.hypot(TURN_NOISE.1 * gone) / turned.abs();
            self.scale.learn(self.scale.value() * turn.by_camera / turned, sigma * sigma);
            self.turn = Some(begun);
        } else if gone > FARTHEST {
            self.turn = Some(begun);
        }
    }
}
