//! The scans of a CARMEN log, a bag, a recording of trundle, or an RGB-D folder whose depth images become scans.

use super::depth_scans;
use super::log_input::{LogInput, LogScans};
use super::request::LaserMapRequest;
use crate::sequence_input::{RecordedRun, SequenceInput, SequenceOptions};
use crate::{AppError, StepProgress};
use trundle_io::{FileKind, LaserLogScans};

/// Opens the log. The scans of bags and CARMEN logs are read one at a time, those of other logs are read here. Scans are deskewed if the log
/// allows it and the request asks for it.
///
/// # Errors
/// Names the file and the invalid line or frame.
pub fn read_log(request: &LaserMapRequest, progress: &dyn StepProgress) -> Result<LogInput, AppError> {
    let input = open_log(request, progress)?;
    Ok(LogInput { is_deskewed: request.deskew, ..input })
}

/// Reads the log: RGB-D images of a folder or a recording, the scans of a recording's laser, a bag or a CARMEN log.
fn open_log(request: &LaserMapRequest, progress: &dyn StepProgress) -> Result<LogInput, AppError> {
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
        kind if kind.is_bag() && SequenceInput::is_sequence(&request.log, &request.topics) => {
            SequenceInput::open(&options)?
        }
        _ => {
            let (log, scans) = LaserLogScans::open(&request.log, &request.laser)?;
            let scans = LogScans::File(scans);
            return Ok(LogInput { scans, ..LogInput::in_memory(log, None, None) });
        }
    };
    depth_scans::read(&input, request.poses.as_deref(), progress)
}
