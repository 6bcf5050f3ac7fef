use crate::{
    bumper,
    config::RobotConfig,
    drawn::DrawnPoses,
    eye::EyeWatch,
    mission::{Mission, Task, TaskRecord},
    navigator::{Goal, Navigator, Surroundings},
    report::StepReport,
    schedule::Ticker,
    sight::Sight,
    stage::{Stage, StageTimes},
    state::DriveState,
    supervisor::Supervisor,
};
use trundle_control::SafetyScan;
use trundle_core::{
    Footprint, GyroRate, Invalid, OccupancyGrid, Odometry, Pose2, Pose3, PoseEstimate, RgbdImage, Scan,
    SensorEvent, Stamp, Vector2, WheelTicks,
};
use trundle_localization::{Correction, Localizer, VisualPose, VisualQuality, WheelOdometry, camera_motion};
use trundle_mapping::{DepthScanner, LiveMapper, MapperConfig, ScanMatcher};
use trundle_planning::PlanResult;
use trundle_slam::{RgbdSlam, TrackReport, Tracking};

/// The whole robot: sensor events in; pose, map, plan and twist out.
///
/// It reads no clock and no file, and draws no chance but from the seeds of its configuration: the same events give the
/// same reports. (Wall-clock times are noted beside it in [`StageTimes`], which only reports read.)
#[derive(Debug)]
pub struct Robot {
    sight: Sight,
    base_from_camera: Pose3,
    /// Of the disc that the robot stands on for certain, m.
    inscribed_radius: f64,
    /// Where something stands that presses the bumper, base frame, m.
    bumper: Vec<Vector2>,
    odometry: WheelOdometry,
    slam: RgbdSlam,
    scanner: DepthScanner,
    matcher: ScanMatcher,
    localizer: Localizer,
    mapper: LiveMapper,
    drawn: DrawnPoses,
    map_due: Ticker,
    navigator: Navigator,
    supervisor: Supervisor,
    latest: Latest,
    times: StageTimes,
}

/// What later steps need of earlier ones.
#[derive(Debug, Default)]
struct Latest {
    odometry: Option<Odometry>,
    /// `odom_from_base` at the last image.
    image_odometry: Option<Pose2>,
    /// The newest scan.
    scan: Option<Scan>,
    /// `odom_from_base` when it was taken.
    scan_odometry: Option<Pose2>,
    eye: EyeWatch,
    /// Since when images that show enough have not been located.
    unplaced: Option<Stamp>,
}

/// Exploring, the robot keeps so much more from things than its footprint needs, m: a view is not worth a squeeze.
const EXPLORING: f64 = 0.03;

/// A correction of the visual map by more than this bends the grid, m and rad.
const BENT: f64 = 0.02;
/// With each image, so many cells of a bent grid are redrawn, about 5 ms.
const REDRAWING: usize = 150_000;

impl Robot {
    /// A robot that has just been switched on: where it stands is the map's origin.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: RobotConfig) -> Result<Self, Invalid> {
        let base_from_camera = config.mount.validated()?.base_from_camera();
        let footprint = config.footprint()?;
        config.require_believable_speeds()?;
        let scanner = DepthScanner::new(config.camera, base_from_camera, config.scan.clone())?;
        let blind_range = match config.sight {
            Sight::DepthCamera => scanner.blind_range(),
            Sight::Laser => 0.0,
        };
        let mapper = LiveMapper::new(MapperConfig { blind_range, ..config.mapping.clone() })?;
        Ok(Self {
            sight: config.sight,
            base_from_camera,
            inscribed_radius: inscribed_radius(&footprint),
            bumper: bumper::ahead_of(&footprint),
            odometry: WheelOdometry::new(config.drive, config.odometry.clone())?,
            slam: RgbdSlam::new(config.camera, config.slam.clone())?,
            scanner,
            matcher: ScanMatcher::new(config.scan_match.clone())?,
            localizer: Localizer::new(config.localization.clone(), base_from_camera)?,
            map_due: Ticker::new(config.schedule.validated()?.map_hz),
            mapper,
            drawn: DrawnPoses::default(),
            navigator: Navigator::new(&config, &footprint)?,
            supervisor: Supervisor::new(&config.supervisor, footprint.circumscribed_radius() + EXPLORING)?,
            latest: Latest::default(),
            times: StageTimes::default(),
        })
    }

    /// Gives the robot a mission in place of what is left of its old one. It begins with the next reading of the wheels; an
    /// empty one lets the robot stand.
    pub fn begin(&mut self, mission: &Mission) {
        self.supervisor.begin(mission);
        if mission.tasks().is_empty() {
            self.navigator.take_up(Goal::Stay);
        }
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
        match event {
            SensorEvent::Gyro(gyro) => self.feel(gyro),
            SensorEvent::Wheels(wheels) => self.roll(wheels, &mut report),
            SensorEvent::Rgbd(image) => self.look(image, &mut report),
            SensorEvent::Touch(touch) => self.touch(touch.pressed),
            SensorEvent::Cliff(cliff) => self.navigator.cliff(cliff.over_edge),
            SensorEvent::Scan(scan) if self.sight == Sight::Laser => {
                self.see(scan.clone());
            }
            // The map is drawn from the depth image alone; a laser beside it is for other programs.
            SensorEvent::Scan(_) | SensorEvent::Truth { .. } => {}
        }
        report.estimate = Some(self.localizer.estimate());
        (report.state, report.finished) = self.state();
        report
    }

    /// What the robot is doing, and whether its mission is over: then the state is that of the whole mission.
    fn state(&self) -> (DriveState, bool) {
        let finished = self.supervisor.is_idle() && !self.supervisor.records().is_empty();
        let state = match self.supervisor.failure() {
            Some(reason) if finished => DriveState::Stopped { reason },
            None if finished => DriveState::Arrived,
            _ => self.navigator.state().clone(),
        };
        (state, finished)
    }

    /// A gyro reading: into the odometry.
    fn feel(&mut self, gyro: &GyroRate) {
        self.times.measure(Stage::Odometry, || self.odometry.step_gyro(gyro));
    }

    /// A wheel reading: odometry, prediction, then navigation: a twist leaves.
    fn roll(&mut self, wheels: &WheelTicks, report: &mut StepReport) {
        let odometry = self.times.measure(Stage::Odometry, || self.odometry.step_wheels(wheels));
        self.times.measure(Stage::Localization, || self.localizer.predict(&odometry));
        self.latest.odometry = Some(odometry);
        let surroundings = Surroundings {
            now: wheels.stamp,
            estimate: self.localizer.estimate(),
            grid: self.mapper.grid(),
            scan: self.latest.carried_scan(),
            seen: self.latest.eye.seen(),
            unplaced: self.latest.unplaced.map_or(0.0, |since| wheels.stamp - since),
        };
        let (supervisor, navigator) = (&mut self.supervisor, &mut self.navigator);
        let order =
            self.times.measure(Stage::Supervision, || supervisor.step(&surroundings, navigator.state()));
        if let Some(goal) = order {
            navigator.take_up(goal);
        }
        let decision = navigator.step(&surroundings, &mut self.times);
        report.twist = Some(decision.twist);
        report.replanned = decision.replanned;
    }

    /// The bumper: what presses it enters the map, which the camera may be blind for.
    fn touch(&mut self, pressed: bool) {
        if pressed && self.latest.odometry.is_some() {
            self.mapper.mark_occupied(self.localizer.estimate().pose, &self.bumper);
        }
        self.navigator.touch(pressed);
    }

    /// An image: the visual pose corrects the estimate; at the map's rate the scan does too, and enters the map.
    fn look(&mut self, image: &RgbdImage, report: &mut StepReport) {
        let Some(odom_from_base) = self.odometry_at(image.stamp()) else { return };
        if self.latest.eye.is_frozen(image, odom_from_base) {
            return;
        }
        let prior = self.camera_motion_since_last_image(odom_from_base);
        let track = self.times.measure(Stage::Slam, || self.slam.step(image, prior));
        if self.latest.is_carried_away(&track) {
            self.slam.kidnapped();
        }
        let is_bent = is_bent(&track);
        let (times, localizer) = (&mut self.times, &mut self.localizer);
        let correction = times.measure(Stage::Localization, || correct_by_sight(localizer, &track, is_bent));
        if correction == Some(Correction::Reanchored) {
            // Scans drawn so far stay where they are: their visual poses are in a frame that has moved.
            self.drawn = DrawnPoses::default();
        }
        let goes_on = track.tracking == Tracking::Ok && !is_bent && !track.relocalised;
        let goes_on = goes_on && matches!(correction, Some(Correction::Applied { .. }));
        let visual = self.visual_base(&track.visual_from_camera).filter(|_| goes_on);
        self.odometry.seen(odom_from_base, visual);
        if is_bent {
            self.follow_the_visual_map();
        }
        self.times.measure(Stage::Mapping, || self.mapper.work(REDRAWING));
        if self.sight == Sight::DepthCamera {
            let scan = self.times.measure(Stage::Scan, || self.scanner.scan(image));
            let stamp = scan.stamp();
            let is_drawn = self.see(scan);
            let visual = self.visual_base(&track.visual_from_camera);
            if let Some(visual) = visual.filter(|_| is_drawn && track.tracking.is_located()) {
                self.drawn.note(stamp, visual);
            }
        }
        report.track = Some(track);
    }

    /// A scan: at the map's rate it corrects the estimate and enters the map; safety watches each. Whether it was drawn.
    fn see(&mut self, scan: Scan) -> bool {
        let is_due = self.map_due.due(scan.stamp());
        if is_due {
            self.fit(&scan);
            self.draw(&scan);
        }
        // One that shows nothing does not make safety forget what the last one showed.
        if self.latest.eye.note(&scan) || self.latest.eye.seen().is_none() {
            self.latest.scan_odometry = self.odometry_at(scan.stamp());
            self.latest.scan = Some(scan);
        }
        is_due
    }

    /// Corrects the estimate by where the scan fits the map.
    fn fit(&mut self, scan: &Scan) {
        let Ok(guess) = self.localizer.pose_at(scan.stamp()) else { return };
        let found =
            self.times.measure(Stage::ScanMatch, || self.matcher.refine(self.mapper.mapper(), scan, guess));
        if let Some(found) = found {
            self.localizer.correct_scan(scan.stamp(), found.pose, &found.covariance);
        }
    }

    /// Draws the scan, and the floor that the robot stands on, into the map; not when no pose is known for its time.
    fn draw(&mut self, scan: &Scan) {
        let Ok(pose) = self.localizer.pose_at(scan.stamp()) else { return };
        let (mapper, radius) = (&mut self.mapper, self.inscribed_radius);
        self.times.measure(Stage::Mapping, || {
            mapper.insert(pose, scan);
            mapper.mark_free_disc(pose, radius);
        });
    }

    /// The base, map frame, of a camera pose in the visual map.
    fn visual_base(&self, visual_from_camera: &Pose3) -> Option<Pose2> {
        let camera_from_base = self.base_from_camera.inverse();
        Some((self.localizer.map_from_visual()? * *visual_from_camera * camera_from_base).to_pose2())
    }

    /// The visual map was bent: the grid is redrawn from where its scans were taken by now.
    fn follow_the_visual_map(&mut self) {
        let trajectory = self.slam.trajectory();
        let bases = trajectory.iter().filter_map(|(stamp, pose)| Some((*stamp, self.visual_base(pose)?)));
        let moved = self.drawn.follow(&bases.collect());
        self.times.measure(Stage::Mapping, || {
            self.mapper.correct(|stamp, pose| moved.get(&stamp).map_or(pose, |moved| *moved * pose))
        });
    }

    /// `odom_from_base` when an image was taken, which may be a while ago.
    fn odometry_at(&self, stamp: Stamp) -> Option<Pose2> {
        let newest = self.latest.odometry.map(|odometry| odometry.pose);
        self.localizer.odometry_at(stamp).ok().or(newest)
    }

    /// `previous_camera_from_camera` by wheels and gyro.
    fn camera_motion_since_last_image(&mut self, odom_from_base: Pose2) -> Option<Pose3> {
        let previous = self.latest.image_odometry.replace(odom_from_base)?;
        Some(camera_motion(previous.inverse() * odom_from_base, self.base_from_camera))
    }

    /// The pose estimate.
    pub fn estimate(&self) -> PoseEstimate {
        self.localizer.estimate()
    }

    /// The map.
    pub fn grid(&self) -> &OccupancyGrid {
        self.mapper.grid()
    }

    /// The visual tracker with its landmark map.
    pub fn slam(&self) -> &RgbdSlam {
        &self.slam
    }

    /// The visual tracker's frame in the map.
    pub fn map_from_visual(&self) -> Option<Pose3> {
        self.localizer.map_from_visual()
    }

    /// The tasks of the mission that have ended.
    pub fn tasks_ended(&self) -> &[TaskRecord] {
        self.supervisor.records()
    }

    /// The task at hand.
    pub fn task(&self) -> Option<Task> {
        self.supervisor.task()
    }

    /// The newest plan.
    pub fn plan(&self) -> Option<&PlanResult> {
        self.navigator.plan()
    }

    /// The newest scan.
    pub fn scan(&self) -> Option<&Scan> {
        self.latest.scan.as_ref()
    }

    /// Images that were left out because they were the last one again though the robot had moved.
    pub fn frozen_images(&self) -> usize {
        self.latest.eye.frozen()
    }

    /// What the stages cost.
    pub fn times(&self) -> &StageTimes {
        &self.times
    }
}

/// An image with so many features shows enough to be located by.
const ENOUGH_FEATURES: usize = 200;
/// Images that show enough and are not located for so long, s, are of another place than the odometry says.
const CARRIED_AWAY: f64 = 1.5;

impl Latest {
    /// Whether it is time to look for the place everywhere: the odometry's has not been recognised for a while.
    fn is_carried_away(&mut self, track: &TrackReport) -> bool {
        if track.tracking.is_located() || track.features < ENOUGH_FEATURES {
            self.unplaced = None;
            return false;
        }
        let since = *self.unplaced.get_or_insert(track.stamp);
        let is_time = track.stamp - since > CARRIED_AWAY;
        if is_time {
            self.unplaced = None;
        }
        is_time
    }

    /// The last scan with the odometry that carries it to now.
    fn carried_scan(&self) -> Option<SafetyScan<'_>> {
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

/// Whether the visual map was corrected by more than tracking goes along with.
fn is_bent(track: &TrackReport) -> bool {
    let is_large =
        |correction: &Pose3| correction.translation.norm() > BENT || correction.log().norm() > BENT;
    track.closed_loop.is_some() || track.merged.is_some() || track.refined.as_ref().is_some_and(is_large)
}

/// The visual pose, where there is one, to the localizer; one of a map that was just bent is believed.
fn correct_by_sight(localizer: &mut Localizer, track: &TrackReport, is_bent: bool) -> Option<Correction> {
    let quality = match track.tracking {
        Tracking::Ok => VisualQuality::Ok,
        Tracking::Weak => VisualQuality::Weak,
        Tracking::DeadReckoning | Tracking::Lost => return None,
    };
    Some(localizer.correct_visual(&VisualPose {
        stamp: track.stamp,
        visual_from_camera: track.visual_from_camera,
        covariance: track.covariance,
        quality,
        map: track.map.number(),
        recognised: track.relocalised || is_bent,
    }))
}
