//! Pictures of camera images: depth and features.

mod depth;
mod feature;
mod photo;

pub use depth::depth_picture;
pub use feature::{FeatureMark, feature_picture};
