//! A ROS 2 robot as the body of a run.

use super::base_sensors::{BaseMonitors, FRAME_WAIT, Shared, lock, subscribe as subscribe_base};
use super::camera_topics::subscribe as subscribe_camera;
use super::commands::{CommandPublisher, CommandThread};
use super::image_inbox::ImageInbox;
use super::link_watch::{LinkWatch, WatchedCamera, WatchedOrder};
use super::ros_camera::RosCameraSource;
use super::{BodySettings, FrameTree};
use crate::Ros2Error;
use crate::clock::RosClock;
use crate::convert::stamp;
use crate::generated::geometry_msgs::TransformStamped;
use crate::generated::rosgraph_msgs::Clock;
use crate::generated::tf2_msgs::TFMessage;
use crate::node::{NodeThread, RosNode, TopicMonitor, qos};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use trundle_app::AppError;
use trundle_app::real_time::{DeviceReport, EventFeed, LiveBody, TimedEvent};
use trundle_core::{DifferentialDrive, Invalid, Odometry, PinholeCamera, Pose3, Stamp};
use trundle_drivers::camera::camera_thread::{CameraThread, CameraThreadConfig, CameraThreadParts};
use trundle_runtime::real_time::InboxSender;

/// Period of queries for transforms. Source: ours.
const FRAME_PERIOD: Duration = Duration::from_millis(50);
/// Wait for images when the camera's thread reopens the camera. Source: ours.
const REOPEN_WAIT: Duration = Duration::from_secs(2);
/// Silence of `/clock` on the computer's clock after which the base counts as lost. Source: ours; a simulator of 50 Hz at a fiftieth of
/// real time.
const MAX_CLOCK_SILENCE: Duration = Duration::from_secs(1);

/// The topics of a ROS 2 robot, subscribed; events flow once [`Ros2Body::start`] connects it to a run.
pub struct Ros2Body {
    settings: BodySettings,
    shared: Arc<Shared>,
    inbox: Arc<ImageInbox>,
    monitors: BaseMonitors,
    commands: CommandPublisher,
}

/// Facts of the robot, once all its topics have started.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyDescription {
    /// The colour camera.
    pub camera: PinholeCamera,
    /// `base_from_camera`, of the colour camera's optical frame; `None` without a transform.
    pub base_from_camera: Option<Pose3>,
    /// The depth camera's pose in the colour camera's frame; `None` if depth is registered to colour.
    pub color_from_depth: Option<Pose3>,
}

impl Ros2Body {
    /// Adds the robot's topics to a node. `drive` is the geometry of the base.
    ///
    /// # Errors
    /// When a topic cannot be created.
    pub fn new(
        node: &mut RosNode,
        settings: BodySettings,
        drive: DifferentialDrive,
    ) -> Result<Self, Ros2Error> {
        let clock = if settings.use_sim_time { RosClock::simulated() } else { RosClock::system() };
        let diagnostics = node.diagnostics();
        let shared = Arc::new(Shared::new(clock.clone(), diagnostics.clone()));
        let inbox = Arc::new(ImageInbox::new(diagnostics));
        let time = settings.use_sim_time.then(|| subscribe_clock(node, &shared)).transpose()?;
        node.measure_silence_by(clock.clone());
        subscribe_frames(node, &shared)?;
        let monitors = BaseMonitors { clock: time, ..subscribe_base(node, &settings, drive, &shared)? };
        subscribe_camera(node, &settings, &shared, &inbox)?;
        let commands = CommandPublisher::new(node, &settings, clock)?;
        Ok(Self { settings, shared, inbox, monitors, commands })
    }

    /// The time.
    #[must_use]
    pub fn clock(&self) -> RosClock {
        self.shared.clock.clone()
    }

    /// A reader of the newest odometry as received, for any thread.
    #[must_use]
    pub fn odometry(&self) -> OdometryReader {
        OdometryReader(Arc::clone(&self.shared))
    }

    /// Waits until clock, odometry and camera have started; returns their facts. `is_cancelled` is called every 0.1 s.
    ///
    /// # Errors
    /// Names the topics without a usable message within `timeout`, and the reason.
    pub fn wait(
        &self,
        timeout: Duration,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<BodyDescription, Ros2Error> {
        let end = Instant::now() + timeout;
        let mut camera = None;
        while Instant::now() < end {
            if is_cancelled() {
                return Err(Ros2Error::Interrupted);
            }
            let source = self.camera_source(None);
            camera = camera.or_else(|| source.open(Duration::from_millis(100)).ok());
            if camera.is_some() && !lock(&self.shared.odometry).is_empty() {
                let cameras = source.cameras().map_err(|error| self.silent(error.to_string(), timeout))?;
                self.wait_for_frames(&is_cancelled)?;
                return Ok(self.description(cameras.0));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let missing: Vec<&str> = [
            (self.settings.use_sim_time && !self.shared.clock.has_begun(), "/clock"),
            (lock(&self.shared.odometry).is_empty(), self.settings.odom.as_str()),
            (self.inbox.infos().0.is_none(), self.settings.camera_info.as_str()),
            (camera.is_none(), self.settings.color.as_str()),
            (camera.is_none(), self.settings.depth.as_str()),
        ]
        .into_iter()
        .filter_map(|(is_missing, topic)| is_missing.then_some(topic))
        .collect();
        Err(self.silent(missing.join(", "), timeout))
    }

    fn silent(&self, topics: String, timeout: Duration) -> Ros2Error {
        let problems = self.shared.diagnostics.summary();
        let reason = if problems.is_empty() { problems } else { format!(" ({problems})") };
        Ros2Error::Silent { topics, seconds: timeout.as_secs_f64(), reason }
    }

    /// Waits for the transforms of camera and gyro, 7 s from the subscription at most.
    fn wait_for_frames(&self, is_cancelled: impl Fn() -> bool) -> Result<(), Ros2Error> {
        while self.base_from_camera().is_none() || self.awaits_gyro() {
            if is_cancelled() {
                return Err(Ros2Error::Interrupted);
            }
            if self.shared.start.elapsed() > FRAME_WAIT {
                break;
            }
            std::thread::sleep(FRAME_PERIOD);
        }
        Ok(())
    }

    fn base_from_camera(&self) -> Option<Pose3> {
        above_floor(&lock(&self.shared.frames), &self.settings.base_frame, self.inbox.frames().0.as_deref()?)
    }

    fn description(&self, camera: PinholeCamera) -> BodyDescription {
        let (color, depth) = self.inbox.frames();
        let depth = depth.filter(|_| self.settings.depth_info.is_some());
        let color_from_depth =
            color.zip(depth).and_then(|(color, depth)| lock(&self.shared.frames).pose(&color, &depth));
        BodyDescription { camera, base_from_camera: self.base_from_camera(), color_from_depth }
    }

    /// Whether a gyro has sent messages, none of them usable so far.
    fn awaits_gyro(&self) -> bool {
        let has_messages = self.monitors.imu.as_ref().is_some_and(|monitor| monitor.has_begun());
        has_messages && !self.shared.has_gyro.load(Ordering::Relaxed)
    }

    fn camera_source(&self, color_from_depth: Option<Pose3>) -> RosCameraSource {
        RosCameraSource {
            inbox: Arc::clone(&self.inbox),
            settings: self.settings.clone(),
            color_from_depth,
            diagnostics: self.shared.diagnostics.clone(),
        }
    }

    /// Connects the robot to a run: events go to `events` from here on. `output` is the camera that the robot works with, `thread` the
    /// running node, which lives as long as the body.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        self,
        output: PinholeCamera,
        described: &BodyDescription,
        events: InboxSender<TimedEvent>,
        thread: Arc<NodeThread>,
    ) -> Result<LiveBody, AppError> {
        let clock = self.clock();
        let host = clock.clone();
        let feed = EventFeed::with_clock(events, Instant::now(), Arc::new(move || host.now()));
        let camera = Arc::new(self.start_camera(output, described, &feed)?);
        let has_gyro = self.shared.has_gyro.load(Ordering::Relaxed);
        self.shared.uses_gyro.store(has_gyro, Ordering::Relaxed);
        let sink = feed.clone();
        *lock(&self.shared.sink) = Some(Box::new(move |event| sink.send(&event)));
        let refused = |error: Ros2Error| AppError::Environment(error.to_string());
        let commands = CommandThread::start(self.commands).map_err(refused)?;
        let watched = WatchedCamera::new(Arc::clone(&camera), self.settings.color);
        let order = WatchedOrder::new(feed.clone());
        let links = LinkWatch::start(Arc::clone(&self.shared), self.monitors, watched, order, thread)
            .map_err(refused)?;
        let sender = commands.commands();
        let shared = self.shared;
        LiveBody::start(feed, Some(sender), move || {
            drop(commands);
            drop(links);
            *lock(&shared.sink) = None;
            DeviceReport::of_camera(camera.counters(), camera.last_fault())
        })
    }

    fn start_camera(
        &self,
        output: PinholeCamera,
        described: &BodyDescription,
        feed: &EventFeed,
    ) -> Result<CameraThread, AppError> {
        let source = self.camera_source(described.color_from_depth);
        let (sink, clock, stamps) = (feed.clone(), self.clock(), self.clock());
        let parts = CameraThreadParts {
            factory: Box::new(move || source.open(REOPEN_WAIT).map(|camera| Box::new(camera) as Box<_>)),
            sink: Box::new(move |event| sink.send(&event)),
            clock: Arc::new(move || clock.now()),
            stamps: Box::new(move |_| {
                let clock = stamps.clone();
                Box::new(move |ros, _| clock.to_run(ros))
            }),
        };
        // A simulator's images may be equal for long.
        let mut config = CameraThreadConfig::default();
        config.output = Some(output);
        config.expects_noise = false;
        CameraThread::start(parts, config)
            .map_err(|error| AppError::Environment(format!("cannot start the camera's threads: {error}")))
    }
}

/// `base_from_camera` with the height over the floor; `base_footprint` is on the floor, if the robot has this frame \[REP 120\].
fn above_floor(frames: &FrameTree, base: &str, camera: &str) -> Option<Pose3> {
    let mut pose = frames.pose(base, camera)?;
    if let Some(on_floor) = frames.pose("base_footprint", camera) {
        pose.translation.z = on_floor.translation.z;
    }
    Some(pose)
}

/// Reads the newest odometry as received.
#[derive(Clone)]
pub struct OdometryReader(Arc<Shared>);

impl OdometryReader {
    /// The newest odometry up to `stamp`, `odom_from_base`.
    #[must_use]
    pub fn at(&self, stamp: Stamp) -> Option<Odometry> {
        let history = lock(&self.0.odometry);
        history.iter().rev().find(|odometry| odometry.stamp <= stamp).copied()
    }

    /// Whether `/tf` holds the transform from the odometry's frame to `base`.
    #[must_use]
    pub fn has_transform(&self, base: &str) -> bool {
        self.frame().is_some_and(|odom| lock(&self.0.frames).pose(&odom, base).is_some())
    }

    /// A reader of one reading, in the frame `frame`.
    #[cfg(test)]
    pub(crate) fn of_one(frame: &str, odometry: Odometry) -> Self {
        let shared = Shared::new(RosClock::system(), Default::default());
        *lock(&shared.odom_frame) = Some(frame.to_owned());
        lock(&shared.odometry).push_back(odometry);
        Self(Arc::new(shared))
    }

    /// Name of the odometry's frame.
    #[must_use]
    pub fn frame(&self) -> Option<String> {
        lock(&self.0.odom_frame).clone()
    }
}

fn subscribe_clock(node: &mut RosNode, shared: &Arc<Shared>) -> Result<Arc<TopicMonitor>, Ros2Error> {
    let shared = Arc::clone(shared);
    let on_clock = move |message: Clock| {
        let time = stamp::from_ros(&message.clock).and_then(|time| shared.clock.set(time));
        shared.accept("/clock", time);
    };
    node.subscribe("/clock", &qos::sensor(1), Some(MAX_CLOCK_SILENCE), on_clock)
}

fn subscribe_frames(node: &mut RosNode, shared: &Arc<Shared>) -> Result<(), Ros2Error> {
    type Add = fn(&mut FrameTree, &TransformStamped) -> Result<(), Invalid>;
    let topics: [(_, _, Add); 2] =
        [("/tf_static", qos::latched(), FrameTree::add_static), ("/tf", qos::sensor(100), FrameTree::add)];
    for (topic, qos, add) in topics {
        let (shared, name) = (Arc::clone(shared), node.names().resolve(topic));
        let on_frames = move |message: TFMessage| {
            for transform in &message.transforms {
                let added = add(&mut lock(&shared.frames), transform);
                shared.accept(&name, added);
            }
        };
        node.subscribe_to_others(topic, &qos, on_frames)?;
    }
    Ok(())
}
