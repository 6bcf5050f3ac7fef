//! Contact has one definition for planning and for docking.

use trundle_core::{
    Cell, CellIndex, DifferentialDrive, DriveLimits, Footprint, GridGeometry, OccupancyGrid, Pose2, Twist2,
    Vector2,
};
use trundle_docking::{DockingConfig, DockingPlan, DockingPlanner, ObstacleScene};
use trundle_planning::{Plan, Planner, PlannerConfig};

/// A wall with a sender of `cells` cells of 5 cm, on the line y = 1.5 m.
fn sender(cells: usize) -> OccupancyGrid {
    let geometry =
        GridGeometry::new(0.05, Vector2::new(0.0, 1.5 - 0.025 * cells as f64 - 1.0), 80, 40 + cells).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    let wall = (0..40 + cells).filter(|row| !(20..20 + cells).contains(row));
    wall.for_each(|row| grid.set(CellIndex { col: 40, row }, Cell::Occupied));
    grid
}

fn passes_by_plan(footprint: &Footprint, grid: &OccupancyGrid, start: Pose2, goal: Pose2) -> bool {
    let mut config = PlannerConfig::default();
    config.beyond = 0.0;
    let mut planner =
        Planner::new(config, footprint, DriveLimits::KOBUKI, DifferentialDrive::KOBUKI).unwrap();
    matches!(planner.plan(grid, start, Twist2::ZERO, goal), Plan::Found(_))
}

fn passes_by_docking(footprint: &Footprint, grid: &OccupancyGrid, start: Pose2, goal: Pose2) -> bool {
    let scene = ObstacleScene::from_grid(grid, start.position(), 3.0, true);
    let planner = DockingPlanner::new(DockingConfig::default()).unwrap();
    matches!(planner.plan(footprint, &scene, start, goal), Ok(DockingPlan::Found(_)))
}

#[test]
fn planning_and_docking_pass_the_same_gaps() {
    let (start, goal) = (Pose2::new(1.4, 1.5, 0.0), Pose2::new(2.6, 1.5, 0.0));
    for cells in [7, 8] {
        let (grid, half) = (sender(cells), 0.025 * cells as f64);
        for (spare, fits) in [(5e-4, true), (0.0, true), (-5e-5, false), (-5e-4, false)] {
            let wide = half - spare;
            let corners = [(0.25, wide), (-0.25, wide), (-0.25, -wide), (0.25, -wide)];
            let polygon = Footprint::polygon(corners.map(|(x, y)| Vector2::new(x, y)).to_vec()).unwrap();
            for footprint in [Footprint::disc(wide).unwrap(), polygon] {
                let case = format!("{cells} cells, {spare} m to spare, {footprint:?}");
                assert_eq!(passes_by_plan(&footprint, &grid, start, goal), fits, "plan: {case}");
                assert_eq!(passes_by_docking(&footprint, &grid, start, goal), fits, "dock: {case}");
            }
        }
    }
}
