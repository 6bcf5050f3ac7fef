//! A drive of the simulated robot without autonomy: by a script, to way-points or by a driver of the front end, with its recording.

mod drive;
mod driver;
mod driver_choice;
mod key_driver;
mod live_drive;
mod numbers;
mod recording;
mod steering;
mod steering_keys;
mod teleop;
mod terminal;
mod true_map;

pub use drive::{SimDrive, drive_simulator};
pub use driver::{ScriptDriver, SimDriver, StillDriver, WaypointDriver};
pub use driver_choice::chosen_driver;
pub use key_driver::KeyDriver;
pub use live_drive::LiveDrive;
pub use numbers::{drive_rows, drive_summary, drive_verdict, recording_hint};
pub use recording::{DriveRecording, recording_announcement};
pub use true_map::true_map;
