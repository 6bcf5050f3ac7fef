//! Check of a pose against a map, without a plan.

use crate::masks::keep_out::cut;
use crate::masks::zone_cells::forbidden_cells;
use crate::polygon::robot_shape::RobotShape;
use crate::search::escape::cells_around;
use trundle_core::{Footprint, GridGeometry, OccupancyGrid, Pose2, Zone};
use trundle_grid::{DistanceField, UnknownIs};

/// Check whether the robot fits at a pose: the planner's own decision for [`Plan::GoalInObstacle`](crate::Plan::GoalInObstacle), without a
/// plan. The cost is proportional to the number of cells around the robot.
#[derive(Debug, Clone)]
pub struct FootprintCheck {
    shape: RobotShape,
}

impl FootprintCheck {
    /// The check of a footprint.
    #[must_use]
    pub fn new(footprint: &Footprint) -> Self {
        Self { shape: RobotShape::new(footprint) }
    }

    /// Depth of the footprint's overlap with occupied cells at a pose of the map frame, m; 0 if free. Unknown floor and floor outside the
    /// map are free. A pose that is not finite gives 0.
    #[must_use]
    pub fn overlap(&self, grid: &OccupancyGrid, pose: Pose2) -> f64 {
        if !(pose.x.is_finite() && pose.y.is_finite() && pose.theta.is_finite()) {
            return 0.0;
        }
        let around = cut(grid, cells_around(grid.geometry(), pose.position(), 0.0, self.shape.radius));
        let reach = self.shape.radius + 4.0 * around.geometry().resolution;
        let field = DistanceField::up_to(reach, &around, UnknownIs::Free);
        self.shape.missing_at_goal(&field, pose).unwrap_or(0.0)
    }

    /// Depth of the footprint's overlap with a no-go zone at a pose of the map frame, m; 0 without overlap. The zone covers every cell of
    /// the lattice that it touches, as in the planner's map.
    #[must_use]
    pub fn overlap_with_zone(&self, zone: &Zone, lattice: &GridGeometry, pose: Pose2) -> f64 {
        let (low, high) = zone.bounds();
        let (at, reach) = (pose.position(), self.shape.radius + 2.0 * lattice.resolution);
        let is_near = (0..2).all(|axis| at[axis] >= low[axis] - reach && at[axis] <= high[axis] + reach);
        if !is_near {
            return 0.0;
        }
        let around = cells_around(lattice, at, 0.0, self.shape.radius);
        self.overlap(&forbidden_cells(around, [zone]), pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Plan, Planner, PlannerConfig};
    use trundle_core::{Cell, DifferentialDrive, DriveLimits, Twist2, Vector2};

    fn floor_with_wall() -> OccupancyGrid {
        let art = [&".".repeat(60)[..]; 30].join("\n") + "\n" + &"#".repeat(60);
        OccupancyGrid::from_ascii(0.05, &art).unwrap()
    }

    #[test]
    fn it_decides_as_the_planner_does_for_discs_and_polygons() {
        let grid = floor_with_wall();
        let corners = [[0.3, 0.1], [0.3, -0.1], [-0.1, -0.1], [-0.1, 0.1]].map(|[x, y]| Vector2::new(x, y));
        for footprint in [Footprint::KOBUKI, Footprint::polygon(corners.to_vec()).unwrap()] {
            let check = FootprintCheck::new(&footprint);
            let (limits, drive) = (DriveLimits::KOBUKI, DifferentialDrive::KOBUKI);
            let mut planner = Planner::new(PlannerConfig::default(), &footprint, limits, drive).unwrap();
            let (mut free, mut overlapping) = (0, 0);
            for i in 0..60 {
                let goal = Pose2::new(1.5, 0.05 + 0.008 * f64::from(i), -0.1 * f64::from(i));
                let overlap = check.overlap(&grid, goal);
                match planner.plan(&grid, Pose2::new(0.7, 1.0, 0.0), Twist2::ZERO, goal) {
                    Plan::GoalInObstacle { clearance } => {
                        assert!((overlap + clearance).abs() < 1e-3, "{goal:?}: {overlap}, {clearance}");
                        overlapping += 1;
                    }
                    plan => {
                        assert_eq!(overlap, 0.0, "{goal:?}: {plan}");
                        free += 1;
                    }
                }
            }
            assert!(free > 5 && overlapping > 5, "{free} free, {overlapping} overlapping");
        }
    }

    #[test]
    fn a_zone_is_as_deep_as_its_cells() {
        let check = FootprintCheck::new(&Footprint::Disc { radius: 0.2 });
        let lattice = GridGeometry::new(0.1, Vector2::zeros(), 5, 5).unwrap();
        let outline = vec![[1.0, 1.0], [1.95, 1.0], [1.95, 1.95], [1.0, 1.95]];
        let zone = Zone { id: 1, name: String::new(), kind: trundle_core::ZoneKind::NoGo, outline };
        let overlap = |x: f64| check.overlap_with_zone(&zone, &lattice, Pose2::new(x, 1.5, 0.0));
        assert!((overlap(0.9) - 0.1).abs() < 1e-5, "{}", overlap(0.9));
        assert!((overlap(2.1) - 0.1).abs() < 1e-5, "{}", overlap(2.1));
        assert_eq!((overlap(0.7), overlap(2.3), overlap(1e9)), (0.0, 0.0, 0.0));
        assert!((overlap(1.5) - 0.2).abs() < 1e-9);
    }

    #[test]
    fn there_is_no_obstacle_off_the_map_and_no_place_that_is_no_number() {
        let check = FootprintCheck::new(&Footprint::KOBUKI);
        let grid = OccupancyGrid::filled(*floor_with_wall().geometry(), Cell::Unknown);
        for pose in [Pose2::new(1e5, -1e5, 0.0), Pose2 { x: f64::NAN, y: 0.0, theta: 0.0 }, Pose2::IDENTITY] {
            assert_eq!(check.overlap(&grid, pose), 0.0);
        }
    }
}
