//! RGB-D SLAM: from images to a camera trajectory and a landmark map.
//!
//! Problem: the pose of the camera at each image. The idea is that of ORB-SLAM2 \[MurArtal17\] for RGB-D. Each frame is located against
//! landmarks by reprojection. A frame with a new view becomes a keyframe, whose depths make new landmarks. Local bundle adjustment refines
//! poses and landmarks around each keyframe. A place in view again is matched with its existing landmarks, so that a camera that turns in a
//! room, or stands still, does not drift. Cost on one core: a few ms per frame besides the features, and some tens of ms per keyframe. See
//! `docs/algorithms/slam.md`.
//!
//! ```
//! use trundle_core::{ColorImage, DepthImage, PinholeCamera, RgbdImage, Stamp};
//! use trundle_slam::{RgbdSlam, SlamConfig, Tracking};
//!
//! // The camera is given whole: a rolling shutter is part of it.
//! let camera = PinholeCamera::kinect_v1().with_readout(0.026)?;
//! let mut slam = RgbdSlam::new(camera, SlamConfig::default())?;
//!
//! // A wall at 2 m with a pattern of random tiles.
//! let tile = |x: usize, y: usize| {
//!     let hash = (x / 8 * 0x9E37_79B9) ^ (y / 8 * 0x85EB_CA6B);
//!     ((hash ^ (hash >> 15)).wrapping_mul(0x2C1B_3C6D) >> 16) as u8
//! };
//! let color = ColorImage::from_fn(640, 480, |x, y| [tile(x, y); 3]);
//! let depth = DepthImage::filled(640, 480, 2.0);
//! for i in 0..3 {
//!     let stamp = Stamp::default().after(f64::from(i) / 30.0);
//!     let image = RgbdImage::new(stamp, color.clone(), depth.clone())?;
//!     let report = slam.step(&image, None);
//!     assert_eq!(report.tracking, Tracking::Ok);
//!     assert!(report.visual_from_camera.translation.norm() < 0.001, "the camera stands still");
//! }
//! assert_eq!((slam.trajectory().len(), slam.keyframes().count()), (3, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Folders, from images to maps; each folder uses only those above it in the table:
//!
//! | folder | holds |
//! |---|---|
//! | `frame/` | features of an image, their depths and standard deviations |
//! | `motion/` | motion priors, velocity, and how uncertain poses compose |
//! | `map/` | keyframes and landmarks in arenas, covisibility, spanning tree |
//! | `matching/` | features matched with points, and the pose that the matches give |
//! | `place_recognition/` | bags of words over the keyframes |
//! | `tracking/` | the pose of a frame: tracked, or relocalized |
//! | `local_mapping/` | new keyframes and landmarks, culling |
//! | `optimisation/` | local and global bundle adjustment, in slices |
//! | `loop_closing/` | loops found, verified and closed |
//! | `atlas/` | several maps, and their merging |
//! | `calibration_check/` | wrong settings found by the images |
//! | `readout/` | the readout time of a rolling shutter, by images of a turning camera |
//! | `persist/` | maps as bytes |
//!
//! | \[MurArtal17\] | here | unit |
//! |---|---|---|
//! | T_cw | inverse of `visual_from_camera` | m |
//! | X, map point | landmark `position` | m |
//! | x = (u_L, v_L, u_R) | pixel and inverse depth of a `PointObservation` | px, 1/m |
//! | Sigma | `pixel_sigma` x scale of the octave, `DepthConfig` | px, 1/m |
//! | K_L, K_F | free and fixed keyframes of the local bundle | |

mod atlas;
mod calibration_check;
mod config;
mod frame;
mod ids;
mod local_mapping;
mod loop_closing;
mod map;
mod matching;
mod median;
mod motion;
mod optimisation;
mod persist;
mod place_recognition;
mod readout;
mod report;
mod slam;
#[cfg(test)]
mod testing;
mod tracking;

pub use calibration_check::issue::CalibrationIssue;
pub use config::SlamConfig;
pub use frame::depth::DepthConfig;
pub use ids::{KeyframeId, LandmarkId, MapId};
pub use local_mapping::config::LocalMappingConfig;
pub use local_mapping::keyframe_policy::KeyframeConfig;
pub use loop_closing::config::LoopConfig;
pub use loop_closing::loop_closure::LoopClosure;
pub use motion::motion_model::MotionModelConfig;
pub use persist::error::MapFileError;
pub use readout::{ReadoutEstimate, ReadoutEstimator};
pub use report::{FramePose, MapMerge, Mode, SeenFeature, TrackReport};
pub use slam::RgbdSlam;
pub use tracking::config::TrackingConfig;
pub use tracking::tracking_status::Tracking;
