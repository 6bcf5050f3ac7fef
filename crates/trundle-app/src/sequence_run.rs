//! The run of a robot that something else drove: the sensors of a bag or a folder, processed as by a live robot without a mission.

use crate::encoded_body::{EncodedBody, RunInput};
use crate::sequence_input::{PendingFrame, SequenceInput, motion_events};
use crate::{AppError, RunSetup, log_warnings};
use std::iter::Peekable;
use trundle_core::{Pose2, Pose3, SensorEvent, Stamp, Twist2};
use trundle_io::EncodedEvent;
use trundle_runtime::{Answer, Job, Mission, RangeSource, Worker};

/// The sensors and the ground truth of a sequence as the events of a run, in the order of a live robot: an image follows the first odometry
/// at or after its stamp, a scan that after its last beam. A damaged image is left out with a warning.
pub struct SequenceEvents<'a> {
    input: &'a SequenceInput,
    frames: Peekable<Box<dyn Iterator<Item = Result<PendingFrame<'a>, AppError>> + 'a>>,
    /// All but the images, the last one first.
    others: Vec<OtherEvent>,
    /// Number of events other than images in the sequence.
    other_count: usize,
    /// Stamp of the newest odometry that was handed out.
    newest: Option<Stamp>,
    images: usize,
    skipped: usize,
}

/// An event other than an image.
enum OtherEvent {
    Ready(EncodedEvent),
    /// A scan by its index.
    Scan(usize),
}

impl<'a> SequenceEvents<'a> {
    /// The events of a sequence with odometry. Jumps of the odometry are logged.
    ///
    /// # Errors
    /// When the sequence has no odometry, or cannot be opened again.
    pub fn of(input: &'a SequenceInput) -> Result<Self, AppError> {
        let odometry = input.odometry_of_base().unwrap_or_default();
        if odometry.is_empty() {
            return Err(AppError::Input(format!(
                "{}: no odometry, expected nav_msgs/Odometry or transforms from odom to the base in a bag, odometry.txt in a folder: a robot's \
                 run needs it; `trundle slam` and `trundle map` take the images alone",
                input.path.display()
            )));
        }
        let others = other_events(input, odometry)?;
        let frames: Box<dyn Iterator<Item = _>> = Box::new(input.frames()?);
        let (frames, other_count) = (frames.peekable(), others.len());
        Ok(Self { input, frames, others, other_count, newest: None, images: 0, skipped: 0 })
    }

    /// Number of images handed out, and of damaged ones.
    #[must_use]
    pub fn image_counts(&self) -> (usize, usize) {
        (self.images, self.skipped)
    }

    /// The part of the sequence that was handed out: of the images, or of the other events if there are no images.
    fn fraction_read(&self) -> f64 {
        let (read, all) = match self.input.len() {
            0 => (self.other_count - self.others.len(), self.other_count),
            images => (self.images + self.skipped, images),
        };
        read as f64 / all.max(1) as f64
    }

    /// Whether the next image's odometry was handed out, or no other event is left.
    fn image_is_due(&mut self) -> bool {
        let stamp = match self.frames.peek() {
            Some(Ok(frame)) => frame.stamp(),
            Some(Err(_)) => return true,
            None => return false,
        };
        self.others.is_empty() || self.newest.is_some_and(|newest| newest >= stamp)
    }

    /// The image; `None` for a damaged one.
    fn image(&mut self, frame: PendingFrame<'a>) -> Result<Option<EncodedEvent>, AppError> {
        let image = match frame.decode() {
            Ok(image) => image,
            Err(problem) => {
                tracing::warn!("{problem}; the image is left out");
                self.skipped += 1;
                return Ok(None);
            }
        };
        self.images += 1;
        frame.encoded(&image).map(EncodedEvent::Rgbd).map(Some).map_err(AppError::input)
    }

    fn next_event(&mut self) -> Result<Option<EncodedEvent>, AppError> {
        while self.image_is_due() {
            let Some(frame) = self.frames.next() else { break };
            if let Some(image) = self.image(frame?)? {
                return Ok(Some(image));
            }
        }
        while let Some(other) = self.others.pop() {
            let event = match other {
                OtherEvent::Ready(event) => Some(event),
                OtherEvent::Scan(index) => self.input.scan(index).map(EncodedEvent::Scan),
            };
            if let Some(EncodedEvent::Odometry(_) | EncodedEvent::Wheels(_)) = &event {
                self.newest = event.as_ref().map(EncodedEvent::stamp);
            }
            if event.is_some() {
                return Ok(event);
            }
        }
        Ok(None)
    }
}

impl Iterator for SequenceEvents<'_> {
    type Item = Result<EncodedEvent, AppError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_event().transpose()
    }
}

/// Odometry, gyro, truth and scans, the last one first. Of events that are due at one time the order is gyro, truth, odometry, scan.
fn other_events(input: &SequenceInput, odometry: &[(Stamp, Pose2)]) -> Result<Vec<OtherEvent>, AppError> {
    let (motion, jumps) = motion_events(odometry, input.gyro(), input.robot.drive);
    log_warnings(&jumps);
    let mut all = Vec::with_capacity(motion.len());
    for event in &motion {
        let rank = if matches!(event, SensorEvent::Gyro(_)) { 0 } else { 2 };
        let event = EncodedEvent::encode(event).map_err(AppError::input)?;
        all.push(((event.stamp(), rank), OtherEvent::Ready(event)));
    }
    for (stamp, pose) in base_truths(input) {
        all.push(((stamp, 1), OtherEvent::Ready(EncodedEvent::Truth { stamp, pose })));
    }
    for (index, (_, end)) in input.scan_times().into_iter().enumerate() {
        let after = odometry.partition_point(|(stamp, _)| *stamp < end);
        let due = odometry.get(after).map_or(end, |(stamp, _)| *stamp);
        all.push(((due, 3), OtherEvent::Scan(index)));
    }
    all.sort_by_key(|(due, _)| *due);
    Ok(all.into_iter().rev().map(|(_, event)| event).collect())
}

/// `world_from_base` of the ground truth, by the mount of the robot that is run; empty without truth.
fn base_truths(input: &SequenceInput) -> impl Iterator<Item = (Stamp, Pose2)> {
    let mount = input.level_from_first_camera().unwrap_or_else(|| input.robot.mount.base_from_camera());
    // Without images the truth is that of the base.
    let camera_from_base = if input.is_empty() { Pose3::identity() } else { mount.inverse() };
    let truths = input.ground_truth().unwrap_or_default();
    truths.iter().map(move |(stamp, pose)| (*stamp, (*pose * camera_from_base).to_pose2()))
}

/// The setup of the run: the input's robot without a mission. Its scans are those of the laser if the input has one, as on a live robot.
#[must_use]
pub fn sequence_setup(input: &SequenceInput) -> RunSetup {
    let mut robot = input.robot.clone();
    let has_laser = !input.scan_times().is_empty();
    if robot.sight == RangeSource::Laser && !has_laser {
        tracing::warn!(
            "{}: no usable scans of a laser; the depth camera is the range source",
            input.path.display()
        );
    }
    robot.sight = if has_laser { RangeSource::Laser } else { RangeSource::DepthCamera };
    // The stamps of a sequence are those of the exposures.
    robot.image_delay = 0.0;
    let name = input.path.display().to_string();
    let mut setup = RunSetup::new(&name, Mission::default(), robot).by_command(RunSetup::SENSORS).operated();
    let start = input.odometry().and_then(|odometry| odometry.first()).map(|(stamp, _)| *stamp);
    let truth = start.and_then(|start| {
        base_truths(input).min_by(|(a, _), (b, _)| (*a - start).abs().total_cmp(&(*b - start).abs()))
    });
    setup.map_from_world = truth.map_or(Pose2::IDENTITY, |(_, pose)| pose.inverse());
    setup
}

/// A sequence as the robot's body, which follows no command.
pub struct SequenceBody<'a> {
    events: SequenceEvents<'a>,
}

impl<'a> SequenceBody<'a> {
    /// The body of a sequence with odometry.
    ///
    /// # Errors
    /// As [`SequenceEvents::of`].
    pub fn new(input: &'a SequenceInput) -> Result<Self, AppError> {
        Ok(Self { events: SequenceEvents::of(input)? })
    }
}

impl EncodedBody for SequenceBody<'_> {
    fn next_input(&mut self) -> Result<Option<RunInput>, AppError> {
        Ok(self.events.next().transpose()?.map(RunInput::Event))
    }

    fn send_command(&mut self, _twist: Twist2) -> Result<(), AppError> {
        Ok(())
    }

    /// The robot's long work is done within its steps.
    fn start_job(&mut self, _job: Job) {}

    fn finish_job(&mut self, _worker: Worker) -> Option<Answer> {
        None
    }

    fn true_contacts(&self) -> Option<u32> {
        None
    }

    fn fraction_read(&self) -> Option<f64> {
        Some(self.events.fraction_read())
    }
}
