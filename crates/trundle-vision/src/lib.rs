//! From images to keypoints, descriptors, matches and relative pose.

mod features;

pub use features::{Descriptor, Features, Keypoint};
