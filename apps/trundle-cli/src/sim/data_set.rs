use rayon::prelude::*;
use trundle::app::AppError;
use trundle::core::{OccupancyGrid, Pose2, Pose3, RgbdImage, SensorEvent, Stamp, Vector2};
use trundle::io::{CarmenLog, OutputFolder, Summary, TumFrame, TumWriter, write_map};
use trundle::localization::{OdometryConfig, WheelOdometry};
use trundle::sim::Simulator;
use trundle::viz::{Color, LineStyle, MapPicture, PoseStyle};

/// So many images wait until they are encoded together, on all cores.
const BATCH: usize = 8;

/// The TUM folder of a drive, as it grows.
pub struct DataSet<'f> {
    folder: &'f OutputFolder,
    tum: TumWriter<'f>,
    wheels: WheelOdometry,
    laser: Option<CarmenLog>,
    base_from_camera: Pose3,
    waiting: Vec<RgbdImage>,
    /// `world_from_base`.
    truth: Vec<(Stamp, Pose2)>,
    /// `odom_from_base`.
    odometry: Vec<(Stamp, Pose2)>,
}

impl<'f> DataSet<'f> {
    /// An empty set of what `robot` will say.
    pub fn new(folder: &'f OutputFolder, robot: &Simulator) -> Result<Self, AppError> {
        let config = robot.config();
        Ok(Self {
            folder,
            tum: TumWriter::new(folder, *robot.camera(), config.camera_rate_hz),
            wheels: WheelOdometry::new(config.kobuki.drive, OdometryConfig::default())?,
            laser: config.laser.as_ref().map(|laser| CarmenLog::new(laser.range_max)),
            base_from_camera: config.base_from_camera,
            waiting: Vec::with_capacity(BATCH),
            truth: Vec::new(),
            odometry: Vec::new(),
        })
    }

    /// Takes in what the robot said.
    pub fn note(&mut self, event: SensorEvent) -> Result<(), AppError> {
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
                if self.waiting.len() == BATCH {
                    self.flush()?;
                }
            }
            SensorEvent::Truth { stamp, pose } => {
                self.tum.ground_truth(stamp, Pose3::from_pose2(pose) * self.base_from_camera);
                self.truth.push((stamp, pose));
            }
            SensorEvent::Scan(scan) => self.laser.iter_mut().for_each(|log| log.scan(&scan)),
            SensorEvent::Touch(_) | SensorEvent::Cliff(_) => {}
        }
        Ok(())
    }

    /// Writes all that is still to be written, with the true map; the folder is yet to be committed.
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
        let encoded: Result<Vec<_>, _> = self.waiting.par_iter().map(TumFrame::encode).collect();
        for frame in encoded.map_err(|error| AppError::Input(error.to_string()))? {
            self.tum.frame(&frame)?;
        }
        self.waiting.clear();
        Ok(())
    }

    /// The drive from above.
    fn overview(&self, grid: &OccupancyGrid, start: Pose2) -> Vec<u8> {
        let truth: Vec<Vector2> = self.truth.iter().map(|(_, pose)| pose.position()).collect();
        let odometry: Vec<Vector2> =
            self.odometry.iter().map(|(_, pose)| (start * *pose).position()).collect();
        let mut picture = MapPicture::over(grid)
            .polyline("odometry", &odometry, LineStyle::solid(Color::VERMILLION))
            .polyline("true way", &truth, LineStyle::solid(Color::BLUE))
            .pose("start", start, PoseStyle::named(Color::GREEN));
        if let Some((_, end)) = self.truth.last() {
            picture = picture.pose("end", *end, PoseStyle::named(Color::VERMILLION));
        }
        picture.to_png()
    }
}
