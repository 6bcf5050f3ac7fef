//! A path with timing on an occupancy grid, for a round robot.
//!
//! `cargo run --release --example 03_plan_on_a_map`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use trundle::core::{DifferentialDrive, DriveLimits, Footprint, OccupancyGrid, Pose2, Twist2};
use trundle::planning::{Plan, Planner, PlannerConfig};

/// A room with a wall, cells of 0.25 m: `#` occupied, `.` free, `?` unknown.
const ROOM: &str = "\
............
............
......#.....
......#.....
......#.....
......#.....";

/// Plans around the wall and prints the trajectory's ends.
///
/// # Errors
/// When the robot or the map is not valid.
pub fn main() -> Result<(), Box<dyn Error>> {
    let grid = OccupancyGrid::from_ascii(0.25, ROOM)?; // or trundle::io::read_map("map.yaml")
    let footprint = Footprint::Disc { radius: 0.17 };
    let mut planner =
        Planner::new(PlannerConfig::default(), &footprint, DriveLimits::KOBUKI, DifferentialDrive::KOBUKI)?;
    let (start, goal) = (Pose2::new(0.5, 0.4, 0.0), Pose2::new(2.5, 0.4, 0.0));
    match planner.plan(&grid, start, Twist2::ZERO, goal) {
        Plan::Found(plan) => {
            println!("{:.2} m with {:.2} m of clearance", plan.length, plan.min_clearance);
            println!("it ends after {:.1} s", plan.trajectory.duration());
            assert!(plan.length > 2.0, "around the wall");
            Ok(())
        }
        other => Err(format!("no plan: {other:?}").into()),
    }
}
