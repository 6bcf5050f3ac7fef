//! The zones of a running robot: the map with no-go zones occupied, speed limits, and the exit from a no-go zone.
//!
//! A no-go zone is an obstacle for plans, not for the safety monitor. A robot deeper in a zone than the planner's escape distance may leave
//! it. During the exit, this zone is floor with high cost and low speed, and all other zones apply. A goal in a no-go zone is refused also
//! during the exit.

use std::sync::Arc;
use trundle_core::{
    Cell, Footprint, GridGeometry, MapAnnotations, OccupancyGrid, Pose2, Stamp, Twist2, Zone, ZoneKind,
};
use trundle_planning::{CostMask, FootprintCheck, SpeedMask, forbid, forbidden_cells, slow_speeds};

/// Highest speed in a no-go zone during the exit \[m/s\]. Source: ours; a slow walk of a person beside the robot.
const LEAVING_SPEED_M_S: f64 = 0.15;
/// Cost of the cells of a zone that the robot leaves, in per cent of the largest. Source: ours.
const LEAVING_COST_PERCENT: u8 = 100;

/// The zones of a running robot.
#[derive(Debug)]
pub(crate) struct RobotZones {
    annotations: Arc<MapAnnotations>,
    check: FootprintCheck,
    /// Overlap with an obstacle up to which the planner can leave the obstacle \[m\].
    escape: f64,
    /// The no-go zones that contain the robot and that it is leaving.
    left: Vec<u32>,
    masks: Option<Arc<ZoneMasks>>,
    floor: Option<ZonedFloor>,
}

/// Demands of the zones on the planner.
#[derive(Debug, Default)]
pub(crate) struct ZoneMasks {
    /// Version, from 1; increases with each change.
    pub(crate) version: u64,
    /// The limits of the slow zones.
    pub(crate) speeds: Option<SpeedMask>,
    /// The costs of zones that the robot leaves.
    pub(crate) costs: Option<CostMask>,
    no_go: Vec<Zone>,
    check: Option<(FootprintCheck, GridGeometry)>,
}

/// The zones of the map as they apply to the robot at its present pose.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ZoneView<'a> {
    /// Speed limits and costs, and the no-go zones. `None` before the first zone.
    pub(crate) masks: Option<&'a Arc<ZoneMasks>>,
    /// The map with the no-go zones occupied. `None` if no zone forbids any cell.
    pub(crate) grid: Option<&'a OccupancyGrid>,
    /// The map without moving obstacles, its no-go zones occupied. `None` without moving obstacles.
    pub(crate) static_grid: Option<&'a OccupancyGrid>,
}

/// The map that zones are drawn over.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ZonedMap<'a> {
    pub(crate) grid: &'a OccupancyGrid,
    /// Revision of the grid.
    pub(crate) revision: u64,
    /// The grid without moving obstacles.
    pub(crate) static_grid: Option<&'a OccupancyGrid>,
    /// Stamp of the scan of `static_grid`.
    pub(crate) scanned: Option<Stamp>,
}

/// The map with the no-go zones occupied, and its inputs.
#[derive(Debug)]
struct ZonedFloor {
    key: (u64, u64, bool, Option<Stamp>),
    grid: OccupancyGrid,
    static_grid: Option<OccupancyGrid>,
}

impl RobotZones {
    /// No zones, for a robot with this footprint; `escape` as `room.escape_m` of the planner \[m\].
    pub(crate) fn new(footprint: &Footprint, escape: f64) -> Self {
        Self {
            annotations: Arc::default(),
            check: FootprintCheck::new(footprint),
            escape,
            left: Vec::new(),
            masks: None,
            floor: None,
        }
    }

    /// Replaces the present zones.
    pub(crate) fn set(&mut self, annotations: MapAnnotations) {
        let are_same = self.annotations.zones == annotations.zones;
        self.annotations = Arc::new(annotations);
        if !are_same {
            self.left.clear();
            self.floor = None;
            self.masks = Some(self.masks_after_change(None));
        }
    }

    pub(crate) fn annotations(&self) -> &Arc<MapAnnotations> {
        &self.annotations
    }

    /// The zones as they apply to the robot.
    pub(crate) fn view(&self) -> ZoneView<'_> {
        ZoneView {
            masks: self.masks.as_ref(),
            grid: self.floor.as_ref().map(|floor| &floor.grid),
            static_grid: self.floor.as_ref().and_then(|floor| floor.static_grid.as_ref()),
        }
    }

    /// A person's twist, scaled to the speed limit of the zone at a pose. The radius of the circle does not change.
    pub(crate) fn slowed(&self, twist: Twist2, pose: Pose2) -> Twist2 {
        let speeds = self.masks.as_ref().and_then(|masks| masks.speeds.as_ref());
        let limit = speeds.map_or(f64::INFINITY, |speeds| speeds.limit(pose.position()));
        let part = (limit / twist.v.abs()).min(1.0);
        if part < 1.0 { Twist2::new(twist.v * part, twist.omega * part) } else { twist }
    }

    /// Updates the zones by the robot's pose and the newest map.
    pub(crate) fn update(&mut self, pose: Pose2, map: &ZonedMap<'_>) {
        if !self.annotations.zones.iter().any(|zone| zone.kind == ZoneKind::NoGo) {
            return;
        }
        let lattice = *map.grid.geometry();
        let left: Vec<u32> =
            self.no_go().filter(|zone| self.leaves(zone, &lattice, pose)).map(|zone| zone.id).collect();
        let is_first = self.masks.as_ref().is_none_or(|masks| masks.check.is_none());
        if is_first || left != self.left {
            self.left = left;
            self.masks = Some(self.masks_after_change(Some(lattice)));
        }
        let version = self.masks.as_ref().map_or(0, |masks| masks.version);
        let key = (
            version,
            map.revision,
            map.static_grid.is_some(),
            map.scanned.filter(|_| map.static_grid.is_some()),
        );
        if self.floor.as_ref().is_none_or(|floor| floor.key != key) {
            let (grid, static_grid) = (self.over(map.grid), map.static_grid.map(|grid| self.over(grid)));
            self.floor = Some(ZonedFloor { key, grid, static_grid });
        }
    }

    fn no_go(&self) -> impl Iterator<Item = &Zone> {
        self.annotations.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo)
    }

    /// Whether the robot leaves a zone: it was too deep in the zone for plans with the zone as an obstacle, and is not out yet.
    fn leaves(&self, zone: &Zone, lattice: &GridGeometry, pose: Pose2) -> bool {
        let overlap = self.check.overlap_with_zone(zone, lattice, pose);
        let is_escaping = self.left.contains(&zone.id);
        overlap > if is_escaping { 0.0 } else { self.escape }
    }

    /// A grid with all no-go zones occupied except those that contain the robot.
    fn over(&self, grid: &OccupancyGrid) -> OccupancyGrid {
        let mut over = grid.clone();
        self.no_go().filter(|zone| !self.left.contains(&zone.id)).for_each(|zone| forbid(&mut over, zone));
        over
    }

    /// The masks of the next version; without a lattice no map exists to define the cells.
    fn masks_after_change(&self, lattice: Option<GridGeometry>) -> Arc<ZoneMasks> {
        let left: Vec<&Zone> = self.no_go().filter(|zone| self.left.contains(&zone.id)).collect();
        let costly =
            left.iter().map(|zone| Zone { kind: ZoneKind::Slow(LEAVING_SPEED_M_S), ..(*zone).clone() });
        let slow: Vec<Zone> = self.annotations.zones.iter().cloned().chain(costly).collect();
        let costs = lattice.filter(|_| !left.is_empty()).and_then(|lattice| {
            let mask = forbidden_cells(lattice, left.iter().copied());
            let cost = |cell: &Cell| if *cell == Cell::Occupied { LEAVING_COST_PERCENT } else { 0 };
            CostMask::new(lattice, mask.cells().iter().map(cost).collect()).ok()
        });
        Arc::new(ZoneMasks {
            version: self.masks.as_ref().map_or(1, |masks| masks.version + 1),
            speeds: slow_speeds(MASK_RESOLUTION_M, &slow),
            costs,
            no_go: self.no_go().cloned().collect(),
            check: lattice.map(|lattice| (self.check.clone(), lattice)),
        })
    }
}

/// Side of the cells of speed limits \[m\]. Source: ours; the default size of the map's cells.
const MASK_RESOLUTION_M: f64 = 0.05;

impl ZoneMasks {
    /// The first no-go zone that the robot's outline would reach into at a pose.
    pub(crate) fn no_go_zone_at(&self, pose: Pose2) -> Option<&Zone> {
        let (check, lattice) = self.check.as_ref()?;
        self.no_go.iter().find(|zone| check.overlap_with_zone(zone, lattice, pose) > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    fn zone(id: u32, kind: ZoneKind, low: [f64; 2], high: [f64; 2]) -> Zone {
        let outline = vec![low, [high[0], low[1]], high, [low[0], high[1]]];
        Zone { id, name: String::new(), kind, outline }
    }

    /// Known floor, 6 x 4 m.
    fn floor() -> OccupancyGrid {
        OccupancyGrid::from_ascii(0.05, &vec![".".repeat(120); 80].join("\n")).unwrap()
    }

    fn zones(list: Vec<Zone>) -> RobotZones {
        let mut zones = RobotZones::new(&Footprint::KOBUKI, 0.06);
        zones.set(MapAnnotations { zones: list, places: vec![] });
        zones
    }

    fn map(grid: &OccupancyGrid, revision: u64) -> ZonedMap<'_> {
        ZonedMap { grid, revision, static_grid: None, scanned: None }
    }

    #[test]
    fn a_no_go_zone_is_an_obstacle_of_plans_and_follows_the_map() {
        let (mut grid, at) = (floor(), Vector2::new(3.02, 2.02));
        let mut zones = zones(vec![zone(1, ZoneKind::NoGo, [3.0, 2.0], [4.0, 3.0])]);
        zones.update(Pose2::new(1.0, 1.0, 0.0), &map(&grid, 1));
        assert_eq!(zones.view().grid.unwrap().at(at), Cell::Occupied);
        let version = zones.view().masks.unwrap().version;
        grid.set(grid.geometry().cell_at(Vector2::new(1.0, 3.0)).unwrap(), Cell::Occupied);
        zones.update(Pose2::new(1.0, 1.0, 0.0), &map(&grid, 2));
        assert_eq!(zones.view().grid.unwrap().at(Vector2::new(1.0, 3.0)), Cell::Occupied);
        assert_eq!(zones.view().masks.unwrap().version, version, "the zones are the same");
        zones.set(MapAnnotations::default());
        zones.update(Pose2::new(1.0, 1.0, 0.0), &map(&grid, 2));
        assert!(zones.view().grid.is_none() && zones.view().masks.unwrap().version > version);
    }

    #[test]
    fn a_robot_in_a_no_go_zone_leaves_it_slowly_and_all_others_count() {
        let grid = floor();
        let mut zones = zones(vec![
            zone(1, ZoneKind::NoGo, [1.0, 1.0], [2.0, 2.0]),
            zone(2, ZoneKind::NoGo, [3.0, 1.0], [4.0, 2.0]),
        ]);
        let inside = Pose2::new(1.5, 1.5, 0.0);
        zones.update(inside, &map(&grid, 1));
        let view = zones.view();
        let cells = |view: ZoneView<'_>| [1.5, 3.5].map(|x| view.grid.unwrap().at(Vector2::new(x, 1.5)));
        assert_eq!(cells(view), [Cell::Free, Cell::Occupied]);
        let masks = view.masks.unwrap();
        assert!((masks.speeds.as_ref().unwrap().limit(inside.position()) - LEAVING_SPEED_M_S).abs() < 1e-6);
        assert!(masks.costs.is_some());
        assert_eq!(masks.no_go_zone_at(Pose2::new(1.4, 1.6, 0.0)).unwrap().id, 1, "no goal in it");
        // The outline still overlaps the zone.
        zones.update(Pose2::new(2.1, 1.5, 0.0), &map(&grid, 1));
        assert_eq!(cells(zones.view()), [Cell::Free, Cell::Occupied]);
        zones.update(Pose2::new(2.3, 1.5, 0.0), &map(&grid, 1));
        assert_eq!(cells(zones.view()), [Cell::Occupied, Cell::Occupied]);
        assert!(zones.view().masks.unwrap().costs.is_none());
        // At the border of the zone the planner leaves it like any obstacle.
        zones.update(Pose2::new(2.15, 1.5, 0.0), &map(&grid, 1));
        assert_eq!(cells(zones.view()), [Cell::Occupied, Cell::Occupied]);
    }

    #[test]
    fn a_person_drives_slowly_in_a_slow_zone_on_the_same_circle() {
        let zones = zones(vec![zone(1, ZoneKind::Slow(0.1), [1.0, 1.0], [2.0, 2.0])]);
        let slowed = |x: f64, v: f64| zones.slowed(Twist2::new(v, 0.8), Pose2::new(x, 1.5, 0.0));
        let slow = slowed(1.5, -0.4);
        assert!((slow.v + 0.1).abs() < 1e-6 && (slow.omega - 0.2).abs() < 1e-6, "{slow:?}");
        assert_eq!(slowed(2.5, 0.4), Twist2::new(0.4, 0.8));
        assert_eq!(slowed(1.5, 0.0), Twist2::new(0.0, 0.8), "turns on the spot");
    }
}
