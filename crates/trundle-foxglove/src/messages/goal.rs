//! `/goal`: the goals that remain.

use super::{MAP_FRAME, pose3, timestamp};
use foxglove::messages::PosesInFrame;
use trundle_app::RunSetup;
use trundle_app::operator::RunView;
use trundle_core::{Pose2, Stamp};

/// The goals of a view, the present one first; without poses if there is none.
pub fn message(view: &RunView) -> Option<(Stamp, PosesInFrame)> {
    let message = PosesInFrame {
        timestamp: Some(timestamp(view.stamp)),
        frame_id: MAP_FRAME.to_owned(),
        poses: goals(view).map(pose3).collect(),
    };
    Some((view.stamp, message))
}

/// Goals of the tasks that have not ended, map frame.
pub fn goals(view: &RunView) -> impl Iterator<Item = Pose2> + '_ {
    view.mission.left.iter().filter_map(RunSetup::goal_of)
}
