//! A way-point follower that drives the simulated robot by its true pose.

use super::WaypointFollowerConfig;
use super::rows::rows;
use trundle_core::{Invalid, Pose2, Stamp, Twist2, Vector2, difference_of_angles};

/// Tolerance of way-points, m and rad: half of the guaranteed one; the rest is for coasting. Source: ours.
const POSITION_TOLERANCE_M: f64 = 0.004;
const HEADING_TOLERANCE_RAD: f64 = 0.004;

/// Distance, m, below which the robot backs up to a way-point behind it. Source: ours.
const BACK_UP_M: f64 = 0.1;

/// Speed over distance left, 1/s: slow enough for motors that lag by a tenth of a second. Source: ours.
const APPROACH_GAIN_PER_S: f64 = 2.5;

/// Steering: rate over heading error, 1/s, and heading over distance from the line, rad/m. Source: ours.
const STEERING_GAIN_PER_S: f64 = 3.0;
const LINE_RETURN_GAIN_RAD_PER_M: f64 = 4.0;

/// Minimum motion that counts as progress, m and rad. Source: ours.
const MIN_PROGRESS: f64 = 0.02;

/// Number of attempts at a way-point after a turn that led away from it. Source: ours.
const MAX_WAYPOINT_ATTEMPTS: u32 = 5;

/// State of a [`WaypointFollower`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Following {
    /// Drives to this way-point, from 0.
    Driving {
        /// Index of the way-point.
        waypoint: usize,
    },
    /// The robot is at the last way-point, within 1 cm and 1 deg.
    Arrived,
    /// An obstacle blocks the path to this way-point, from 0; the drive ends.
    Blocked {
        /// Index of the way-point.
        waypoint: usize,
    },
}

/// Drives from way-point to way-point by the true pose: turns towards it on the spot, drives straight, turns to its heading.
///
/// For data generation: it uses the true pose and avoids no obstacles. Straight legs follow the line to the way-point: heading error and
/// distance from the line control the turn rate. Speeds ramp up, and fall with the remaining distance.
#[derive(Debug, Clone)]
pub struct WaypointFollower {
    config: WaypointFollowerConfig,
    waypoints: Vec<Pose2>,
    state: Following,
    phase: Phase,
    attempts: u32,
    /// The last step: its stamp and its twist.
    last: Option<(Stamp, Twist2)>,
    /// Stamp and pose of the last progress.
    anchor: Option<(Stamp, Pose2)>,
}

#[derive(Debug, Clone, Copy)]
enum Phase {
    /// Chooses the motion to the way-point.
    Plan,
    /// Turns on the spot to `heading`, rad; then drives straight (`Some`: the line's direction) or is done.
    Turn { heading: f64, then: Option<Line> },
    /// Going along a line.
    Straight(Line),
}

/// A straight leg, which ends at the way-point.
#[derive(Debug, Clone, Copy)]
struct Line {
    direction: Vector2,
    /// 1 forward, -1 backward.
    sense: f64,
}

impl WaypointFollower {
    /// To `waypoints`, `world_from_base` each, in their order.
    ///
    /// # Errors
    /// When no way-point is given, one is not finite, or a number of the configuration is outside its range.
    pub fn new(waypoints: Vec<Pose2>, config: WaypointFollowerConfig) -> Result<Self, Invalid> {
        if waypoints.is_empty() {
            return Err(Invalid::new("way-points", 0, "", "1 or more"));
        }
        if let Some(i) = waypoints.iter().position(|pose| !pose.is_finite()) {
            return Err(Invalid::new(format!("way-point {i}"), "not finite", "", "finite numbers"));
        }
        Ok(Self {
            config: config.validated()?,
            waypoints,
            state: Following::Driving { waypoint: 0 },
            phase: Phase::Plan,
            attempts: 0,
            last: None,
            anchor: None,
        })
    }

    /// Way-points from lines `x y heading_deg` (m, m, deg; the scene's world frame), with the default speeds; `#` starts a comment.
    ///
    /// # Errors
    /// When the text has no line, or a line is not three finite numbers; the error names the line.
    pub fn parse(text: &str) -> Result<Self, Invalid> {
        let rows = rows(text, ["x", "y", "heading_deg"])?;
        let waypoints = rows.iter().map(|(_, [x, y, deg])| Pose2::new(*x, *y, deg.to_radians())).collect();
        Self::new(waypoints, WaypointFollowerConfig::default())
    }

    /// Way-points, `world_from_base`.
    pub fn waypoints(&self) -> &[Pose2] {
        &self.waypoints
    }

    /// State of the follower.
    pub fn state(&self) -> Following {
        self.state
    }

    /// Twist for the true pose `world_from_base`. Must be called at 20 Hz or more.
    pub fn step(&mut self, stamp: Stamp, pose: Pose2) -> Twist2 {
        let Following::Driving { waypoint } = self.state else { return Twist2::ZERO };
        let target = self.target(pose, self.waypoints[waypoint]);
        if self.is_stuck(stamp, pose) {
            self.state = Following::Blocked { waypoint };
        }
        if !matches!(self.state, Following::Driving { .. }) {
            return Twist2::ZERO;
        }
        let twist = self.ramped(stamp, target);
        self.last = Some((stamp, twist));
        twist
    }

    /// The twist without limits of acceleration; selects the next phase at the end of one.
    fn target(&mut self, pose: Pose2, goal: Pose2) -> Twist2 {
        match self.phase {
            Phase::Plan => {
                self.phase = plan(pose, goal);
                Twist2::ZERO
            }
            Phase::Turn { heading, then } => {
                let error = difference_of_angles(heading, pose.theta);
                if error.abs() > HEADING_TOLERANCE_RAD {
                    let c = &self.config;
                    return Twist2::new(0.0, approach(error, c.omega, c.angular_acceleration));
                }
                match then {
                    Some(line) => self.phase = Phase::Straight(line),
                    None => self.at_waypoint(pose, goal),
                }
                Twist2::ZERO
            }
            Phase::Straight(line) => {
                let left = line.direction.dot(&(goal.position() - pose.position()));
                if left < POSITION_TOLERANCE_M {
                    self.phase = Phase::Turn { heading: goal.theta, then: None };
                    return Twist2::ZERO;
                }
                self.along(line, left, pose, goal)
            }
        }
    }

    /// The command along a line of which `left` m remain.
    fn along(&self, line: Line, left: f64, pose: Pose2, goal: Pose2) -> Twist2 {
        let aside = line.direction.perp(&(pose.position() - goal.position()));
        let course = line.direction.y.atan2(line.direction.x) - (LINE_RETURN_GAIN_RAD_PER_M * aside).atan();
        let heading = if line.sense > 0.0 { course } else { course + std::f64::consts::PI };
        let error = difference_of_angles(heading, pose.theta);
        let c = &self.config;
        let v = line.sense * approach(left, c.v, c.acceleration) * error.cos().max(0.0);
        Twist2::new(v, (STEERING_GAIN_PER_S * error).clamp(-c.omega, c.omega))
    }

    fn at_waypoint(&mut self, pose: Pose2, goal: Pose2) {
        let Following::Driving { waypoint } = self.state else { return };
        self.phase = Phase::Plan;
        if pose.distance(&goal) > 2.0 * POSITION_TOLERANCE_M {
            self.attempts += 1;
            if self.attempts >= MAX_WAYPOINT_ATTEMPTS {
                self.state = Following::Blocked { waypoint };
            }
            return;
        }
        self.attempts = 0;
        let is_last = waypoint + 1 == self.waypoints.len();
        self.state = if is_last { Following::Arrived } else { Following::Driving { waypoint: waypoint + 1 } };
    }

    fn is_stuck(&mut self, stamp: Stamp, pose: Pose2) -> bool {
        let (since, place) = *self.anchor.get_or_insert((stamp, pose));
        let turned = difference_of_angles(pose.theta, place.theta).abs();
        if pose.distance(&place) > MIN_PROGRESS || turned > MIN_PROGRESS {
            self.anchor = Some((stamp, pose));
            return false;
        }
        stamp - since > self.config.patience
    }

    fn ramped(&self, stamp: Stamp, target: Twist2) -> Twist2 {
        let (since, before) = self.last.unwrap_or((stamp, Twist2::ZERO));
        let elapsed = (stamp - since).clamp(0.0, 0.1);
        let ramp = |from: f64, to: f64, max: f64| from + (to - from).clamp(-max * elapsed, max * elapsed);
        // Braking is twice as fast, which makes the speeds of `approach` feasible.
        let c = &self.config;
        let max = |from: f64, to: f64, rate: f64| if to.abs() < from.abs() { 2.0 * rate } else { rate };
        Twist2::new(
            ramp(before.v, target.v, max(before.v, target.v, c.acceleration)),
            ramp(before.omega, target.omega, max(before.omega, target.omega, c.angular_acceleration)),
        )
    }
}

fn plan(pose: Pose2, goal: Pose2) -> Phase {
    let offset = goal.position() - pose.position();
    let distance = offset.norm();
    if distance < POSITION_TOLERANCE_M {
        return Phase::Turn { heading: goal.theta, then: None };
    }
    let direction = offset / distance;
    let is_behind = distance < BACK_UP_M && direction.dot(&pose.direction()) < 0.0;
    let sense = if is_behind { -1.0 } else { 1.0 };
    let heading = (sense * direction.y).atan2(sense * direction.x);
    Phase::Turn { heading, then: Some(Line { direction, sense }) }
}

/// The speed to cover `left` (signed) at, at most `max`, that braking by `rate` can still stop.
fn approach(left: f64, max: f64, rate: f64) -> f64 {
    let brake = (2.0 * rate * left.abs()).sqrt().min(APPROACH_GAIN_PER_S * left.abs());
    left.signum() * brake.min(max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Drives an ideal base at 50 Hz until the follower is done; the pose and the seconds it took.
    fn drive(follower: &mut WaypointFollower, start: Pose2, speed: f64) -> (Pose2, f64) {
        let (mut pose, mut stamp) = (start, Stamp::default());
        while matches!(follower.state(), Following::Driving { .. }) {
            let twist = follower.step(stamp, pose);
            assert!(twist.v.abs() <= 0.3 && twist.omega.abs() <= 0.8);
            pose = pose.advance(Twist2::new(twist.v * speed, twist.omega * speed), 0.02);
            stamp = stamp.after(0.02);
        }
        (pose, stamp.as_secs())
    }

    #[test]
    fn it_ends_at_the_last_waypoint() {
        let mut follower = WaypointFollower::parse("1 0 90\n1 1.5 180 # corner\n-0.5 1.5 -90\n").unwrap();
        let (end, seconds) = drive(&mut follower, Pose2::new(0.0, 0.2, 2.0), 1.0);
        assert_eq!(follower.state(), Following::Arrived);
        assert!(end.distance(&Pose2::new(-0.5, 1.5, 0.0)) < 0.01, "{end:?}");
        assert!(difference_of_angles(end.theta, -90_f64.to_radians()).abs() < 0.017);
        assert!(seconds < 45.0, "{seconds}");
    }

    #[test]
    fn a_way_point_just_behind_is_backed_up_to() {
        let mut follower = WaypointFollower::parse("-0.05 0 0").unwrap();
        let (end, seconds) = drive(&mut follower, Pose2::IDENTITY, 1.0);
        assert!(end.distance(&Pose2::new(-0.05, 0.0, 0.0)) < 0.01 && seconds < 3.0, "{end:?} {seconds}");
    }

    #[test]
    fn a_robot_that_cannot_move_is_blocked() {
        let mut follower = WaypointFollower::parse("1 0 0").unwrap();
        let (_, seconds) = drive(&mut follower, Pose2::IDENTITY, 0.0);
        assert_eq!(follower.state(), Following::Blocked { waypoint: 0 });
        assert!((seconds - 10.0).abs() < 0.1);
        assert_eq!(follower.step(Stamp::from_nanos(0), Pose2::IDENTITY), Twist2::ZERO);
    }

    #[test]
    fn bad_lines_are_named() {
        let error = WaypointFollower::parse("1 0 0\n1 0").unwrap_err().to_string();
        assert_eq!(error, "line 2 is '1 0', expected 3 numbers: x y heading_deg");
        assert!(WaypointFollower::parse("").is_err());
    }
}
