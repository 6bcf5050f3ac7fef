//! Conversion of RGB-D images with their poses, and of a robot's other sensors: ROS bag, TUM folder or recording into another of these
//! forms, and the recording of a camera into a TUM folder.

mod form;
mod recorded_camera;

pub use form::{Converted, SequenceForm};
pub use recorded_camera::RecordedCamera;

use crate::sequence::SequenceRequest;
use crate::sequence_input::{PendingFrame, SequenceInput, SequenceOptions};
use crate::sequence_run::{SequenceEvents, sequence_setup};
use crate::{AppError, StepProgress, stop};
use trundle_core::{FrameId, Pose3, RgbdImage, Stamp};
use trundle_io::ros_message::RosMessage;
use trundle_io::{EncodedEvent, EncodedRgbd, OutputFolder, Recorder, TumFrame, TumWriter, ros_message};

/// Name of the file of a ROS 2 bag in its folder.
const BAG_FILE: &str = "bag.mcap";
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
    match form {
        SequenceForm::Recording => SequenceRequest::of_options(&options.clone().for_robot(), None).open(),
        SequenceForm::TumFolder | SequenceForm::RosBag => SequenceInput::open(options),
    }
}

/// Writes the images of `input`, its odometry and its ground truth into `folder`. A damaged image is left out with a warning.
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
        SequenceForm::RosBag => to_bag(input, folder, progress),
        SequenceForm::Recording => to_recording(input, folder, progress),
    }
}

fn to_tum(
    input: &SequenceInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<Converted, AppError> {
    let mut writer = TumWriter::new(folder, input.camera.model.camera, DEFAULT_RATE_HZ);
    let converted = each_image(input, progress, |_, image| {
        let frame = TumFrame::encode(&image).map_err(AppError::input)?;
        Ok(writer.frame(&frame)?)
    })?;
    input.odometry_of_base().into_iter().flatten().for_each(|(stamp, pose)| writer.odometry(*stamp, *pose));
    input.ground_truth().into_iter().flatten().for_each(|(stamp, pose)| writer.ground_truth(*stamp, *pose));
    writer.finish()?;
    Ok(converted)
}

fn to_bag(
    input: &SequenceInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<Converted, AppError> {
    let mut bag = folder.bag(BAG_FILE)?;
    bag.set_camera(input.camera.model.camera);
    if input.camera.model.camera.readout() > 0.0 {
        tracing::warn!(
            "camera_info holds no readout time: give the camera with --camera when the bag is read"
        );
    }
    let (base, camera) = (FrameId::Base.to_string(), FrameId::Camera.to_string());
    let mut poses = poses(input, &base, &camera);
    poses.reverse();
    let mut mount = input.level_from_first_camera();
    let mut write = |bag: &mut Recorder<_>, until: Stamp| -> Result<(), AppError> {
        if let Some(pose) = mount.take() {
            bag.record_message(
                "/tf_static",
                until,
                &ros_message::transforms(&[(until, &base, &camera, pose)]),
            )?;
        }
        while let Some((stamp, topic, message)) = poses.pop_if(|(stamp, ..)| *stamp <= until) {
            bag.record_message(topic, stamp, &message)?;
        }
        Ok(())
    };
    let converted = each_image(input, progress, |frame, image| {
        write(&mut bag, image.stamp())?;
        let encoded: EncodedRgbd = frame.encoded(&image).map_err(AppError::input)?;
        Ok(bag.record_images(&encoded)?)
    })?;
    write(&mut bag, Stamp::from_nanos(i64::MAX))?;
    bag.finish()?;
    Ok(converted)
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

/// Odometry and ground truth as messages with their topics, in the order of their stamps.
fn poses(input: &SequenceInput, base: &str, camera: &str) -> Vec<(Stamp, &'static str, RosMessage)> {
    let (odom, world) = (FrameId::Odom.to_string(), FrameId::World.to_string());
    let odometry = input.odometry_of_base().into_iter().flatten().map(|(stamp, pose)| {
        let pose = Pose3::from_pose2(*pose);
        (*stamp, "/odom", ros_message::odometry_pose(*stamp, &odom, base, pose))
    });
    let truth = input.ground_truth().into_iter().flatten().map(|(stamp, pose)| {
        (*stamp, "/ground_truth", ros_message::odometry_pose(*stamp, &world, camera, *pose))
    });
    let mut all: Vec<_> = odometry.chain(truth).collect();
    all.sort_by_key(|(stamp, ..)| *stamp);
    all
}

/// Hands on each image that is whole.
fn each_image(
    input: &SequenceInput,
    progress: &dyn StepProgress,
    mut write: impl FnMut(PendingFrame<'_>, RgbdImage) -> Result<(), AppError>,
) -> Result<Converted, AppError> {
    let mut converted = Converted { images: 0, skipped: 0, scans: 0 };
    progress.begin(Some(input.len()));
    for frame in input.frames()? {
        if stop::is_requested(|| format!("{} of {} images", converted.images, input.len())) {
            return Err(AppError::Stopped);
        }
        let frame = frame?;
        match frame.decode() {
            Ok(image) => {
                write(frame, image)?;
                converted.images += 1;
            }
            Err(problem) => {
                tracing::warn!("{problem}; the image is left out");
                converted.skipped += 1;
            }
        }
        progress.advance();
    }
    progress.end();
    finished(input, converted)
}

fn finished(input: &SequenceInput, converted: Converted) -> Result<Converted, AppError> {
    if converted.images == 0 && converted.scans == 0 {
        return Err(AppError::Input(format!("{}: no image can be used", input.path.display())));
    }
    Ok(converted)
}
