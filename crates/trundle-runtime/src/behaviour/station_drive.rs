//! Motions at a charging station: a sweep of the heading, the last straight move onto the contacts, and straight back.

use crate::behaviour::spin::turn_to;
use crate::mission::dock_failure::DockFailure;
use crate::world_state::WorldState;
use std::f64::consts::PI;
use trundle_control::StationMotion;
use trundle_core::{Pose2, Stamp, Twist2, difference_of_angles};
use trundle_estimation::StationEstimate;

/// A motion at a charging station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StationGoal {
    /// Turn to both sides of the station and back, so the receivers cross the edges of its light.
    Sweep(Pose2),
    /// Straight along the axis to a distance of the base from the station, m.
    Advance(StationEstimate, f64),
    /// Straight onto the contacts, until the battery charges.
    Approach(StationEstimate),
    /// Straight back by a distance, m.
    BackOff(f64),
}

/// Progress of a motion at a charging station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StationProgress {
    Moving(Twist2),
    Done,
    Failed(DockFailure),
}

/// Angle of a sweep to either side of the station \[rad\]: beyond the edges of the middle receiver's field of view. Source: ours.
const SWEEP_ANGLE_RAD: f64 = 1.2;
/// Speed of the last straight move \[m/s\]. Faster: the robot pushes the station before it stops. Source: ours.
const APPROACH_SPEED_M_S: f64 = 0.05;
/// Speed of backing off \[m/s\]. Source: ours, the highest that the safety monitor permits.
const BACK_OFF_SPEED_M_S: f64 = 0.1;
/// Heading per distance from the axis on the last straight move \[rad/m\]: a third is left after 0.25 m. Source: ours.
const HEADING_PER_DISTANCE: f64 = 4.0;
/// Largest heading off the axis on the last straight move \[rad\]. Source: ours.
const MAX_HEADING_OFF_AXIS_RAD: f64 = 0.12;
/// Turn rate per heading error \[1/s\]. Source: the same gain as for the positioner's straight moves.
const HEADING_GAIN: f64 = 1.5;
/// Maximum turn rate of a straight move \[rad/s\]. Source: ours, below the limit of the safety monitor.
const MAX_HEADING_RATE_RAD_S: f64 = 0.1;
/// Distance beyond the expected contact at which a straight move ends \[m\]; the light measures distance less accurately than the axis.
/// Source: ours.
const OVERRUN_M: f64 = 0.1;
/// Standard deviations of the distance that are added. Source: ours.
const OVERRUN_SIGMAS: f64 = 2.0;
/// Largest addition for an uncertain distance \[m\]. Source: ours.
const MAX_ADDED_OVERRUN_M: f64 = 0.1;
/// Distance of the receivers from the station below which the estimate no longer changes the course \[m\]. Source: ours.
const FROZEN_GAP_M: f64 = 0.12;
/// Time on a pressed bumper in which the charger may still report \[s\]. Source: ours.
const CHARGER_TIME_S: f64 = 1.0;
/// Time without motion after which a straight move fails \[s\]. Source: ours.
const HELD_TIME_S: f64 = 5.0;
/// Minimum progress that counts as motion \[m\]. Source: ours.
const MOTION_M: f64 = 0.01;
/// Sides of the station to which a sweep turns, in order. Source: ours.
const SWEEP_SIDES: [f64; 3] = [1.0, -1.0, 0.0];

/// Carries out one motion at a charging station.
#[derive(Debug, Clone, Default)]
pub(crate) struct StationDrive {
    start: Option<Pose2>,
    /// Stamp and pose of the robot's last progress.
    last: Option<(Stamp, Pose2)>,
    /// Sides of the sweep that are done.
    sides: usize,
    touched: Option<Stamp>,
    /// The station's pose as used by the last straight move.
    station: Option<StationEstimate>,
}

impl StationDrive {
    /// Executes one control step; `touched` is the bumper, `reach` the distance from the base's origin to its front, m.
    pub(crate) fn step(
        &mut self,
        goal: &StationGoal,
        s: &WorldState<'_>,
        touched: bool,
        reach: f64,
    ) -> StationProgress {
        let pose = s.estimate.pose;
        let start = *self.start.get_or_insert(pose);
        match goal {
            StationGoal::Sweep(station) => self.sweep(s.station.estimate.map_or(*station, |e| e.pose), pose),
            StationGoal::Advance(first, distance) => self.advance(*first, *distance, s, touched, reach),
            StationGoal::Approach(first) => self.approach(*first, s, touched, reach),
            StationGoal::BackOff(distance) => self.back_off(*distance, start, s),
        }
    }

    /// The motion that the safety monitor shall permit.
    pub(crate) fn permission(&self, goal: &StationGoal, pose: Pose2) -> Option<StationMotion> {
        match goal {
            StationGoal::Sweep(_) => None,
            StationGoal::Advance(first, _) | StationGoal::Approach(first) => {
                let station = self.station.unwrap_or(*first);
                let base_from_station = pose.inverse() * station.pose;
                Some(StationMotion::Docking { base_from_station, distance_error: overrun(&station) })
            }
            StationGoal::BackOff(_) => Some(StationMotion::Undocking),
        }
    }

    fn sweep(&mut self, station: Pose2, pose: Pose2) -> StationProgress {
        let Some(side) = SWEEP_SIDES.get(self.sides) else { return StationProgress::Done };
        let to_station = station.position() - pose.position();
        let twist = turn_to(pose, to_station.y.atan2(to_station.x) + side * SWEEP_ANGLE_RAD);
        self.sides += usize::from(twist == Twist2::ZERO);
        StationProgress::Moving(twist)
    }

    fn advance(
        &mut self,
        first: StationEstimate,
        distance: f64,
        s: &WorldState<'_>,
        touched: bool,
        reach: f64,
    ) -> StationProgress {
        let at = self.station_of(first, s, reach).pose.inverse() * s.estimate.pose;
        if at.x <= distance || touched || s.station.is_docked {
            return StationProgress::Done;
        }
        if self.is_held(s) {
            return StationProgress::Failed(DockFailure::Held);
        }
        StationProgress::Moving(Twist2::new(APPROACH_SPEED_M_S, heading_rate(at)))
    }

    fn approach(
        &mut self,
        first: StationEstimate,
        s: &WorldState<'_>,
        touched: bool,
        reach: f64,
    ) -> StationProgress {
        if s.station.is_docked {
            return StationProgress::Done;
        }
        let station = self.station_of(first, s, reach);
        let at = station.pose.inverse() * s.estimate.pose;
        if touched || at.x < reach - overrun(&station) {
            return self.wait_for_charger(s.now);
        }
        if self.is_held(s) {
            return StationProgress::Failed(DockFailure::Held);
        }
        StationProgress::Moving(Twist2::new(APPROACH_SPEED_M_S, heading_rate(at)))
    }

    /// The newest estimate until the robot is near; then the last one.
    fn station_of(&mut self, first: StationEstimate, s: &WorldState<'_>, reach: f64) -> StationEstimate {
        let last = self.station.unwrap_or(first);
        let gap = (last.pose.inverse() * s.estimate.pose).x - reach;
        let newest = s.station.estimate.filter(|_| gap > FROZEN_GAP_M);
        *self.station.insert(newest.unwrap_or(last))
    }

    fn wait_for_charger(&mut self, now: Stamp) -> StationProgress {
        let since = *self.touched.get_or_insert(now);
        if now - since > CHARGER_TIME_S {
            StationProgress::Failed(DockFailure::NoCharging { attempts: 1 })
        } else {
            StationProgress::Moving(Twist2::ZERO)
        }
    }

    fn back_off(&mut self, distance: f64, start: Pose2, s: &WorldState<'_>) -> StationProgress {
        if start.distance(&s.estimate.pose) >= distance {
            return StationProgress::Done;
        }
        if self.is_held(s) {
            return StationProgress::Failed(DockFailure::Held);
        }
        let off = difference_of_angles(start.theta, s.estimate.pose.theta);
        StationProgress::Moving(Twist2::new(-BACK_OFF_SPEED_M_S, limited(HEADING_GAIN * off)))
    }

    fn is_held(&mut self, s: &WorldState<'_>) -> bool {
        let (since, at) = *self.last.get_or_insert((s.now, s.estimate.pose));
        if at.distance(&s.estimate.pose) > MOTION_M {
            self.last = Some((s.now, s.estimate.pose));
        }
        s.now - since > HELD_TIME_S
    }
}

/// Distance beyond the expected contact up to which contact may still come, m.
fn overrun(station: &StationEstimate) -> f64 {
    OVERRUN_M + (OVERRUN_SIGMAS * station.distance_sigma()).min(MAX_ADDED_OVERRUN_M)
}

/// Turn rate that brings a robot at `station_from_base` onto the axis, facing the station.
fn heading_rate(at: Pose2) -> f64 {
    let off_axis = (HEADING_PER_DISTANCE * at.y).clamp(-MAX_HEADING_OFF_AXIS_RAD, MAX_HEADING_OFF_AXIS_RAD);
    limited(HEADING_GAIN * difference_of_angles(PI + off_axis, at.theta))
}

fn limited(rate: f64) -> f64 {
    rate.clamp(-MAX_HEADING_RATE_RAD_S, MAX_HEADING_RATE_RAD_S)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_state::{DynamicObstacles, StationState};
    use trundle_core::{OccupancyGrid, PoseEstimate};

    const REACH: f64 = 0.18;

    fn station() -> StationEstimate {
        StationEstimate { pose: Pose2::IDENTITY, covariance: [[0.0; 3]; 3] }
    }

    fn world(grid: &OccupancyGrid, pose: Pose2, time: f64, is_docked: bool) -> WorldState<'_> {
        let (now, covariance) = (Stamp::default().after(time), nalgebra::Matrix3::zeros());
        WorldState {
            now,
            estimate: PoseEstimate { stamp: now, pose, twist: Twist2::ZERO, covariance },
            pose_status: crate::behaviour::navigator::testing::KNOWN_POSE,
            grid,
            scan: None,
            seen: None,
            wheels: Some(now),
            hold: None,
            motion: trundle_control::MotionSense::Wheels,
            dynamic_obstacles: DynamicObstacles::default(),
            station: StationState { estimate: Some(station()), is_docked },
            zones: crate::zones::ZoneView::default(),
        }
    }

    /// Drives until the end of the motion. `is_free` is false if an obstacle stops the robot; `docks_at` and `touches_at` are distances
    /// from the station, m.
    fn drive(
        goal: StationGoal,
        start: Pose2,
        is_free: bool,
        docks_at: f64,
        touches_at: f64,
    ) -> (Pose2, StationProgress) {
        let grid = OccupancyGrid::from_ascii(0.1, "..\n..\n").unwrap();
        let (mut drive, mut pose) = (StationDrive::default(), start);
        for i in 0..3000 {
            let s = world(&grid, pose, 0.02 * f64::from(i), pose.x <= docks_at);
            match drive.step(&goal, &s, pose.x <= touches_at, REACH) {
                StationProgress::Moving(twist) if is_free => pose = pose.advance(twist, 0.02),
                StationProgress::Moving(_) => {}
                end => return (pose, end),
            }
        }
        panic!("it does not end: {pose:?}");
    }

    #[test]
    fn a_straight_move_ends_at_the_contacts_or_with_a_reason() {
        let (goal, start) = (StationGoal::Approach(station()), Pose2::new(0.45, 0.0, PI));
        let no_charging = StationProgress::Failed(DockFailure::NoCharging { attempts: 1 });
        let (at, end) = drive(goal, start, true, 0.185, 0.17);
        assert_eq!(end, StationProgress::Done);
        assert!((at.x - 0.185).abs() < 0.002, "{at:?}");
        let (at, end) = drive(goal, start, true, -1.0, 0.17);
        assert_eq!(end, no_charging);
        assert!((at.x - 0.17).abs() < 0.002, "it stays where the bumper is pressed: {at:?}");
        let (at, end) = drive(goal, start, true, -1.0, -1.0);
        assert_eq!(end, no_charging, "nothing is there");
        assert!(at.x > REACH - OVERRUN_M - 0.01, "{at:?}");
        assert_eq!(drive(goal, start, false, -1.0, -1.0).1, StationProgress::Failed(DockFailure::Held));
        let advance = StationGoal::Advance(station(), 0.45);
        let (at, end) = drive(advance, Pose2::new(0.7, 0.01, PI), true, -1.0, -1.0);
        assert_eq!(end, StationProgress::Done);
        assert!((at.x - 0.45).abs() < 0.002 && at.y.abs() < 0.006, "{at:?}");
    }

    #[test]
    fn backing_off_is_straight_and_ends_at_its_distance_or_where_something_stands() {
        let start = Pose2::new(0.18, 0.0, PI);
        let (at, end) = drive(StationGoal::BackOff(0.4), start, true, 0.19, -1.0);
        assert_eq!(end, StationProgress::Done);
        assert!((at.x - 0.58).abs() < 0.01 && at.y.abs() < 1e-6, "{at:?}");
        let held = drive(StationGoal::BackOff(0.4), start, false, 0.19, -1.0).1;
        assert_eq!(held, StationProgress::Failed(DockFailure::Held));
    }

    #[test]
    fn a_sweep_turns_to_both_sides_and_ends_at_the_station() {
        let grid = OccupancyGrid::from_ascii(0.1, "..\n..\n").unwrap();
        let (mut drive, mut pose, mut turned) =
            (StationDrive::default(), Pose2::new(0.7, 0.0, PI), (0.0_f64, 0.0_f64));
        let goal = StationGoal::Sweep(Pose2::IDENTITY);
        for i in 0..3000 {
            match drive.step(&goal, &world(&grid, pose, 0.02 * f64::from(i), false), false, REACH) {
                StationProgress::Moving(twist) => pose = pose.advance(twist, 0.02),
                end => {
                    assert_eq!(end, StationProgress::Done);
                    break;
                }
            }
            let off = difference_of_angles(pose.theta, PI);
            turned = (turned.0.min(off), turned.1.max(off));
        }
        assert!(turned.0 < -1.1 && turned.1 > 1.1, "{turned:?}");
        assert!(difference_of_angles(pose.theta, PI).abs() < 0.06 && pose.x == 0.7);
    }

    #[test]
    fn only_straight_moves_have_a_permission() {
        let permission = |goal| StationDrive::default().permission(&goal, Pose2::new(0.5, 0.0, PI));
        assert_eq!(permission(StationGoal::Sweep(Pose2::IDENTITY)), None);
        assert_eq!(permission(StationGoal::BackOff(0.4)), Some(StationMotion::Undocking));
        let Some(StationMotion::Docking { base_from_station, distance_error }) =
            permission(StationGoal::Approach(station()))
        else {
            panic!("a permission to dock");
        };
        assert!((base_from_station.x - 0.5).abs() < 1e-9 && distance_error == OVERRUN_M);
    }

    #[test]
    fn the_straight_move_ends_on_the_axis_facing_the_station() {
        for (y, deg) in [(0.01, 0.0), (-0.015, 1.0), (0.0, -2.0), (0.02, 2.0)] {
            let mut at = Pose2::new(0.7, y, PI + f64::to_radians(deg));
            while at.x > 0.18 {
                at = at.advance(Twist2::new(APPROACH_SPEED_M_S, heading_rate(at)), 0.02);
            }
            let heading = difference_of_angles(at.theta, PI).to_degrees();
            assert!(at.y.abs() < 0.004 && heading.abs() < 1.5, "from {y} m: {at:?}");
        }
    }
}
