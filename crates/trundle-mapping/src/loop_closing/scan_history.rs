//! Stored scans, step covariances and closed loops of a run.

use crate::loop_closing::dropped_scans::{DroppedScans, keep};
use crate::loop_closing::stored_scan::StoredScan;
use crate::pose_graph::Constraint;
use nalgebra::Matrix3;
use std::collections::BTreeSet;
use trundle_core::{Pose2, Stamp};

/// History of a run: every processed scan, the covariance of each step, and the closed loops.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScanHistory {
    pub(crate) scans: Vec<StoredScan>,
    /// Covariance of the step to each pose, in that pose's frame: m, m, rad.
    pub(crate) steps: Vec<Matrix3<f64>>,
    /// The measured steps, up to the last correction, since a correction is no measurement.
    pub(crate) measured: Vec<Pose2>,
    pub(crate) loops: Vec<Constraint>,
    pub(crate) dropped: DroppedScans,
}

/// The stored scan that represents a scan after others were dropped.
#[derive(Debug, Clone, Copy)]
struct Successor {
    /// Number of the stored scan after dropping.
    number: usize,
    /// Number of the stored scan before dropping.
    old: usize,
}

/// For each scan, the scan itself or the previous kept one.
fn successors(goes: &[bool]) -> Vec<Successor> {
    let mut heir = Successor { number: 0, old: 0 };
    let mut kept = 0;
    let mut next = |k: usize| {
        if !goes[k] {
            heir = Successor { number: kept, old: k };
            kept += 1;
        }
        heir
    };
    (0..goes.len()).map(&mut next).collect()
}

/// Marks every second one of the first `count` of `all` scans, except the first.
pub(crate) fn every_second(all: usize, count: usize) -> Vec<bool> {
    (0..all).map(|k| k % 2 == 1 && k + 1 < count).collect()
}

/// The number of scan `k` after dropping, or that of the previous kept scan.
pub(crate) fn number_after(goes: &[bool], k: usize) -> usize {
    if k < goes.len() { successors(goes)[k].number } else { goes.iter().filter(|goes| !**goes).count() }
}

impl ScanHistory {
    pub(crate) fn push(&mut self, scan: StoredScan, step: Matrix3<f64>) {
        self.scans.push(scan);
        self.steps.push(step);
        self.dropped.push();
    }

    /// Records the steps of a trajectory that are not recorded yet.
    pub(crate) fn measure(&mut self, poses: &[Pose2]) {
        for k in self.measured.len().max(1)..poses.len() {
            if self.measured.is_empty() {
                self.measured.push(Pose2::IDENTITY);
            }
            self.measured.push(poses[k - 1].inverse() * poses[k]);
        }
    }

    /// Replaces the measured steps and loops by those between better `poses`. A later correction bends these.
    pub(crate) fn replace_measurements(&mut self, poses: &[Pose2]) {
        self.measured.clear();
        self.measure(poses);
        for constraint in &mut self.loops {
            let (from, to) = constraint.poses();
            constraint.from_to = poses[from].inverse() * poses[to];
        }
    }

    /// The steps and the loops as constraints between the poses of a trajectory.
    pub(crate) fn constraints(&self, poses: &[Pose2]) -> Vec<Constraint> {
        let step = |k: usize| Constraint {
            from: k as u32 - 1,
            to: k as u32,
            from_to: self.measured.get(k).copied().unwrap_or_else(|| poses[k - 1].inverse() * poses[k]),
            covariance: self.steps[k],
        };
        (1..poses.len()).map(step).chain(self.loops.iter().copied()).collect()
    }

    /// Drops the scans for which `goes` is true, with their poses of the trajectory, except the first and the last scan. Their steps are
    /// composed. A loop that ends at a dropped scan is moved to the previous kept scan by the trajectory's step. Of loops between the same
    /// two scans the newest is kept.
    pub(crate) fn thin(&mut self, trajectory: &mut Vec<(Stamp, Pose2)>, goes: &[bool]) {
        let poses: Vec<Pose2> = trajectory.iter().map(|(_, pose)| *pose).collect();
        self.measure(&poses);
        let successors = successors(goes);
        let renamed = |k: usize| {
            let Successor { number, old } = successors[k];
            (number as u32, if old == k { Pose2::IDENTITY } else { poses[old].inverse() * poses[k] })
        };
        for k in (0..goes.len()).filter(|&k| goes[k]) {
            let earlier = successors[k].old;
            self.dropped.note(trajectory[k].0, k, earlier, poses[earlier].inverse() * poses[k]);
        }
        for constraint in &mut self.loops {
            let (from, to_old_from) = renamed(constraint.from as usize);
            let (to, to_old_to) = renamed(constraint.to as usize);
            let from_to = to_old_from * constraint.from_to * to_old_to.inverse();
            *constraint = Constraint { from, to, from_to, covariance: constraint.covariance };
        }
        self.keep_newest_loops();
        for k in (1..self.steps.len()).filter(|&k| goes[k]) {
            self.measured[k + 1] = self.measured[k] * self.measured[k + 1];
            let step = self.steps[k];
            self.steps[k + 1] += step;
        }
        keep(&mut self.scans, goes);
        keep(&mut self.steps, goes);
        keep(&mut self.measured, goes);
        self.dropped.thin(goes);
        keep(trajectory, goes);
    }

    /// Drops loops of a scan with itself, and all but the newest between two scans.
    fn keep_newest_loops(&mut self) {
        let mut seen = BTreeSet::new();
        let mut newest: Vec<Constraint> = std::mem::take(&mut self.loops)
            .into_iter()
            .rev()
            .filter(|constraint| constraint.from != constraint.to && seen.insert(constraint.poses()))
            .collect();
        newest.reverse();
        self.loops = newest;
    }

    /// Drops all scans but the first `count`, with their steps and loops.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.scans.truncate(count);
        self.steps.truncate(count);
        self.measured.truncate(count);
        self.dropped.truncate(count);
        self.loops.retain(|constraint| constraint.poses().0.max(constraint.poses().1) < count);
    }

    /// Bytes in use.
    pub(crate) fn bytes(&self) -> usize {
        self.scans.iter().map(StoredScan::bytes).sum::<usize>()
            + self.steps.capacity() * size_of::<Matrix3<f64>>()
            + self.measured.capacity() * size_of::<Pose2>()
            + self.loops.capacity() * size_of::<Constraint>()
            + self.dropped.bytes()
    }
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
        let mut path = vec![(Stamp::default(), Pose2::IDENTITY)];
        for k in 0..41 {
            history.push(
                StoredScan::new(&ParticleConfig::default(), &ScanPoints::default()),
                Matrix3::identity() * 1e-4,
            );
            if k > 0 {
                path.push((Stamp::from_nanos(k), path.last().unwrap().1 * step));
            }
        }
        let constraint = |from: u32, to: u32| Constraint {
            from,
            to,
            from_to: path[from as usize].1.inverse() * path[to as usize].1,
            covariance: Matrix3::identity() * 1e-4,
        };
        history.loops = vec![constraint(3, 37), constraint(4, 15), constraint(8, 40)];
        let mut thinned = path.clone();
        history.thin(&mut thinned, &every_second(41, 20));
        assert_eq!((history.scans.len(), thinned.len(), history.measured.len()), (32, 32, 32));
        assert_eq!(thinned[0], path[0]);
        let is_path = |all: &[(Stamp, Pose2)]| {
            all.len() == path.len()
                && all.iter().zip(&path).all(|(a, b)| a.0 == b.0 && a.1.distance(&b.1) < 1e-5)
        };
        assert!(is_path(&history.dropped.whole(&thinned, 0)));
        assert_eq!(thinned.last(), path.last());
        let poses: Vec<Pose2> = thinned.iter().map(|(_, pose)| *pose).collect();
        for constraint in history.constraints(&poses) {
            assert!(
                constraint.residual(poses[constraint.from as usize], poses[constraint.to as usize]).norm()
                    < 1e-9,
                "{constraint:?}"
            );
        }
        // A scan to which others are relative may be dropped as well.
        history.thin(&mut thinned, &every_second(32, 30));
        assert_eq!(history.scans.len(), 18);
        assert!(is_path(&history.dropped.whole(&thinned, 0)));
        history.truncate(10);
        assert!(history.dropped.whole(&thinned[..10], 0).iter().zip(&path).all(|(a, b)| a.0 == b.0));
        assert!(history.dropped.whole(&thinned[..10], 4)[0] == thinned[4]);
    }
}
