//! Cells with a hit in one scan, and cells observed as free in it.

use crate::{GridCell, MapperConfig, ray_cells};
use trundle_core::{Beam, Pose2, Scan, Vector2};

/// Cells of one scan, each listed once. A cell with a hit is not listed as free.
///
/// Buffers are reused from scan to scan.
#[derive(Debug, Clone, Default)]
pub struct ScanCells {
    /// Cells with hits, in the order of the beams.
    pub hits: Vec<HitCell>,
    /// Cells that beams passed freely, in the order of the beams and along each beam.
    pub free: Vec<GridCell>,
    /// Origin of the beams, in cells.
    pub origin: Vector2,
    /// Number of beams that end beyond the map's extent, or whose pose is not finite.
    pub ignored_beams: usize,
    segments: Vec<Segment>,
    /// Free stretches of the beams: start and end, in cells.
    free_stretches: Vec<(Vector2, Vector2)>,
    marks: MarkWindow,
}

/// Cell with hits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HitCell {
    /// The cell.
    pub cell: GridCell,
    sum: Vector2,
    count: u32,
}

impl HitCell {
    /// Mean of the hits, from the cell's lower-left corner, in cells.
    pub fn mean_within(&self) -> Vector2 {
        self.sum / f64::from(self.count) - Vector2::new(f64::from(self.cell.x), f64::from(self.cell.y))
    }
}

#[derive(Debug, Clone, Copy)]
struct Segment {
    beam: usize,
    end: Vector2,
    hit: bool,
}

/// Marks over the bounding box of a scan: 0 untouched, 1 free, 2 surface, n + 3 the n-th hit cell.
#[derive(Debug, Clone, Default)]
struct MarkWindow {
    corner: (i32, i32),
    width: usize,
    marks: Vec<u32>,
}

/// Marks of the cells in a [`MarkWindow`].
const UNTOUCHED_MARK: u32 = 0;
const FREE_MARK: u32 = 1;
const SURFACE_MARK: u32 = 2;
const FIRST_HIT_MARK: u32 = 3;

impl ScanCells {
    /// Finds the cells of `scan`, taken at `map_from_base`. `is_obstacle`: whether a cell of the blind range may hide the cells
    /// behind it.
    pub fn rasterise(
        &mut self,
        config: &MapperConfig,
        map_from_base: Pose2,
        scan: &Scan,
        is_obstacle: impl Fn(GridCell) -> bool,
    ) {
        self.hits.clear();
        self.free.clear();
        self.find_segments(config, map_from_base, scan, is_obstacle);
        self.marks.cover(self.origin, &self.segments);
        for i in 0..self.segments.len() {
            if self.segments[i].hit {
                self.mark_hit(self.segments[i].end);
            }
        }
        self.mark_surfaces(config.surface_gap / config.resolution);
        for i in 0..self.free_stretches.len() {
            self.mark_free(self.free_stretches[i]);
        }
    }

    /// Lowest and highest cell of the scan's bounding box; `None` if every beam was ignored.
    pub fn reach(&self) -> Option<(GridCell, GridCell)> {
        let MarkWindow { corner, width, marks } = &self.marks;
        let height = marks.len().checked_div(*width)?;
        let low = GridCell { x: corner.0, y: corner.1 };
        Some((low, GridCell { x: low.x + *width as i32 - 1, y: low.y + height as i32 - 1 }))
    }

    fn find_segments(
        &mut self,
        config: &MapperConfig,
        map_from_base: Pose2,
        scan: &Scan,
        is_obstacle: impl Fn(GridCell) -> bool,
    ) {
        let cells_from_metres = 1.0 / config.resolution;
        let limit = config.half_extent * cells_from_metres;
        // NaN is not within the limit either.
        let within = |p: Vector2| p.x.abs() <= limit && p.y.abs() <= limit;
        self.segments.clear();
        self.free_stretches.clear();
        self.ignored_beams = 0;
        self.origin = map_from_base.transform(scan.origin()) * cells_from_metres;
        let origin_counts = within(self.origin) && map_from_base.theta.is_finite();
        for (i, beam) in scan.beams().iter().enumerate() {
            let (range, hit) = match *beam {
                Beam::Hit { range } => (range.min(config.max_range), range <= config.max_range),
                Beam::Free { range } => (range.min(config.max_range), false),
                Beam::Unseen => continue,
            };
            let at = |range: f64| map_from_base.transform(scan.point(i, range)) * cells_from_metres;
            let end = at(range);
            if origin_counts && within(end) {
                self.segments.push(Segment { beam: i, end, hit });
                let covered = self.covered_from(at(range.min(config.blind_range)), &is_obstacle);
                let seen = covered.map_or(range, |cells| range.min(cells * config.resolution));
                let spans = scan.free_spans(i).filter(|(from, _)| *from < seen);
                let stretch = |(from, to): (f64, f64)| {
                    let start = if from == 0.0 { self.origin } else { at(from) };
                    (start, if to < seen { at(to) } else { at(seen) })
                };
                self.free_stretches.extend(spans.map(stretch));
            } else {
                self.ignored_beams += 1;
            }
        }
    }

    /// Distance, in cells, at which a beam meets an obstacle of the blind range, which ends at `blind_end`. Obstacle cells at the
    /// sensor itself are skipped.
    fn covered_from(&self, blind_end: Vector2, is_obstacle: impl Fn(GridCell) -> bool) -> Option<f64> {
        let covers = ray_cells(self.origin, blind_end)
            .skip_while(|cell| is_obstacle(*cell))
            .find(|cell| is_obstacle(*cell));
        covers.map(|cell| (cell.center_cells() - self.origin).norm())
    }

    fn mark_hit(&mut self, end: Vector2) {
        let cell = GridCell::containing(end);
        let mark = self.marks.at(cell);
        if *mark == UNTOUCHED_MARK {
            *mark = FIRST_HIT_MARK + self.hits.len() as u32;
            self.hits.push(HitCell { cell, sum: end, count: 1 });
        } else {
            let hit = &mut self.hits[(*mark - FIRST_HIT_MARK) as usize];
            hit.sum += end;
            hit.count += 1;
        }
    }

    /// Marks the cells on the line between two neighbouring hits of one surface. Grazing beams do not clear these cells.
    fn mark_surfaces(&mut self, gap_cells: f64) {
        for pair in self.segments.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let neighbours = a.hit && b.hit && b.beam == a.beam + 1;
            if neighbours && (b.end - a.end).norm() <= gap_cells {
                for cell in ray_cells(a.end, b.end) {
                    let mark = self.marks.at(cell);
                    if *mark == UNTOUCHED_MARK {
                        *mark = SURFACE_MARK;
                    }
                }
            }
        }
    }

    fn mark_free(&mut self, (start, end): (Vector2, Vector2)) {
        for cell in ray_cells(start, end) {
            let mark = self.marks.at(cell);
            if *mark == UNTOUCHED_MARK {
                *mark = FREE_MARK;
                self.free.push(cell);
            }
        }
    }
}

impl MarkWindow {
    fn cover(&mut self, origin: Vector2, segments: &[Segment]) {
        self.marks.clear();
        self.width = 0;
        if segments.is_empty() {
            return;
        }
        let ends = segments.iter().map(|s| s.end);
        let (low, high) = ends.fold((origin, origin), |(low, high), p| (low.inf(&p), high.sup(&p)));
        let (low, high) = (GridCell::containing(low), GridCell::containing(high));
        self.corner = (low.x, low.y);
        self.width = (high.x - low.x + 1) as usize;
        self.marks.resize(self.width * (high.y - low.y + 1) as usize, UNTOUCHED_MARK);
    }

    fn at(&mut self, cell: GridCell) -> &mut u32 {
        let (col, row) = ((cell.x - self.corner.0) as usize, (cell.y - self.corner.1) as usize);
        &mut self.marks[row * self.width + col]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;
    use trundle_core::{FreeSpan, ScanParts, Stamp};

    fn any_beam() -> impl Strategy<Value = Beam> {
        prop_oneof![
            (0.0..6.0).prop_map(|range| Beam::Hit { range }),
            (0.0..6.0).prop_map(|range| Beam::Free { range }),
            Just(Beam::Unseen),
        ]
    }

    proptest! {
        #[test]
        fn every_cell_is_listed_once_as_by_brute_force(
            beams in prop::collection::vec(any_beam(), 1..80),
            x in -3.0..3.0, y in -3.0..3.0, theta in -3.0..3.0,
        ) {
            let config =
                MapperConfig { resolution: 0.1, max_range: 5.0, surface_gap: 0.0, ..MapperConfig::default() };
            let pose = Pose2::new(x, y, theta);
            let scan = Scan::new(Stamp::default(), Vector2::new(0.1, 0.0), -0.6, 0.02, beams).unwrap();
            let mut cells = ScanCells::default();
            cells.rasterise(&config, pose, &scan, |_| false);

            let origin = pose.transform(scan.origin()) * 10.0;
            let (mut hits, mut free) = (BTreeSet::new(), BTreeSet::new());
            for (i, beam) in scan.beams().iter().enumerate() {
                let (Beam::Hit { range } | Beam::Free { range }) = *beam else { continue };
                let end = pose.transform(scan.point(i, range.min(5.0))) * 10.0;
                free.extend(ray_cells(origin, end));
                if matches!(beam, Beam::Hit { range } if *range <= 5.0) {
                    hits.insert(GridCell::containing(end));
                }
            }
            let free: BTreeSet<_> = free.difference(&hits).copied().collect();
            prop_assert_eq!(cells.hits.len(), hits.len());
            prop_assert_eq!(cells.free.len(), free.len());
            prop_assert_eq!(cells.hits.iter().map(|h| h.cell).collect::<BTreeSet<_>>(), hits);
            prop_assert_eq!(cells.free.iter().copied().collect::<BTreeSet<_>>(), free);
        }
    }

    #[test]
    fn beams_that_graze_a_wall_do_not_clear_it() {
        // A wall 0.1 m to the left, along x: hits are up to 0.3 m apart.
        let beam = |angle: f64| Beam::Hit { range: 0.1 / angle.sin() };
        let beams = (0..300).map(|i| beam(0.03 + 0.002 * f64::from(i))).collect();
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), 0.03, 0.002, beams).unwrap();
        let cleared = |surface_gap: f64| {
            let mut cells = ScanCells::default();
            let config = MapperConfig { surface_gap, ..MapperConfig::default() };
            cells.rasterise(&config, Pose2::new(0.02, 0.02, 0.0), &scan, |_| false);
            cells.free.iter().filter(|cell| cell.y == 2 && cell.x > 4).count()
        };
        assert!(cleared(0.0) > 5);
        assert_eq!(cleared(0.3), 0);
    }

    #[test]
    fn only_free_spans_are_cleared() {
        let span = |from, to| FreeSpan { beam: 0, from, to };
        let parts = ScanParts {
            beams: vec![Beam::Hit { range: 2.03 }],
            free: Some(vec![span(0.0, 0.52), span(1.02, 1.52), span(1.7, 9.0)]),
            ..ScanParts::default()
        };
        let scan = Scan::from_parts(Stamp::default(), Vector2::zeros(), (0.0, 0.1), parts).unwrap();
        let mut cells = ScanCells::default();
        let config = MapperConfig { resolution: 0.1, ..MapperConfig::default() };
        cells.rasterise(&config, Pose2::IDENTITY, &scan, |_| false);
        let columns: Vec<i32> = cells.free.iter().map(|cell| cell.x).collect();
        // The cell at the end of a span is free; the cell of the hit is not.
        assert_eq!(columns, [0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14, 15, 17, 18, 19]);
        assert_eq!(cells.hits.len(), 1);
    }

    #[test]
    fn beams_beyond_the_extent_and_poses_that_are_not_finite_are_ignored() {
        let config = MapperConfig { half_extent: 10.0, ..MapperConfig::default() };
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 0.1, vec![Beam::Hit { range: 2.0 }; 3]);
        let scan = scan.unwrap();
        let mut cells = ScanCells::default();
        for pose in [
            Pose2::new(9.0, 0.0, 0.0),
            Pose2 { theta: f64::NAN, ..Pose2::IDENTITY },
            Pose2::new(1e300, 0.0, 0.0),
        ] {
            cells.rasterise(&config, pose, &scan, |_| false);
            assert_eq!((cells.ignored_beams, cells.hits.len(), cells.reach()), (3, 0, None));
        }
    }
}
