//! A manoeuvre of turns and straight moves onto a pose, in a corridor barely wider than the robot.
//!
//! `cargo run --release --example 04_dock_in_a_tight_place`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use trundle::core::{Footprint, Pose2, Vector2};
use trundle::docking::{DockingConfig, DockingPlan, DockingPlanner, Obstacle, ObstacleScene};

/// Plans 20 cm sideways in a corridor of 0.9 m and prints the manoeuvre's time with its proven bound.
///
/// # Errors
/// When start or goal touch an obstacle.
pub fn main() -> Result<(), Box<dyn Error>> {
    let wall = |y: f64| Obstacle::Segment(Vector2::new(-2.0, y), Vector2::new(2.0, y));
    let corridor = ObstacleScene::new(&[wall(-0.45), wall(0.45)])?;
    let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)];
    let footprint = Footprint::polygon(corners.map(|(x, y)| Vector2::new(x, y)).to_vec())?;
    let planner = DockingPlanner::new(DockingConfig::default())?;
    let (start, goal) = (Pose2::new(0.0, -0.1, 0.0), Pose2::new(0.0, 0.1, 0.0));
    match planner.plan(&footprint, &corridor, start, goal)? {
        DockingPlan::Found(solution) => {
            let time = solution.manoeuvre.duration();
            println!("{time:.2} s; no manoeuvre takes less than {:.2} s", solution.bound);
            assert!(solution.bound <= time + 1e-9);
            Ok(())
        }
        other => Err(format!("no manoeuvre: {other:?}").into()),
    }
}
