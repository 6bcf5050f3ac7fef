//! Paths and trajectories on occupancy grids: from a grid, a pose and a goal to a verified curve with its timing.
//!
//! [`Planner`] is the entry point. A geodesic search on the grid finds waypoints. A quadratic program fits a [`Curve`] through them inside
//! a convex free corridor. Timing turns the curve into a [`Trajectory`](trundle_core::Trajectory) within the drive's limits. Equations,
//! parameters and limits are in `docs/algorithms/planning.md`; definitions in docs/methods.md, A4 and A5.
//!
//! ```
//! use trundle_core::{DifferentialDrive, DriveLimits, Footprint, OccupancyGrid, Pose2, Twist2};
//! use trundle_planning::{Plan, Planner, PlannerConfig};
//!
//! // A wall with an opening at the top, cells of 0.25 m.
//! let art = "........\n........\n....#...\n....#...\n....#...\n....#...";
//! let grid = OccupancyGrid::from_ascii(0.25, art)?;
//! let footprint = Footprint::Disc { radius: 0.17 };
//! let (limits, drive) = (DriveLimits::KOBUKI, DifferentialDrive::KOBUKI);
//! let mut planner = Planner::new(PlannerConfig::default(), &footprint, limits, drive)?;
//! let (start, goal) = (Pose2::new(0.4, 0.4, 0.0), Pose2::new(1.7, 0.4, 0.0));
//! let Plan::Found(plan) = planner.plan(&grid, start, Twist2::ZERO, goal) else { panic!("no path") };
//! assert!(plan.trajectory.end().distance(&goal) < 1e-6);
//! assert!(plan.min_clearance > 0.0 && plan.length > 2.0, "around the wall");
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod area;
mod config;
mod curve;
mod exploration;
mod geometry;
mod masks;
mod moving_obstacles;
mod multi_goal;
mod path_validation;
mod plan;
mod planner;
mod polygon;
mod query;
mod search;
mod timing;

pub use config::PlannerConfig;
pub use curve::analytic_curve::{ActiveRow, Curve, CurveSample};
pub use curve::bezier::BezierPiece;
pub use curve::fit::config::CurveConfig;
pub use curve::half_plane::HalfPlane;
pub use curve::phase::Phase;
pub use exploration::config::ExploreConfig;
pub use exploration::explorer::{Exploration, Explorer, Viewpoint};
pub use exploration::frontier::Frontier;
pub use masks::cost_mask::CostMask;
pub use masks::speed_mask::SpeedMask;
pub use masks::zone_cells::{forbid, forbidden_cells, require_on_map, slow_speeds};
pub use moving_obstacles::config::ObstacleTrackerConfig;
pub use moving_obstacles::forecast::MovingObstacle;
pub use moving_obstacles::tracker::MovingObstacleTracker;
pub use multi_goal::MultiGoalPlan;
pub use path_validation::Obstruction;
pub use plan::{MAX_CLEARANCE_M, Plan, PlanResult, Replan, clearance_text};
pub use planner::api::Planner;
pub use query::footprint_check::FootprintCheck;
pub use query::stage_timer::PlanningTimes;
pub use search::clearance_cost::ClearanceCostConfig;
pub use search::potential::{PotentialConfig, PotentialField, PotentialKind, PotentialOutcome};
pub use search::waypoint_graph::WaypointGraph;
pub use timing::config::TimingConfig;
pub use trundle_grid::{DistanceField, NO_OBSTACLE_DISTANCE_M, UnknownIs};
