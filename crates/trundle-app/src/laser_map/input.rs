//! The scans of a CARMEN log, a bag, a recording of trundle, or an RGB-D folder whose depth images become scans.

use super::depth_scans::{self, neighbours};
use super::log_input::LogInput;
use super::request::LaserMapRequest;
use crate::sequence_input::{RecordedRun, SequenceInput, SequenceOptions};
use crate::{AppError, StepProgress};
use trundle_core::deskewed;
use trundle_io::{FileKind, LaserLog, read_laser_log};

/// Reads the log. Its scans are deskewed if the log allows it and the request asks for it.
///
/// # Errors
/// Names the file and the invalid line or frame.
pub fn read_log(request: &LaserMapRequest, progress: &dyn StepProgress) -> Result<LogInput, AppError> {
    let mut input = read_raw_log(request, progress)?;
    if request.deskew {
        let LaserLog { scans, odometry, .. } = &mut input.log;
        for entry in scans.iter_mut().filter(|entry| entry.scan.beam_times().is_some()) {
            let pose = |stamp| neighbours(odometry, stamp).map(|(a, b, part)| a.interpolate(&b, part));
            entry.scan = deskewed(entry.scan.clone(), pose);
        }
    }
    Ok(input)
}

/// Reads the log: RGB-D images of a folder or a recording, the scans of a recording's laser, a bag or a CARMEN log.
fn read_raw_log(request: &LaserMapRequest, progress: &dyn StepProgress) -> Result<LogInput, AppError> {
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
            let log = read_laser_log(&request.log, &request.laser)?;
            return Ok(LogInput { log, depth: None, cut_report: None });
        }
    };
    depth_scans::read(&input, request.poses.as_deref(), progress)
}
