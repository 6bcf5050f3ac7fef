mod known;

use crate::{
    GridCell, LogOddsGrid, MapperConfig, live_grid::LiveGrid, mapper_config::probability,
    scan_cells::ScanCells,
};
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Vector2};

/// Draws scans taken at known poses into a log-odds occupancy grid.
///
/// Problem: which cells of the floor are occupied, given noisy scans and trusted poses? Each cell is a binary variable
/// of its own, and every scan adds its log-odds (Moravec and Elfes 1985; Thrun, Probabilistic Robotics, ch. 9): a hit
/// raises its cell, beams lower the cells that they pass, each cell at most once a scan. Cost: one step for each cell
/// that a beam passes; no work grows with the length of the run, but for a re-layout of the published grid when the map
/// outgrows it.
///
/// | symbol | here | unit |
/// |---|---|---|
/// | l(occupied given z) | `hit` | log-odds |
/// | l(free given z) | `-free` | log-odds |
/// | l_min, l_max | `-clamp_low`, `clamp_high` | log-odds |
#[derive(Debug, Clone)]
pub struct GridMapper {
    config: MapperConfig,
    evidence: LogOddsGrid,
    live: LiveGrid,
    cells: ScanCells,
    /// Whether the three-valued map follows; else only the evidence counts.
    shows: bool,
}

/// What one scan did to the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Insertion {
    /// Cells with hits.
    pub hits: usize,
    /// Cells passed freely.
    pub frees: usize,
    /// Beams that reach out of the map's greatest extent, or all of them when the pose is not finite.
    pub ignored_beams: usize,
}

impl GridMapper {
    /// An empty map about the map frame's origin.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: MapperConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let mut evidence = LogOddsGrid::default();
        evidence.reach(GridCell { x: -1, y: -1 });
        evidence.reach(GridCell { x: 0, y: 0 });
        let live = LiveGrid::new(&config, &evidence);
        Ok(Self { live, evidence, cells: ScanCells::default(), shows: true, config })
    }

    /// Draws `scan`, taken with the base at `map_from_base`.
    pub fn insert(&mut self, map_from_base: Pose2, scan: &Scan) -> Insertion {
        self.live.begin();
        let mut cells = std::mem::take(&mut self.cells);
        cells.rasterise(&self.config, map_from_base, scan, |cell| self.evidence.log_odds(cell) > 0.0);
        if let Some((low, high)) = cells.reach() {
            self.grow(low, high);
        }
        self.draw(&cells);
        let (hits, frees) = (cells.hits.len(), cells.frees.len());
        let ignored_beams = cells.ignored_beams;
        self.cells = cells;
        Insertion { hits, frees, ignored_beams }
    }

    /// Marks a disc of `radius` m about a pose as free for certain: the robot stands there.
    pub fn mark_free_disc(&mut self, map_from_base: Pose2, radius: f64) {
        let limit = self.config.half_extent - radius;
        if !(radius > 0.0 && map_from_base.x.abs() <= limit && map_from_base.y.abs() <= limit) {
            return;
        }
        self.live.begin();
        let center = map_from_base.position() / self.config.resolution;
        let reach = Vector2::repeat(radius / self.config.resolution);
        let (low, high) = (GridCell::containing(center - reach), GridCell::containing(center + reach));
        self.grow(low, high);
        for y in low.y..=high.y {
            for x in low.x..=high.x {
                let cell = GridCell { x, y };
                if (cell.center_cells() - center).norm() <= reach.x {
                    self.set(cell, -self.config.clamp_low as f32);
                }
            }
        }
    }

    /// Marks the cells at these points (base frame, m) as occupied for certain: the bumper met something there.
    pub fn mark_occupied(&mut self, map_from_base: Pose2, points: &[Vector2]) {
        self.live.begin();
        for point in points {
            let at = map_from_base.transform(*point);
            let limit = self.config.half_extent;
            if at.x.abs() <= limit && at.y.abs() <= limit {
                let cell = GridCell::containing(at / self.config.resolution);
                self.grow(cell, cell);
                self.set(cell, self.config.clamp_high as f32);
            }
        }
    }

    /// The hook for corrections: forgets the map and draws it anew from scans at corrected poses.
    pub fn redraw<'a>(&mut self, scans: impl IntoIterator<Item = (Pose2, &'a Scan)>) {
        let (low, (cols, rows)) = self.evidence.bounds();
        self.evidence = LogOddsGrid::default();
        self.evidence.reach(low);
        self.evidence.reach(GridCell { x: low.x + cols as i32 - 1, y: low.y + rows as i32 - 1 });
        let blank = self.evidence.clone();
        self.live.begin();
        self.live.fit(&blank);
        self.live.show_all(&blank);
        for (map_from_base, scan) in scans {
            self.insert(map_from_base, scan);
        }
    }

    /// The three-valued map. Its geometry grows with what is seen, in steps of 64 cells, and never shrinks.
    pub fn grid(&self) -> &OccupancyGrid {
        self.live.grid()
    }

    /// Counts the scans, discs and redrawings that may have changed [`GridMapper::grid`].
    pub fn revision(&self) -> u64 {
        self.live.revision()
    }

    /// The tiles of 64 x 64 cells of [`GridMapper::grid`] in which a cell changed after `revision`: lowest cell and (columns,
    /// rows) of each.
    pub fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        self.live.changes_since(revision)
    }

    /// Another map with this one's settings and bounds, of other evidence within them, whose three-valued map shows nothing: to be
    /// taken over by [`GridMapper::replace_with`].
    pub(crate) fn with_evidence(&self, mut evidence: LogOddsGrid) -> Self {
        let (low, (cols, rows)) = self.evidence.bounds();
        evidence.reach(low);
        evidence.reach(GridCell { x: low.x + cols as i32 - 1, y: low.y + rows as i32 - 1 });
        let live = LiveGrid::new(&self.config, &evidence);
        Self { live, evidence, cells: ScanCells::default(), shows: false, config: self.config.clone() }
    }

    /// Takes over another map, telling what differs.
    pub(crate) fn replace_with(&mut self, mut other: Self) {
        let (low, (cols, rows)) = self.evidence.bounds();
        other.grow(low, GridCell { x: low.x + cols as i32 - 1, y: low.y + rows as i32 - 1 });
        self.live.fit(&other.evidence);
        self.live.begin();
        self.live.show_all(&other.evidence);
        self.evidence = other.evidence;
    }

    /// All evidence, cell by cell. Cloning it is cheap.
    pub fn evidence(&self) -> &LogOddsGrid {
        &self.evidence
    }

    /// The configuration.
    pub fn config(&self) -> &MapperConfig {
        &self.config
    }

    /// Log-odds of being occupied at a point of the map frame (m): 0 where nothing is known.
    pub fn log_odds_at(&self, point: Vector2) -> f64 {
        let cell = GridCell::containing(point / self.config.resolution);
        f64::from(self.evidence.log_odds(cell))
    }

    /// Probability of being occupied at a point of the map frame (m): 0.5 where nothing is known.
    pub fn probability_at(&self, point: Vector2) -> f64 {
        probability(self.log_odds_at(point))
    }

    /// The probabilities of [`GridMapper::grid`]'s cells, in its order: for pictures.
    pub fn probabilities(&self) -> Vec<f32> {
        let (corner, (cols, rows)) = self.evidence.bounds();
        let cell = |i: usize| GridCell { x: corner.x + (i % cols) as i32, y: corner.y + (i / cols) as i32 };
        (0..cols * rows).map(|i| probability(f64::from(self.evidence.log_odds(cell(i)))) as f32).collect()
    }

    /// What the three-valued map says of a cell.
    pub(crate) fn value(&self, log_odds: f32) -> Cell {
        self.live.value(log_odds)
    }

    fn set(&mut self, cell: GridCell, log_odds: f32) {
        self.evidence.entry(cell).log_odds = log_odds;
        if self.shows {
            self.live.show(cell, log_odds);
        }
    }

    fn grow(&mut self, low: GridCell, high: GridCell) {
        self.evidence.reach(low);
        self.evidence.reach(high);
        if self.shows {
            self.live.fit(&self.evidence);
        }
    }

    fn draw(&mut self, cells: &ScanCells) {
        let config = &self.config;
        let (live, shows) = (&mut self.live, self.shows);
        // Most cells are called what they were called before.
        let mut show = |cell: GridCell, before: f32, now: f32| {
            if shows && live.value(before) != live.value(now) {
                live.show(cell, now);
            }
        };
        for hit in &cells.hits {
            let evidence = self.evidence.entry(hit.cell);
            let before = evidence.log_odds;
            evidence.log_odds = (before + config.hit as f32).min(config.clamp_high as f32);
            evidence.add_hit(hit.mean_within());
            show(hit.cell, before, evidence.log_odds);
        }
        let blind_cells = config.blind_range / config.resolution;
        let (free, low) = (config.free as f32, -config.clamp_low as f32);
        self.evidence.each_entry(&cells.frees, |cell, evidence| {
            let before = evidence.log_odds;
            let hidden = before > 0.0 && (cell.center_cells() - cells.origin).norm() < blind_cells;
            if !hidden {
                evidence.log_odds = (before - free).max(low);
                show(cell, before, evidence.log_odds);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Beam, Stamp};

    fn mapper() -> GridMapper {
        GridMapper::new(MapperConfig::default()).unwrap()
    }

    fn ahead(beam: Beam) -> Scan {
        Scan::new(Stamp::default(), Vector2::zeros(), 0.001, 0.001, vec![beam; 3]).unwrap()
    }

    #[test]
    fn log_odds_are_clamped_so_that_what_moved_is_forgotten() {
        let mut mapper = mapper();
        let point = Vector2::new(2.01, 0.01);
        for _ in 0..100 {
            mapper.insert(Pose2::IDENTITY, &ahead(Beam::Hit { range: 2.01 }));
        }
        assert_eq!(mapper.log_odds_at(point), 3.5);
        for _ in 0..13 {
            mapper.insert(Pose2::IDENTITY, &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(point), Cell::Free);
        assert!(mapper.probability_at(point) < 0.196);
    }

    #[test]
    fn a_saved_grid_goes_on_as_it_was() {
        let mut first = mapper();
        let at = Pose2::new(0.3, -0.2, 0.4);
        for _ in 0..5 {
            first.insert(at, &ahead(Beam::Hit { range: 2.0 }));
        }
        let mut second = GridMapper::from_grid(MapperConfig::default(), first.grid()).unwrap();
        assert_eq!(second.grid(), first.grid());
        second.insert(at, &ahead(Beam::Free { range: 3.0 }));
        let wall = at.transform(Vector2::new(2.0, 0.004));
        assert_eq!(second.grid().at(wall), Cell::Occupied, "one look does not undo it");
    }

    #[test]
    fn what_was_touched_is_on_the_map_until_it_is_seen_to_be_free() {
        let mut mapper = mapper();
        let (pose, touched) = (Pose2::new(1.0, 1.0, std::f64::consts::FRAC_PI_2), Vector2::new(0.99, 1.21));
        mapper.mark_occupied(pose, &[Vector2::new(0.21, 0.01)]);
        assert_eq!(mapper.grid().at(touched), Cell::Occupied);
        for _ in 0..20 {
            mapper.insert(pose, &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(touched), Cell::Occupied, "so near the camera sees nothing");
        let away = Pose2::new(1.0, 0.0, std::f64::consts::FRAC_PI_2);
        for _ in 0..20 {
            mapper.insert(away, &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(touched), Cell::Free);
    }

    #[test]
    fn a_beam_does_not_erase_what_hides_in_the_blind_range() {
        let mut mapper = mapper();
        let (low_box, beyond) = (Vector2::new(1.01, 0.01), Vector2::new(0.76, 0.01));
        mapper.insert(Pose2::IDENTITY, &ahead(Beam::Hit { range: 1.01 }));
        for _ in 0..20 {
            mapper.insert(Pose2::new(0.5, 0.0, 0.0), &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(low_box), Cell::Occupied);
        assert_eq!(mapper.grid().at(beyond), Cell::Free);
        for _ in 0..20 {
            mapper.insert(Pose2::new(-0.5, 0.0, 0.0), &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(low_box), Cell::Free);
    }

    #[test]
    fn a_beam_that_meets_what_hides_in_the_blind_range_says_nothing_of_what_is_behind_it() {
        // A chair's seat: its near edge is too near to be seen, and the floor is seen under it.
        let mut mapper = mapper();
        let at = |x: f64| Vector2::new(x, 0.01);
        for edge in [1.01, 1.41] {
            for _ in 0..3 {
                mapper.insert(Pose2::IDENTITY, &ahead(Beam::Hit { range: edge }));
            }
        }
        for _ in 0..20 {
            mapper.insert(Pose2::new(0.5, 0.0, 0.0), &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(at(0.76)), Cell::Free);
        assert_eq!(mapper.grid().at(at(1.41)), Cell::Occupied, "its far edge");
        assert_eq!(mapper.grid().at(at(2.01)), Cell::Unknown, "beyond");
    }

    #[test]
    fn the_robot_stands_on_free_floor() {
        let mut mapper = mapper();
        mapper.mark_free_disc(Pose2::new(9.0, -7.0, 0.0), 0.1755);
        assert_eq!(mapper.grid().at(Vector2::new(9.1, -7.1)), Cell::Free);
        assert_eq!(mapper.grid().at(Vector2::new(9.2, -7.0)), Cell::Unknown);
        let geometry = *mapper.grid().geometry();
        for (i, &cell) in mapper.grid().cells().iter().enumerate() {
            let distance = (geometry.center(geometry.cell(i)) - Vector2::new(9.0, -7.0)).norm();
            assert_eq!(cell == Cell::Free, distance <= 0.1755, "{distance} m");
        }
        mapper.mark_free_disc(Pose2::new(f64::NAN, 0.0, 0.0), 0.2);
        mapper.mark_free_disc(Pose2::new(1e9, 0.0, 0.0), 0.2);
        mapper.mark_occupied(Pose2::new(0.0, f64::NAN, 0.0), &[Vector2::x()]);
        mapper.mark_occupied(Pose2::IDENTITY, &[Vector2::new(-1e9, 0.0)]);
    }

    #[test]
    fn growing_moves_no_cell_and_the_live_grid_is_the_evidence() {
        let mut mapper = mapper();
        for i in 0..60 {
            let pose = Pose2::new(f64::from(i) * 0.3 - 9.0, f64::from(i) * 0.2, f64::from(i));
            mapper.insert(pose, &ahead(Beam::Hit { range: 2.0 + f64::from(i % 7) }));
        }
        let geometry = *mapper.grid().geometry();
        for (i, (&cell, &p)) in mapper.grid().cells().iter().zip(&mapper.probabilities()).enumerate() {
            let log_odds = mapper.log_odds_at(geometry.center(geometry.cell(i)));
            assert_eq!(cell, mapper.value(log_odds as f32));
            assert!((probability(log_odds) as f32 - p).abs() < 1e-6);
        }
    }

    #[test]
    fn redrawing_from_the_same_poses_gives_the_same_map() {
        let mut mapper = mapper();
        let scan = ahead(Beam::Hit { range: 4.0 });
        let poses: Vec<_> =
            (0..20).map(|i| Pose2::new(0.2 * f64::from(i), 0.0, 0.1 * f64::from(i))).collect();
        for &pose in &poses {
            mapper.insert(pose, &scan);
        }
        let before = mapper.grid().clone();
        mapper.redraw(poses.iter().map(|&pose| (pose, &scan)));
        assert_eq!(*mapper.grid(), before);
        mapper.redraw([]);
        assert!(mapper.grid().cells().iter().all(|&c| c == Cell::Unknown));
    }
}
