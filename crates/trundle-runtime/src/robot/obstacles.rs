//! Dynamic obstacles nearby, tracked from scan to scan.

use crate::world_state::DynamicObstacles;
use trundle_core::{Invalid, OccupancyGrid, Pose2, Scan, Stamp, Vector2};
use trundle_planning::{MovingObstacle, MovingObstacleTracker, ObstacleTrackerConfig};

/// Distance within which a new obstacle is kept until a scan shows free space there \[m\]: more than the braking distance. Source: ours.
const NEARBY_OBSTACLE_M: f64 = 1.5;
/// Age of the last scan \[s\] beyond which the position of a moving obstacle is unknown. Source: ours.
pub(super) const MAX_TRACK_AGE_S: f64 = 1.0;

/// Dynamic obstacles: tracked at each scan, predicted between scans.
#[derive(Debug)]
pub(super) struct ObstacleTracks {
    tracker: MovingObstacleTracker,
    /// Moving obstacles, predicted to the newest decision.
    pub(super) movers: Vec<MovingObstacle>,
    /// The grid without moving obstacles; `None` without moving obstacles.
    pub(super) static_grid: Option<OccupancyGrid>,
    /// Hits of unconfirmed obstacles, map frame \[m\].
    unconfirmed: Vec<Vector2>,
}

impl ObstacleTracks {
    /// A tracker without obstacles.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub(super) fn new(config: ObstacleTrackerConfig) -> Result<Self, Invalid> {
        let tracker = MovingObstacleTracker::new(config)?;
        Ok(Self { tracker, movers: Vec::new(), static_grid: None, unconfirmed: Vec::new() })
    }

    /// The dynamic obstacles for a decision.
    pub(super) fn view(&self) -> DynamicObstacles<'_> {
        DynamicObstacles {
            movers: &self.movers,
            unconfirmed: &self.unconfirmed,
            static_grid: self.static_grid.as_ref(),
        }
    }

    /// Updates the tracks by a scan taken at `pose`, map frame.
    pub(super) fn add_scan(&mut self, pose: Pose2, scan: &Scan, grid: &OccupancyGrid) {
        let now = scan.stamp();
        self.tracker.add_scan(pose, scan);
        self.movers = self.tracker.moving_obstacles(now);
        self.unconfirmed = self.tracker.unconfirmed_hits(now, pose.position(), NEARBY_OBSTACLE_M);
        self.static_grid = (!self.movers.is_empty()).then(|| self.tracker.static_grid(grid));
    }

    /// Skips a scan at an unknown pose. Hits of unconfirmed obstacles are in the map frame and expire.
    pub(super) fn skip_scan(&mut self, now: Stamp, position: Vector2) {
        self.unconfirmed = self.tracker.unconfirmed_hits(now, position, NEARBY_OBSTACLE_M);
        self.clear_movers();
    }

    /// Predicts the obstacles to `now`; without recent scans moving obstacles are dropped.
    pub(super) fn forecast(&mut self, scanned: Option<Stamp>, now: Stamp) {
        if self.movers.is_empty() {
            return;
        }
        self.movers = self.tracker.moving_obstacles(now);
        if self.movers.is_empty() || scanned.is_none_or(|scanned| now - scanned > MAX_TRACK_AGE_S) {
            self.clear_movers();
        }
    }

    /// Drops all obstacles, since static objects seem to move after a jump of the pose.
    pub(super) fn clear(&mut self) {
        self.tracker.clear();
        self.unconfirmed.clear();
        self.clear_movers();
    }

    fn clear_movers(&mut self) {
        self.movers.clear();
        self.static_grid = None;
    }

    /// A state during tracking, for tests.
    #[cfg(test)]
    pub(super) fn tracking(
        tracker: MovingObstacleTracker,
        movers: Vec<MovingObstacle>,
        static_grid: OccupancyGrid,
    ) -> Self {
        Self { tracker, movers, static_grid: Some(static_grid), unconfirmed: Vec::new() }
    }
}
