//! The recording of a drive: images, wheels and gyro.

use crate::AppError;
use crate::sequence_input::{SequenceInput, SequenceOptions};
use std::path::Path;
use trundle_core::{GyroRate, Vector3, WheelTicks};
use trundle_estimation::{GyroAngle, WheelAngles};
use trundle_io::{EncodedEvent, FileKind, RecordedMessage, RecordingReader};

/// A recording of a drive with images, wheels and gyro.
pub struct CalibrationInput {
    pub(super) images: SequenceInput,
    gyro: Vec<GyroRate>,
    ticks: Vec<WheelTicks>,
}

impl CalibrationInput {
    /// Opens a recording of trundle; with `recover` one that is cut, up to the cut.
    ///
    /// # Errors
    /// When the file is not a recording of trundle, or contains no images or no robot.
    pub fn open(path: &Path, recover: bool) -> Result<Self, AppError> {
        if !matches!(FileKind::of(path)?, FileKind::TrundleRecording) {
            let name = path.display();
            let problem = format!(
                "{name}: no recording of trundle, expected one with images, wheels and gyro; record a drive with --record all"
            );
            return Err(AppError::Input(problem));
        }
        let options = SequenceOptions { recover, ..SequenceOptions::new(path) };
        let images = SequenceInput::open(&options)?;
        let reader = if recover { RecordingReader::open_to_cut(path)? } else { RecordingReader::open(path)? };
        let (gyro, ticks) = read_base(reader)?;
        Ok(Self { images, gyro, ticks })
    }

    pub(super) fn gyro(&self) -> GyroAngle {
        GyroAngle::new(&self.gyro)
    }

    pub(super) fn wheels(&self) -> WheelAngles {
        WheelAngles::new(&self.ticks, self.images.robot.drive.ticks_per_turn)
    }

    /// The upward axis in the camera's frame by the mount in use.
    pub(super) fn expected_up(&self) -> Vector3 {
        self.images.robot.mount.base_from_camera().inverse().rotate(Vector3::z())
    }

    /// Names the recording in front of an error.
    pub(super) fn refused(&self, problem: &dyn std::fmt::Display) -> AppError {
        AppError::Input(format!("{}: {problem}", self.images.path.display()))
    }
}

/// Readings of gyro and wheels.
fn read_base(mut reader: RecordingReader) -> Result<(Vec<GyroRate>, Vec<WheelTicks>), AppError> {
    let (mut gyro, mut ticks) = (Vec::new(), Vec::new());
    while let Some(message) = reader.next_message()? {
        match message {
            RecordedMessage::Event(EncodedEvent::Gyro(rate)) => gyro.push(rate),
            RecordedMessage::Event(EncodedEvent::Wheels(reading)) => ticks.push(reading),
            _ => {}
        }
    }
    Ok((gyro, ticks))
}
