//! Images of a camera as messages, encoded on a separate thread.

use super::ServerSettings;
use crate::Ros2Error;
use crate::convert::camera_info;
use crate::convert::image::{color_to_ros, compressed_depth_to_ros, depth_to_ros, jpeg_to_ros};
use crate::generated::sensor_msgs::{CameraInfoMessage, CompressedImage, ImageMessage};
use crate::node::{Readers, RosNode, qos};
use crate::outputs::OutputTopic;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use trundle_core::{PinholeCamera, RgbdImage, Stamp};
use trundle_io::{JPEG_QUALITY, encode_color, encode_depth};

/// The topics of a camera.
struct CameraTopics {
    form: Form,
    color_info: OutputTopic<CameraInfoMessage>,
    depth_info: OutputTopic<CameraInfoMessage>,
    camera: PinholeCamera,
    frame: String,
}

enum Form {
    Compressed(OutputTopic<CompressedImage>, OutputTopic<CompressedImage>),
    Raw(OutputTopic<ImageMessage>, OutputTopic<ImageMessage>),
}

/// Publishes images on a separate thread: while an image waits, newer ones are dropped.
pub struct ImagePublisher {
    images: Option<SyncSender<(Option<RgbdImage>, Stamp)>>,
    thread: Option<JoinHandle<()>>,
    /// Whether anybody reads the images.
    image_readers: [Readers; 2],
    /// Whether anybody reads the intrinsics.
    info_readers: [Readers; 2],
    /// Images that were dropped, since the thread was busy.
    pub dropped: u64,
}

impl ImagePublisher {
    /// The topics `camera/color/...` and `camera/depth/...` of `camera`, and the thread.
    ///
    /// # Errors
    /// When a topic cannot be created or the system refuses a thread.
    pub fn start(
        node: &mut RosNode,
        settings: &ServerSettings,
        camera: PinholeCamera,
    ) -> Result<Self, Ros2Error> {
        let (color, depth) = ("camera/color/image_raw", "camera/depth/image_raw");
        let qos = qos::sensor(2);
        let (color, depth) = match settings.raw_images {
            true => (color.to_owned(), depth.to_owned()),
            false => (format!("{color}/compressed"), format!("{depth}/compressedDepth")),
        };
        let form = if settings.raw_images {
            Form::Raw(OutputTopic::new(node, &color, &qos)?, OutputTopic::new(node, &depth, &qos)?)
        } else {
            Form::Compressed(OutputTopic::new(node, &color, &qos)?, OutputTopic::new(node, &depth, &qos)?)
        };
        let (color_info, depth_info) = ("camera/color/camera_info", "camera/depth/camera_info");
        let image_readers = [&color, &depth].map(|topic| node.readers(topic));
        let info_readers = [color_info, depth_info].map(|topic| node.readers(topic));
        let topics = CameraTopics {
            form,
            color_info: OutputTopic::new(node, color_info, &qos::reliable(1))?,
            depth_info: OutputTopic::new(node, depth_info, &qos::reliable(1))?,
            camera,
            frame: settings.frames.camera.clone(),
        };
        let (images, received) = sync_channel(1);
        let thread = std::thread::Builder::new().name("ros2-images".to_owned());
        let thread = thread.spawn(move || topics.publish_all(&received))?;
        let (images, thread) = (Some(images), Some(thread));
        Ok(Self { images, thread, image_readers, info_readers, dropped: 0 })
    }

    /// Publishes an image with the intrinsics, stamped `at` on the ROS clock. An image without a subscriber is not encoded: the intrinsics
    /// alone are published for their subscribers.
    pub fn publish(&mut self, image: &RgbdImage, at: Stamp) {
        let is_read = |readers: &[Readers]| readers.iter().any(Readers::are_there);
        let image = is_read(&self.image_readers).then(|| image.clone());
        if image.is_none() && !is_read(&self.info_readers) {
            return;
        }
        let sent = self.images.as_ref().map(|images| images.try_send((image, at)));
        self.dropped += u64::from(matches!(sent, Some(Err(TrySendError::Full(_)))));
    }
}

impl Drop for ImagePublisher {
    fn drop(&mut self) {
        self.images = None;
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread that publishes images panicked");
        }
    }
}

impl CameraTopics {
    fn publish_all(&self, images: &Receiver<(Option<RgbdImage>, Stamp)>) {
        for (image, at) in images {
            let info = camera_info::to_ros(&self.camera, at, &self.frame);
            self.color_info.publish(info.clone());
            self.depth_info.publish(info);
            image.iter().for_each(|image| self.publish_image(image, at));
        }
    }

    fn publish_image(&self, image: &RgbdImage, at: Stamp) {
        match &self.form {
            Form::Raw(color, depth) => {
                color.publish(color_to_ros(image.color(), at, &self.frame));
                depth.publish(depth_to_ros(image.depth(), at, &self.frame));
            }
            Form::Compressed(color, depth) => {
                match (encode_color(image.color(), JPEG_QUALITY), encode_depth(image.depth())) {
                    (Ok(jpeg), Ok(png)) => {
                        color.publish(jpeg_to_ros(jpeg, at, &self.frame));
                        depth.publish(compressed_depth_to_ros(&png, at, &self.frame));
                    }
                    (Err(error), _) | (_, Err(error)) => {
                        tracing::warn!("an image was not published: {error}")
                    }
                }
            }
        }
    }
}
