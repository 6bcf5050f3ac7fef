//! Conversion of RGB-D images with their poses, and of a robot's other sensors: ROS bag, TUM folder or recording into another of these
//! forms, and the recording of a camera into a TUM folder.

mod bag;
mod form;
mod images;
mod recorded_camera;

pub use form::{Converted, SequenceForm};
pub use recorded_camera::RecordedCamera;

use crate::sequence::SequenceRequest;
use crate::sequence_input::{SequenceInput, SequenceOptions};
use crate::sequence_run::{SequenceEvents, sequence_setup};
use crate::{AppError, StepProgress, stop};
use images::{each_image, finished};
use trundle_io::{EncodedEvent, OutputFolder, TumFrame, TumWriter};

/// Name of a recording in its folder.
const RECORDING_FILE: &str = "recording.mcap";
/// Rate of the images if the input gives no rate \[Hz\]; the rate of the simulated camera. Source: ours.
const DEFAULT_RATE_HZ: f64 = 15.0;

/// Input of a conversion.
pub enum ConversionInput {
    /// A ROS bag, a TUM folder or a recording of trundle.
    Sequence(Box<SequenceInput>),
    /// The recording of a camera.
    Camera(RecordedCamera),
}

impl ConversionInput {
    /// Opens what `options` name: the recording of a camera, as `kinect2-dump:FILE`, or a sequence.
    ///
    /// # Errors
    /// As [`RecordedCamera::open`] and [`open_for`].
    pub fn open(options: &SequenceOptions<'_>, form: SequenceForm) -> Result<Self, AppError> {
        match RecordedCamera::named_by(options) {
            Some(spec) => Ok(Self::Camera(RecordedCamera::open(&spec, options, form)?)),
            None => Ok(Self::Sequence(Box::new(open_for(options, form)?))),
        }
    }

    /// Writes the images into `folder`.
    ///
    /// # Errors
    /// As [`RecordedCamera::to_tum`] and [`convert_sequence`].
    pub fn convert(
        self,
        form: SequenceForm,
        folder: &OutputFolder,
        progress: &dyn StepProgress,
    ) -> Result<Converted, AppError> {
        match self {
            Self::Sequence(input) => convert_sequence(&input, form, folder, progress),
            Self::Camera(camera) => camera.to_tum(folder, progress),
        }
    }
}

/// Opens a sequence for its conversion into `form`. A recording needs the camera's mount, which the floor in the images shows where the
/// input has none.
///
/// # Errors
/// As [`SequenceInput::open`].
pub fn open_for(options: &SequenceOptions<'_>, form: SequenceForm) -> Result<SequenceInput, AppError> {
    let with_laser = options.clone().for_robot();
    match form {
        SequenceForm::Recording => SequenceRequest::of_options(&with_laser, None).open(),
        SequenceForm::RosBag => SequenceInput::open(&with_laser),
        SequenceForm::TumFolder => {
            options.refuse_unused_scans()?;
            SequenceInput::open(&with_laser)
        }
    }
}

/// Sensors of `input` that a TUM folder has no file for, in one sentence; `None` without them.
#[must_use]
pub fn lost_in_tum(input: &SequenceInput) -> Option<String> {
    let (gyro, scans) = (input.gyro().len(), input.scan_stamps().len());
    (gyro + scans > 0).then(|| {
        format!(
            "{}: {gyro} readings of a gyro and {scans} scans of a laser are left out, since a TUM folder has no file for them; \
             `--to recording` and `--to bag` keep them",
            input.path.display()
        )
    })
}

/// Writes the images of `input`, its odometry and its ground truth into `folder`, and its gyro and scans if the form has them. A damaged
/// image is left out with a warning.
///
/// # Errors
/// When the input breaks, no image can be used, or the folder cannot be written.
pub fn convert_sequence(
    input: &SequenceInput,
    form: SequenceForm,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<Converted, AppError> {
    match form {
        SequenceForm::TumFolder => to_tum(input, folder, progress),
        SequenceForm::RosBag => bag::write(input, folder, progress),
        SequenceForm::Recording => to_recording(input, folder, progress),
    }
}

fn to_tum(
    input: &SequenceInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<Converted, AppError> {
    if input.is_empty() {
        let problem =
            "no images, expected some for --to tum; `--to recording` and `--to bag` take the laser alone";
        return Err(AppError::Input(format!("{}: {problem}", input.path.display())));
    }
    lost_in_tum(input).into_iter().for_each(|lost| tracing::warn!("{lost}"));
    let mut writer = TumWriter::new(folder, input.camera.model.camera, DEFAULT_RATE_HZ);
    let converted = each_image(input, progress, |_, image| {
        let frame = TumFrame::encode(&image).map_err(AppError::input)?;
        Ok(writer.frame(&frame)?)
    })?;
    input.odometry_of_base().into_iter().flatten().for_each(|(stamp, pose)| writer.odometry(*stamp, *pose));
    input.ground_truth().into_iter().flatten().for_each(|(stamp, pose)| writer.ground_truth(*stamp, *pose));
    writer.finish()?;
    finished(input, converted)
}

fn to_recording(
    input: &SequenceInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<Converted, AppError> {
    if input.is_recording() {
        let problem =
            "this is a recording of trundle already, expected a ROS 2 bag or a TUM folder for --to recording";
        return Err(AppError::Input(format!("{}: {problem}", input.path.display())));
    }
    let mut events = SequenceEvents::of(input)?.peekable();
    let mut recording = folder.recorder(RECORDING_FILE)?;
    if !input.is_empty() {
        recording.set_camera(input.camera.model.camera);
    }
    let begin = events.peek().and_then(|event| event.as_ref().ok()).map(EncodedEvent::stamp);
    recording.record_json("/config", "trundle.Config", begin.unwrap_or_default(), &sequence_setup(input))?;
    progress.begin((!input.is_empty()).then_some(input.len()));
    let (mut images, mut scans) = (0, 0);
    for event in events.by_ref() {
        let event = event?;
        recording.record_event(&event)?;
        scans += usize::from(matches!(event, EncodedEvent::Scan(_)));
        if matches!(event, EncodedEvent::Rgbd(_)) {
            images += 1;
            progress.advance();
            if stop::is_requested(|| format!("{images} of {} images", input.len())) {
                return Err(AppError::Stopped);
            }
        }
    }
    progress.end();
    recording.finish()?;
    finished(input, Converted { images, skipped: input.len() - images, scans })
}
