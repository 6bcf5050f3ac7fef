//! From images to keypoints, descriptors, matches and relative pose.
//!
//! | problem | here |
//! |---|---|
//! | points that are found again in other images | [`OrbExtractor`] |
//! | which features of two images are the same point | [`match_mutual`], [`rotation_consistent`], [`FeatureGrid`] |
//! | the motion between two RGB-D frames, some pairs being wrong | [`estimate_rigid_motion`] |
//! | the pose of a camera from points and pixels | [`estimate_pose_pnp`], [`refine_pose_by_reprojection`] |
//! | the position of a feature to a tenth of a pixel | [`Template`] |
//! | a camera by images of a calibration board | [`board`] |
//! | which of thousands of images shows the same place | [`Vocabulary`], [`PlaceIndex`] |
//!
//! Everything is deterministic: the same input and seed give the same bits on any number of threads. Methods, sources and figures:
//! `docs/algorithms/orb.md`, `alignment.md` and `place-recognition.md`.
//!
//! ```
//! use trundle_core::GrayImage;
//! use trundle_vision::{OrbConfig, OrbExtractor, PlaceIndex, Vocabulary, match_mutual};
//!
//! // A pattern of random tiles, and the same pattern 5 px to the left.
//! let tile = |x: usize, y: usize| {
//!     let hash = (x / 8 * 0x9E37_79B9) ^ (y / 8 * 0x85EB_CA6B);
//!     ((hash ^ (hash >> 15)).wrapping_mul(0x2C1B_3C6D) >> 16) as u8
//! };
//! let (a, b) = (GrayImage::from_fn(320, 240, tile), GrayImage::from_fn(320, 240, |x, y| tile(x + 5, y)));
//! let mut extractor = OrbExtractor::new(OrbConfig::default())?;
//! let (a, b) = (extractor.extract(&a), extractor.extract(&b));
//!
//! let pairs = match_mutual(&a.descriptors, &b.descriptors, 64, 0.8);
//! let shifted = |m: &&trundle_vision::Match| (a.keypoints[m.a].x - b.keypoints[m.b].x - 5.0).abs() < 1.0;
//! assert!(pairs.len() > 100 && pairs.iter().filter(shifted).count() * 10 > pairs.len() * 9);
//!
//! // The second image is recognized by the bag of words of the first.
//! let vocabulary = Vocabulary::builtin();
//! let mut index = PlaceIndex::default();
//! index.add(7, &vocabulary.describe(&a.descriptors).0);
//! let found = index.query(&vocabulary.describe(&b.descriptors).0, |_| true);
//! assert_eq!(found[0].0, 7);
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod alignment;
pub mod board;
mod feature_grid;
mod features;
mod matching;
mod motion;
mod orb;
mod rotation_consistency;
mod vocabulary;

pub use alignment::{ImagePatch, PatchAlignment, Template};
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
