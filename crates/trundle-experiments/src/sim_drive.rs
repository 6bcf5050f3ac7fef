//! A drive of the simulated robot without autonomy: by a script, to way-points or by a driver of the front end, with its recording.

mod drive;
mod driver;
mod hand;
mod live_drive;
mod numbers;
mod recording;
mod steering;
mod true_map;

pub use drive::{SimDrive, drive_simulator};
pub use driver::{ScriptDriver, SimDriver, Standing, WaypointDriver};
pub use live_drive::LiveDrive;
pub use numbers::{drive_rows, drive_summary, drive_verdict, recording_hint};
pub use recording::{DriveRecording, recording_announcement};
pub use steering::{Steering, SteeringKey};
pub use true_map::true_map;
