//! Docking: fine positioning in narrow spaces by turns in place and straight moves, exact for the footprint.
//!
//! [`DockingPlanner`] plans a manoeuvre of minimum time onto a goal pose, with a lower bound of the time, or proves that none exists.
//! [`Positioner`] carries manoeuvres out in closed loop. Equations, parameters and limits are in `docs/algorithms/docking.md`.
//!
//! ```
//! use trundle_core::{Footprint, Pose2, Vector2};
//! use trundle_docking::{DockingConfig, DockingPlan, DockingPlanner, Obstacle, ObstacleScene};
//!
//! let wall = |y: f64| Obstacle::Segment(Vector2::new(-2.0, y), Vector2::new(2.0, y));
//! let corridor = ObstacleScene::new(&[wall(-0.45), wall(0.45)])?;
//! let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)].map(|(x, y)| Vector2::new(x, y));
//! let footprint = Footprint::polygon(corners.to_vec())?;
//! let planner = DockingPlanner::new(DockingConfig::default())?;
//! let (start, goal) = (Pose2::new(0.0, -0.1, 0.0), Pose2::new(0.0, 0.1, 0.0));
//! let DockingPlan::Found(solution) = planner.plan(&footprint, &corridor, start, goal)? else { panic!("no manoeuvre") };
//! assert!(solution.manoeuvre.end().distance(&goal) < 1e-9);
//! assert!(solution.bound <= solution.manoeuvre.duration() + 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod certificate;
mod connectivity_proof;
mod contact_space;
pub mod corridor;
mod docking_config;
mod docking_plan;
mod free_motion;
pub mod hong24;
mod legs;
mod lower_bound;
mod margin_selection;
mod motion;
mod planner;
mod point_queries;
mod pose_margin;
mod positioner;
mod scene;
mod search;
mod work_budget;

pub use certificate::{Certificate, SearchLimit};
pub use contact_space::ContactSpace;
pub use docking_config::{DockingConfig, Method};
pub use docking_plan::{DockingPlan, DockingRefusal, Impossible, Solution};
pub use free_motion::{FreeDrive, FreeTurn};
pub use motion::limits::MotionLimits;
pub use motion::manoeuvre::{Manoeuvre, Motion, Step};
pub use planner::{DockingJob, DockingPlanner};
pub use pose_margin::margin_of;
pub use positioner::config::PositionerConfig;
pub use positioner::positioner_loop::Positioner;
pub use positioner::report::{PositionerInput, PositionerReason, PositionerReport};
pub use scene::blocker::{Blocker, BlockerKind};
pub use scene::obstacle_scene::{Obstacle, ObstacleScene};
pub use work_budget::PlanningJob;
