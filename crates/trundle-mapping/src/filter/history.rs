use super::{graph::Tie, store::StoredScan};
use nalgebra::Matrix3;
use trundle_core::Pose2;

/// What is kept of the run: every processed scan, how surely each step was measured, and the loops that were closed.
#[derive(Debug, Clone, Default)]
pub(crate) struct History {
    pub(crate) scans: Vec<StoredScan>,
    /// Covariance of the step to each pose, in that pose's frame: m, m, rad.
    pub(crate) steps: Vec<Matrix3<f64>>,
    /// The steps as they were measured, up to the last correction: a correction must not count as measured.
    pub(crate) measured: Vec<Pose2>,
    pub(crate) loops: Vec<Tie>,
}

impl History {
    pub(crate) fn push(&mut self, scan: StoredScan, step: Matrix3<f64>) {
        self.scans.push(scan);
        self.steps.push(step);
    }

    /// Notes the steps of a trajectory that were not noted before.
    pub(crate) fn measure(&mut self, poses: &[Pose2]) {
        for k in self.measured.len().max(1)..poses.len() {
            if self.measured.is_empty() {
                self.measured.push(Pose2::IDENTITY);
            }
            self.measured.push(poses[k - 1].inverse() * poses[k]);
        }
    }

    /// The steps and the loops as ties between the poses of a trajectory.
    pub(crate) fn ties(&self, poses: &[Pose2]) -> Vec<Tie> {
        let step = |k: usize| Tie {
            from: k as u32 - 1,
            to: k as u32,
            from_to: self.measured.get(k).copied().unwrap_or_else(|| poses[k - 1].inverse() * poses[k]),
            covariance: self.steps[k],
        };
        (1..poses.len()).map(step).chain(self.loops.iter().copied()).collect()
    }

    /// Bytes that it holds.
    pub(crate) fn bytes(&self) -> usize {
        self.scans.iter().map(StoredScan::bytes).sum::<usize>()
            + self.steps.capacity() * size_of::<Matrix3<f64>>()
            + self.measured.capacity() * size_of::<Pose2>()
            + self.loops.capacity() * size_of::<Tie>()
    }
}
