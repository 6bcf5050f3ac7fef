//! Data of a run's recording other than images: the robot, odometry, truth, scans of a laser.

use crate::setup::RunSetup;
use crate::{AppError, RecordingContent};
use std::path::{Path, PathBuf};
use trundle_core::{Pose2, Pose3, Scan, Stamp};
use trundle_estimation::WheelOdometry;
use trundle_io::{EncodedEvent, RecordedMessage, RecordingReader};
use trundle_runtime::RobotConfig;

/// A recording of a run, read once without its images.
pub struct RecordedRun {
    file: PathBuf,
    recover: bool,
    robot: Option<RobotConfig>,
    images: usize,
    odometry: Vec<(Stamp, Pose2)>,
    camera_truth: Vec<(Stamp, Pose3)>,
    scans: Vec<Scan>,
    cut_report: Option<String>,
}

impl RecordedRun {
    /// Reads a recording; with `recover` one that is cut, up to the cut.
    ///
    /// # Errors
    /// When the file is not a recording, is broken, or contains an invalid robot.
    pub fn read(file: &Path, recover: bool) -> Result<Self, AppError> {
        let mut reader = open(file, recover)?;
        let setup =
            reader.config().cloned().map(|config| RunSetup::of_recording(file, config)).transpose()?;
        let robot = setup.map(|setup| setup.robot);
        let mut survey = Survey::new(robot.clone().unwrap_or_default())?;
        while let Some(message) = reader.next_message()? {
            if let RecordedMessage::Event(event) = message {
                survey.add(event);
            }
        }
        let Survey { images, odometry, camera_truth, scans, span, .. } = survey;
        let seconds = span.map_or(0.0, |(first, last)| last - first);
        let cut_report = reader.cut().map(|cut| cut.report(seconds));
        let file = file.to_owned();
        Ok(Self { file, recover, robot, images, odometry, camera_truth, scans, cut_report })
    }

    /// The recording again, from its beginning.
    ///
    /// # Errors
    /// When the file can no longer be read.
    pub(super) fn open(&self) -> Result<RecordingReader, AppError> {
        open(&self.file, self.recover)
    }

    /// Refuses a recording without images.
    ///
    /// # Errors
    /// When the recording has no image.
    pub fn require_images(&self) -> Result<(), AppError> {
        if self.images > 0 {
            return Ok(());
        }
        let name = self.file.display();
        Err(AppError::Input(match &self.cut_report {
            Some(report) => format!("{name}: no image before the cut: {report}"),
            None => format!("{name}: {}", RecordingContent::NO_IMAGES),
        }))
    }

    /// The robot of the recording; `None` if the recording contains none.
    #[must_use]
    pub fn robot(&self) -> Option<&RobotConfig> {
        self.robot.as_ref()
    }

    /// Number of images.
    #[must_use]
    pub fn image_count(&self) -> usize {
        self.images
    }

    /// `odom_from_base` by wheels and gyro; `None` for a recording without wheels.
    #[must_use]
    pub fn odometry(&self) -> Option<&[(Stamp, Pose2)]> {
        (!self.odometry.is_empty()).then_some(&self.odometry)
    }

    /// `world_from_camera`; `None` for a recording without truth.
    #[must_use]
    pub fn ground_truth(&self) -> Option<&[(Stamp, Pose3)]> {
        (!self.camera_truth.is_empty()).then_some(&self.camera_truth)
    }

    /// The scans of a 2-D laser, base frame.
    #[must_use]
    pub fn scans(&self) -> &[Scan] {
        &self.scans
    }

    /// Logs a warning if the recording was cut.
    pub fn warn_of_cut(&self) {
        if let Some(report) = &self.cut_report {
            tracing::warn!("{}: {report}", self.file.display());
        }
    }

    /// Position of the cut in the recording, in one sentence; `None` for a complete recording.
    #[must_use]
    pub fn cut_report(&self) -> Option<&str> {
        self.cut_report.as_deref()
    }
}

fn open(file: &Path, recover: bool) -> Result<RecordingReader, AppError> {
    Ok(if recover { RecordingReader::open_to_cut(file)? } else { RecordingReader::open(file)? })
}

/// The events of a recording, added up.
struct Survey {
    base_from_camera: Pose3,
    wheels: WheelOdometry,
    images: usize,
    odometry: Vec<(Stamp, Pose2)>,
    camera_truth: Vec<(Stamp, Pose3)>,
    scans: Vec<Scan>,
    span: Option<(Stamp, Stamp)>,
}

impl Survey {
    fn new(robot: RobotConfig) -> Result<Self, AppError> {
        Ok(Self {
            base_from_camera: robot.mount.base_from_camera(),
            wheels: WheelOdometry::new(robot.drive, robot.odometry)?,
            images: 0,
            odometry: Vec::new(),
            camera_truth: Vec::new(),
            scans: Vec::new(),
            span: None,
        })
    }

    fn add(&mut self, event: EncodedEvent) {
        let stamp = event.stamp();
        self.span = Some((self.span.map_or(stamp, |(first, _)| first), stamp));
        match event {
            EncodedEvent::Gyro(rate) => self.wheels.step_gyro(&rate),
            EncodedEvent::Wheels(ticks) => {
                let odometry = self.wheels.step_wheels(&ticks);
                push_later(&mut self.odometry, odometry.stamp, odometry.pose);
            }
            EncodedEvent::Truth { stamp, pose } => {
                push_later(&mut self.camera_truth, stamp, Pose3::from_pose2(pose) * self.base_from_camera);
            }
            EncodedEvent::Rgbd(_) => self.images += 1,
            EncodedEvent::Scan(scan) => self.scans.push(scan),
            EncodedEvent::Odometry(odometry) => push_later(&mut self.odometry, odometry.stamp, odometry.pose),
            _ => {}
        }
    }
}

/// Adds a pose that is later than the last one.
fn push_later<T>(poses: &mut Vec<(Stamp, T)>, stamp: Stamp, pose: T) {
    if poses.last().is_none_or(|(last, _)| *last < stamp) {
        poses.push((stamp, pose));
    }
}
