//! The run of a robot that something else drove: images and odometry of a bag or a folder, processed as by a live robot without a mission.

use crate::encoded_body::{EncodedBody, RunInput};
use crate::sequence_input::{PendingFrame, SequenceInput};
use crate::{AppError, RunSetup};
use std::iter::Peekable;
use trundle_core::{Odometry, Pose2, Stamp, Twist2};
use trundle_io::EncodedEvent;
use trundle_runtime::{Answer, Job, Mission, Worker};

/// Images, odometry and ground truth of a sequence as the events of a run, in the order of a live robot: an image follows the first odometry
/// at or after its stamp. A damaged image is left out with a warning.
pub struct SequenceEvents<'a> {
    frames: Peekable<Box<dyn Iterator<Item = Result<PendingFrame<'a>, AppError>> + 'a>>,
    /// Odometry and truth, the last one first.
    poses: Vec<EncodedEvent>,
    /// Stamp of the newest odometry that was handed out.
    newest: Option<Stamp>,
    images: usize,
    skipped: usize,
}

impl<'a> SequenceEvents<'a> {
    /// The events of a sequence with odometry.
    ///
    /// # Errors
    /// When the sequence has no odometry, or cannot be opened again.
    pub fn of(input: &'a SequenceInput) -> Result<Self, AppError> {
        let odometry = input.odometry().unwrap_or_default();
        if odometry.is_empty() {
            return Err(AppError::Input(format!(
                "{}: no odometry, expected nav_msgs/Odometry or transforms from odom to the base in a bag, odometry.txt in a folder: a robot's \
                 run needs it; `trundle slam` and `trundle map` take the images alone",
                input.path.display()
            )));
        }
        let mut poses: Vec<_> = with_twists(odometry).map(EncodedEvent::Odometry).collect();
        poses.extend(base_truths(input).map(|(stamp, pose)| EncodedEvent::Truth { stamp, pose }));
        poses.sort_by_key(|event| std::cmp::Reverse(event.stamp()));
        let frames: Box<dyn Iterator<Item = _>> = Box::new(input.frames()?);
        Ok(Self { frames: frames.peekable(), poses, newest: None, images: 0, skipped: 0 })
    }

    /// Number of images handed out, and of damaged ones.
    #[must_use]
    pub fn image_counts(&self) -> (usize, usize) {
        (self.images, self.skipped)
    }

    /// Whether the next image's odometry was handed out, or no pose is left.
    fn image_is_due(&mut self) -> bool {
        let stamp = match self.frames.peek() {
            Some(Ok(frame)) => frame.stamp(),
            Some(Err(_)) => return true,
            None => return false,
        };
        self.poses.is_empty() || self.newest.is_some_and(|newest| newest >= stamp)
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
        let pose = self.poses.pop();
        if let Some(EncodedEvent::Odometry(odometry)) = &pose {
            self.newest = Some(odometry.stamp);
        }
        Ok(pose)
    }
}

impl Iterator for SequenceEvents<'_> {
    type Item = Result<EncodedEvent, AppError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_event().transpose()
    }
}

/// Odometry with the twist since the pose before. The covariance is zero: the noise is that of the robot's wheels.
fn with_twists(poses: &[(Stamp, Pose2)]) -> impl Iterator<Item = Odometry> {
    let before = std::iter::once(None).chain(poses.iter().map(Some));
    before.zip(poses).map(|(before, (stamp, pose))| {
        let twist = before.filter(|(last, _)| last < stamp).map_or(Twist2::ZERO, |(last, from)| {
            let (motion, dt) = (from.inverse() * *pose, *stamp - *last);
            Twist2::new(motion.x / dt, motion.theta / dt)
        });
        Odometry { stamp: *stamp, pose: *pose, twist, covariance: nalgebra::Matrix3::zeros() }
    })
}

/// `world_from_base` of the ground truth, by the mount of the robot that is run; empty without truth.
fn base_truths(input: &SequenceInput) -> impl Iterator<Item = (Stamp, Pose2)> {
    let mount = input.level_from_first_camera().unwrap_or_else(|| input.robot.mount.base_from_camera());
    let camera_from_base = mount.inverse();
    let truths = input.ground_truth().unwrap_or_default();
    truths.iter().map(move |(stamp, pose)| (*stamp, (*pose * camera_from_base).to_pose2()))
}

/// The setup of the run: the input's robot without a mission.
#[must_use]
pub fn sequence_setup(input: &SequenceInput) -> RunSetup {
    let mut robot = input.robot.clone();
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
    images: usize,
}

impl<'a> SequenceBody<'a> {
    /// The body of a sequence with odometry.
    ///
    /// # Errors
    /// As [`SequenceEvents::of`].
    pub fn new(input: &'a SequenceInput) -> Result<Self, AppError> {
        Ok(Self { events: SequenceEvents::of(input)?, images: input.len() })
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
        let (images, skipped) = self.events.image_counts();
        Some((images + skipped) as f64 / self.images.max(1) as f64)
    }
}
