mod palette;
mod plan;
mod run;
mod trajectory;
mod visual_map;

pub use plan::{PlanScene, plan_picture};
pub use run::{CameraView, RunReport};
pub use trajectory::trajectory_picture;
pub use visual_map::{VisualMapScene, visual_map_picture};
