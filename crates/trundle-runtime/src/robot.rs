//! The whole robot: a sensor event in, a report out.

mod background;
mod body_state;
mod deferred_work;
mod event_log;
mod obey;
mod pose_monitor;
mod restore;
mod scans;
mod sensor_watch;
#[cfg(test)]
mod tests;
mod validation;
mod views;

pub use views::MissionProgress;

use crate::world_state::{DynamicObstacles, StationState, WorldState};
use crate::{
    behaviour::drive_state::DriveState,
    behaviour::navigator::position_sigma,
    bumper,
    config::RobotConfig,
    mission::{Mission, MissionState, Task},
    monitors::camera_health::CameraHealth,
    monitors::scan_map_consistency::ScanMapConsistency,
    operator::RunSetting,
    range_source::RangeSource,
    report::StepReport,
    scan_pose_log::ScanPoseLog,
    schedule::Ticker,
    stage::{Stage, StageTimes},
    workers::decision_worker::DecisionWorker,
    workers::perception_worker::{PerceptionResult, PerceptionWorker},
    workers::teleop_controller::TeleopController,
    zones::{RobotZones, ZonedMap},
};
use background::Background;
use body_state::BodyState;
use event_log::DroppedImage;
use sensor_watch::SensorWatch;
use std::sync::Arc;
use trundle_control::{MotionHold, MotionSense, SafetyScan};
use trundle_core::{
    BodyEvent, BodyEventKind, Footprint, GyroRate, Invalid, OccupancyGrid, Odometry, Pose2, Pose3, RgbdImage,
    Scan, SensorEvent, Stamp, Vector2, WheelTicks,
};
use trundle_estimation::{
    Correction, Localizer, OdometryState, StationEstimator, VisualPose, VisualQuality, WheelOdometry,
};
use trundle_mapping::{LiveMapper, MapperConfig, ScanMatcher};
use trundle_planning::{MovingObstacle, MovingObstacleTracker};
use trundle_slam::{TrackReport, Tracking};

/// The whole robot: sensor events in; pose, map, plan and twist out.
///
/// It reads no clock and no file, and draws no chance but from the seeds of its configuration: the same events give the
/// same reports. (Wall-clock times are noted beside it in [`StageTimes`], which only reports read.)
///
/// By default the robot does everything within the step. After [`Robot::with_background_jobs`] long work leaves as
/// [`crate::Job`]s, and [`Robot::apply_answer`] applies each result between two events. The same events and results in the same
/// order give the same reports.
#[derive(Debug)]
pub struct Robot {
    range_source: RangeSource,
    base_from_camera: Pose3,
    /// Standard deviation of the position above which the pose is lost \[m\].
    lost_sigma: f64,
    /// Radius of the largest disc inside the footprint \[m\].
    inscribed_radius: f64,
    /// Points at which an obstacle presses the bumper, base frame \[m\].
    bumper: Vec<Vector2>,
    odometry: WheelOdometry,
    /// None while a perception job runs.
    perception: Option<Box<PerceptionWorker>>,
    matcher: ScanMatcher,
    obstacle_tracker: MovingObstacleTracker,
    localizer: Localizer,
    /// Pose of the charging station.
    station: StationEstimator,
    /// `base_from_station` of a robot on the contacts.
    docked: Pose2,
    mapper: LiveMapper,
    scan_poses: ScanPoseLog,
    /// Commands within which a corrected grid is redrawn.
    redrawn_within: usize,
    map_due: Ticker,
    /// None while a decision job runs.
    decision_worker: Option<Box<DecisionWorker>>,
    background: Background,
    /// Drives by the twists of an operator.
    teleop: TeleopController,
    zones: RobotZones,
    /// Present values of the settings that may change while the robot runs.
    settings: [RunSetting; 2],
    latest: Latest,
    times: StageTimes,
}

/// State that later steps take from earlier ones.
#[derive(Debug, Default)]
struct Latest {
    odometry: Option<Odometry>,
    /// Power, wheel drop, links.
    body: BodyState,
    sensors: SensorWatch,
    /// The newest scan.
    scan: Option<Scan>,
    /// `odom_from_base` when it was taken.
    scan_odometry: Option<Pose2>,
    camera_health: CameraHealth,
    /// Start of the time in which images show enough and are not located.
    unlocated: Option<Stamp>,
    /// Stamp of the newest image that was located.
    located: Option<Stamp>,
    scan_map_consistency: ScanMapConsistency,
    /// Images that were left out because the camera was frozen.
    frozen: usize,
    /// The newest state, and whether the mission is over.
    state: (DriveState, bool),
    /// The newest state of the mission.
    mission: MissionState,
    /// Dynamic obstacles at the newest scan.
    movers: Vec<MovingObstacle>,
    /// The grid without dynamic obstacles; none where there are none.
    static_grid: Option<OccupancyGrid>,
    /// Hits of unconfirmed obstacles, map frame \[m\].
    unconfirmed: Vec<Vector2>,
}

/// Time without a located image \[s\] after which images with enough features count as images of another place than the estimate. Source: ours.
const UNLOCATED_WITH_FEATURES_S: f64 = 0.3;
/// Largest age of a located image \[s\] that still measures the robot's motion. Source: ours.
const MAX_VISUAL_MOTION_AGE_S: f64 = 0.8;
/// Correction of the pose \[m\] above which obstacle tracks restart: motion is not measured from scans on both sides of a jump. Source: ours.
const JUMP_M: f64 = 0.1;
/// The same for the heading \[rad\]. Source: ours.
const JUMP_RAD: f64 = 0.1;
/// Distance \[m\] within which a new obstacle is kept until a scan shows it gone: more than the braking distance. Source: ours.
const NEARBY_OBSTACLE_M: f64 = 1.5;
/// Age of the last scan \[s\] beyond which the position of a moving obstacle is unknown. Source: ours.
const MAX_TRACK_AGE_S: f64 = 1.0;
/// Smallest number of cells of a corrected grid that are redrawn after each command: about 1.5 ms of depth scans. Source: ours.
const MIN_REDRAWN_CELLS: usize = 60_000;
/// Number of commands over which the rest of a corrected grid is redrawn: 1.8 s. Source: ours.
const REDRAW_COMMANDS: usize = 90;
/// Seed of the candidates of the station's pose. Source: ours; any.
const STATION_SEED: u64 = 1;

impl Robot {
    /// A robot that has just been switched on: where it stands is the map's origin.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: RobotConfig) -> Result<Self, Invalid> {
        let base_from_camera = config.mount.validated()?.base_from_camera();
        let footprint = config.footprint()?;
        config.require_believable_speeds()?;
        config.require_image_delay()?;
        let perception = PerceptionWorker::new(&config, base_from_camera)?;
        let blind_range = perception.blind_range();
        let mapper = LiveMapper::new(MapperConfig { blind_range, ..config.mapping.clone() })?;
        Ok(Self {
            range_source: config.sight,
            base_from_camera,
            lost_sigma: config.mission_executor.lost_sigma,
            inscribed_radius: inscribed_radius(&footprint),
            bumper: bumper::ahead_of(&footprint),
            odometry: WheelOdometry::new(config.drive, config.odometry.clone())?,
            perception: Some(Box::new(perception)),
            matcher: ScanMatcher::new(config.scan_match.clone())?,
            obstacle_tracker: MovingObstacleTracker::new(config.movers)?,
            localizer: Localizer::new(config.localization.clone(), base_from_camera)?,
            map_due: Ticker::new(config.schedule.validated()?.map_hz),
            station: StationEstimator::new(config.station, STATION_SEED)?,
            docked: Pose2::new(bumper::front_of(&footprint), 0.0, std::f64::consts::PI),
            mapper,
            scan_poses: ScanPoseLog::default(),
            redrawn_within: REDRAW_COMMANDS,
            decision_worker: Some(Box::new(DecisionWorker::new(&config, &footprint)?)),
            background: Background::default(),
            teleop: TeleopController::new(&config, &footprint)?,
            zones: RobotZones::new(&footprint, config.planning.room.escape),
            settings: [
                RunSetting::Speed(config.limits.v),
                RunSetting::Patience(config.mission_executor.patience),
            ],
            latest: Latest::default(),
            times: StageTimes::default(),
        })
    }

    /// Gives the robot a mission in place of what is left of its old one. It begins with the next reading of the wheels. From an
    /// empty mission on the robot brakes to rest, within the limits of its base.
    pub fn begin(&mut self, mission: &Mission) {
        self.restore_mission(MissionState::new(mission.clone()));
    }

    /// Resumes a mission at its recorded task.
    fn restore_mission(&mut self, mission: MissionState) {
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.begin(&mission),
            None => self.background.set_mission(&mission),
        }
        self.latest.mission = mission;
    }

    /// Gives the robot one goal pose, map frame.
    ///
    /// # Errors
    /// When the goal is not finite.
    pub fn drive_to(&mut self, goal: Pose2) -> Result<(), Invalid> {
        self.begin(&Mission::new(vec![Task::Go(goal)])?);
        Ok(())
    }

    /// One sensor event through the whole robot.
    pub fn step(&mut self, event: &SensorEvent) -> StepReport {
        let mut report = StepReport::default();
        self.latest.sensors.on_event(event.stamp());
        match event {
            SensorEvent::Gyro(gyro) => self.on_gyro(gyro),
            SensorEvent::Wheels(wheels) => self.on_wheels(wheels, &mut report),
            SensorEvent::Rgbd(image) => self.on_image(image, &mut report),
            SensorEvent::Touch(touch) => self.on_touch(touch.pressed),
            SensorEvent::Cliff(cliff) => self.on_cliff(cliff.over_edge),
            SensorEvent::Odometry(odometry) => self.on_odometry(odometry, &mut report),
            SensorEvent::Body(event) => self.on_body(event, &mut report),
            SensorEvent::Scan(scan) if self.range_source == RangeSource::Laser => {
                self.on_laser(scan, &mut report);
            }
            // The grid of a robot with a depth camera ignores lasers; truth is for evaluation alone.
            _ => {}
        }
        self.complete(&mut report);
        report
    }

    /// Completes a report with estimate and state after the step.
    fn complete(&mut self, report: &mut StepReport) {
        report.estimate = Some(self.localizer.estimate());
        if let Some(decision_worker) = &self.decision_worker {
            let state = decision_worker.state();
            event_log::state(self.latest.sensors.newest(), &self.latest.state.0, &state.0);
            self.latest.state = state;
        }
        (report.state, report.finished) = self.latest.state.clone();
    }

    /// A gyro reading: into the odometry.
    fn on_gyro(&mut self, gyro: &GyroRate) {
        self.latest.sensors.on_gyro(gyro.stamp);
        self.times.measure(Stage::Odometry, || self.odometry.step_gyro(gyro));
    }

    /// A wheel reading: odometry, prediction, then navigation: a twist leaves.
    fn on_wheels(&mut self, wheels: &WheelTicks, report: &mut StepReport) {
        let odometry = self.times.measure(Stage::Odometry, || self.odometry.step_wheels(wheels));
        report.measurements.motion = self.odometry.increment().copied();
        let changes = self.latest.sensors.on_wheels(wheels.stamp, self.odometry.wheels_are_unresponsive());
        changes.for_each(|change| event_log::sensor_change(wheels.stamp, change));
        event_log::encoder_jump(wheels.stamp, self.odometry.report(), self.odometry.counts());
        self.drive_on(odometry, wheels.stamp, report);
    }

    /// Odometry that the body computed: as a reading of the wheels. Invalid odometry is dropped.
    fn on_odometry(&mut self, odometry: &Odometry, report: &mut StepReport) {
        let Ok(odometry) = odometry.checked() else {
            tracing::warn!("odometry of {} s is not finite and is dropped", odometry.stamp);
            return;
        };
        let now = odometry.stamp;
        let odometry = self.times.measure(Stage::Odometry, || self.odometry.step_odometry(&odometry));
        self.drive_on(odometry, now, report);
    }

    /// An event of the body: a condition that begins stops the robot at once, one that ends lets it go on, and in silence time goes on.
    fn on_body(&mut self, event: &BodyEvent, report: &mut StepReport) {
        let before = self.latest.body.hold(self.range_source);
        self.latest.body.update(event.kind);
        if matches!(event.kind, BodyEventKind::Battery(_)) && self.latest.body.is_docked() {
            self.station.add_contact(self.localizer.estimate().pose * self.docked);
        }
        self.on_hold(before, event.stamp, report);
        if report.twist.is_none() && event.kind == BodyEventKind::Silence {
            self.decide(event.stamp, report);
        }
    }

    /// Acts at once on a change of what holds the robot.
    fn on_hold(&mut self, before: Option<MotionHold>, now: Stamp, report: &mut StepReport) {
        let hold = self.latest.body.hold(self.range_source);
        if before != hold {
            event_log::hold(now, hold);
            self.decide(now, report);
        }
    }

    /// New odometry: prediction, then navigation.
    fn drive_on(&mut self, odometry: Odometry, now: Stamp, report: &mut StepReport) {
        self.times.measure(Stage::Localization, || self.localizer.predict(&odometry));
        self.latest.odometry = Some(odometry);
        self.add_station_light(now);
        self.decide(now, report);
    }

    /// The light of the charging station at the present pose.
    fn add_station_light(&mut self, now: Stamp) {
        let light = self.latest.body.station_light();
        if self.is_pose_known(now) {
            self.station.add_light(self.localizer.estimate().pose, &light);
        }
    }

    /// Navigation by the state of the world at `now`: a twist leaves.
    fn decide(&mut self, now: Stamp, report: &mut StepReport) {
        self.latest.forecast_movers(&self.obstacle_tracker, now);
        self.update_zones();
        let world = WorldState {
            now,
            estimate: self.localizer.estimate(),
            grid: self.mapper.grid(),
            scan: self.latest.scan_with_odometry(),
            seen: self.latest.camera_health.seen(),
            unlocated: self.latest.unlocated.map_or(0.0, |since| now - since),
            wheels: self.latest.odometry.as_ref().map(|odometry| odometry.stamp),
            hold: self.latest.body.hold(self.range_source),
            motion: self.motion_sense(now),
            dynamic_obstacles: DynamicObstacles {
                movers: &self.latest.movers,
                unconfirmed: &self.latest.unconfirmed,
                static_grid: self.latest.static_grid.as_ref(),
            },
            station: StationState {
                estimate: self.station.estimate(),
                is_docked: self.latest.body.is_docked(),
            },
            zones: self.zones.view(),
        };
        match self.decision_worker.take() {
            Some(mut decision_worker) if !self.background.is_for(&decision_worker, &world) => {
                let decision = decision_worker.step(&world, &mut self.times);
                self.decision_worker = Some(decision_worker);
                report.twist = Some(decision.twist);
                report.replanned = decision.replanned;
            }
            decision_worker => {
                let times = &mut self.times;
                let background = &mut self.background;
                report.twist = times.measure(Stage::Control, || background.steer(decision_worker, &world));
            }
        }
        let by_hand = WorldState { hold: self.latest.body.hold_besides_pause(self.range_source), ..world };
        let by_hand = self.teleop.step(&by_hand).map(|twist| self.zones.slowed(twist, world.estimate.pose));
        report.twist = by_hand.or(report.twist);
        report.twist.into_iter().for_each(|twist| self.odometry.set_command(twist));
        self.redraw();
    }

    /// The zones as they count at the present pose, on the present map.
    fn update_zones(&mut self) {
        let map = ZonedMap {
            grid: self.mapper.grid(),
            revision: self.mapper.revision(),
            static_grid: self.latest.static_grid.as_ref(),
            scanned: self.latest.scan.as_ref().map(Scan::stamp),
        };
        self.zones.update(self.localizer.estimate().pose, &map);
    }

    /// The source that shows how the robot moves.
    fn motion_sense(&self, now: Stamp) -> MotionSense {
        let is_seen = || self.latest.located.is_some_and(|located| now - located <= MAX_VISUAL_MOTION_AGE_S);
        match self.range_source {
            _ if !self.odometry.wheels_are_unresponsive() => MotionSense::Wheels,
            RangeSource::DepthCamera if !is_seen() => MotionSense::Nothing,
            RangeSource::DepthCamera | RangeSource::Laser => MotionSense::Sight,
        }
    }

    /// Redraws a slice of a corrected grid.
    fn redraw(&mut self) {
        if self.mapper.is_redrawing() {
            let (cells, within) = (MIN_REDRAWN_CELLS, self.redrawn_within);
            self.times.measure(Stage::Mapping, || self.mapper.work_within(cells, within));
            self.redrawn_within = within.saturating_sub(1).max(1);
        }
    }

    /// The bumper: what presses it enters the map, which the camera may be blind for.
    fn on_touch(&mut self, pressed: bool) {
        let estimate = self.localizer.estimate();
        if pressed && self.latest.odometry.is_some() && self.is_pose_known(estimate.stamp) {
            self.mapper.mark_occupied(estimate.pose, &self.bumper);
        }
        self.forward_touch(pressed);
    }

    /// An image: processed here or queued for a job.
    fn on_image(&mut self, image: &RgbdImage, report: &mut StepReport) {
        if self.background.is_used() {
            return self.background.queue_image(image.clone().into());
        }
        let Some(odometer) = self.odometry_at(image.stamp()) else { return };
        let Some(perception) = &mut self.perception else { return };
        report.image = Some(image.stamp());
        match perception.process(image, odometer, &mut self.times) {
            Some(result) => self.apply_perception(result, report),
            None => self.drop_frozen(image.stamp()),
        }
    }

    /// Applies the result of an image: the visual pose corrects the estimate; at the grid's rate the scan does too, and enters the grid.
    fn apply_perception(&mut self, result: PerceptionResult, report: &mut StepReport) {
        let PerceptionResult {
            odom_from_base,
            track,
            scan,
            place,
            unlocated,
            is_carried_away,
            corrected_trajectory,
            visual_snapshot,
        } = result;
        self.latest.unlocated = unlocated;
        if track.tracking.is_located() {
            self.latest.located = self.latest.located.max(Some(track.stamp));
        }
        if is_carried_away {
            self.lose_pose();
        }
        let (times, localizer) = (&mut self.times, &mut self.localizer);
        let before = localizer.estimate().pose;
        let visual = visual_pose(&track, corrected_trajectory.is_some());
        let correct = |visual| times.measure(Stage::Localization, || localizer.correct_visual(visual));
        let correction = visual.as_ref().map(correct);
        report.measurements.visual = visual;
        event_log::correction(track.stamp, "the visual pose", before, self.localizer.estimate().pose);
        if correction == Some(Correction::Reanchored) {
            // Scans drawn so far stay where they are: their visual poses are in a frame that has moved.
            self.scan_poses = ScanPoseLog::default();
        }
        let goes_on = track.tracking == Tracking::Ok && corrected_trajectory.is_none() && !track.relocalised;
        let goes_on = goes_on && matches!(correction, Some(Correction::Applied { .. }));
        let base = track.visual_from_camera * self.base_from_camera.inverse();
        if goes_on {
            self.odometry.add_visual_pose(track.stamp, odom_from_base, base);
        } else {
            self.odometry.break_visual_track(track.stamp);
        }
        if let Some(trajectory) = corrected_trajectory {
            self.redraw_from_visual_map(&trajectory);
        }
        self.apply_global_localization(place);
        let jump = before.inverse() * self.localizer.estimate().pose;
        if jump.position().norm() > JUMP_M || jump.theta.abs() > JUMP_RAD {
            self.clear_dynamic_obstacles();
        }
        if let Some(scan) = scan {
            let stamp = scan.stamp();
            let is_drawn = self.on_scan(scan, report);
            if is_drawn
                && track.tracking.is_located()
                && self.scan_poses.note(stamp, track.visual_from_camera, || self.mapper.logged_stamps())
            {
                self.perception.iter_mut().for_each(|perception| perception.forget_frames(&self.scan_poses));
            }
        }
        // A grid that has not yet followed the visual map does not fit it.
        let fits = self.is_pose_known(track.stamp) && !self.mapper.is_redrawing();
        let visual_snapshot = visual_snapshot.filter(|_| fits);
        report.checkpoint = visual_snapshot.map(|visual| Arc::new(self.checkpoint_with(visual)));
        report.track = Some(track);
    }

    /// Counts an image of a frozen camera.
    fn drop_frozen(&mut self, stamp: Stamp) {
        self.latest.frozen += 1;
        event_log::dropped_image(stamp, DroppedImage::Frozen);
    }

    /// Drops the dynamic obstacles: after a jump of the pose static things seem to move.
    fn clear_dynamic_obstacles(&mut self) {
        self.obstacle_tracker.clear();
        self.latest.unconfirmed.clear();
        self.latest.clear_movers();
    }

    /// Whether the pose is known well enough for scans to enter the grid.
    fn is_pose_known(&self, now: Stamp) -> bool {
        let is_unlocated = self.latest.unlocated.is_some_and(|since| now - since > UNLOCATED_WITH_FEATURES_S);
        !is_unlocated
            && !self.latest.body.is_lifted()
            && position_sigma(&self.localizer.estimate()) < self.lost_sigma
    }

    /// The base, map frame, of a camera pose in the visual map.
    fn visual_base(&self, visual_from_camera: &Pose3) -> Option<Pose2> {
        let camera_from_base = self.base_from_camera.inverse();
        Some((self.localizer.map_from_visual()? * *visual_from_camera * camera_from_base).to_pose2())
    }

    /// Applies a correction of the visual map: the grid is redrawn from the corrected poses of its scans.
    fn redraw_from_visual_map(&mut self, trajectory: &[(Stamp, Pose3)]) {
        let mut scan_poses = std::mem::take(&mut self.scan_poses);
        let moved = scan_poses.follow(trajectory, |pose| self.visual_base(pose));
        self.scan_poses = scan_poses;
        let redrawn = self.times.measure(Stage::Mapping, || {
            self.mapper.correct(|stamp, pose| moved.get(&stamp).map_or(pose, |moved| *moved * pose))
        });
        if redrawn > 0 {
            self.redrawn_within = REDRAW_COMMANDS;
            // A search in the old grid is void; it begins again in the new one.
            self.perception.iter_mut().for_each(|perception| perception.global_localization.end());
        }
    }

    /// Odometry at the stamp of an image, which may be older than the newest reading. Long after the newest reading it is that reading,
    /// with the uncertainty of the motion that the base may have made since.
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
    /// Forecasts the dynamic obstacles to `now`; without recent scans they are dropped.
    fn forecast_movers(&mut self, obstacle_tracker: &MovingObstacleTracker, now: Stamp) {
        if self.movers.is_empty() {
            return;
        }
        self.movers = obstacle_tracker.moving_obstacles(now);
        if self.movers.is_empty()
            || self.scan.as_ref().is_none_or(|scan| now - scan.stamp() > MAX_TRACK_AGE_S)
        {
            self.clear_movers();
        }
    }

    fn clear_movers(&mut self) {
        self.movers.clear();
        self.static_grid = None;
    }

    /// The newest scan with the odometry that carries it to now.
    fn scan_with_odometry(&self) -> Option<SafetyScan<'_>> {
        Some(SafetyScan {
            scan: self.scan.as_ref()?,
            odom_at_scan: self.scan_odometry?,
            odom_now: self.odometry?.pose,
        })
    }
}

/// Of the largest disc about the base's origin that is inside the footprint, m; 0 where the origin is outside.
fn inscribed_radius(footprint: &Footprint) -> f64 {
    match footprint {
        Footprint::Disc { radius } => *radius,
        Footprint::Polygon { corners } => {
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            let from_side = |(a, b): (&Vector2, &Vector2)| (b - a).perp(&-a) / (b - a).norm();
            sides.map(from_side).fold(f64::INFINITY, f64::min).max(0.0)
        }
    }
}

/// The visual pose of a located image. A pose in a map that was just corrected counts as recognised.
fn visual_pose(track: &TrackReport, is_corrected: bool) -> Option<VisualPose> {
    let quality = match track.tracking {
        Tracking::Ok => VisualQuality::Ok,
        Tracking::Weak => VisualQuality::Weak,
        Tracking::DeadReckoning | Tracking::Lost => return None,
    };
    Some(VisualPose {
        stamp: track.stamp,
        visual_from_camera: track.visual_from_camera,
        covariance: track.covariance,
        quality,
        map: track.map.number(),
        recognised: track.relocalised || is_corrected,
    })
}
