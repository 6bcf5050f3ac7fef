//! A scan against the map at a pose: patches of surface that agree, and objects that contradict.

use trundle_core::{Beam, Cell, CellIndex, OccupancyGrid, Pose2, Scan, Vector2};

/// Kind of a patch of a scan, compared with the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PatchKind {
    /// The map has an obstacle there.
    Agrees,
    /// An object of the size of a person or a chair, in the scan or in the map alone.
    Small,
    /// A surface larger than a person, in the scan or in the map alone.
    Large,
}

/// A beam or an object of a scan, compared with the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Comparison {
    /// Where it is, base frame at the scan [m].
    pub(crate) point: Vector2,
    pub(crate) kind: PatchKind,
}

/// A pose with the part of its uncertainty that matters for a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ViewPoint {
    pub(crate) map_from_base: Pose2,
    /// Standard deviation of the position \[m\].
    pub(crate) position_sigma: f64,
    /// Standard deviation of the heading \[rad\].
    pub(crate) heading_sigma: f64,
}

/// Largest size of a person, a chair, an open door or what each leaves in the map \[m\]. Source: a door of 0.9 m.
const MAX_SMALL_SIZE_M: f64 = 0.95;
/// Largest distance of neighbouring points of one object \[m\]. Source: ours.
const MAX_POINT_GAP_M: f64 = 0.3;
/// Smallest number of beams of an object: a single beam is an edge. Source: ours.
const MIN_OBJECT_BEAMS: usize = 2;
/// Distance of a hit from an occupied cell that agrees, at an exact pose \[m\]: two cells and the range's noise. Source: ours.
const MIN_TOLERANCE_M: f64 = 0.15;
/// The largest such distance \[m\]. Source: ours.
const MAX_TOLERANCE_M: f64 = 0.5;
/// Largest age of the scan before that stands for a map where nothing is mapped \[s\]. Source: ours.
pub(crate) const MAX_PREVIOUS_AGE_S: f64 = 0.5;

/// Verdict on the end of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Verdict {
    Agrees,
    /// With the point of the contradiction, base frame: the end, where the map is free; or the map's obstacle before it.
    Contradicts {
        at: Vector2,
        is_before: bool,
    },
    Unknown,
}

/// The scan before, with the odometry's motion since: `previous_from_base`.
pub(crate) type Previous<'a> = (&'a Scan, Pose2);

/// Compares a scan with the map at a pose, and with the scan before it where the map knows nothing. Cost: linear in the beams'
/// lengths in cells.
pub(crate) fn compare(
    grid: &OccupancyGrid,
    view: &ViewPoint,
    scan: &Scan,
    previous: Option<Previous<'_>>,
) -> Vec<Comparison> {
    let mut comparisons = Vec::new();
    let mut object = Object::default();
    for (i, beam) in scan.beams().iter().enumerate() {
        let (range, is_hit) = match *beam {
            Beam::Hit { range } => (range, true),
            Beam::Free { range } => (range, false),
            Beam::Unseen => {
                object.end(&mut comparisons);
                continue;
            }
        };
        let end = scan.point(i, range);
        let by_map = verdict(grid, view, scan.origin(), (end, is_hit));
        let verdict = match (by_map, previous) {
            (Verdict::Unknown, Some(previous)) if is_hit => by_previous(previous, end),
            _ => by_map,
        };
        match verdict {
            Verdict::Contradicts { at, is_before } => {
                object.add((at, is_before), end, &mut comparisons);
            }
            Verdict::Agrees => {
                object.end(&mut comparisons);
                comparisons.push(Comparison { point: end, kind: PatchKind::Agrees });
            }
            Verdict::Unknown => object.end(&mut comparisons),
        }
    }
    object.end(&mut comparisons);
    comparisons
}

/// Neighbouring beams that contradict the map in the same way.
#[derive(Debug, Default)]
struct Object {
    /// Points of the contradiction, base frame.
    points: Vec<Vector2>,
    /// Ends of the beams, base frame.
    ends: Vec<Vector2>,
    is_before: bool,
}

impl Object {
    fn add(&mut self, (at, is_before): (Vector2, bool), end: Vector2, found: &mut Vec<Comparison>) {
        let goes_on = self.is_before == is_before
            && self.points.last().is_some_and(|last| (at - last).norm() <= MAX_POINT_GAP_M);
        if !goes_on {
            self.end(found);
        }
        self.is_before = is_before;
        self.points.push(at);
        self.ends.push(end);
    }

    fn end(&mut self, found: &mut Vec<Comparison>) {
        if self.points.len() >= MIN_OBJECT_BEAMS {
            let first = self.points[0];
            let size = self.points.iter().map(|point| (point - first).norm()).fold(0.0, f64::max);
            if size <= MAX_SMALL_SIZE_M {
                found.push(Comparison { point: self.points[self.points.len() / 2], kind: PatchKind::Small });
            } else {
                found.extend(self.ends.iter().map(|end| Comparison { point: *end, kind: PatchKind::Large }));
            }
        }
        self.points.clear();
        self.ends.clear();
    }
}

/// The map's verdict on a beam that ends at `end` (base frame), with a hit or free.
fn verdict(
    grid: &OccupancyGrid,
    view: &ViewPoint,
    origin: Vector2,
    (end, is_hit): (Vector2, bool),
) -> Verdict {
    let range = (end - origin).norm();
    let tolerance = 2.0 * (view.position_sigma + range * view.heading_sigma);
    let tolerance = (MIN_TOLERANCE_M + tolerance).min(MAX_TOLERANCE_M);
    let (from, to) = (view.map_from_base.transform(origin), view.map_from_base.transform(end));
    let mut around = CellCounts::default();
    around.count(grid, to, tolerance);
    if is_hit && around.occupied > 0 {
        return Verdict::Agrees;
    }
    if let Some(along) = first_occupied(grid, from, to, tolerance) {
        return Verdict::Contradicts { at: origin + (end - origin) * along, is_before: true };
    }
    // A wall may begin beside unknown cells.
    if is_hit && grid.at(to) == Cell::Free && around.unknown == 0 {
        return Verdict::Contradicts { at: end, is_before: false };
    }
    Verdict::Unknown
}

/// The part of the line from `from` to `to` (map frame) at which it meets the first occupied cell, to `tolerance` before its end.
fn first_occupied(grid: &OccupancyGrid, from: Vector2, to: Vector2, tolerance: f64) -> Option<f64> {
    let (way, step) = (to - from, grid.geometry().resolution);
    let length = way.norm();
    let count = ((length - tolerance).max(0.0) / step) as usize;
    (0..count).map(|i| i as f64 * step / length).find(|along| grid.at(from + way * *along) == Cell::Occupied)
}

/// Cells about a point.
#[derive(Debug, Default)]
struct CellCounts {
    occupied: usize,
    unknown: usize,
}

impl CellCounts {
    /// Counts the cells within `reach` of a point, as a square; those off the map are unknown.
    fn count(&mut self, grid: &OccupancyGrid, at: Vector2, reach: f64) {
        let geometry = grid.geometry();
        let reach = (reach / geometry.resolution).ceil() as i64;
        let middle = (at - geometry.origin) / geometry.resolution;
        let (col, row) = (middle.x.floor() as i64, middle.y.floor() as i64);
        for r in row - reach..=row + reach {
            for c in col - reach..=col + reach {
                match cell(grid, c, r) {
                    Cell::Occupied => self.occupied += 1,
                    Cell::Unknown => self.unknown += 1,
                    Cell::Free => {}
                }
            }
        }
    }
}

fn cell(grid: &OccupancyGrid, col: i64, row: i64) -> Cell {
    let geometry = grid.geometry();
    match (usize::try_from(col), usize::try_from(row)) {
        (Ok(col), Ok(row)) if col < geometry.width && row < geometry.height => {
            grid.get(CellIndex { col, row })
        }
        _ => Cell::Unknown,
    }
}

/// The verdict of the scan before on a hit at `end` (base frame): its beams about the same bearing.
fn by_previous((scan, previous_from_base): Previous<'_>, end: Vector2) -> Verdict {
    let ray = previous_from_base.transform(end) - scan.origin();
    let range = ray.norm();
    let middle = ((ray.y.atan2(ray.x) - scan.angle_min()) / scan.angle_increment()).round();
    if middle < 1.0 || middle + 2.0 > scan.beams().len() as f64 {
        return Verdict::Unknown;
    }
    let middle = middle as usize;
    let mut reach = (f64::INFINITY, 0.0_f64);
    for beam in &scan.beams()[middle - 1..=middle + 1] {
        match *beam {
            Beam::Hit { range: hit } if (hit - range).abs() <= MIN_TOLERANCE_M => return Verdict::Agrees,
            Beam::Hit { range: hit } => reach = (reach.0.min(hit), reach.1.max(hit)),
            Beam::Free { .. } | Beam::Unseen => return Verdict::Unknown,
        }
    }
    let is_before = range > reach.1;
    if range < reach.0 || is_before {
        return Verdict::Contradicts { at: end, is_before };
    }
    Verdict::Unknown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::{room, scan_of};

    fn kinds(truth: Pose2, believed: Pose2, hidden: Option<f64>) -> [usize; 3] {
        let grid = room();
        let scan = scan_of(&grid, truth, 0.0, hidden);
        let view = ViewPoint { map_from_base: believed, position_sigma: 0.02, heading_sigma: 0.01 };
        let found = compare(&grid, &view, &scan, None);
        [PatchKind::Agrees, PatchKind::Small, PatchKind::Large]
            .map(|kind| found.iter().filter(|comparison| comparison.kind == kind).count())
    }

    #[test]
    fn at_the_right_pose_everything_agrees() {
        for pose in [Pose2::new(1.0, 2.0, 0.2), Pose2::new(5.0, 3.0, -2.0)] {
            let [agrees, small, large] = kinds(pose, pose, None);
            assert!(agrees > 60 && small <= 1 && large == 0, "{agrees} {small} {large}");
        }
    }

    #[test]
    fn a_person_is_one_small_object_whatever_part_of_the_view_it_hides() {
        let pose = Pose2::new(1.0, 2.0, 0.2);
        let [agrees, small, large] = kinds(pose, pose, Some(1.2));
        assert!(agrees > 25 && small == 1 && large == 0, "{agrees} {small} {large}");
    }

    #[test]
    fn at_another_place_whole_walls_contradict() {
        let truth = Pose2::new(5.0, 3.0, -2.0);
        let [agrees, _, large] = kinds(truth, Pose2::new(1.0, 2.0, 0.2), None);
        assert!(large > agrees, "{large} {agrees}");
    }

    #[test]
    fn the_scan_before_stands_for_a_map_of_nothing() {
        let (grid, nothing) = (room(), OccupancyGrid::filled(*room().geometry(), Cell::Unknown));
        let (here, there) = (Pose2::new(1.0, 2.0, 0.2), Pose2::new(5.0, 3.0, -2.0));
        let view = ViewPoint { map_from_base: here, position_sigma: 0.0, heading_sigma: 0.0 };
        let (before, after) = (scan_of(&grid, here, 0.0, None), scan_of(&grid, there, 0.2, None));
        let large = |scan: &Scan| {
            let found = compare(&nothing, &view, scan, Some((&before, Pose2::IDENTITY)));
            found.iter().filter(|comparison| comparison.kind == PatchKind::Large).count()
        };
        assert_eq!(large(&before), 0);
        assert!(large(&after) > 20, "{}", large(&after));
    }
}
