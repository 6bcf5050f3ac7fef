//! Evidence of scans: each patch of surface counts once, by its newest comparison with the map.

use crate::pose_monitor::scan_comparison::{Comparison, MAX_PREVIOUS_AGE_S, PatchKind, ViewPoint, compare};
use std::collections::{BTreeMap, VecDeque};
use trundle_core::{OccupancyGrid, Pose2, Scan, Stamp, Vector2};

/// The comparisons of the newest scans with the map at the estimated pose, and the scans for a comparison at other poses.
///
/// Neighbouring beams and successive scans of one surface are one observation: a patch of 0.5 m counts once. Patches lie in the odometry's
/// frame, which neither a correction nor another pose moves.
#[derive(Debug, Clone, Default)]
pub(crate) struct ViewEvidence {
    patches: Patches,
    kept: VecDeque<KeptScan>,
    previous: Option<KeptScan>,
}

/// A scan with the odometry's pose when it was taken.
#[derive(Debug, Clone)]
struct KeptScan {
    scan: Scan,
    odom_from_base: Pose2,
}

/// The newest comparison of each patch.
#[derive(Debug, Clone, Default)]
struct Patches(BTreeMap<(i32, i32), (Stamp, PatchKind)>);

/// Side of a patch \[m\]. Source: ours.
const PATCH_M: f64 = 0.5;
/// Time for which a comparison counts \[s\]. Source: ours, the drift of the odometry stays far below a patch.
pub(crate) const WINDOW_S: f64 = 20.0;
/// Largest number of kept scans. Source: ours.
const MAX_KEPT: usize = 24;
/// Motion after which a scan is kept \[m\]. Source: ours.
const KEPT_EVERY_M: f64 = 0.3;
/// Turn after which a scan is kept \[rad\]: 10 deg. Source: ours.
const KEPT_EVERY_RAD: f64 = 0.175;
/// Log-likelihood ratio of a patch that agrees, against another place \[nats\]. Source: ours.
const AGREES_NATS: f64 = 0.8;
/// The same of a small object \[nats\]. Source: ours.
const SMALL_NATS: f64 = -0.8;
/// The same of a patch of a large surface \[nats\]. Source: ours.
const LARGE_NATS: f64 = -2.0;

impl ViewEvidence {
    /// Compares a scan with the map at a pose. The scan is not yet part of the map.
    pub(crate) fn add(&mut self, grid: &OccupancyGrid, view: &ViewPoint, odom_from_base: Pose2, scan: &Scan) {
        let now = scan.stamp();
        let previous = self.previous.as_ref().filter(|last| now - last.scan.stamp() <= MAX_PREVIOUS_AGE_S);
        let previous = previous.map(|last| (&last.scan, last.odom_from_base.inverse() * odom_from_base));
        let comparisons = compare(grid, view, scan, previous);
        self.patches.add(now, odom_from_base, &comparisons);
        self.patches.0.retain(|_, (stamp, _)| now - *stamp <= WINDOW_S);
        let scan = KeptScan { scan: scan.clone(), odom_from_base };
        self.keep(&scan);
        self.previous = Some(scan);
    }

    /// Smallest log-likelihood ratio at the estimated pose, against a robot that was carried away at any one moment \[nats\], and that
    /// moment. `images` is the ratio of the images since a moment, for another place.
    ///
    /// What agreed before the moment says nothing. At most 0, which is that of the present moment.
    pub(crate) fn worst_since(&self, now: Stamp, images: impl Fn(Stamp) -> f64) -> (f64, Stamp) {
        let mut newest: Vec<(Stamp, PatchKind)> = self.patches.0.values().copied().collect();
        newest.sort_by(|a, b| b.cmp(a));
        let (mut sum, mut worst) = (0.0, (-images(now), now));
        for (i, (stamp, kind)) in newest.iter().enumerate() {
            sum += nats(*kind);
            let is_first_of_scan = newest.get(i + 1).is_none_or(|(next, _)| next != stamp);
            if is_first_of_scan && sum - images(*stamp) < worst.0 {
                worst = (sum - images(*stamp), *stamp);
            }
        }
        let before = now.after(-WINDOW_S);
        if sum - images(before) < worst.0 { (sum - images(before), before) } else { worst }
    }

    /// Log-likelihood ratio of all scans at the estimated pose, against another place \[nats\].
    pub(crate) fn nats(&self) -> f64 {
        self.patches.nats()
    }

    /// Drops what came before a moment: the robot was elsewhere then.
    pub(crate) fn forget_before(&mut self, moment: Stamp) {
        self.patches.0.retain(|_, (stamp, _)| *stamp >= moment);
        self.kept.retain(|kept| kept.scan.stamp() >= moment);
    }

    /// The same of the kept scans at any pose of the odometry's frame in the map.
    pub(crate) fn nats_at(&self, grid: &OccupancyGrid, map_from_odom: Pose2) -> f64 {
        let mut patches = Patches::default();
        for KeptScan { scan, odom_from_base } in &self.kept {
            let map_from_base = map_from_odom * *odom_from_base;
            let view =
                ViewPoint { map_from_base, position_sigma: SEARCH_SIGMA_M, heading_sigma: SEARCH_SIGMA_RAD };
            patches.add(scan.stamp(), *odom_from_base, &compare(grid, &view, scan, None));
        }
        patches.nats()
    }

    /// The pose is another: what was compared says nothing of it. The scans stay.
    pub(crate) fn restart(&mut self) {
        self.patches = Patches::default();
    }

    fn keep(&mut self, scan: &KeptScan) {
        let has_moved = self.kept.back().is_none_or(|last| {
            let motion = last.odom_from_base.inverse() * scan.odom_from_base;
            motion.position().norm() >= KEPT_EVERY_M || motion.theta.abs() >= KEPT_EVERY_RAD
        });
        if has_moved {
            self.kept.push_back(scan.clone());
        }
        let newest = scan.scan.stamp();
        while self.kept.len() > MAX_KEPT
            || self.kept.front().is_some_and(|first| newest - first.scan.stamp() > MAX_KEPT_AGE_S)
        {
            self.kept.pop_front();
        }
    }
}

/// Largest age of a kept scan \[s\]. Source: ours.
const MAX_KEPT_AGE_S: f64 = 60.0;
/// Uncertainty of a pose that a search finds \[m\]. Source: ours.
const SEARCH_SIGMA_M: f64 = 0.03;
/// Uncertainty of its heading \[rad\]. Source: ours.
const SEARCH_SIGMA_RAD: f64 = 0.01;

impl Patches {
    /// Takes the comparisons of one scan: of each patch the kind with the largest number of beams, the worse of equal ones.
    fn add(&mut self, stamp: Stamp, odom_from_base: Pose2, comparisons: &[Comparison]) {
        let mut counts: BTreeMap<(i32, i32), [usize; 3]> = BTreeMap::new();
        for comparison in comparisons {
            let patch = patch_of(odom_from_base.transform(comparison.point));
            counts.entry(patch).or_default()[comparison.kind as usize] += 1;
        }
        const KINDS: [PatchKind; 3] = [PatchKind::Agrees, PatchKind::Small, PatchKind::Large];
        for (patch, counts) in counts {
            let kind = KINDS.into_iter().max_by_key(|kind| counts[*kind as usize]);
            kind.into_iter().for_each(|kind| {
                self.0.insert(patch, (stamp, kind));
            });
        }
    }

    fn nats(&self) -> f64 {
        self.0.values().map(|(_, kind)| nats(*kind)).sum()
    }
}

fn nats(kind: PatchKind) -> f64 {
    match kind {
        PatchKind::Agrees => AGREES_NATS,
        PatchKind::Small => SMALL_NATS,
        PatchKind::Large => LARGE_NATS,
    }
}

fn patch_of(point: Vector2) -> (i32, i32) {
    ((point.x / PATCH_M).floor() as i32, (point.y / PATCH_M).floor() as i32)
}
