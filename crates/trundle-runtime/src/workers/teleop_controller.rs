//! The teleop controller: drives by the twists of an operator, under the safety monitor.

use crate::behaviour::navigator::safety_input;
use crate::config::RobotConfig;
use crate::operator::TELEOP_SILENCE_S;
use crate::world_state::WorldState;
use trundle_control::{Limiter, SafetyMonitor};
use trundle_core::{Footprint, Invalid, Stamp, Twist2};

/// Drives by the twists of an operator, within the limits of the base; the safety monitor checks each twist. Without a new twist for
/// [`TELEOP_SILENCE_S`] the robot stops immediately.
#[derive(Debug)]
pub(crate) struct TeleopController {
    limiter: Limiter,
    safety: SafetyMonitor,
    pub(crate) touched: bool,
    pub(crate) over_edge: bool,
    /// The operator's last twist, with its stamp.
    wanted: Option<(Twist2, Stamp)>,
    /// Stamp of the last sent twist.
    sent: Option<Stamp>,
}

impl TeleopController {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            limiter: Limiter::new(config.drive, config.limits)?,
            safety: SafetyMonitor::new(config.safety.clone(), footprint)?,
            touched: false,
            over_edge: false,
            wanted: None,
            sent: None,
        })
    }

    /// Sets the operator's twist at `now`.
    pub(crate) fn drive(&mut self, twist: Twist2, now: Stamp) {
        self.wanted = Some((twist, now));
    }

    /// Ends driving by the operator.
    pub(crate) fn release(&mut self) {
        self.wanted = None;
    }

    /// The twist of a control step; `None` if no operator drives. `s.hold` stops the robot, except for a pause of the mission.
    pub(crate) fn step(&mut self, s: &WorldState<'_>) -> Option<Twist2> {
        let wanted = self.wanted.filter(|(_, since)| s.now - *since <= TELEOP_SILENCE_S);
        let Some((wanted, _)) = wanted else {
            self.wanted = None;
            self.sent = None;
            self.limiter.sent(Twist2::ZERO);
            return None;
        };
        let dt = self.sent.replace(s.now).map_or(0.0, |sent| s.now - sent);
        let limited = self.limiter.limit(wanted, dt).twist;
        let twist = self.safety.check(&safety_input(s, limited, self.touched, self.over_edge)).twist;
        self.limiter.sent(twist);
        Some(twist)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::behaviour::navigator::testing::{at_rest, floor};
    use trundle_control::MotionHold;
    use trundle_core::{Cell, CellIndex, Pose2, Vector2};

    /// A control step \[s\].
    const STEP_S: f64 = 0.02;

    fn controller() -> TeleopController {
        let config = RobotConfig::default();
        TeleopController::new(&config, &config.footprint().unwrap()).unwrap()
    }

    fn at(seconds: f64) -> Stamp {
        Stamp::default().after(10.0 + seconds)
    }

    /// Twists from the first command on, one each control step.
    fn twists(
        teleop: &mut TeleopController,
        from: f64,
        steps: u32,
        is_wall_ahead: bool,
    ) -> Vec<Option<Twist2>> {
        let mut grid = floor(|_| false);
        let wall = (0..grid.geometry().height).filter_map(|row| {
            let cell = grid.geometry().cell_at(Vector2::new(3.3, 0.0))?;
            is_wall_ahead.then_some(CellIndex { row, ..cell })
        });
        wall.collect::<Vec<_>>().into_iter().for_each(|cell| grid.set(cell, Cell::Occupied));
        let pose = Pose2::new(3.0, 2.0, 0.0);
        (0..steps)
            .map(|i| {
                let now = at(from + STEP_S * f64::from(i));
                teleop.step(&WorldState { seen: Some(now), ..at_rest(&grid, now, pose) })
            })
            .collect()
    }

    #[test]
    fn the_robot_speeds_up_within_its_limits_and_stops_after_silence() {
        let mut teleop = controller();
        assert_eq!(twists(&mut teleop, 0.0, 1, false), [None]);
        teleop.drive(Twist2::new(0.3, 0.0), at(0.0));
        let sent = twists(&mut teleop, 0.0, 20, false);
        let speeds: Vec<f64> = sent.iter().map(|twist| twist.map_or(-1.0, |twist| twist.v)).collect();
        assert!(
            speeds[..15].windows(2).all(|v| v[1] > v[0] && v[1] - v[0] <= 0.5 * STEP_S + 1e-9),
            "{speeds:?}"
        );
        // A step exactly at the limit may count to either side.
        assert!(matches!(sent.iter().position(Option::is_none), Some(15 | 16)), "{speeds:?}");
        teleop.drive(Twist2::new(0.3, 0.0), at(2.0));
        assert_eq!(twists(&mut teleop, 2.0, 1, false), [Some(Twist2::ZERO)], "it starts from rest again");
    }

    #[test]
    fn safety_checks_the_twist_and_a_hold_of_the_body_stops_it() {
        let mut teleop = controller();
        teleop.drive(Twist2::new(0.3, 0.0), at(0.0));
        let sent = twists(&mut teleop, 0.0, 15, true);
        assert!(sent.iter().flatten().all(|twist| twist.v < 0.12), "a wall stands 0.12 m ahead: {sent:?}");
        assert_eq!(twists(&mut teleop, 0.9, 1, true), [None]);
        teleop.drive(Twist2::new(0.3, 0.0), at(1.0));
        let grid = floor(|_| false);
        for (i, hold) in [(0, None), (1, None), (2, Some(MotionHold::WheelDrop))] {
            let now = at(1.0 + STEP_S * f64::from(i));
            let world =
                WorldState { seen: Some(now), hold, ..at_rest(&grid, now, Pose2::new(3.0, 2.0, 0.0)) };
            let twist = teleop.step(&world).unwrap();
            assert_eq!(twist.v > 0.0, i == 1, "{hold:?}");
        }
    }
}
