//! Complete pictures and pages: plan, run, trajectory and visual map.

mod palette;
mod plan;
mod plan_parts;
mod run;
mod run_map;
mod trajectory;
mod visual_map;

pub use plan::{MaskShares, PlanScene, no_plan_picture, plan_picture};
pub use plan_parts::{PlanParts, plan_part_pictures, speed_charts};
pub use run::{CameraView, RunReport};
pub use run_map::RunMap;
pub use trajectory::trajectory_picture;
pub use visual_map::{VisualMapScene, visual_map_picture};
