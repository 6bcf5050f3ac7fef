//! Steps between scans of a log that reveal the mount of the laser, collected while the log is read.

use std::collections::VecDeque;
use std::sync::Arc;
use trundle_core::Pose2;
use trundle_io::{EvenSample, LaserLogScan};

/// Largest number of steps of each kind that are compared. Source: ours.
const MAX_STEPS: usize = 24;
/// Number of steps of each kind at which those collected are thinned. Source: ours, several times those compared; a scan of 360 beams has 6
/// kB.
const MAX_COLLECTED_STEPS: usize = 8 * MAX_STEPS;
/// Minimum turn of a step that reveals a mirrored laser \[rad\]. Source: ours.
const MIN_STEP_TURN_RAD: f64 = 0.15;
/// Largest turn of a step \[rad\]. Two scans farther apart share too little. Source: ours.
const MAX_STEP_TURN_RAD: f64 = 0.8;
/// Minimum length of a step that reveals a turned laser \[m\]: at a turn of 10 degrees it displaces the scan by 9 cm. Source: ours.
const MIN_STEP_LENGTH_M: f64 = 0.5;
/// Largest length of a step \[m\]. Two scans farther apart share too little. Source: ours.
const MAX_STEP_LENGTH_M: f64 = 1.0;
/// Number of scans after the first among which a step ends. Source: ours.
const MAX_STEP_SCANS: usize = 40;

/// Two scans, and the later base seen from the earlier by odometry.
#[derive(Debug, Clone)]
pub(super) struct Step {
    pub(super) first: Arc<LaserLogScan>,
    pub(super) second: Arc<LaserLogScan>,
    pub(super) first_from_second: Pose2,
}

/// A kind of steps that reveals something about the mount.
#[derive(Debug, Clone, Copy)]
enum StepKind {
    /// A turn reveals a mirrored laser.
    Turn,
    /// A step that leads on reveals a turned laser.
    LeadOn,
}

/// Steps of both kinds, spread over the log. The number of scans in memory does not grow with the log.
#[derive(Debug)]
pub(super) struct MountSteps {
    kinds: [StepsOfKind; 2],
}

/// The first step of a kind from each scan.
#[derive(Debug)]
struct StepsOfKind {
    kind: StepKind,
    /// The last scans, each with its step once this is known.
    last: VecDeque<(Arc<LaserLogScan>, Option<Step>)>,
    steps: EvenSample<Step>,
}

impl Default for MountSteps {
    fn default() -> Self {
        Self { kinds: [StepKind::Turn, StepKind::LeadOn].map(StepsOfKind::new) }
    }
}

impl MountSteps {
    /// Takes the next scan of the log.
    pub(super) fn take(&mut self, scan: &Arc<LaserLogScan>) {
        self.kinds.iter_mut().for_each(|steps| steps.take(scan));
    }

    /// Steps that turn and steps that lead on.
    pub(super) fn finish(self) -> Vec<Step> {
        self.kinds.into_iter().flat_map(StepsOfKind::finish).collect()
    }
}

impl StepsOfKind {
    fn new(kind: StepKind) -> Self {
        Self { kind, last: VecDeque::new(), steps: EvenSample::new(MAX_COLLECTED_STEPS) }
    }

    fn take(&mut self, scan: &Arc<LaserLogScan>) {
        if self.last.len() > MAX_STEP_SCANS {
            self.drop_first();
        }
        for (first, step) in self.last.iter_mut().filter(|(_, step)| step.is_none()) {
            let first_from_second = first.odom_from_base.inverse() * scan.odom_from_base;
            if self.kind.is_wanted(first_from_second) {
                *step = Some(Step { first: first.clone(), second: scan.clone(), first_from_second });
            }
        }
        self.last.push_back((scan.clone(), None));
    }

    fn drop_first(&mut self) {
        if let Some((_, Some(step))) = self.last.pop_front() {
            self.steps.push(step);
        }
    }

    fn finish(mut self) -> Vec<Step> {
        while !self.last.is_empty() {
            self.drop_first();
        }
        let steps = self.steps.elements();
        let stride = steps.len().div_ceil(MAX_STEPS).max(1);
        steps.iter().step_by(stride).cloned().collect()
    }
}

impl StepKind {
    fn is_wanted(self, step: Pose2) -> bool {
        let (turn, length) = (step.theta.abs(), step.position().norm());
        let is_near = turn < MAX_STEP_TURN_RAD && length < MAX_STEP_LENGTH_M;
        is_near
            && match self {
                Self::Turn => turn >= MIN_STEP_TURN_RAD,
                Self::LeadOn => length >= MIN_STEP_LENGTH_M,
            }
    }
}
