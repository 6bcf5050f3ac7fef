//! Choice of redundant stored scans: those of places with many newer scans.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use trundle_core::Pose2;

/// Side of a place \[m\]. Source: ours, three gates of the filter.
const PLACE_SIDE_M: f64 = 1.0;
/// Number of viewing directions of a place. Source: ours, the different views of a camera or of a laser with 180 deg.
const HEADING_COUNT: f64 = 8.0;
/// Number of newest scans of a place in one direction that are kept. Source: ours; several of them draw each cell.
const MAX_SCANS_PER_PLACE: usize = 4;
/// Number of newest scans that are always kept: those of the last submap and more. Source: ours.
const RECENT_SCANS: usize = 100;

/// For each pose (m), whether its scan is redundant. The first, that at `first_of_run` and the newest ones are kept.
pub(crate) fn crowded(poses: &[Pose2], first_of_run: usize) -> Vec<bool> {
    let mut goes = vec![false; poses.len()];
    let mut counts: BTreeMap<(i64, i64, i64), usize> = BTreeMap::new();
    for (k, pose) in poses.iter().enumerate().rev() {
        let count = counts.entry(place(*pose)).or_default();
        let is_old = k > 0 && k != first_of_run && k + RECENT_SCANS < poses.len();
        goes[k] = is_old && *count >= MAX_SCANS_PER_PLACE;
        *count += 1;
    }
    goes
}

fn place(pose: Pose2) -> (i64, i64, i64) {
    let heading = (pose.theta / TAU * HEADING_COUNT).floor().rem_euclid(HEADING_COUNT);
    ((pose.x / PLACE_SIDE_M).floor() as i64, (pose.y / PLACE_SIDE_M).floor() as i64, heading as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_many_laps_each_place_keeps_its_newest_scans() {
        let lap =
            |k: usize| Pose2::new(3.0 * (0.1 * k as f64).cos(), 3.0 * (0.1 * k as f64).sin(), 0.1 * k as f64);
        let poses: Vec<Pose2> = (0..6000).map(lap).collect();
        let goes = crowded(&poses, 10);
        let stay = goes.iter().filter(|goes| !**goes).count();
        assert!(stay < 400, "{stay}");
        assert!(!goes[0] && !goes[10] && goes[5899 - 1000..5899 - 700].iter().all(|goes| *goes));
        assert!(goes[6000 - RECENT_SCANS..].iter().all(|goes| !*goes));
        let straight: Vec<Pose2> = (0..6000).map(|k| Pose2::new(0.3 * f64::from(k), 0.0, 0.0)).collect();
        assert!(crowded(&straight, 0).iter().all(|goes| !*goes), "no place is seen twice");
    }
}
