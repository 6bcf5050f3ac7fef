//! A plan on a map, outside a run: the files that shape it, the planner's answer, its numbers, pictures and folder.

mod explanation;
mod goal_refusal;
mod masks;
mod numbers;
mod off_map;
mod output;
mod picture;
mod place_arg;
mod plan_times;
mod request;

pub use goal_refusal::{GoalRefusal, MovedGoal};
pub use masks::SpeedMaskLimits;
pub use numbers::{curve_lines, plan_rows};
pub use off_map::OffMap;
pub use output::{write_plan, write_refusal};
pub use place_arg::PlaceArg;
pub use plan_times::PlanTimes;
pub use request::{NamedPose, PlanFiles, PlanRequest};
