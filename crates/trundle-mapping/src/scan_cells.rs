use crate::{GridCell, MapperConfig, ray_cells};
use trundle_core::{Beam, Pose2, Scan, Vector2};

/// What one scan says about cells, each cell once: a hit wins over passing freely.
///
/// Buffers are kept from scan to scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScanCells {
    /// Cells with hits, in the order of the beams.
    pub(crate) hits: Vec<HitCell>,
    /// Cells that beams passed freely, in the order of the beams and along them.
    pub(crate) frees: Vec<GridCell>,
    /// Where the beams start, in cells.
    pub(crate) origin: Vector2,
    /// Beams that reach out of the map, or whose pose is not finite.
    pub(crate) ignored_beams: usize,
    segments: Vec<Segment>,
    /// What was seen to be free: from where to where, in cells.
    ways: Vec<(Vector2, Vector2)>,
    window: Window,
}

/// A cell with hits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HitCell {
    pub(crate) cell: GridCell,
    sum: Vector2,
    count: u32,
}

impl HitCell {
    /// Mean of the hits, from the cell's lower-left corner, in cells.
    pub(crate) fn mean_within(&self) -> Vector2 {
        self.sum / f64::from(self.count) - Vector2::new(f64::from(self.cell.x), f64::from(self.cell.y))
    }
}

#[derive(Debug, Clone, Copy)]
struct Segment {
    beam: usize,
    end: Vector2,
    hit: bool,
}

/// Marks over the cells that the scan reaches: 0 untouched, 1 free, 2 surface, n + 3 the n-th hit.
#[derive(Debug, Clone, Default)]
struct Window {
    corner: (i32, i32),
    width: usize,
    marks: Vec<u32>,
}

const UNTOUCHED: u32 = 0;
const FREE: u32 = 1;
const SURFACE: u32 = 2;
const FIRST_HIT: u32 = 3;

impl ScanCells {
    /// Finds the cells of `scan` taken at `map_from_base`. `hides`: whether a cell of the blind range may hide what is behind it.
    pub(crate) fn rasterise(
        &mut self,
        config: &MapperConfig,
        map_from_base: Pose2,
        scan: &Scan,
        hides: impl Fn(GridCell) -> bool,
    ) {
        self.hits.clear();
        self.frees.clear();
        self.find_segments(config, map_from_base, scan, hides);
        self.window.cover(self.origin, &self.segments);
        for i in 0..self.segments.len() {
            if self.segments[i].hit {
                self.mark_hit(self.segments[i].end);
            }
        }
        self.mark_surfaces(config.surface_gap / config.resolution);
        for i in 0..self.ways.len() {
            self.mark_free(self.ways[i]);
        }
    }

    /// The lowest and the highest cell that may be touched; `None` when no beam counts.
    pub(crate) fn reach(&self) -> Option<(GridCell, GridCell)> {
        let Window { corner, width, marks } = &self.window;
        let height = marks.len().checked_div(*width)?;
        let low = GridCell { x: corner.0, y: corner.1 };
        Some((low, GridCell { x: low.x + *width as i32 - 1, y: low.y + height as i32 - 1 }))
    }

    fn find_segments(
        &mut self,
        config: &MapperConfig,
        map_from_base: Pose2,
        scan: &Scan,
        hides: impl Fn(GridCell) -> bool,
    ) {
        let cells_from_metres = 1.0 / config.resolution;
        let limit = config.half_extent * cells_from_metres;
        // NaN is not within either.
        let within = |p: Vector2| p.x.abs() <= limit && p.y.abs() <= limit;
        self.segments.clear();
        self.ways.clear();
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
                let covered = self.covered_from(at(range.min(config.blind_range)), &hides);
                let seen = covered.map_or(range, |cells| range.min(cells * config.resolution));
                let spans = scan.free_spans(i).filter(|(from, _)| *from < seen);
                let way = |(from, to): (f64, f64)| {
                    let start = if from == 0.0 { self.origin } else { at(from) };
                    (start, if to < seen { at(to) } else { at(seen) })
                };
                self.ways.extend(spans.map(way));
            } else {
                self.ignored_beams += 1;
            }
        }
    }

    /// Where a beam meets something in the blind range, which ends at `blind_end`, cells. What the sensor itself stands over it
    /// leaves first.
    fn covered_from(&self, blind_end: Vector2, hides: impl Fn(GridCell) -> bool) -> Option<f64> {
        let covers =
            ray_cells(self.origin, blind_end).skip_while(|cell| hides(*cell)).find(|cell| hides(*cell));
        covers.map(|cell| (cell.center_cells() - self.origin).norm())
    }

    fn mark_hit(&mut self, end: Vector2) {
        let cell = GridCell::containing(end);
        let mark = self.window.at(cell);
        if *mark == UNTOUCHED {
            *mark = FIRST_HIT + self.hits.len() as u32;
            self.hits.push(HitCell { cell, sum: end, count: 1 });
        } else {
            let hit = &mut self.hits[(*mark - FIRST_HIT) as usize];
            hit.sum += end;
            hit.count += 1;
        }
    }

    /// Between two neighbouring hits that lie near each other goes a surface: beams that graze it do not clear it.
    fn mark_surfaces(&mut self, gap_cells: f64) {
        for pair in self.segments.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let neighbours = a.hit && b.hit && b.beam == a.beam + 1;
            if neighbours && (b.end - a.end).norm() <= gap_cells {
                for cell in ray_cells(a.end, b.end) {
                    let mark = self.window.at(cell);
                    if *mark == UNTOUCHED {
                        *mark = SURFACE;
                    }
                }
            }
        }
    }

    fn mark_free(&mut self, (start, end): (Vector2, Vector2)) {
        for cell in ray_cells(start, end) {
            let mark = self.window.at(cell);
            if *mark == UNTOUCHED {
                *mark = FREE;
                self.frees.push(cell);
            }
        }
    }
}

impl Window {
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
        self.marks.resize(self.width * (high.y - low.y + 1) as usize, UNTOUCHED);
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
        fn every_cell_is_told_once_and_as_brute_force_says(
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
            let (mut hits, mut frees) = (BTreeSet::new(), BTreeSet::new());
            for (i, beam) in scan.beams().iter().enumerate() {
                let (Beam::Hit { range } | Beam::Free { range }) = *beam else { continue };
                let end = pose.transform(scan.point(i, range.min(5.0))) * 10.0;
                frees.extend(ray_cells(origin, end));
                if matches!(beam, Beam::Hit { range } if *range <= 5.0) {
                    hits.insert(GridCell::containing(end));
                }
            }
            let frees: BTreeSet<_> = frees.difference(&hits).copied().collect();
            prop_assert_eq!(cells.hits.len(), hits.len());
            prop_assert_eq!(cells.frees.len(), frees.len());
            prop_assert_eq!(cells.hits.iter().map(|h| h.cell).collect::<BTreeSet<_>>(), hits);
            prop_assert_eq!(cells.frees.iter().copied().collect::<BTreeSet<_>>(), frees);
        }
    }

    #[test]
    fn beams_that_graze_a_wall_do_not_clear_it() {
        // A wall 0.1 m to the left, along x: hits lie up to 0.3 m apart.
        let beam = |angle: f64| Beam::Hit { range: 0.1 / angle.sin() };
        let beams = (0..300).map(|i| beam(0.03 + 0.002 * f64::from(i))).collect();
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), 0.03, 0.002, beams).unwrap();
        let cleared = |surface_gap: f64| {
            let mut cells = ScanCells::default();
            let config = MapperConfig { surface_gap, ..MapperConfig::default() };
            cells.rasterise(&config, Pose2::new(0.02, 0.02, 0.0), &scan, |_| false);
            cells.frees.iter().filter(|cell| cell.y == 2 && cell.x > 4).count()
        };
        assert!(cleared(0.0) > 5);
        assert_eq!(cleared(0.3), 0);
    }

    #[test]
    fn only_what_was_seen_is_cleared() {
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
        let columns: Vec<i32> = cells.frees.iter().map(|cell| cell.x).collect();
        // The cell in which a stretch ends counts as the whole beam's does; the hit's own does not.
        assert_eq!(columns, [0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14, 15, 17, 18, 19]);
        assert_eq!(cells.hits.len(), 1);
    }

    #[test]
    fn what_is_far_away_or_nowhere_is_ignored() {
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
