//! Calibration by a recording or by images of a board: camera, mount, wheels, image delay.
//!
//! Each function reads its input, fits, and returns a [`Calibration`]: values with standard deviations, next to the values in use.
//! [`Calibration::write`] changes exactly these keys of a robot file. See `docs/how-to/calibrate.md`.

mod board_sheet;
mod camera;
mod camera_track;
mod delay;
mod mount;
mod recording;
mod robot_file_update;
mod values;
mod wheels;

pub use board_sheet::write_board;
pub use camera::{BoardRequest, CameraCalibration, calibrate_board};
pub use delay::calibrate_delay;
pub use mount::{calibrate_mount, floor_values};
pub use recording::CalibrationInput;
pub use robot_file_update::require_robot_file;
pub use values::{CalibratedValue, Calibration};
pub use wheels::calibrate_wheels;
