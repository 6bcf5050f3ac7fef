//! Calibration boards: found in images, and the camera calibrated by them.
//!
//! | problem | here |
//! |---|---|
//! | geometry of the board, m | [`Board`] |
//! | corners of a board in an image, to a tenth of a pixel | [`Board::find`] |
//! | square markers in an image | [`tags`] |
//! | intrinsics and lens from corners in several images | [`calibrate_camera`] |

mod board_kind;
mod board_view;
mod camera_fit;
mod camera_parameters;
mod checkerboard;
mod corner_refinement;
mod coverage;
mod homography;
mod saddle_points;
mod smooth_image;
mod tag_board;
pub mod tags;

pub use board_kind::Board;
pub use board_view::{BoardPoint, BoardProblem, BoardView};
pub use camera_fit::{CameraFit, CameraFitError, RejectedView, calibrate_camera};
pub use camera_parameters::{CameraParameters, LensModel};
pub use coverage::BoardCoverage;
pub use tag_board::TagBoard;
