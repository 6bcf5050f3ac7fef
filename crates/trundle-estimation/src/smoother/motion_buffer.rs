//! The increments of the window, with the motion between any two stamps.

use super::preintegration::{Parameters, Preintegrated};
use crate::odometry::motion_increment::MotionIncrement;
use crate::odometry_config::OdometryConfig;
use std::collections::VecDeque;
use trundle_core::{DifferentialDrive, Stamp};

/// Increments of the window, by stamp.
#[derive(Debug, Clone)]
pub(crate) struct MotionBuffer {
    drive: DifferentialDrive,
    config: OdometryConfig,
    increments: VecDeque<MotionIncrement>,
}

/// Initial capacity in increments: a window of 20 s at 100 Hz. Source: ours.
const INCREMENT_CAPACITY: usize = 2048;

impl MotionBuffer {
    pub(crate) fn new(drive: DifferentialDrive, config: OdometryConfig) -> Self {
        Self { drive, config, increments: VecDeque::with_capacity(INCREMENT_CAPACITY) }
    }

    pub(crate) fn config(&self) -> &OdometryConfig {
        &self.config
    }

    /// The newest increment.
    pub(crate) fn newest(&self) -> Option<&MotionIncrement> {
        self.increments.back()
    }

    /// Appends an increment, and adds it to `head` if given.
    pub(crate) fn push(&mut self, increment: MotionIncrement) {
        self.increments.push_back(increment);
    }

    /// Drops all increments that end before a stamp.
    pub(crate) fn forget_before(&mut self, stamp: Stamp) {
        while self.increments.front().is_some_and(|increment| increment.stamp < stamp) {
            self.increments.pop_front();
        }
    }

    /// Adds an increment to a motion.
    pub(crate) fn extend(&self, motion: &mut Preintegrated, increment: &MotionIncrement) {
        motion.add(&self.config, self.drive.wheelbase, increment);
    }

    /// The motion between two stamps; the later one must not be beyond the newest increment.
    pub(crate) fn between(&self, from: Stamp, to: Stamp, at: Parameters) -> Preintegrated {
        let mut motion = Preintegrated::new(at);
        let first = self.increments.partition_point(|increment| increment.stamp <= from);
        for increment in self.increments.iter().skip(first) {
            let begin = increment.stamp.after(-increment.dt);
            if begin >= to {
                break;
            }
            let covered = increment.stamp.min(to) - begin.max(from);
            let fraction = (covered / increment.dt).clamp(0.0, 1.0);
            self.extend(&mut motion, &part(increment, fraction));
        }
        motion
    }
}

/// A fraction of an increment.
fn part(increment: &MotionIncrement, fraction: f64) -> MotionIncrement {
    MotionIncrement {
        dt: increment.dt * fraction,
        left: increment.left * fraction,
        right: increment.right * fraction,
        turn_by_gyro: increment.turn_by_gyro.map(|turn| turn * fraction),
        slip: increment.slip * fraction,
        unobserved: increment.unobserved * fraction,
        ..*increment
    }
}
