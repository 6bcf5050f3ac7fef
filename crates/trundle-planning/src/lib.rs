//! From a grid, a pose and a goal to a path and a trajectory.
//!
//! [`Planner`] is the door: [`DistanceField`] says how much room there is, the potential ([`PotentialConfig`]) leads to
//! way-points, a quadratic programme lays a [`Curve`] through them inside a convex free corridor, and timing turns it into
//! a [`Trajectory`](trundle_core::Trajectory) within the drive's limits. docs/methods.md A4 and A5; `docs/algorithms/planning.md`.

mod area;
mod bezier;
mod body;
mod config;
mod corridor;
mod curve;
mod dial;
mod escape;
mod explore;
mod field;
mod finer;
mod fit;
mod geometry;
mod graph;
mod guide;
mod halt;
mod lattice;
mod maneuver;
mod masks;
mod movers;
mod outline;
mod plan;
mod planner;
mod potential;
mod pull;
mod room;
mod route;
mod space;
mod stopwatch;
mod task;
mod timing;
mod tour;
mod tracking;
mod watch;
mod wave;
mod way;

pub use bezier::BezierPiece;
pub use config::PlannerConfig;
pub use corridor::HalfPlane;
pub use curve::{ActiveRow, Curve, CurveSample};
pub use explore::{Exploration, ExploreConfig, Explorer, Frontier, Viewpoint};
pub use field::{DistanceField, FAR, UnknownIs};
pub use fit::CurveConfig;
pub use graph::WayPointGraph;
pub use masks::{DearMask, SpeedMask};
pub use movers::Mover;
pub use plan::{Plan, PlanResult, ROOM_CAP, room_in_words};
pub use planner::Planner;
pub use potential::{PotentialConfig, PotentialField, PotentialKind, PotentialOutcome};
pub use room::RoomConfig;
pub use route::Phase;
pub use stopwatch::StageTimes;
pub use timing::TimingConfig;
pub use tour::{Replan, Tour};
pub use tracking::{MoverTracker, TrackerConfig};
pub use watch::Obstruction;
