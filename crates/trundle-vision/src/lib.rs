//! From images to keypoints, descriptors, matches and relative pose.
//!
//! [`OrbExtractor`] finds ORB features in an image; [`match_mutual`] pairs the descriptors of two images,
//! [`rotation_consistent`] drops pairs that turn unlike the rest, [`FeatureGrid`] answers where in an image to look;
//! [`estimate_rigid_motion`] finds the motion between two RGB-D frames from such pairs in spite of wrong ones,
//! [`estimate_pose_pnp`] does it from points and pixels alone, and [`refine_pose_by_reprojection`] polishes a pose against
//! pixels. A [`Template`] finds
//! where exactly something is that another image showed. A [`Vocabulary`] turns descriptors into words, by which
//! [`PlaceIndex`] finds places seen before. Everything is deterministic: the same input and seed
//! give the same bits on any number of threads. The method and its sources: `docs/algorithms/orb.md`.

mod alignment;
mod feature_grid;
mod features;
mod matching;
mod motion;
mod orb;
mod rotation_consistency;
mod vocabulary;

pub use alignment::{Alignment, ImagePatch, Template};
pub use feature_grid::FeatureGrid;
pub use features::{Descriptor, Features, Keypoint};
pub use matching::{Match, match_mutual};
pub use motion::{
    RansacConfig, RansacResult, RefineConfig, estimate_pose_pnp, estimate_rigid_motion,
    refine_pose_by_reprojection,
};
pub use orb::{OrbConfig, OrbExtractor};
pub use rotation_consistency::rotation_consistent;
pub use vocabulary::{BagOfWords, NodeId, PlaceIndex, Vocabulary, VocabularyConfig, VocabularyError};
