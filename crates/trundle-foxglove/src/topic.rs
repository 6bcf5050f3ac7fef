//! The topics: name, schema, and when a view has something new.

use crate::messages::{camera, goal, map, plan, pose, scan, state, telemetry, transforms};
use foxglove::{Encode, Schema};
use std::sync::Arc;
use trundle_app::operator::RunView;
use trundle_core::Stamp;

/// A topic; its number is that of its channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum RunTopic {
    /// Poses of the frames `odom` and `base_link`.
    Transforms = 1,
    /// The map.
    Map,
    /// The newest scan.
    Scan,
    /// The newest colour image.
    Camera,
    /// The planned poses.
    Plan,
    /// The goals that remain.
    Goal,
    /// Pose with covariance, and twist.
    Pose,
    /// State of the run with its reason.
    State,
    /// Numbers for plots.
    Telemetry,
}

impl RunTopic {
    /// All topics.
    pub const ALL: [Self; 9] = [
        Self::Transforms,
        Self::Map,
        Self::Scan,
        Self::Camera,
        Self::Plan,
        Self::Goal,
        Self::Pose,
        Self::State,
        Self::Telemetry,
    ];

    /// Name of the topic.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transforms => "/tf",
            Self::Map => "/map",
            Self::Scan => "/scan",
            Self::Camera => "/camera",
            Self::Plan => "/plan",
            Self::Goal => "/goal",
            Self::Pose => "/pose",
            Self::State => "/state",
            Self::Telemetry => "/telemetry",
        }
    }

    /// Number of the topic's channel.
    pub fn channel(self) -> u32 {
        self as u32
    }

    /// The topic of a channel.
    pub fn of_channel(channel: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|topic| topic.channel() == channel)
    }

    /// Encoding and schema of the topic's messages.
    pub fn encoding(self) -> Option<(String, Schema)> {
        match self {
            Self::Transforms => encoding_of(transforms::message),
            Self::Map => encoding_of(map::message),
            Self::Scan => encoding_of(scan::message),
            Self::Camera => encoding_of(camera::message),
            Self::Plan => encoding_of(plan::message),
            Self::Goal => encoding_of(goal::message),
            Self::Pose => encoding_of(pose::message),
            Self::State => encoding_of(state::message),
            Self::Telemetry => encoding_of(telemetry::message),
        }
    }

    /// Appends the message of a view; its stamp, or `None` if the view has no such data.
    pub fn append(self, view: &RunView, bytes: &mut Vec<u8>) -> Option<Stamp> {
        match self {
            Self::Transforms => append(transforms::message(view), bytes),
            Self::Map => append(map::message(view), bytes),
            Self::Scan => append(scan::message(view), bytes),
            Self::Camera => append(camera::message(view), bytes),
            Self::Plan => append(plan::message(view), bytes),
            Self::Goal => append(goal::message(view), bytes),
            Self::Pose => append(pose::message(view), bytes),
            Self::State => append(state::message(view), bytes),
            Self::Telemetry => append(telemetry::message(view), bytes),
        }
    }

    /// Whether the run copies this data only for a viewer.
    pub fn is_copied_on_demand(self) -> bool {
        matches!(self, Self::Map | Self::Scan | Self::Camera)
    }

    /// Whether two views differ in this topic. Equal large parts of views share an allocation.
    pub fn differs(self, last: &RunView, view: &RunView) -> bool {
        match self {
            Self::Map => !is_same(last.map.as_ref(), view.map.as_ref()),
            Self::Scan => !is_same(last.scan.as_ref(), view.scan.as_ref()),
            Self::Camera => !is_same(last.perception.image.as_ref(), view.perception.image.as_ref()),
            Self::Plan => !is_same(last.plan.as_ref(), view.plan.as_ref()),
            Self::Goal => goal::goals(last).ne(goal::goals(view)),
            Self::State => state::text(last) != state::text(view),
            Self::Transforms | Self::Pose | Self::Telemetry => last.stamp != view.stamp,
        }
    }
}

fn encoding_of<M: Encode>(_: fn(&RunView) -> Option<(Stamp, M)>) -> Option<(String, Schema)> {
    Some((M::get_message_encoding(), M::get_schema()?))
}

fn append(message: Option<(Stamp, impl Encode)>, bytes: &mut Vec<u8>) -> Option<Stamp> {
    let (stamp, message) = message?;
    message.encode(bytes).ok()?;
    Some(stamp)
}

fn is_same<T>(a: Option<&Arc<T>>, b: Option<&Arc<T>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_topic_has_a_channel_and_a_name_of_its_own() {
        for (index, topic) in RunTopic::ALL.into_iter().enumerate() {
            assert_eq!(RunTopic::of_channel(topic.channel()), Some(topic));
            assert!(RunTopic::ALL[..index].iter().all(|other| other.name() != topic.name()), "{topic:?}");
        }
        assert_eq!((RunTopic::of_channel(0), RunTopic::of_channel(10)), (None, None));
    }
}
