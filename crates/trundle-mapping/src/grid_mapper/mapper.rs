//! Occupancy grid from scans at known poses.

use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Scan, Vector2};
use trundle_grid::{
    GridCell, LogOddsGrid, MapperConfig, PublishedGrid, ScanCells, Thresholds, log_odds, probability,
};

/// Occupancy grid from scans at known poses.
///
/// Problem: the occupied cells of the floor, given noisy scans and known poses. Each cell is an independent binary variable, and every scan
/// adds its log-odds (Moravec and Elfes 1985; Thrun, Probabilistic Robotics, ch. 9). A hit raises the log-odds of its cell; a free ray
/// lowers those of the cells that it passes. Each cell changes at most once per scan. Cost: one step per cell along each ray. The cost of a
/// scan does not grow with the run, except that a larger bounding box needs a new layout of the published grid.
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
    thresholds: Thresholds<f32>,
    published: PublishedGrid,
    cells: ScanCells,
    /// Whether the published grid follows the evidence.
    publishes: bool,
}

/// Number of cells that one scan changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Insertion {
    /// Cells with hits.
    pub hits: usize,
    /// Cells that rays passed freely.
    pub free: usize,
    /// Rays that end beyond the map's extent. All rays when the pose is not finite.
    pub ignored_beams: usize,
}

impl GridMapper {
    /// Empty map around the origin of the map frame.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: MapperConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let mut evidence = LogOddsGrid::default();
        evidence.reach(GridCell { x: -1, y: -1 });
        evidence.reach(GridCell { x: 0, y: 0 });
        Ok(Self::over(config, evidence, true))
    }

    /// Map of this evidence whose published grid is still unknown everywhere.
    fn over(config: MapperConfig, evidence: LogOddsGrid, publishes: bool) -> Self {
        let (first, size) = evidence.tile_bounds();
        let thresholds = Thresholds {
            occupied_above: log_odds(config.occupied_above) as f32,
            free_below: log_odds(config.free_below) as f32,
        };
        let published = PublishedGrid::new(config.resolution, LogOddsGrid::TILE_SIDE, first, size);
        Self { config, evidence, thresholds, published, cells: ScanCells::default(), publishes }
    }

    /// Inserts `scan`, taken with the base at `map_from_base`.
    pub fn insert(&mut self, map_from_base: Pose2, scan: &Scan) -> Insertion {
        self.published.begin_revision();
        let mut cells = std::mem::take(&mut self.cells);
        cells.rasterise(&self.config, map_from_base, scan, |cell| self.evidence.log_odds(cell) > 0.0);
        if let Some((low, high)) = cells.reach() {
            self.grow(low, high);
        }
        self.update(&cells);
        let (hits, free) = (cells.hits.len(), cells.free.len());
        let ignored_beams = cells.ignored_beams;
        self.cells = cells;
        Insertion { hits, free, ignored_beams }
    }

    /// Sets a disc of `radius` m about a pose to free with the lowest log-odds: the footprint of the robot.
    pub fn mark_free_disc(&mut self, map_from_base: Pose2, radius: f64) {
        let limit = self.config.half_extent - radius;
        if !(radius > 0.0 && map_from_base.x.abs() <= limit && map_from_base.y.abs() <= limit) {
            return;
        }
        self.published.begin_revision();
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

    /// Sets the cells at these points (base frame, m) to occupied with the highest log-odds: contacts of the bumper.
    pub fn mark_occupied(&mut self, map_from_base: Pose2, points: &[Vector2]) {
        self.published.begin_revision();
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

    /// Clears the map and inserts scans at corrected poses. The bounding box does not change.
    pub fn redraw<'a>(&mut self, scans: impl IntoIterator<Item = (Pose2, &'a Scan)>) {
        let (low, high) = self.corners();
        self.evidence = LogOddsGrid::default();
        self.evidence.reach(low);
        self.evidence.reach(high);
        let empty = self.evidence.clone();
        self.published.begin_revision();
        self.publish_all(&empty);
        for (map_from_base, scan) in scans {
            self.insert(map_from_base, scan);
        }
    }

    /// The three-valued map. Its bounding box grows in steps of 64 cells and never shrinks.
    pub fn grid(&self) -> &OccupancyGrid {
        self.published.grid()
    }

    /// Number of scans, discs, contacts and redraws that may have changed [`GridMapper::grid`].
    pub fn revision(&self) -> u64 {
        self.published.revision()
    }

    /// Tiles of 64 x 64 cells of [`GridMapper::grid`] that changed after `revision`: lowest cell and (columns, rows) of each.
    pub fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        self.published.changes_since(revision)
    }

    /// Map with the settings and the bounding box of this one and with other evidence. The map publishes no cell before
    /// [`GridMapper::replace_with`] adopts it.
    pub(crate) fn with_evidence(&self, mut evidence: LogOddsGrid) -> Self {
        let (low, high) = self.corners();
        evidence.reach(low);
        evidence.reach(high);
        Self::over(self.config.clone(), evidence, false)
    }

    /// Replaces the evidence by that of another map, as one revision of the published grid.
    pub(crate) fn replace_with(&mut self, mut other: Self) {
        let (low, high) = self.corners();
        other.grow(low, high);
        self.publish_bounds(&other.evidence);
        self.published.begin_revision();
        self.publish_all(&other.evidence);
        self.evidence = other.evidence;
    }

    /// Evidence of all cells. A clone shares the tiles.
    pub fn evidence(&self) -> &LogOddsGrid {
        &self.evidence
    }

    /// The configuration.
    pub fn config(&self) -> &MapperConfig {
        &self.config
    }

    /// Log-odds of occupancy at a point of the map frame (m); 0 for unknown.
    pub fn log_odds_at(&self, point: Vector2) -> f64 {
        let cell = GridCell::containing(point / self.config.resolution);
        f64::from(self.evidence.log_odds(cell))
    }

    /// Probability of occupancy at a point of the map frame (m); 0.5 for unknown.
    pub fn probability_at(&self, point: Vector2) -> f64 {
        probability(self.log_odds_at(point))
    }

    /// Probabilities of the cells of [`GridMapper::grid`], in the grid's order, for pictures.
    pub fn probabilities(&self) -> Vec<f32> {
        let (corner, (cols, rows)) = self.evidence.bounds();
        let cell = |i: usize| GridCell { x: corner.x + (i % cols) as i32, y: corner.y + (i / cols) as i32 };
        (0..cols * rows).map(|i| probability(f64::from(self.evidence.log_odds(cell(i)))) as f32).collect()
    }

    /// Thresholds of the published classes.
    pub(crate) fn thresholds(&self) -> Thresholds<f32> {
        self.thresholds
    }

    /// Lowest and highest cell of the bounding box.
    fn corners(&self) -> (GridCell, GridCell) {
        let (low, (cols, rows)) = self.evidence.bounds();
        (low, GridCell { x: low.x + cols as i32 - 1, y: low.y + rows as i32 - 1 })
    }

    fn set(&mut self, cell: GridCell, log_odds: f32) {
        self.evidence.entry(cell).log_odds = log_odds;
        if self.publishes {
            self.published.set(cell, self.thresholds.classify(log_odds));
        }
    }

    fn grow(&mut self, low: GridCell, high: GridCell) {
        self.evidence.reach(low);
        self.evidence.reach(high);
        if self.publishes {
            let (first, (cols, rows)) = self.evidence.tile_bounds();
            self.published.reach(first, (first.0 + cols as i32 - 1, first.1 + rows as i32 - 1));
        }
    }

    /// Grows the published grid to the bounding box of `evidence`.
    fn publish_bounds(&mut self, evidence: &LogOddsGrid) {
        let (first, (cols, rows)) = evidence.tile_bounds();
        self.published.reach(first, (first.0 + cols as i32 - 1, first.1 + rows as i32 - 1));
    }

    /// Publishes all cells of `evidence`, whose bounding box equals that of the published grid.
    fn publish_all(&mut self, evidence: &LogOddsGrid) {
        let (corner, (cols, rows)) = evidence.bounds();
        for (row, col) in (0..rows as i32).flat_map(|row| (0..cols as i32).map(move |col| (row, col))) {
            let cell = GridCell { x: corner.x + col, y: corner.y + row };
            self.published.set(cell, self.thresholds.classify(evidence.log_odds(cell)));
        }
    }

    fn update(&mut self, cells: &ScanCells) {
        let config = &self.config;
        let (published, thresholds, publishes) = (&mut self.published, self.thresholds, self.publishes);
        // The class of a cell rarely changes: the published grid is touched only then.
        let mut publish = |cell: GridCell, before: f32, now: f32| {
            if publishes && thresholds.classify(before) != thresholds.classify(now) {
                published.set(cell, thresholds.classify(now));
            }
        };
        for hit in &cells.hits {
            let evidence = self.evidence.entry(hit.cell);
            let before = evidence.log_odds;
            evidence.log_odds = (before + config.hit as f32).min(config.clamp_high as f32);
            evidence.add_hit(hit.mean_within());
            publish(hit.cell, before, evidence.log_odds);
        }
        let blind_cells = config.blind_range / config.resolution;
        let (free, low) = (config.free as f32, -config.clamp_low as f32);
        self.evidence.each_entry(&cells.free, |cell, evidence| {
            let before = evidence.log_odds;
            let hidden = before > 0.0 && (cell.center_cells() - cells.origin).norm() < blind_cells;
            if !hidden {
                evidence.log_odds = (before - free).max(low);
                publish(cell, before, evidence.log_odds);
            }
        });
    }

    /// Sets a cell to the clamped evidence of its class; `surface` adds a hit at the centre of the cell. The bounding box must contain the
    /// cell.
    pub(super) fn set_known(&mut self, cell: GridCell, value: Cell, surface: bool) {
        let log_odds = match value {
            Cell::Unknown => return,
            Cell::Free => -self.config.clamp_low as f32,
            Cell::Occupied => self.config.clamp_high as f32,
        };
        self.set(cell, log_odds);
        if surface {
            self.evidence.entry(cell).add_hit(Vector2::repeat(0.5));
        }
    }

    /// Begins a revision with a bounding box that contains these cells.
    pub(super) fn begin_with(&mut self, low: GridCell, high: GridCell) {
        self.grow(low, high);
        self.published.begin_revision();
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
    fn clamped_log_odds_let_a_moved_obstacle_disappear() {
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
    fn a_map_from_a_saved_grid_publishes_the_same_grid() {
        let mut first = mapper();
        let at = Pose2::new(0.3, -0.2, 0.4);
        for _ in 0..5 {
            first.insert(at, &ahead(Beam::Hit { range: 2.0 }));
        }
        let mut second = GridMapper::from_grid(MapperConfig::default(), first.grid()).unwrap();
        assert_eq!(second.grid(), first.grid());
        second.insert(at, &ahead(Beam::Free { range: 3.0 }));
        let wall = at.transform(Vector2::new(2.0, 0.004));
        assert_eq!(second.grid().at(wall), Cell::Occupied, "one free ray does not clear the wall");
    }

    #[test]
    fn a_contact_stays_on_the_map_until_rays_clear_it() {
        let mut mapper = mapper();
        let (pose, contact) = (Pose2::new(1.0, 1.0, std::f64::consts::FRAC_PI_2), Vector2::new(0.99, 1.21));
        mapper.mark_occupied(pose, &[Vector2::new(0.21, 0.01)]);
        assert_eq!(mapper.grid().at(contact), Cell::Occupied);
        for _ in 0..20 {
            mapper.insert(pose, &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(contact), Cell::Occupied, "a contact in the blind range stays");
        let away = Pose2::new(1.0, 0.0, std::f64::consts::FRAC_PI_2);
        for _ in 0..20 {
            mapper.insert(away, &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(contact), Cell::Free);
    }

    #[test]
    fn a_ray_clears_no_obstacle_in_the_blind_range() {
        let mut mapper = mapper();
        let (low_box, behind) = (Vector2::new(1.01, 0.01), Vector2::new(0.76, 0.01));
        mapper.insert(Pose2::IDENTITY, &ahead(Beam::Hit { range: 1.01 }));
        for _ in 0..20 {
            mapper.insert(Pose2::new(0.5, 0.0, 0.0), &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(low_box), Cell::Occupied);
        assert_eq!(mapper.grid().at(behind), Cell::Free);
        for _ in 0..20 {
            mapper.insert(Pose2::new(-0.5, 0.0, 0.0), &ahead(Beam::Free { range: 3.0 }));
        }
        assert_eq!(mapper.grid().at(low_box), Cell::Free);
    }

    #[test]
    fn a_ray_over_an_obstacle_in_the_blind_range_clears_nothing_behind_it() {
        // The seat of a chair: its near edge is in the blind range, and the floor below it is in the camera's view.
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
        assert_eq!(mapper.grid().at(at(1.41)), Cell::Occupied, "far edge of the seat");
        assert_eq!(mapper.grid().at(at(2.01)), Cell::Unknown, "behind the seat");
    }

    #[test]
    fn the_footprint_of_the_robot_is_free() {
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
    fn growth_moves_no_cell_and_the_published_grid_follows_the_evidence() {
        let mut mapper = mapper();
        for i in 0..60 {
            let pose = Pose2::new(f64::from(i) * 0.3 - 9.0, f64::from(i) * 0.2, f64::from(i));
            mapper.insert(pose, &ahead(Beam::Hit { range: 2.0 + f64::from(i % 7) }));
        }
        let geometry = *mapper.grid().geometry();
        for (i, (&cell, &p)) in mapper.grid().cells().iter().zip(&mapper.probabilities()).enumerate() {
            let log_odds = mapper.log_odds_at(geometry.center(geometry.cell(i)));
            assert_eq!(cell, mapper.thresholds().classify(log_odds as f32));
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
