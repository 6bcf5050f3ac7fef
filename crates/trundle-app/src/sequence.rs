//! SLAM on a recorded RGB-D sequence: tracking, the comparison with ground truth, and the folder of results.

mod comparison;
mod depth_check;
mod first_camera;
mod floor_log;
mod floor_mount;
mod live_view;
mod numbers;
mod odometry_prior;
mod output;
mod readout;
mod recorder;
mod report;
mod request;
mod run;
mod scan_motion;
mod trajectory;

pub use first_camera::FirstCamera;
pub use numbers::sequence_rows;
pub use output::{SequenceOutput, write_sequence};
pub use request::SequenceRequest;
pub use run::{SequenceRun, track_sequence};
pub use trajectory::SequenceTrajectory;
