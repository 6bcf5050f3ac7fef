//! Subscriptions of a camera's images and intrinsics.

use super::BodySettings;
use super::base_sensors::Shared;
use super::image_inbox::{ImageInbox, ReceivedImage};
use crate::Ros2Error;
use crate::generated::sensor_msgs::{CameraInfoMessage, CompressedImage, ImageMessage};
use crate::generated::std_msgs::Header;
use crate::interface::MessageType;
use crate::node::{RosNode, qos};
use std::sync::Arc;
use std::time::Duration;
use trundle_core::Stamp;

/// Silence of images after which their topic counts as stalled. Source: the value of the drivers' cameras, `max_silence_s`.
const MAX_IMAGE_SILENCE: Duration = Duration::from_secs(1);

/// Subscribes to colour, depth and intrinsics. Images are best effort: reliable streams of large messages stall after packet loss.
///
/// # Errors
/// When a topic cannot be created.
pub fn subscribe(
    node: &mut RosNode,
    settings: &BodySettings,
    shared: &Arc<Shared>,
    inbox: &Arc<ImageInbox>,
) -> Result<(), Ros2Error> {
    if settings.is_color_compressed() {
        images::<CompressedImage>(node, &settings.color, shared, inbox, ImageInbox::on_color)?;
    } else {
        images::<ImageMessage>(node, &settings.color, shared, inbox, ImageInbox::on_color)?;
    }
    if settings.is_depth_compressed() {
        images::<CompressedImage>(node, &settings.depth, shared, inbox, ImageInbox::on_depth)?;
    } else {
        images::<ImageMessage>(node, &settings.depth, shared, inbox, ImageInbox::on_depth)?;
    }
    let own = Arc::clone(inbox);
    node.subscribe(&settings.camera_info, &qos::sensor(1), None, move |info: CameraInfoMessage| {
        own.on_color_info(info)
    })?;
    if let Some(topic) = &settings.depth_info {
        let own = Arc::clone(inbox);
        node.subscribe(topic, &qos::sensor(1), None, move |info: CameraInfoMessage| own.on_depth_info(info))?;
    }
    Ok(())
}

/// A message that is an image.
trait ImageOfTopic: MessageType {
    fn header(&self) -> &Header;
    fn into_message(self) -> ReceivedImage;
}

impl ImageOfTopic for ImageMessage {
    fn header(&self) -> &Header {
        &self.header
    }

    fn into_message(self) -> ReceivedImage {
        ReceivedImage::Raw(self)
    }
}

impl ImageOfTopic for CompressedImage {
    fn header(&self) -> &Header {
        &self.header
    }

    fn into_message(self) -> ReceivedImage {
        ReceivedImage::Compressed(self)
    }
}

fn images<M: ImageOfTopic>(
    node: &mut RosNode,
    topic: &str,
    shared: &Arc<Shared>,
    inbox: &Arc<ImageInbox>,
    put: impl Fn(&ImageInbox, Stamp, ReceivedImage) + Send + 'static,
) -> Result<(), Ros2Error> {
    let (shared, inbox, name) = (Arc::clone(shared), Arc::clone(inbox), node.names().resolve(topic));
    let on_image = move |image: M| {
        if let Some(stamp) = shared.stamp(&name, &image.header().stamp) {
            put(&inbox, stamp, image.into_message());
        }
    };
    node.subscribe(topic, &qos::sensor(2), Some(MAX_IMAGE_SILENCE), on_image).map(drop)
}
