//! The scans of a CARMEN log, a bag, a recording of trundle, or an RGB-D folder whose depth images become scans.

use super::depth_scans;
use super::log_input::LogInput;
use super::request::LaserMapRequest;
use crate::sequence_input::{RecordedRun, SequenceInput, SequenceOptions};
use crate::{AppError, StepProgress};
use trundle_io::{FileKind, read_laser_log};

/// Reads the log: RGB-D images of a folder or a recording, the scans of a recording's laser, a bag or a CARMEN log.
///
/// # Errors
/// Names the file, and the line or frame that cannot be accepted.
pub fn read_log(request: &LaserMapRequest, progress: &dyn StepProgress) -> Result<LogInput, AppError> {
    let options = SequenceOptions {
        recover: request.recover,
        topics: request.topics.clone(),
        ..SequenceOptions::new(&request.log)
    };
    let input = match FileKind::of(&request.log)? {
        FileKind::SequenceFolder => SequenceInput::open(&options)?,
        FileKind::TrundleRecording => {
            let run = RecordedRun::read(&request.log, request.recover)?;
            if run.image_count() == 0 && !run.scans().is_empty() {
                return depth_scans::of_laser(&run, &request.log);
            }
            SequenceInput::of_recording(&options, run)?
        }
        kind if kind.is_bag() && SequenceInput::is_one(&request.log, &request.topics) => {
            SequenceInput::open(&options)?
        }
        _ => {
            let log = read_laser_log(&request.log, &request.laser)?;
            return Ok(LogInput { log, depth: None, cut_report: None });
        }
    };
    depth_scans::read(&input, request.poses.as_deref(), progress)
}
