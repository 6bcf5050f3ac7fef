//! The faults that are active at the present time.

use super::{FaultKind, FaultSchedule, WheelSide};
use crate::rng::{hash, unit};
use trundle_core::Pose2;

/// The active faults.
#[derive(Debug)]
pub(crate) struct Faults {
    schedule: FaultSchedule,
    seed: u64,
    now: f64,
    /// Whether each one-time fault has happened.
    is_done: Vec<bool>,
}

/// State of the camera under faults.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct CameraFault {
    pub(crate) is_black: bool,
    pub(crate) is_dark: bool,
    pub(crate) is_frozen: bool,
    pub(crate) has_no_depth: bool,
    pub(crate) is_dropped: bool,
    /// Seconds.
    pub(crate) delay: f64,
}

impl Faults {
    /// The state of a valid schedule.
    pub(crate) fn new(schedule: FaultSchedule, seed: u64) -> Self {
        let is_done = vec![false; schedule.faults.len()];
        Self { schedule, seed: hash(seed, 0xFA17), now: 0.0, is_done }
    }

    /// Advances to `time` seconds after the start.
    pub(crate) fn at(&mut self, time: f64) {
        self.now = time;
    }

    /// Faults of image number `frame`.
    pub(crate) fn camera(&self, frame: u64) -> CameraFault {
        let mut fault = CameraFault::default();
        for (i, kind) in self.holding() {
            match kind {
                FaultKind::CameraBlack => fault.is_black = true,
                FaultKind::LightsOut => fault.is_dark = true,
                FaultKind::CameraFrozen => fault.is_frozen = true,
                FaultKind::DepthGone => fault.has_no_depth = true,
                FaultKind::CameraLate { delay_s } => fault.delay = delay_s,
                FaultKind::CameraDropped { probability } => {
                    fault.is_dropped |= unit(hash(hash(self.seed, i as u64), frame)) < probability;
                }
                _ => {}
            }
        }
        fault
    }

    /// The fraction of each wheel's distance that moves the body, left and right.
    pub(crate) fn grip(&self) -> (f64, f64) {
        let mut grip = (1.0, 1.0);
        for (_, kind) in self.holding() {
            match kind {
                FaultKind::WheelSlips { side: WheelSide::Left, factor } => grip.0 = factor,
                FaultKind::WheelSlips { side: WheelSide::Right, factor } => grip.1 = factor,
                _ => {}
            }
        }
        grip
    }

    pub(crate) fn are_encoders_stuck(&self) -> bool {
        self.holding().any(|(_, kind)| kind == FaultKind::EncodersStuck)
    }

    pub(crate) fn is_gyro_stuck(&self) -> bool {
        self.holding().any(|(_, kind)| kind == FaultKind::GyroStuck)
    }

    pub(crate) fn is_laser_gone(&self) -> bool {
        self.holding().any(|(_, kind)| kind == FaultKind::LaserGone)
    }

    /// State of a stuck bumper.
    pub(crate) fn bumper(&self) -> Option<bool> {
        let reported = |(_, kind)| match kind {
            FaultKind::BumperStuck { pressed } => Some(pressed),
            _ => None,
        };
        self.holding().filter_map(reported).last()
    }

    /// Ticks by which the encoders jump now, left and right; each jump is returned once.
    pub(crate) fn jump(&mut self) -> Option<(i32, i32)> {
        let jumped = |kind| match kind {
            FaultKind::OdometryJumps { left_ticks, right_ticks } => Some((left_ticks, right_ticks)),
            _ => None,
        };
        self.once(jumped, |_| true)
    }

    /// Pose to which the robot is moved now, `world_from_base`, if `is_free`; returned once.
    pub(crate) fn kidnapping(&mut self, is_free: impl Fn(Pose2) -> bool) -> Option<Pose2> {
        let put = |kind| match kind {
            FaultKind::Kidnapped { x, y, heading_deg } => Some(Pose2::new(x, y, heading_deg.to_radians())),
            _ => None,
        };
        self.once(put, |pose: &Pose2| is_free(*pose))
    }

    fn holding(&self) -> impl Iterator<Item = (usize, FaultKind)> + '_ {
        let faults = self.schedule.faults.iter().enumerate();
        faults.filter(|(_, fault)| fault.holds_at(self.now)).map(|(i, fault)| (i, fault.kind))
    }

    /// The first fault of a kind that is due and has not occurred yet, if `may_be`.
    fn once<T>(&mut self, pick: impl Fn(FaultKind) -> Option<T>, may_be: impl Fn(&T) -> bool) -> Option<T> {
        for (fault, is_done) in self.schedule.faults.iter().zip(&mut self.is_done) {
            if *is_done || self.now < fault.from_s {
                continue;
            }
            if let Some(thing) = pick(fault.kind).filter(|thing| may_be(thing)) {
                *is_done = true;
                return Some(thing);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::Fault;

    fn faults(kinds: &[FaultKind]) -> Faults {
        let fault = |&kind| Fault { from_s: 1.0, to_s: 2.0, kind };
        Faults::new(FaultSchedule { faults: kinds.iter().map(fault).collect() }, 3)
    }

    #[test]
    fn faults_hold_from_their_first_moment_to_before_their_last() {
        let mut faults = faults(&[FaultKind::GyroStuck]);
        let stuck: Vec<bool> = [0.999, 1.0, 1.999, 2.0]
            .into_iter()
            .map(|time| {
                faults.at(time);
                faults.is_gyro_stuck()
            })
            .collect();
        assert_eq!(stuck, [false, true, true, false]);
    }

    #[test]
    fn a_share_of_images_is_dropped_the_same_ones_every_time() {
        let mut faults = faults(&[FaultKind::CameraDropped { probability: 0.3 }]);
        faults.at(1.5);
        let dropped: Vec<bool> = (0..10_000).map(|frame| faults.camera(frame).is_dropped).collect();
        let share = dropped.iter().filter(|d| **d).count();
        assert!((share as f64 / 1e4 - 0.3).abs() < 0.02, "{share}");
        assert!((0..10_000).all(|frame| faults.camera(frame).is_dropped == dropped[frame as usize]));
    }

    #[test]
    fn a_single_fault_happens_once_and_waits_until_it_may() {
        let put = FaultKind::Kidnapped { x: 1.0, y: 2.0, heading_deg: 90.0 };
        let mut faults = faults(&[put, FaultKind::OdometryJumps { left_ticks: 5, right_ticks: -5 }]);
        faults.at(0.5);
        assert_eq!((faults.kidnapping(|_| true), faults.jump()), (None, None));
        faults.at(1.0);
        assert_eq!(faults.kidnapping(|_| false), None);
        faults.at(7.0);
        assert_eq!(faults.kidnapping(|_| true), Some(Pose2::new(1.0, 2.0, std::f64::consts::FRAC_PI_2)));
        assert_eq!((faults.kidnapping(|_| true), faults.jump(), faults.jump()), (None, Some((5, -5)), None));
    }
}
