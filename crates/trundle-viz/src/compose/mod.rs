mod palette;
mod plan;
mod run;
mod trajectory;

pub use plan::{PlanScene, plan_picture};
pub use run::{CameraView, RunReport};
pub use trajectory::trajectory_picture;
