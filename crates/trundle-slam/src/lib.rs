//! From RGB-D frames to a camera trajectory and a landmark map.
//!
//! The problem: where was the camera when it took each image? The idea, that of ORB-SLAM2 \[MurArtal17\] on RGB-D: each
//! frame is located against landmarks by reprojection; frames that see something new become keyframes, whose depths make
//! new landmarks; after each keyframe, local bundle adjustment refines poses and landmarks around it. A place seen again
//! is matched with the landmarks it already has, so a camera that looks around a room, or stands still, does not drift.
//! Cost: a few ms a frame on one core besides the features, and some tens of ms a keyframe. See `docs/algorithms/slam.md`.
//!
//! | \[MurArtal17\] | here | unit |
//! |---|---|---|
//! | T_cw | inverse of `visual_from_camera` | m |
//! | X, map point | landmark `position` | m |
//! | x = (u_L, v_L, u_R) | pixel and inverse depth of a `PointObservation` | px, 1/m |
//! | Sigma | `pixel_sigma` x scale of the octave, `DepthConfig` | px, 1/m |
//! | K_L, K_F | free and fixed keyframes of the local bundle | |

mod align;
mod anchor;
mod arena;
mod claim;
mod closing;
mod component;
mod config;
mod contradiction;
mod covisibility;
mod depth;
mod diagnosis;
mod floor;
mod found;
mod frame;
mod global_bundle;
mod ids;
mod keyframe_culling;
mod keyframe_grid;
mod keyframe_policy;
mod landmark;
mod local_bundle;
mod local_map;
mod look;
mod map;
mod map_bundle;
mod mapping;
mod median;
mod motion;
mod outline;
mod persist;
mod places;
mod refine;
mod refinement;
mod relocalisation;
mod report;
mod rolled;
mod search;
mod sensor;
mod slam;
mod spanning_tree;
#[cfg(test)]
mod testing;
mod ties;
mod tracker;
mod trajectory;
mod triangulation;

pub use closing::{LoopClosure, LoopConfig};
pub use config::SlamConfig;
pub use depth::DepthConfig;
pub use diagnosis::Suspicion;
pub use ids::{KeyframeId, LandmarkId};
pub use keyframe_policy::KeyframeConfig;
pub use mapping::MappingConfig;
pub use motion::MotionConfig;
pub use persist::MapFileError;
pub use report::{MapId, MapMerge, Mode, SeenFeature, TrackReport, Tracking};
pub use slam::RgbdSlam;
pub use tracker::TrackingConfig;
