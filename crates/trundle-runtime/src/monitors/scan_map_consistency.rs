//! Consistency of scans with the map: detects a robot that was carried away while no image is located.

use trundle_core::{Beam, Cell, CellIndex, OccupancyGrid, Pose2, Scan, Stamp, Vector2};

/// Detects scans that contradict the map.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ScanMapConsistency {
    /// Stamp since which all scans contradict the map.
    since: Option<Stamp>,
    /// Stamp of the last scan, and its fraction that contradicts the map.
    last: Option<(Stamp, f64)>,
}

/// Result of the comparison of a scan with the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fit {
    /// The scan agrees with the estimated pose.
    Fits,
    /// The scan shows another place or a large change, and is not drawn into the map.
    Contradicts,
    /// All scans contradicted the map for [`CONTRADICTION_DURATION_S`]: the robot is displaced.
    Elsewhere,
}

/// Largest distance between a hit and an occupied cell that counts as agreement \[m\]: the error of pose and map. Source: ours.
const HIT_TOLERANCE_M: f64 = 0.25;
/// Fraction of contradicting hits on known cells above which a scan contradicts the map. A person nearby hides less. Source: ours.
const CONTRADICTING_SHARE: f64 = 0.45;
/// This fraction if the previous scan agreed with the map, since new objects come into view gradually. Source: ours.
const SUDDEN_CONTRADICTING_SHARE: f64 = 0.15;
/// Fraction of contradicting hits up to which a scan agrees with the map. Source: ours.
const AGREEING_SHARE: f64 = 0.03;
/// Largest age of the previous scan \[s\]: two periods of the map. Source: ours.
const MAX_PREVIOUS_SCAN_AGE_S: f64 = 0.5;
/// Smallest fraction of hits in known cells for a verdict. Source: ours.
const MIN_KNOWN_SHARE: f64 = 0.15;
/// Time of contradiction \[s\] after which the scans show another place. Source: ours.
const CONTRADICTION_DURATION_S: f64 = 1.5;

impl ScanMapConsistency {
    /// Compares a scan with the map at the estimated pose `map_from_base`.
    pub(crate) fn judge(&mut self, grid: &OccupancyGrid, map_from_base: Pose2, scan: &Scan) -> Fit {
        let part = contradicted(grid, map_from_base, scan);
        let before = self.last.replace((scan.stamp(), part));
        let before = before.filter(|(at, _)| scan.stamp() - *at <= MAX_PREVIOUS_SCAN_AGE_S);
        if before.is_none() {
            // Evidence from before a time gap is dropped.
            self.since = None;
        }
        let fitted = before.is_some_and(|(_, part)| part <= AGREEING_SHARE);
        let enough =
            if fitted || self.since.is_some() { SUDDEN_CONTRADICTING_SHARE } else { CONTRADICTING_SHARE };
        if part < enough {
            self.since = None;
            return Fit::Fits;
        }
        let since = *self.since.get_or_insert(scan.stamp());
        if scan.stamp() - since < CONTRADICTION_DURATION_S {
            return Fit::Contradicts;
        }
        self.forget();
        Fit::Elsewhere
    }

    /// Drops the evidence, when another source measures the pose.
    pub(crate) fn forget(&mut self) {
        *self = Self::default();
    }
}

/// Fraction of the hits in known cells that are in free cells or behind occupied cells; 0 with too few such hits.
fn contradicted(grid: &OccupancyGrid, map_from_base: Pose2, scan: &Scan) -> f64 {
    let origin = map_from_base.transform(scan.origin());
    let ends = scan.beams().iter().enumerate().filter_map(|(i, beam)| match beam {
        Beam::Hit { range } => Some(map_from_base.transform(scan.point(i, *range))),
        _ => None,
    });
    let (mut agree, mut contradict, mut unknown) = (0_usize, 0_usize, 0_usize);
    for end in ends {
        match judged(grid, origin, end) {
            Some(true) => agree += 1,
            Some(false) => contradict += 1,
            None => unknown += 1,
        }
    }
    let known = agree + contradict;
    let is_enough = known > 0 && known as f64 >= MIN_KNOWN_SHARE * (known + unknown) as f64;
    if is_enough { contradict as f64 / known as f64 } else { 0.0 }
}

/// Whether the map has an occupied cell where a beam ends; `None` if the cell is unknown.
fn judged(grid: &OccupancyGrid, origin: Vector2, end: Vector2) -> Option<bool> {
    let about = |at| around(grid, at);
    if about(end).any(|cell| cell == Cell::Occupied) {
        return Some(true);
    }
    let (offset, step) = (end - origin, grid.geometry().resolution);
    let count = ((offset.norm() - HIT_TOLERANCE_M).max(0.0) / step) as usize;
    let mut on_the_way = (0..count).map(|i| origin + offset * (i as f64 * step / offset.norm()));
    let is_behind = on_the_way.any(|point| grid.at(point) == Cell::Occupied);
    // Unknown cells may contain the beginning of a wall.
    let is_clear = || grid.at(end) == Cell::Free && about(end).all(|cell| cell == Cell::Free);
    (is_behind || is_clear()).then_some(false)
}

/// The cells within [`HIT_TOLERANCE_M`] of a point, as a square; those off the map are unknown.
fn around(grid: &OccupancyGrid, at: Vector2) -> impl Iterator<Item = Cell> + '_ {
    let geometry = grid.geometry();
    let reach = (HIT_TOLERANCE_M / geometry.resolution).ceil() as i64;
    let middle = (at - geometry.origin) / geometry.resolution;
    let (col, row) = (middle.x.floor() as i64, middle.y.floor() as i64);
    let get = move |col: i64, row: i64| match (usize::try_from(col), usize::try_from(row)) {
        (Ok(col), Ok(row)) if col < geometry.width && row < geometry.height => {
            grid.get(CellIndex { col, row })
        }
        _ => Cell::Unknown,
    };
    (row - reach..=row + reach).flat_map(move |r| (col - reach..=col + reach).map(move |c| get(c, r)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::GridGeometry;

    /// A room of 6 x 4 m with a box, known up to x = `known` \[m\]; its corner is at the origin.
    fn room(known: f64) -> OccupancyGrid {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), 120, 80).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        for k in 0..geometry.len() {
            let cell = geometry.cell(k);
            let is_wall = [0, 119].contains(&cell.col) || [0, 79].contains(&cell.row);
            let is_box = (70..90).contains(&cell.col) && cell.row < 30;
            if geometry.center(cell).x > known {
                grid.set(cell, Cell::Unknown);
            } else if is_wall || is_box {
                grid.set(cell, Cell::Occupied);
            }
        }
        grid
    }

    /// The camera's scan of the room from a pose. `before`: maximum range in a part of the view, as in front of a person.
    fn scan(at: Pose2, time: f64, before: Option<f64>) -> Scan {
        let grid = room(f64::INFINITY);
        let beam = |i: i32| {
            let bearing = at.theta + f64::from(i).to_radians();
            let along = |k: u32| f64::from(k) * 0.02;
            let is_there = |r: f64| {
                grid.at(at.position() + Vector2::new(bearing.cos(), bearing.sin()) * r) == Cell::Occupied
            };
            let range = (0..400).map(along).find(|r| is_there(*r)).unwrap_or(8.0);
            let hidden = before.filter(|_| (-10..20).contains(&i));
            Beam::Hit { range: hidden.map_or(range, |near| range.min(near)) }
        };
        let step = 1_f64.to_radians();
        let beams = (-35..=35).map(beam).collect();
        Scan::new(Stamp::default().after(time), Vector2::zeros(), -35.0 * step, step, beams).unwrap()
    }

    /// Results for scans taken at `truth` every 0.2 s by a robot with a wrong pose estimate.
    fn judged(grid: &OccupancyGrid, truth: Pose2, believed: Pose2, before: Option<f64>) -> Vec<Fit> {
        let mut watch = ScanMapConsistency::default();
        (0..9).map(|i| watch.judge(grid, believed, &scan(truth, 0.2 * f64::from(i), before))).collect()
    }

    #[test]
    fn a_robot_that_was_carried_away_detects_it_by_scans_that_contradict_the_map() {
        let here = Pose2::new(1.0, 2.0, 0.0);
        for truth in [Pose2::new(4.8, 2.0, -2.0), Pose2::new(5.3, 3.3, 1.5), Pose2::new(1.0, 2.0, 3.0)] {
            let fits = judged(&room(f64::INFINITY), truth, here, None);
            assert_eq!(fits[0], Fit::Contradicts, "{truth:?}");
            assert_eq!(fits[8], Fit::Elsewhere, "{truth:?}: {fits:?}");
        }
    }

    #[test]
    fn errors_people_and_what_nobody_has_seen_contradict_nothing() {
        let here = Pose2::new(1.0, 2.0, 0.2);
        let off = here * Pose2::new(0.1, -0.08, 0.05);
        for (known, before) in [(9.0, None), (9.0, Some(0.8)), (2.0, None)] {
            let fits = judged(&room(known), here, off, before);
            assert!(fits.iter().all(|fit| *fit == Fit::Fits), "{known} {before:?}: {fits:?}");
        }
        // An empty map contradicts no scan.
        let fits = judged(&room(-1.0), here, Pose2::new(3.0, 1.0, 2.0), None);
        assert!(fits.iter().all(|fit| *fit == Fit::Fits));
    }

    #[test]
    fn a_sudden_change_needs_a_smaller_share() {
        let (grid, here) = (room(f64::INFINITY), Pose2::new(1.0, 2.0, 0.0));
        let fits = |before: &[Option<f64>]| {
            let mut watch = ScanMapConsistency::default();
            let scans = before.iter().zip(0..).map(|(before, i)| scan(here, 0.2 * f64::from(i), *before));
            scans.map(|scan| watch.judge(&grid, here, &scan)).collect::<Vec<_>>()
        };
        let hidden = Some(1.0);
        assert_eq!(fits(&[None, hidden])[1], Fit::Contradicts, "30 of 71 deg at once");
        assert_eq!(fits(&[hidden, hidden])[1], Fit::Fits, "it stood there before");
        let lasts = [[None].as_slice(), &[hidden; 9]].concat();
        assert_eq!(fits(&lasts)[9], Fit::Elsewhere);
        assert_eq!(fits(&[None, hidden, None, None])[3], Fit::Fits, "it has gone");
    }
}
