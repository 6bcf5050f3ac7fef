//! `/plan`: the poses of the planned trajectory.

use super::{MAP_FRAME, pose3, timestamp};
use foxglove::messages::PosesInFrame;
use trundle_app::operator::RunView;
use trundle_core::Stamp;

/// Maximum number of poses; longer plans are thinned. Source: ours, as on the live page.
const MAX_PLAN_POSES: usize = 400;

/// The plan of a view; without poses if there is none.
pub fn message(view: &RunView) -> Option<(Stamp, PosesInFrame)> {
    let points = view.plan.as_deref().map_or(&[][..], |plan| plan.trajectory.points());
    let stride = points.len().div_ceil(MAX_PLAN_POSES).max(1);
    let message = PosesInFrame {
        timestamp: Some(timestamp(view.stamp)),
        frame_id: MAP_FRAME.to_owned(),
        poses: points.iter().step_by(stride).map(|point| pose3(point.pose)).collect(),
    };
    Some((view.stamp, message))
}
