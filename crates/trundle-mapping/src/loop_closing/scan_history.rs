//! Stored scans, step covariances and closed loops of a run.

use crate::loop_closing::stored_scan::StoredScan;
use crate::pose_graph::Constraint;
use nalgebra::Matrix3;
use trundle_core::{Pose2, Stamp};

/// History of a run: every processed scan, the covariance of each step, and the closed loops.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScanHistory {
    pub(crate) scans: Vec<StoredScan>,
    /// Covariance of the step to each pose, in that pose's frame: m, m, rad.
    pub(crate) steps: Vec<Matrix3<f64>>,
    /// The steps as they were measured, up to the last correction: a correction must not count as measured.
    pub(crate) measured: Vec<Pose2>,
    pub(crate) loops: Vec<Constraint>,
}

impl ScanHistory {
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
    pub(crate) fn constraints(&self, poses: &[Pose2]) -> Vec<Constraint> {
        let step = |k: usize| Constraint {
            from: k as u32 - 1,
            to: k as u32,
            from_to: self.measured.get(k).copied().unwrap_or_else(|| poses[k - 1].inverse() * poses[k]),
            covariance: self.steps[k],
        };
        (1..poses.len()).map(step).chain(self.loops.iter().copied()).collect()
    }

    /// Drops every second of the first `count` scans (not the first), with the poses of the trajectory that belong to them. Their steps
    /// are composed. A loop that ends at a dropped scan then ends at the scan before, moved by the trajectory's step.
    pub(crate) fn thin(&mut self, trajectory: &mut Vec<(Stamp, Pose2)>, count: usize) {
        let poses: Vec<Pose2> = trajectory.iter().map(|(_, pose)| *pose).collect();
        self.measure(&poses);
        let goes = |k: usize| k % 2 == 1 && k + 1 < count;
        let number = |k: usize| if k < count { k.div_ceil(2) } else { k - (count.max(1) - 1) / 2 };
        let renamed = |k: u32| {
            let k = k as usize;
            if goes(k) {
                (number(k - 1) as u32, poses[k - 1].inverse() * poses[k])
            } else {
                (number(k) as u32, Pose2::IDENTITY)
            }
        };
        for constraint in &mut self.loops {
            let ((from, to_old_from), (to, to_old_to)) = (renamed(constraint.from), renamed(constraint.to));
            let from_to = to_old_from * constraint.from_to * to_old_to.inverse();
            *constraint = Constraint { from, to, from_to, covariance: constraint.covariance };
        }
        self.loops.retain(|constraint| constraint.from != constraint.to);
        for k in (1..self.steps.len().min(count)).filter(|&k| goes(k)) {
            self.measured[k + 1] = self.measured[k] * self.measured[k + 1];
            let step = self.steps[k];
            self.steps[k + 1] += step;
        }
        keep(&mut self.scans, |k| !goes(k));
        keep(&mut self.steps, |k| !goes(k));
        keep(&mut self.measured, |k| !goes(k));
        keep(trajectory, |k| !goes(k));
    }

    /// Drops all scans but the first `count`, with their steps and loops.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.scans.truncate(count);
        self.steps.truncate(count);
        self.measured.truncate(count);
        self.loops.retain(|constraint| constraint.poses().0.max(constraint.poses().1) < count);
    }

    /// Bytes that it holds.
    pub(crate) fn bytes(&self) -> usize {
        self.scans.iter().map(StoredScan::bytes).sum::<usize>()
            + self.steps.capacity() * size_of::<Matrix3<f64>>()
            + self.measured.capacity() * size_of::<Pose2>()
            + self.loops.capacity() * size_of::<Constraint>()
    }
}

/// Keeps the elements for whose index `stays` is true.
fn keep<T>(all: &mut Vec<T>, stays: impl Fn(usize) -> bool) {
    let mut k = 0;
    all.retain(|_| {
        k += 1;
        stays(k - 1)
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particle_config::ParticleConfig;
    use crate::scan_match::scan_points::ScanPoints;

    #[test]
    fn thinning_keeps_the_path_and_its_loops() {
        let step = Pose2::new(0.5, 0.1, 0.2);
        let mut history = ScanHistory::default();
        let mut way = vec![(Stamp::default(), Pose2::IDENTITY)];
        for k in 0..41 {
            history.push(StoredScan::new(&ParticleConfig::default(), &ScanPoints::default()), Matrix3::identity() * 1e-4);
            if k > 0 {
                way.push((Stamp::from_nanos(k), way.last().unwrap().1 * step));
            }
        }
        let constraint = |from: u32, to: u32| Constraint {
            from,
            to,
            from_to: way[from as usize].1.inverse() * way[to as usize].1,
            covariance: Matrix3::identity() * 1e-4,
        };
        history.loops = vec![constraint(3, 37), constraint(4, 15), constraint(8, 40)];
        let mut thinned = way.clone();
        history.thin(&mut thinned, 20);
        assert_eq!((history.scans.len(), thinned.len(), history.measured.len()), (32, 32, 32));
        assert_eq!(thinned[0], way[0]);
        assert_eq!(thinned.last(), way.last());
        let poses: Vec<Pose2> = thinned.iter().map(|(_, pose)| *pose).collect();
        for constraint in history.constraints(&poses) {
            assert!(
                constraint.residual(poses[constraint.from as usize], poses[constraint.to as usize]).norm()
                    < 1e-9,
                "{constraint:?}"
            );
        }
    }
}
