//! The TUM RGB-D folder of a drive: images, ground truth, odometry, laser log, true map.

use rayon::prelude::*;
use trundle_app::{AppError, FreeSpace};
use trundle_core::{OccupancyGrid, Pose2, Pose3, RgbdImage, SensorEvent, Stamp, Vector2};
use trundle_estimation::{OdometryConfig, WheelOdometry};
use trundle_io::{CarmenLog, IoError, OutputFolder, Summary, TumFrame, TumWriter, write_map};
use trundle_sim::Simulator;
use trundle_viz::{Color, LineStyle, MapPicture, PoseStyle};

/// Number of images encoded in parallel. Source: ours.
const ENCODED_BATCH: usize = 8;

/// Size of a pixel of colour and depth as PNG \[bytes\]. Source: recordings of the built-in scenes.
const BYTES_PER_PIXEL: f64 = 3.2;

/// Size of the recording of a drive in a sentence; `duration` in s, if known.
#[must_use]
pub fn recording_announcement(robot: &Simulator, duration: Option<f64>) -> String {
    let (camera, config) = (robot.camera(), robot.config());
    let pixels = (camera.width() * camera.height()) as f64;
    let rate = BYTES_PER_PIXEL * pixels * config.camera_rate_hz / 1e6;
    let total = duration.map_or_else(String::new, |s| format!(", {:.0} MB in {s} s", rate * s));
    format!("Records about {rate:.1} MB per second of the robot's time{total}.")
}

/// The TUM folder of a drive.
pub struct DriveRecording<'f> {
    folder: &'f OutputFolder,
    tum: TumWriter<'f>,
    wheels: WheelOdometry,
    laser: Option<CarmenLog>,
    base_from_camera: Pose3,
    waiting: Vec<RgbdImage>,
    space: FreeSpace,
    /// `world_from_base`.
    truth: Vec<(Stamp, Pose2)>,
    /// `odom_from_base`.
    odometry: Vec<(Stamp, Pose2)>,
}

impl<'f> DriveRecording<'f> {
    /// An empty folder for the events of `robot`.
    ///
    /// # Errors
    /// When the base is invalid, or the disk is short of space.
    pub fn new(folder: &'f OutputFolder, robot: &Simulator) -> Result<Self, AppError> {
        let config = robot.config();
        let space = FreeSpace::of(&folder.staged(""));
        if let Some(problem) = space.shortage() {
            return Err(AppError::Environment(format!("{}: {problem}", folder.target().display())));
        }
        Ok(Self {
            folder,
            tum: TumWriter::new(folder, *robot.camera(), config.camera_rate_hz),
            wheels: WheelOdometry::new(config.kobuki.drive, OdometryConfig::default())?,
            laser: config.laser.as_ref().map(|laser| CarmenLog::new(laser.range_max)),
            base_from_camera: config.base_from_camera,
            waiting: Vec::with_capacity(ENCODED_BATCH),
            space,
            truth: Vec::new(),
            odometry: Vec::new(),
        })
    }

    /// Records an event.
    ///
    /// # Errors
    /// When an image cannot be encoded or written.
    pub fn on_event(&mut self, event: SensorEvent) -> Result<(), AppError> {
        match event {
            SensorEvent::Wheels(ticks) => {
                let odometry = self.wheels.step_wheels(&ticks);
                self.tum.odometry(ticks.stamp, odometry.pose);
                self.odometry.push((ticks.stamp, odometry.pose));
                if let Some(log) = &mut self.laser {
                    log.odometry(ticks.stamp, odometry.pose, odometry.twist);
                }
            }
            SensorEvent::Gyro(rate) => self.wheels.step_gyro(&rate),
            SensorEvent::Rgbd(image) => {
                self.waiting.push(image);
                if self.waiting.len() == ENCODED_BATCH {
                    self.flush()?;
                }
            }
            SensorEvent::Truth { stamp, pose } => {
                self.tum.ground_truth(stamp, Pose3::from_pose2(pose) * self.base_from_camera);
                self.truth.push((stamp, pose));
            }
            SensorEvent::Scan(scan) => self.laser.iter_mut().for_each(|log| log.scan(&scan)),
            _ => {}
        }
        Ok(())
    }

    /// Whether the disk has refused a file, which ends the drive.
    pub fn is_refused(&self) -> bool {
        self.folder.is_incomplete()
    }

    /// Writes the remaining files, with the true map; the caller commits the folder.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn finish(mut self, grid: &OccupancyGrid, start: Pose2, summary: &Summary) -> Result<(), AppError> {
        self.flush()?;
        write_map(self.folder, "map", grid)?;
        self.folder.write("overview.png", &self.overview(grid, start))?;
        if let Some(log) = self.laser.take() {
            self.folder.write("laser.log", log.into_text().as_bytes())?;
        }
        self.folder.write("summary.json", summary.to_json().as_bytes())?;
        Ok(self.tum.finish()?)
    }

    fn flush(&mut self) -> Result<(), AppError> {
        if let Some(problem) = self.space.shortage() {
            self.waiting.clear();
            self.folder.leave_out(IoError::Malformed { path: self.folder.target().join("rgb"), problem });
            return Ok(());
        }
        let encoded: Result<Vec<_>, _> = self.waiting.par_iter().map(TumFrame::encode).collect();
        for frame in encoded.map_err(|error| AppError::Input(error.to_string()))? {
            self.tum.frame(&frame)?;
        }
        self.waiting.clear();
        Ok(())
    }

    /// A picture of the drive on the map.
    fn overview(&self, grid: &OccupancyGrid, start: Pose2) -> Vec<u8> {
        let truth: Vec<Vector2> = self.truth.iter().map(|(_, pose)| pose.position()).collect();
        let odometry: Vec<Vector2> =
            self.odometry.iter().map(|(_, pose)| (start * *pose).position()).collect();
        let mut picture = MapPicture::over(grid)
            .polyline("odometry", &odometry, LineStyle::solid(Color::VERMILLION))
            .polyline("true path", &truth, LineStyle::solid(Color::BLUE))
            .pose("start", start, PoseStyle::named(Color::GREEN));
        if let Some((_, end)) = self.truth.last() {
            picture = picture.pose("end", *end, PoseStyle::named(Color::VERMILLION));
        }
        picture.to_png()
    }
}
