//! The grid of the robot: scan matching, drawing of scans, and the redraw after a correction.

use crate::bumper;
use crate::scan_pose_log::ScanPoseLog;
use crate::schedule::Ticker;
use std::collections::BTreeMap;
use trundle_core::{Cell, Footprint, Invalid, OccupancyGrid, Pose2, Pose3, Scan, Stamp, Vector2};
use trundle_estimation::{MapUncertainty, PoseUncertainty};
use trundle_mapping::{LiveMapper, MapperConfig, ScanMatch, ScanMatchConfig, ScanMatcher};

/// Smallest number of cells of a corrected grid that are redrawn after each command: about 1.5 ms of depth scans. Source: ours.
const MIN_REDRAWN_CELLS: usize = 60_000;
/// Number of commands over which the rest of a corrected grid is redrawn: 1.8 s. Source: ours.
const REDRAW_COMMANDS: usize = 90;

/// The grid with its mapper, scan matcher and logs.
#[derive(Debug)]
pub(super) struct GridMapping {
    pub(super) mapper: LiveMapper,
    matcher: ScanMatcher,
    uncertainty: MapUncertainty,
    pub(super) scan_poses: ScanPoseLog,
    /// Number of commands within which a corrected grid is redrawn.
    redrawn_within: usize,
    due: Ticker,
    /// Radius of the largest disc inside the footprint \[m\].
    inscribed_radius: f64,
    /// Points at which an obstacle presses the bumper, base frame \[m\].
    bumper: Vec<Vector2>,
    /// Number of revisions of earlier, replaced maps.
    earlier_revisions: u64,
    /// Whether a running perception job may search the pose in a replaced map.
    pub(super) voids_search: bool,
}

impl GridMapping {
    /// An empty grid, drawn `map_hz` times per second by a robot of this footprint.
    ///
    /// # Errors
    /// When a number of a configuration is outside its range.
    pub(super) fn new(
        mapping: MapperConfig,
        matching: ScanMatchConfig,
        map_hz: f64,
        footprint: &Footprint,
    ) -> Result<Self, Invalid> {
        Ok(Self {
            mapper: LiveMapper::new(mapping)?,
            matcher: ScanMatcher::new(matching)?,
            uncertainty: MapUncertainty::default(),
            scan_poses: ScanPoseLog::default(),
            redrawn_within: REDRAW_COMMANDS,
            due: Ticker::new(map_hz),
            inscribed_radius: inscribed_radius(footprint),
            bumper: bumper::ahead_of(footprint),
            earlier_revisions: 0,
            voids_search: false,
        })
    }

    /// The grid.
    pub(super) fn grid(&self) -> &OccupancyGrid {
        self.mapper.grid()
    }

    /// Number of the grid's present revision; never decreases.
    pub(super) fn revision(&self) -> u64 {
        self.earlier_revisions + self.mapper.revision()
    }

    /// Replaces the grid by a given one, to which scans are then matched.
    ///
    /// # Errors
    /// When its cells differ from the mapper's; the present grid then stays.
    pub(super) fn replace(&mut self, grid: &OccupancyGrid) -> Result<(), Invalid> {
        let mapper = LiveMapper::on_given(self.mapper.mapper().config().clone(), grid)?;
        self.continue_with(mapper, grid);
        Ok(())
    }

    /// Replaces the grid by one of the robot's own drawing.
    ///
    /// # Errors
    /// As [`GridMapping::replace`].
    pub(super) fn resume(&mut self, grid: &OccupancyGrid) -> Result<(), Invalid> {
        let mapper = LiveMapper::from_grid(self.mapper.mapper().config().clone(), grid)?;
        self.continue_with(mapper, grid);
        Ok(())
    }

    fn continue_with(&mut self, mapper: LiveMapper, grid: &OccupancyGrid) {
        self.earlier_revisions = self.revision() + 1;
        self.mapper = mapper;
        self.uncertainty = MapUncertainty::of_certain(occupied(grid));
        self.scan_poses = ScanPoseLog::default();
    }

    /// Whether a scan at `now` is due for drawing, by the rate of the map.
    pub(super) fn is_due(&mut self, now: Stamp) -> bool {
        self.due.due(now)
    }

    /// The pose at which the scan fits the grid, near `guess`.
    pub(super) fn matched(&self, scan: &Scan, guess: Pose2) -> Option<ScanMatch> {
        self.matcher.refine(self.mapper.matched_map(), scan, guess)
    }

    /// Uncertainty of the grid at a pose that is matched by a scan; `None` where nothing was drawn.
    pub(super) fn uncertainty_at(&self, pose: Pose2, scan: &Scan) -> Option<PoseUncertainty> {
        self.uncertainty.at(pose, scan.hits().map(|hit| pose.transform(hit)))
    }

    /// Draws a scan taken at `pose` of this uncertainty, and the floor under the robot.
    pub(super) fn integrate_scan(&mut self, pose: Pose2, uncertainty: &PoseUncertainty, scan: &Scan) {
        let hits = scan.hits().map(|hit| pose.transform(hit));
        self.uncertainty.note(pose, uncertainty, hits.filter(|hit| !self.mapper.is_given_at(*hit)));
        self.mapper.insert(pose, scan);
        self.mapper.mark_free_disc(pose, self.inscribed_radius);
    }

    /// Marks the obstacle of a pressed bumper, since the camera may not see it.
    pub(super) fn mark_touch(&mut self, pose: Pose2) {
        self.mapper.mark_occupied(pose, &self.bumper);
    }

    /// Records the pose of a drawn scan in the visual map. Returns whether the log was thinned.
    pub(super) fn note_scan_pose(&mut self, stamp: Stamp, visual_from_camera: Pose3) -> bool {
        self.scan_poses.note(stamp, visual_from_camera, || self.mapper.logged_stamps())
    }

    /// Applies a corrected visual trajectory. Returns whether the grid is redrawn from the corrected poses of its scans.
    pub(super) fn correct(
        &mut self,
        trajectory: &[(Stamp, Pose3)],
        visual_base: impl Fn(&Pose3) -> Option<Pose2>,
    ) -> bool {
        let moved: BTreeMap<Stamp, Pose2> = self.scan_poses.follow(trajectory, visual_base);
        let redrawn =
            self.mapper.correct(|stamp, pose| moved.get(&stamp).map_or(pose, |moved| *moved * pose));
        if redrawn > 0 {
            self.redrawn_within = REDRAW_COMMANDS;
        }
        redrawn > 0
    }

    /// Redraws a slice of a corrected grid.
    pub(super) fn redraw_slice(&mut self) {
        self.mapper.work_within(MIN_REDRAWN_CELLS, self.redrawn_within);
        self.redrawn_within = self.redrawn_within.saturating_sub(1).max(1);
    }
}

/// The centres of the occupied cells, m.
fn occupied(grid: &OccupancyGrid) -> impl Iterator<Item = Vector2> + '_ {
    let geometry = grid.geometry();
    let cells = (0..geometry.len()).map(|k| geometry.cell(k));
    cells.filter(|cell| grid.get(*cell) == Cell::Occupied).map(|cell| geometry.center(cell))
}

/// Radius of the largest disc around the base's origin inside the footprint, m; 0 if the origin is outside.
pub(super) fn inscribed_radius(footprint: &Footprint) -> f64 {
    match footprint {
        Footprint::Disc { radius } => *radius,
        Footprint::Polygon { corners } => {
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            let from_side = |(a, b): (&Vector2, &Vector2)| (b - a).perp(&-a) / (b - a).norm();
            sides.map(from_side).fold(f64::INFINITY, f64::min).max(0.0)
        }
    }
}
