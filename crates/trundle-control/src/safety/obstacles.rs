//! Obstacles near the robot: hits of the scan and cells of the map.

use trundle_core::{Cell, OccupancyGrid, Pose2, Scan, Vector2};

/// The newest scan, and the motion since.
#[derive(Debug, Clone, Copy)]
pub struct SafetyScan<'a> {
    /// The scan.
    pub scan: &'a Scan,
    /// `odom_from_base` at the stamp of the scan.
    pub odom_at_scan: Pose2,
    /// `odom_from_base` now.
    pub odom_now: Pose2,
}

/// The map, and the robot's pose in the map.
#[derive(Debug, Clone, Copy)]
pub struct SafetyMemory<'a> {
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// Obstacles observed recently and not yet in the map, map frame, m.
    pub unconfirmed: &'a [Vector2],
    /// `map_from_base` now.
    pub map_from_base: Pose2,
}

/// A round obstacle near the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Obstacle {
    /// Centre of the obstacle, base frame, m.
    pub(super) at: Vector2,
    /// Radius of the obstacle, m: 0 for a hit of a beam, half a side for a cell.
    pub(super) extent: f64,
}

/// Appends the scan's hits within `reach` of the base, in the present base frame, m.
pub(super) fn collect_scan(view: &SafetyScan<'_>, reach: f64, found: &mut Vec<Obstacle>) {
    let now_from_scan = view.odom_now.inverse() * view.odom_at_scan;
    let hits = view.scan.hits().map(|hit| now_from_scan.transform(hit));
    found.extend(hits.filter(|p| p.norm() <= reach).map(|at| Obstacle { at, extent: 0.0 }));
}

/// Appends the unconfirmed obstacles and the occupied cells within `reach` of the base, base frame, m.
pub(super) fn collect_memory(memory: &SafetyMemory<'_>, reach: f64, found: &mut Vec<Obstacle>) {
    let geometry = memory.grid.geometry();
    let base_from_map = memory.map_from_base.inverse();
    let unconfirmed = memory.unconfirmed.iter().map(|at| base_from_map.transform(*at));
    found.extend(unconfirmed.filter(|at| at.norm() <= reach).map(|at| Obstacle { at, extent: 0.0 }));
    let at = (memory.map_from_base.position() - geometry.origin) / geometry.resolution;
    let extent = geometry.resolution / 2.0;
    let cells = reach / geometry.resolution + 0.5;
    let range = |at: f64, size: usize| {
        let (low, high) = ((at - cells).floor().max(0.0), (at + cells).ceil().min(size as f64));
        low as usize..high.max(0.0) as usize
    };
    for row in range(at.y, geometry.height) {
        for col in range(at.x, geometry.width) {
            let cell = trundle_core::CellIndex { col, row };
            if memory.grid.get(cell) == Cell::Occupied {
                let at = base_from_map.transform(geometry.center(cell));
                if at.norm() <= reach + extent {
                    found.push(Obstacle { at, extent });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;
    use trundle_core::{Beam, GridGeometry, Stamp};

    #[test]
    fn the_scan_is_carried_forward() {
        let beams = vec![Beam::Hit { range: 1.0 }, Beam::Hit { range: 9.0 }];
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 0.1, beams).unwrap();
        let view = SafetyScan {
            scan: &scan,
            odom_at_scan: Pose2::new(5.0, 5.0, FRAC_PI_2),
            odom_now: Pose2::new(5.0, 5.4, FRAC_PI_2),
        };
        let mut points = Vec::new();
        collect_scan(&view, 2.0, &mut points);
        assert_eq!(points.len(), 1);
        assert!((points[0].at - Vector2::new(0.6, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn a_cell_counts_if_its_nearest_side_is_within_reach() {
        let geometry = GridGeometry::new(0.1, Vector2::new(-1.0, 2.0), 30, 30).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        grid.set(trundle_core::CellIndex { col: 9, row: 14 }, Cell::Occupied);
        let memory =
            SafetyMemory { grid: &grid, unconfirmed: &[], map_from_base: Pose2::new(0.45, 3.45, 0.0) };
        for (reach, count) in [(0.46, 1), (0.44, 0)] {
            let mut points = Vec::new();
            collect_memory(&memory, reach, &mut points);
            assert_eq!(points.len(), count, "{reach} m");
        }
    }

    #[test]
    fn cells_and_unconfirmed_obstacles_come_in_the_base_frame() {
        let mut grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(30); 30].join("\n")).unwrap();
        grid.set(trundle_core::CellIndex { col: 14, row: 19 }, Cell::Occupied);
        let mut points = Vec::new();
        let memory =
            SafetyMemory { grid: &grid, unconfirmed: &[], map_from_base: Pose2::new(1.45, 1.45, FRAC_PI_2) };
        collect_memory(&memory, 0.6, &mut points);
        assert_eq!(points.len(), 1);
        assert!((points[0].at - Vector2::new(0.5, 0.0)).norm() < 1e-12);
        points.clear();
        collect_memory(&memory, 0.4, &mut points);
        assert!(points.is_empty());
        // An unconfirmed obstacle 0.3 m ahead counts although the map is free; one 1 m ahead is out of reach.
        let unconfirmed = [Vector2::new(1.45, 1.75), Vector2::new(1.45, 2.45)];
        collect_memory(&SafetyMemory { unconfirmed: &unconfirmed, ..memory }, 0.4, &mut points);
        assert_eq!(points.len(), 1);
        assert!((points[0].at - Vector2::new(0.3, 0.0)).norm() < 1e-12);
        points.clear();
        let far = SafetyMemory { grid: &grid, unconfirmed: &[], map_from_base: Pose2::new(-90.0, 1e9, 0.0) };
        collect_memory(&far, 0.6, &mut points);
        assert!(points.is_empty());
    }
}
