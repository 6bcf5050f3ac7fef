//! The world state, input of a decision: by reference, and as a copy for a decision job.

use crate::pose_status::PoseStatus;
use crate::zones::{ZoneMasks, ZoneView};
use std::sync::Arc;
use trundle_control::{MotionHold, MotionSense, SafetyScan};
use trundle_core::{OccupancyGrid, Pose2, PoseEstimate, Scan, Stamp, Vector2};
use trundle_estimation::StationEstimate;
use trundle_planning::MovingObstacle;

/// State of robot and surroundings at a decision.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WorldState<'a> {
    pub(crate) now: Stamp,
    pub(crate) estimate: PoseEstimate,
    pub(crate) pose_status: PoseStatus,
    pub(crate) grid: &'a OccupancyGrid,
    /// The newest scan, with the odometry since its stamp.
    pub(crate) scan: Option<SafetyScan<'a>>,
    /// Stamp of the newest scan with content.
    pub(crate) seen: Option<Stamp>,
    /// Stamp of the newest reading of the wheels. `None` before the first.
    pub(crate) wheels: Option<Stamp>,
    /// A condition of the body under which no wheel may turn.
    pub(crate) hold: Option<MotionHold>,
    /// The source that measures the robot's motion.
    pub(crate) motion: MotionSense,
    pub(crate) dynamic_obstacles: DynamicObstacles<'a>,
    pub(crate) station: StationState,
    pub(crate) zones: ZoneView<'a>,
}

/// The robot's knowledge of the charging station.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct StationState {
    /// Estimated pose of the station. `None` before the first light.
    pub(crate) estimate: Option<StationEstimate>,
    /// Whether the robot is on the contacts of the station.
    pub(crate) is_docked: bool,
}

/// Moving and new obstacles nearby.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct DynamicObstacles<'a> {
    pub(crate) movers: &'a [MovingObstacle],
    /// Hits of new nearby obstacles, not refuted by a later scan, map frame, m.
    pub(crate) unconfirmed: &'a [Vector2],
    /// The map without moving obstacles. `None` without moving obstacles.
    pub(crate) static_grid: Option<&'a OccupancyGrid>,
}

impl<'a> WorldState<'a> {
    /// The map without moving obstacles: the known floor.
    pub(crate) fn floor(&self) -> &'a OccupancyGrid {
        self.dynamic_obstacles.static_grid.unwrap_or(self.grid)
    }

    /// The map for plans: the floor with occupied no-go zones.
    pub(crate) fn permitted_floor(&self) -> &'a OccupancyGrid {
        self.zones.static_grid.or(self.zones.grid).unwrap_or(self.floor())
    }

    /// The map with moving obstacles and with occupied no-go zones.
    pub(crate) fn permitted_grid(&self) -> &'a OccupancyGrid {
        self.zones.grid.unwrap_or(self.grid)
    }
}

/// A copy of a [`WorldState`], for another thread.
#[derive(Debug)]
pub(crate) struct OwnedWorldState {
    now: Stamp,
    estimate: PoseEstimate,
    pose_status: PoseStatus,
    grid: OccupancyGrid,
    /// The last scan, with `odom_from_base` at the scan and now.
    scan: Option<(Scan, Pose2, Pose2)>,
    seen: Option<Stamp>,
    wheels: Option<Stamp>,
    hold: Option<MotionHold>,
    motion: MotionSense,
    movers: Vec<MovingObstacle>,
    unconfirmed: Vec<Vector2>,
    static_grid: Option<OccupancyGrid>,
    station: StationState,
    zone_masks: Option<Arc<ZoneMasks>>,
    /// The grids of [`ZoneView`].
    zone_grids: [Option<OccupancyGrid>; 2],
}

impl From<&WorldState<'_>> for OwnedWorldState {
    fn from(s: &WorldState<'_>) -> Self {
        Self {
            now: s.now,
            estimate: s.estimate,
            pose_status: s.pose_status,
            grid: s.grid.clone(),
            scan: s.scan.map(|seen| (seen.scan.clone(), seen.odom_at_scan, seen.odom_now)),
            seen: s.seen,
            wheels: s.wheels,
            hold: s.hold,
            motion: s.motion,
            movers: s.dynamic_obstacles.movers.to_vec(),
            unconfirmed: s.dynamic_obstacles.unconfirmed.to_vec(),
            static_grid: s.dynamic_obstacles.static_grid.cloned(),
            station: s.station,
            zone_masks: s.zones.masks.cloned(),
            zone_grids: [s.zones.grid.cloned(), s.zones.static_grid.cloned()],
        }
    }
}

impl OwnedWorldState {
    pub(crate) fn now(&self) -> Stamp {
        self.now
    }

    pub(crate) fn as_world_state(&self) -> WorldState<'_> {
        let scan = self.scan.as_ref();
        WorldState {
            now: self.now,
            estimate: self.estimate,
            pose_status: self.pose_status,
            grid: &self.grid,
            scan: scan.map(|(scan, odom_at_scan, odom_now)| SafetyScan {
                scan,
                odom_at_scan: *odom_at_scan,
                odom_now: *odom_now,
            }),
            seen: self.seen,
            wheels: self.wheels,
            hold: self.hold,
            motion: self.motion,
            dynamic_obstacles: DynamicObstacles {
                movers: &self.movers,
                unconfirmed: &self.unconfirmed,
                static_grid: self.static_grid.as_ref(),
            },
            station: self.station,
            zones: ZoneView {
                masks: self.zone_masks.as_ref(),
                grid: self.zone_grids[0].as_ref(),
                static_grid: self.zone_grids[1].as_ref(),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_status::PoseCertainty;
    use trundle_core::{Beam, CellIndex, Twist2};

    const KNOWN: PoseStatus =
        PoseStatus { certainty: PoseCertainty::Known, is_contradicted: true, is_doubtful: false };

    fn estimate() -> PoseEstimate {
        let (pose, covariance) = (Pose2::new(1.0, 2.0, 0.3), nalgebra::Matrix3::identity());
        PoseEstimate { stamp: Stamp::from_nanos(7), pose, twist: Twist2::new(0.1, 0.2), covariance }
    }

    #[test]
    fn a_copy_for_another_thread_holds_what_the_original_held() {
        let grid = OccupancyGrid::from_ascii(0.1, "#.#\n...\n").unwrap();
        let mut still = grid.clone();
        still.set(CellIndex { col: 0, row: 0 }, trundle_core::Cell::Occupied);
        let scan =
            Scan::new(Stamp::from_nanos(5), Vector2::zeros(), 0.0, 0.1, vec![Beam::Unseen; 4]).unwrap();
        let hits = [Vector2::new(0.5, 0.5)];
        let (masks, zoned) = (Arc::default(), OccupancyGrid::from_ascii(0.1, "###\n...\n").unwrap());
        let original = WorldState {
            now: Stamp::from_nanos(9),
            estimate: estimate(),
            pose_status: KNOWN,
            grid: &grid,
            scan: Some(SafetyScan {
                scan: &scan,
                odom_at_scan: Pose2::new(0.1, 0.0, 0.0),
                odom_now: Pose2::new(0.2, 0.0, 0.0),
            }),
            seen: Some(Stamp::from_nanos(4)),
            wheels: Some(Stamp::from_nanos(8)),
            hold: Some(MotionHold::Paused),
            motion: MotionSense::Sight,
            dynamic_obstacles: DynamicObstacles {
                movers: &[],
                unconfirmed: &hits,
                static_grid: Some(&still),
            },
            station: StationState { estimate: None, is_docked: true },
            zones: ZoneView { masks: Some(&masks), grid: Some(&zoned), static_grid: None },
        };
        let owned = OwnedWorldState::from(&original);
        let copy = owned.as_world_state();
        assert_eq!((copy.now, copy.estimate, copy.grid), (original.now, original.estimate, original.grid));
        assert_eq!(copy.pose_status, KNOWN);
        assert_eq!(
            (copy.seen, copy.motion, copy.wheels, copy.hold),
            (original.seen, original.motion, original.wheels, original.hold)
        );
        let (carried, kept) = (copy.scan.unwrap(), original.scan.unwrap());
        assert_eq!(carried.scan, kept.scan);
        assert_eq!((carried.odom_at_scan, carried.odom_now), (kept.odom_at_scan, kept.odom_now));
        assert_eq!(
            (copy.dynamic_obstacles.unconfirmed, copy.dynamic_obstacles.static_grid),
            (&hits[..], Some(&still))
        );
        assert_eq!((owned.now(), copy.station), (original.now, original.station));
        assert_eq!(copy.floor(), &still, "the floor is known without what moves");
        assert_eq!((copy.permitted_floor(), copy.permitted_grid()), (&zoned, &zoned));
        assert!(copy.zones.masks.is_some_and(|copied| Arc::ptr_eq(copied, &masks)));
        let alone = WorldState { zones: ZoneView::default(), ..copy };
        assert_eq!((alone.permitted_floor(), alone.permitted_grid()), (&still, &grid));
        let alone = WorldState { dynamic_obstacles: DynamicObstacles::default(), ..alone };
        assert_eq!((alone.floor(), alone.permitted_floor()), (&grid, &grid));
    }
}
