//! The whole robot: a sensor event in, a report out.

mod background;
mod body_state;
mod deferred_work;
mod event_log;
mod image_queue;
mod mapping;
mod obstacles;
mod operator_commands;
mod perception;
mod pose_monitor;
mod restore;
mod scans;
mod sensor_watch;
mod station;
mod steering;
#[cfg(test)]
mod tests;
mod validation;
mod views;
mod visual_check;

pub use views::MissionProgress;

use crate::world_state::{StationState, WorldState};
use crate::{
    config::RobotConfig,
    mission::{Mission, MissionState, Task},
    monitors::camera_health::CameraHealth,
    monitors::scan_map_consistency::ScanMapConsistency,
    operator::{RunSetting, RunSettings},
    range_source::RangeSource,
    report::StepReport,
    stage::{Stage, StageTimes},
    workers::perception_worker::PerceptionWorker,
    zones::{RobotZones, ZonedMap},
};
use body_state::BodyState;
use image_queue::ImageQueue;
use mapping::GridMapping;
use obstacles::ObstacleTracks;
use sensor_watch::SensorWatch;
use station::ChargingStation;
use steering::Steering;
use trundle_control::{MotionHold, MotionSense, SafetyScan};
use trundle_core::{
    BodyEvent, BodyEventKind, GyroRate, Invalid, Odometry, Pose2, Pose3, Scan, SensorEvent, Stamp, WheelTicks,
};
use trundle_estimation::{Localizer, OdometryState, PoseMonitor, WheelOdometry};

/// The whole robot: sensor events in; pose, map, plan and twist out.
///
/// The robot reads no clock and no file, and random numbers come only from the seeds of its configuration: the same events give the same
/// reports. ([`StageTimes`] records wall-clock times for reports only.)
///
/// By default the robot does all work within the step. After [`Robot::with_background_jobs`] long work is given out as [`crate::Job`]s, and
/// [`Robot::apply_answer`] applies each result between two events. The same events and results in the same order give the same reports.
#[derive(Debug)]
pub struct Robot {
    range_sensor: RangeSensor,
    base_from_camera: Pose3,
    /// Standard deviation of the position above which the pose is lost \[m\].
    lost_sigma: f64,
    odometry: WheelOdometry,
    /// `None` while a perception job runs.
    perception: Option<Box<PerceptionWorker>>,
    images: ImageQueue,
    localizer: Localizer,
    /// Pose of the charging station.
    station: ChargingStation,
    mapping: GridMapping,
    obstacles: ObstacleTracks,
    steering: Steering,
    zones: RobotZones,
    /// Present values of the settings that may change while the robot runs.
    settings: RunSettings,
    latest: Latest,
    times: StageTimes,
}

/// The sensor of the scans.
#[derive(Debug, Clone, Copy)]
struct RangeSensor {
    source: RangeSource,
    /// Whether scans of a laser are deskewed.
    deskews: bool,
}

/// State carried from step to step.
#[derive(Debug, Default)]
struct Latest {
    odometry: Option<Odometry>,
    /// Power, wheel drop, links.
    body: BodyState,
    sensors: SensorWatch,
    /// The newest scan.
    scan: Option<Scan>,
    /// `odom_from_base` at the newest scan.
    scan_odometry: Option<Pose2>,
    camera_health: CameraHealth,
    /// Stamp of the newest image that was located.
    located: Option<Stamp>,
    scan_map_consistency: ScanMapConsistency,
    /// Decides the use of visual poses, and detects a displacement of the robot.
    pose_monitor: PoseMonitor,
    /// Number of images skipped because the camera was frozen.
    frozen: usize,
}

/// Largest age of a located image as a measurement of motion \[s\]. Source: ours.
const MAX_VISUAL_MOTION_AGE_S: f64 = 0.8;

impl Robot {
    /// A robot after power-on: its pose is the map's origin.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: RobotConfig) -> Result<Self, Invalid> {
        let base_from_camera = config.mount.validated()?.base_from_camera();
        let footprint = config.footprint()?;
        config.require_plausible_speeds()?;
        config.require_image_delay()?;
        let perception = PerceptionWorker::new(&config, base_from_camera)?;
        let blind_range = perception.blind_range();
        let map_hz = config.schedule.validated()?.map_hz;
        let mut mapping = config.mapping.clone();
        mapping.blind_range = blind_range;
        Ok(Self {
            range_sensor: RangeSensor { source: config.sight, deskews: config.deskew },
            base_from_camera,
            lost_sigma: config.mission_executor.lost_sigma,
            odometry: WheelOdometry::new(config.drive, config.odometry.clone())?,
            perception: Some(Box::new(perception)),
            images: ImageQueue::default(),
            localizer: Localizer::new(config.localization.clone(), base_from_camera)?,
            station: ChargingStation::new(config.station, &footprint)?,
            mapping: GridMapping::new(mapping, config.scan_match.clone(), map_hz, &footprint)?,
            obstacles: ObstacleTracks::new(config.movers)?,
            steering: Steering::new(&config, &footprint)?,
            zones: RobotZones::new(&footprint, config.planning.room.escape),
            settings: RunSetting::all_of(&config),
            latest: Latest::default(),
            times: StageTimes::default(),
        })
    }

    /// Replaces the mission, beginning with the next reading of the wheels. With an empty mission the robot brakes to rest within the
    /// limits of its base.
    pub fn begin(&mut self, mission: &Mission) {
        self.steering.begin(MissionState::new(mission.clone()));
    }

    /// Gives the robot one goal pose, map frame.
    ///
    /// # Errors
    /// When the goal is not finite.
    pub fn drive_to(&mut self, goal: Pose2) -> Result<(), Invalid> {
        self.begin(&Mission::new(vec![Task::go(goal)])?);
        Ok(())
    }

    /// Processes one sensor event.
    pub fn step(&mut self, event: &SensorEvent) -> StepReport {
        let mut report = StepReport::default();
        self.latest.sensors.on_event(event.stamp());
        match event {
            SensorEvent::Gyro(gyro) => self.on_gyro(gyro),
            SensorEvent::Wheels(wheels) => self.on_wheels(wheels, &mut report),
            SensorEvent::Rgbd(image) => self.on_image(image, &mut report),
            SensorEvent::Touch(touch) => self.on_touch(touch.pressed),
            SensorEvent::Cliff(cliff) => self.steering.on_cliff(cliff.over_edge),
            SensorEvent::Odometry(odometry) => self.on_odometry(odometry, &mut report),
            SensorEvent::Body(event) => self.on_body(event, &mut report),
            SensorEvent::Scan(scan) if self.range_sensor.source == RangeSource::Laser => {
                self.on_laser(scan, &mut report);
            }
            // With the depth camera as range source, laser scans are ignored. Truth is for evaluation only.
            _ => {}
        }
        self.complete(&mut report);
        report
    }

    /// Completes a report with estimate and state after the step.
    fn complete(&mut self, report: &mut StepReport) {
        report.estimate = Some(self.localizer.estimate());
        report.pose_is_lost = self.is_lost();
        self.steering.complete(self.latest.sensors.newest(), report);
    }

    /// Adds a gyro reading to the odometry.
    fn on_gyro(&mut self, gyro: &GyroRate) {
        self.latest.sensors.on_gyro(gyro.stamp);
        self.times.measure(Stage::Odometry, || self.odometry.step_gyro(gyro));
    }

    /// Processes a wheel reading: odometry, prediction, navigation, twist.
    fn on_wheels(&mut self, wheels: &WheelTicks, report: &mut StepReport) {
        let odometry = self.times.measure(Stage::Odometry, || self.odometry.step_wheels(wheels));
        report.measurements.motion = self.odometry.increment().copied();
        let changes = self.latest.sensors.on_wheels(wheels.stamp, self.odometry.wheels_are_unresponsive());
        changes.for_each(|change| event_log::sensor_change(wheels.stamp, change));
        event_log::encoder_jump(wheels.stamp, self.odometry.report(), self.odometry.counts());
        self.drive_on(odometry, wheels.stamp, report);
    }

    /// Processes odometry computed by the body, like a wheel reading. Invalid odometry is dropped.
    fn on_odometry(&mut self, odometry: &Odometry, report: &mut StepReport) {
        let Ok(odometry) = odometry.checked() else {
            tracing::warn!("odometry of {} s is not finite and is dropped", odometry.stamp);
            return;
        };
        let now = odometry.stamp;
        let odometry = self.times.measure(Stage::Odometry, || self.odometry.step_odometry(&odometry));
        self.drive_on(odometry, now, report);
    }

    /// Processes an event of the body: a new condition stops the robot at once, its end lets the robot continue, and silence advances the
    /// time.
    fn on_body(&mut self, event: &BodyEvent, report: &mut StepReport) {
        let before = self.latest.body.hold(self.range_sensor.source);
        self.latest.body.update(event.kind);
        event_log::body(event);
        if self.latest.body.is_lifted() {
            self.latest.pose_monitor.add_lift(event.stamp);
        }
        let is_contact = matches!(event.kind, BodyEventKind::Battery(_)) && self.latest.body.is_docked();
        if is_contact && self.is_pose_known(event.stamp) {
            self.station.add_contact(self.localizer.estimate().pose);
        }
        self.on_hold(before, event.stamp, report);
        if report.twist.is_none() && event.kind == BodyEventKind::Silence {
            self.decide(event.stamp, report);
        }
    }

    /// Acts at once on a change of the holding condition.
    fn on_hold(&mut self, before: Option<MotionHold>, now: Stamp, report: &mut StepReport) {
        let hold = self.latest.body.hold(self.range_sensor.source);
        if before != hold {
            event_log::hold(now, hold);
            self.decide(now, report);
        }
    }

    /// Processes new odometry: prediction, then navigation.
    fn drive_on(&mut self, odometry: Odometry, now: Stamp, report: &mut StepReport) {
        self.localizer.set_turn_scale_sigma(self.odometry.turn_scale_sigma());
        self.times.measure(Stage::Localization, || self.localizer.predict(&odometry));
        self.latest.odometry = Some(odometry);
        self.add_station_light(now);
        self.decide(now, report);
    }

    /// Adds the light of the charging station at the present pose.
    fn add_station_light(&mut self, now: Stamp) {
        let light = self.latest.body.station_light();
        if self.is_pose_known(now) {
            self.station.add_light(self.localizer.estimate().pose, &light);
        }
    }

    /// Navigates by the state of the world at `now`, and commands a twist.
    fn decide(&mut self, now: Stamp, report: &mut StepReport) {
        self.obstacles.forecast(self.latest.scan.as_ref().map(Scan::stamp), now);
        self.update_zones();
        let scan = self.latest.scan_with_odometry();
        let world = WorldState {
            now,
            estimate: self.localizer.estimate(),
            pose_status: self.pose_status(now),
            grid: self.mapping.grid(),
            scan,
            // A scan without odometry shows the safety monitor nothing.
            seen: self.latest.camera_health.seen().filter(|_| scan.is_some()),
            wheels: self.latest.odometry.as_ref().map(|odometry| odometry.stamp),
            hold: self.latest.body.hold(self.range_sensor.source),
            motion: self.motion_sense(now),
            dynamic_obstacles: self.obstacles.view(),
            station: StationState {
                estimate: self.station.estimate(),
                is_docked: self.latest.body.is_docked(),
            },
            zones: self.zones.view(),
        };
        self.steering.step(&world, &mut self.times, report);
        let by_hand =
            WorldState { hold: self.latest.body.hold_besides_pause(self.range_sensor.source), ..world };
        let by_hand =
            self.steering.teleop.step(&by_hand).map(|twist| self.zones.slowed(twist, world.estimate.pose));
        report.twist = by_hand.or(report.twist);
        report.twist.into_iter().for_each(|twist| self.odometry.set_command(twist));
        self.redraw();
    }

    /// Updates the zones for the present pose and map.
    fn update_zones(&mut self) {
        let map = ZonedMap {
            grid: self.mapping.grid(),
            revision: self.mapping.revision(),
            static_grid: self.obstacles.static_grid.as_ref(),
            scanned: self.latest.scan.as_ref().map(Scan::stamp),
        };
        self.zones.update(self.localizer.estimate().pose, &map);
    }

    /// The source that measures the robot's motion.
    fn motion_sense(&self, now: Stamp) -> MotionSense {
        let is_seen = || self.latest.located.is_some_and(|located| now - located <= MAX_VISUAL_MOTION_AGE_S);
        match self.range_sensor.source {
            _ if !self.odometry.wheels_are_unresponsive() => MotionSense::Wheels,
            RangeSource::DepthCamera if !is_seen() => MotionSense::Nothing,
            RangeSource::DepthCamera | RangeSource::Laser => MotionSense::Sight,
        }
    }

    /// Redraws a slice of a corrected grid.
    fn redraw(&mut self) {
        if self.mapping.mapper.is_redrawing() {
            self.times.measure(Stage::Mapping, || self.mapping.redraw_slice());
        }
    }

    /// Processes the bumper: a contact enters the map, since the camera may not see the obstacle.
    fn on_touch(&mut self, pressed: bool) {
        let estimate = self.localizer.estimate();
        if pressed && self.latest.odometry.is_some() && self.is_pose_known(estimate.stamp) {
            self.mapping.mark_touch(estimate.pose);
        }
        self.steering.on_touch(pressed);
    }

    /// Whether the pose is known well enough for scans to enter the grid.
    fn is_pose_known(&self, now: Stamp) -> bool {
        self.pose_status(now).allows_mapping()
    }

    /// Odometry at the stamp of an image, which may be older than the newest reading. Long after the newest reading, the result is that
    /// reading with the uncertainty of a motion since then.
    fn odometry_at(&self, stamp: Stamp) -> Option<OdometryState> {
        let newest = || {
            let odometry = self.latest.odometry.as_ref()?;
            let unobserved = self.odometry.unobserved_motion((stamp - odometry.stamp).max(0.0));
            Some(OdometryState {
                covariance: odometry.covariance + unobserved,
                ..OdometryState::from(odometry)
            })
        };
        self.localizer.odometry_at(stamp).ok().or_else(newest)
    }
}

impl Latest {
    /// The newest scan with the odometry since its stamp.
    fn scan_with_odometry(&self) -> Option<SafetyScan<'_>> {
        Some(SafetyScan {
            scan: self.scan.as_ref()?,
            odom_at_scan: self.scan_odometry?,
            odom_now: self.odometry?.pose,
        })
    }
}
