//! RGB-D images of ROS bags: raw and compressed images, camera_info, odometry and the mount of the camera;
//! for a robot also gyro and laser.

mod camera_info;
mod chosen_images;
mod compressed_depth;
mod frames;
mod image_message;
mod options;
mod pixels;
mod raw_image;
mod sensors;
mod sequence;
mod sequence_topics;
mod survey;
mod topic_choice;
mod yuv;

pub use compressed_depth::decode_compressed_depth;
pub use frames::{RosFrame, RosFrames};
pub use options::RosSequenceOptions;
pub use sequence::RosSequence;
pub use sequence_topics::RosImageTopics;
pub use topic_choice::RosTopics;
