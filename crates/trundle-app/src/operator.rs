//! The link between a run and its front ends: requests of an operator enter, views of the run leave.
//!
//! A front end (a page, ROS 2) owns an [`Operator`], the run an [`OperatorLink`]. A request is recorded at the step that applies it, so a
//! replay applies it at the same step. A view costs the robot a few copies at each control step; a slow reader skips views.

mod annotation_edit;
mod annotation_store;
mod annotations;
mod depth_view;
mod hands;
mod image_feed;
mod link;
mod map_copy;
mod map_file;
mod map_folder;
mod motion;
mod operator_error;
mod perception_feed;
mod replay_options;
mod request;
mod request_queue;
mod run_view;
mod series;
mod view_feed;
mod visual_map_feed;

pub use annotation_edit::AnnotationEdit;
pub use depth_view::{DepthPicture, DepthView, DepthViewpoint};
pub use hands::HandId;
pub(crate) use image_feed::ImageFeed;
pub use link::{Operator, OperatorLink, operator_link};
pub(crate) use map_copy::MapCopy;
pub use map_file::{ZONES_FILE, map_file};
pub use map_folder::{FolderMap, MapFolder};
pub(crate) use motion::twist_between;
pub use operator_error::OperatorError;
pub(crate) use perception_feed::PerceptionFeed;
pub use replay_options::refuse_for_replay;
pub use request::OperatorRequest;
pub use run_view::{
    Activity, ClosedLoop, FeatureSpot, FeatureView, ImageView, MapView, MissionView, PerceptionView,
    PlanView, RunCounts, RunState, RunView, VisualMapView,
};
pub use series::{EndedRun, SeriesView};
pub use visual_map_feed::VISUAL_MAP_PERIOD_S;
pub(crate) use visual_map_feed::{VisualMapFeed, on_floor};

use crate::Progress;

/// Companions of a run: the progress line, and an optional operator.
pub struct FrontEnd {
    /// The progress line.
    pub progress: Progress,
    /// The run's end of the link to an operator. With [`crate::RunSetup::is_operated`] the run continues after its mission.
    pub operator: Option<OperatorLink>,
}

impl From<Progress> for FrontEnd {
    fn from(progress: Progress) -> Self {
        Self { progress, operator: None }
    }
}
