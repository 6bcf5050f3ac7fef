//! Images of a recorded camera as a TUM folder: a dump of a Kinect V2, a recording of a RealSense, a file of a camera stream.

use super::form::{Converted, SequenceForm};
use crate::hardware::OpenCamera;
use crate::sequence_input::SequenceOptions;
use crate::{AppError, StepProgress, stop};
use std::time::Duration;
use trundle_core::{ColorImage, DepthImage, Invalid, RgbdImage, Stamp};
use trundle_drivers::CameraSpec;
use trundle_drivers::camera::pixels::{color_from_raw, depth_from_raw};
use trundle_drivers::camera::registration::Registration;
use trundle_drivers::camera::{CameraFrame, DepthCamera};
use trundle_io::{OutputFolder, TumFrame, TumWriter};

/// Longest wait for a frame of a recording before the next check for the end of the work. Source: ours.
const FRAME_TIMEOUT: Duration = Duration::from_secs(1);

/// A camera that plays a recording.
pub struct RecordedCamera {
    name: String,
    camera: Box<dyn DepthCamera>,
}

impl RecordedCamera {
    /// The camera that the input of `options` names, as `kinect2-dump:FILE` or `realsense:FILE.db3`; `None` if it names a file or folder.
    #[must_use]
    pub fn named_by(options: &SequenceOptions<'_>) -> Option<CameraSpec> {
        let name = options.path.to_str().filter(|name| name.contains(':') && !options.path.exists());
        name?.parse().ok()
    }

    /// Opens the recording.
    ///
    /// # Errors
    /// When the camera cannot be opened or is live, or an option or the form does not suit it.
    pub fn open(
        spec: &CameraSpec,
        options: &SequenceOptions<'_>,
        form: SequenceForm,
    ) -> Result<Self, AppError> {
        refuse_idle(spec, options, form)?;
        let opened = OpenCamera::open(spec)?;
        opened.require_recording()?;
        Ok(Self { name: spec.to_string(), camera: opened.into_camera() })
    }

    /// Writes the images, depth registered to colour, into `folder`. A damaged frame is left out with a warning.
    ///
    /// # Errors
    /// When the recording breaks, contains no image, or the folder cannot be written.
    pub fn to_tum(
        mut self,
        folder: &OutputFolder,
        progress: &dyn StepProgress,
    ) -> Result<Converted, AppError> {
        let info = self.camera.info().clone();
        let mut frames = Frames::new(Registration::new(&info, None), info.depth_unit_m);
        let mut writer = TumWriter::new(folder, info.color.camera, info.color.rate_hz);
        let mut converted = Converted { images: 0, skipped: 0, scans: 0 };
        progress.begin(None);
        while !self.camera.has_ended() {
            if stop::is_requested(|| format!("{} images", converted.images)) {
                return Err(AppError::Stopped);
            }
            match self.next_image(&mut frames)? {
                Some(Ok(image)) => {
                    writer.frame(&TumFrame::encode(&image).map_err(AppError::input)?)?;
                    converted.images += 1;
                    progress.advance();
                }
                Some(Err(problem)) => {
                    tracing::warn!("{}: {problem}; the frame is left out", self.name);
                    converted.skipped += 1;
                }
                None => {}
            }
        }
        progress.end();
        if converted.images == 0 {
            return Err(AppError::Input(format!(
                "{}: no image can be used, {} frames are damaged",
                self.name, converted.skipped
            )));
        }
        writer.finish()?;
        Ok(converted)
    }

    /// The next image, or the reason why the next frame is none; `None` if no frame came in time.
    fn next_image(&mut self, frames: &mut Frames) -> Result<Option<Result<RgbdImage, String>>, AppError> {
        match self.camera.next_frame(FRAME_TIMEOUT) {
            Ok(None) => Ok(None),
            Ok(Some(frame)) => Ok(Some(frames.image(&frame))),
            Err(error) if error.is_of_one_frame() => Ok(Some(Err(error.to_string()))),
            Err(error) => Err(AppError::Input(format!("camera {}: {error}", self.name))),
        }
    }
}

/// Refuses what has no effect on a camera, and the forms that need more than images.
fn refuse_idle(spec: &CameraSpec, options: &SequenceOptions<'_>, form: SequenceForm) -> Result<(), AppError> {
    let refused = |problem: String| Err(AppError::Input(problem));
    if form != SequenceForm::TumFolder {
        return refused(format!(
            "{spec} is the recording of a camera, expected --to tum for it; convert the folder again for a bag"
        ));
    }
    if options.camera.is_some() || options.depth_scale.is_some() {
        return refused(format!(
            "--camera and --depth-scale have no effect on {spec}, which contains its own intrinsics, expected none of them"
        ));
    }
    match options.first_topic() {
        Some((option, topic)) => {
            refused(format!("{option} {topic} has no effect on {spec}, expected a ROS 2 bag or no {option}"))
        }
        None => Ok(()),
    }
}

/// Frames to registered images; the images in between are reused.
struct Frames {
    registration: Registration,
    depth_unit_m: f64,
    color: ColorImage,
    depth: DepthImage,
    last: Option<Stamp>,
}

impl Frames {
    fn new(registration: Registration, depth_unit_m: f64) -> Self {
        let (color, depth) = Default::default();
        Self { registration, depth_unit_m, color, depth, last: None }
    }

    fn image(&mut self, frame: &CameraFrame) -> Result<RgbdImage, String> {
        let stamp = frame.color.device_stamp;
        if self.last.is_some_and(|last| stamp <= last) {
            return Err(format!(
                "the frame at {stamp} s does not follow the one before, expected a later time"
            ));
        }
        let image = self.registered(stamp, frame).map_err(|problem| problem.to_string())?;
        self.last = Some(stamp);
        Ok(image)
    }

    fn registered(&mut self, stamp: Stamp, frame: &CameraFrame) -> Result<RgbdImage, Invalid> {
        color_from_raw(&frame.color, &mut self.color)?;
        depth_from_raw(&frame.depth, self.depth_unit_m, &mut self.depth)?;
        self.registration.register(stamp, &self.color, &self.depth)
    }
}
