//! RGB-D images of ROS bags: raw and compressed images, camera_info, odometry and the mount of the camera.

mod camera_info;
mod compressed_depth;
mod frames;
mod image_message;
mod pixels;
mod raw_image;
mod sequence;
mod survey;
mod topic_choice;
mod yuv;

pub use compressed_depth::decode_compressed_depth;
pub use frames::{RosFrame, RosFrames};
pub use sequence::{RosSequence, RosSequenceOptions};
pub use topic_choice::{RosImageTopics, RosTopics};
