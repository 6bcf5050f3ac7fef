//! A ROS 2 robot as the body of a run.

use super::base_sensors::{BaseMonitors, Shared, lock, subscribe as subscribe_base};
use super::camera_topics::subscribe as subscribe_camera;
use super::commands::{CommandPublisher, CommandThread};
use super::image_inbox::ImageInbox;
use super::ros_camera::RosCameraSource;
use super::{BodySettings, FrameTree};
use crate::Ros2Error;
use crate::clock::RosClock;
use crate::convert::stamp;
use crate::generated::rosgraph_msgs::Clock;
use crate::generated::tf2_msgs::TFMessage;
use crate::node::{Level, NodeThread, RosNode, TopicMonitor, qos};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use trundle_app::AppError;
use trundle_app::real_time::{EventFeed, LiveBody, TimedEvent};
use trundle_core::{
    BodyEvent, BodyEventKind, Device, DifferentialDrive, Link, Odometry, PinholeCamera, Pose3, SensorEvent,
    Stamp,
};
use trundle_drivers::camera::camera_thread::{CameraThread, CameraThreadConfig, CameraThreadParts};
use trundle_runtime::real_time::InboxSender;

/// Time between two looks at the links. Source: ours.
const LINK_PERIOD: Duration = Duration::from_millis(50);
/// Wait of the camera's thread for images when it opens the camera again. Source: ours.
const REOPEN_WAIT: Duration = Duration::from_secs(2);
/// Wait for the transform of the camera after its first images. Source: ours; tf_static comes at once.
const FRAME_WAIT: Duration = Duration::from_secs(2);

/// The topics of a ROS 2 robot, subscribed; events flow once [`Ros2Body::start`] connects it to a run.
pub struct Ros2Body {
    settings: BodySettings,
    shared: Arc<Shared>,
    inbox: Arc<ImageInbox>,
    monitors: BaseMonitors,
    commands: CommandPublisher,
}

/// What is known of the robot when all its topics have begun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyDescription {
    /// The colour camera.
    pub camera: PinholeCamera,
    /// `base_from_camera`, of the colour camera's optical frame; `None` where no transform says.
    pub base_from_camera: Option<Pose3>,
    /// The depth camera's pose in the colour camera's frame; `None` where depth is registered to colour.
    pub color_from_depth: Option<Pose3>,
}

impl Ros2Body {
    /// Adds the robot's topics to a node. `drive` is the geometry of the base.
    ///
    /// # Errors
    /// When a topic cannot be made.
    pub fn new(
        node: &mut RosNode,
        settings: BodySettings,
        drive: DifferentialDrive,
    ) -> Result<Self, Ros2Error> {
        let clock = if settings.use_sim_time { RosClock::simulated() } else { RosClock::system() };
        let diagnostics = node.diagnostics();
        let shared = Arc::new(Shared {
            sink: Mutex::default(),
            frames: Mutex::new(FrameTree::default()),
            odometry: Mutex::default(),
            has_gyro: AtomicBool::default(),
            uses_gyro: AtomicBool::default(),
            odom_frame: Mutex::default(),
            clock: clock.clone(),
            diagnostics: diagnostics.clone(),
        });
        let inbox = Arc::new(ImageInbox::new(diagnostics));
        if settings.use_sim_time {
            subscribe_clock(node, &shared)?;
        }
        subscribe_frames(node, &shared)?;
        let monitors = subscribe_base(node, &settings, drive, &shared)?;
        subscribe_camera(node, &settings, &shared, &inbox)?;
        let commands = CommandPublisher::new(node, &settings, clock)?;
        Ok(Self { settings, shared, inbox, monitors, commands })
    }

    /// The time.
    #[must_use]
    pub fn clock(&self) -> RosClock {
        self.shared.clock.clone()
    }

    /// Reads the newest odometry as the robot gave it, from any thread.
    #[must_use]
    pub fn odometry(&self) -> OdometryReader {
        OdometryReader(Arc::clone(&self.shared))
    }

    /// Waits until clock, odometry and camera have begun; what they say. `is_cancelled` is asked every 0.1 s.
    ///
    /// # Errors
    /// Names the topics on which nothing usable came within `timeout`, and why it was not usable.
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
                return Ok(self.description(
                    source.cameras().map_err(|error| self.silent(error.to_string(), timeout))?.0,
                ));
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

    fn description(&self, camera: PinholeCamera) -> BodyDescription {
        let end = Instant::now() + FRAME_WAIT;
        loop {
            let (color, depth) = self.inbox.frames();
            let frames = lock(&self.shared.frames);
            let base_from_camera =
                color.as_deref().and_then(|frame| above_floor(&frames, &self.settings.base_frame, frame));
            let color_from_depth =
                color.as_deref().zip(depth.as_deref()).and_then(|(color, depth)| frames.pose(color, depth));
            drop(frames);
            if base_from_camera.is_some() || Instant::now() >= end {
                let color_from_depth = color_from_depth.filter(|_| self.settings.depth_info.is_some());
                return BodyDescription { camera, base_from_camera, color_from_depth };
            }
            std::thread::sleep(LINK_PERIOD);
        }
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
        let camera = self.start_camera(output, described, &feed)?;
        let has_gyro = self.shared.has_gyro.load(Ordering::Relaxed);
        self.shared.uses_gyro.store(has_gyro, Ordering::Relaxed);
        let sink = feed.clone();
        *lock(&self.shared.sink) = Some(Box::new(move |event| sink.send(&event)));
        let refused = |error: Ros2Error| AppError::Environment(error.to_string());
        let commands = CommandThread::start(self.commands).map_err(refused)?;
        let links = LinkWatch::start(Arc::clone(&self.shared), self.monitors, thread).map_err(refused)?;
        let sender = commands.commands();
        let shared = self.shared;
        LiveBody::start(feed, Some(sender), move || {
            drop(commands);
            drop(links);
            *lock(&shared.sink) = None;
            camera.last_fault()
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
        let config = CameraThreadConfig {
            output: Some(output),
            expects_noise: false,
            ..CameraThreadConfig::default()
        };
        CameraThread::start(parts, config)
            .map_err(|error| AppError::Environment(format!("cannot start the camera's threads: {error}")))
    }
}

/// `base_from_camera` with the height over the floor, which `base_footprint` lies on where the robot has this frame \[REP 120\].
fn above_floor(frames: &FrameTree, base: &str, camera: &str) -> Option<Pose3> {
    let mut pose = frames.pose(base, camera)?;
    if let Some(on_floor) = frames.pose("base_footprint", camera) {
        pose.translation.z = on_floor.translation.z;
    }
    Some(pose)
}

/// Reads the newest odometry as the robot gave it.
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

    /// Name of the odometry's frame.
    #[must_use]
    pub fn frame(&self) -> Option<String> {
        lock(&self.0.odom_frame).clone()
    }
}

fn subscribe_clock(node: &mut RosNode, shared: &Arc<Shared>) -> Result<(), Ros2Error> {
    let shared = Arc::clone(shared);
    let on_clock = move |message: Clock| {
        let time = stamp::from_ros(&message.clock).and_then(|time| shared.clock.set(time));
        shared.accept("/clock", time);
    };
    node.subscribe("/clock", &qos::sensor(1), Some(Duration::from_secs(1)), on_clock).map(drop)
}

fn subscribe_frames(node: &mut RosNode, shared: &Arc<Shared>) -> Result<(), Ros2Error> {
    for (topic, qos) in [("/tf_static", qos::latched()), ("/tf", qos::sensor(100))] {
        let (shared, name) = (Arc::clone(shared), node.names().resolve(topic));
        let on_frames = move |message: TFMessage| {
            for transform in &message.transforms {
                let added = lock(&shared.frames).add(transform);
                shared.accept(&name, added);
            }
        };
        node.subscribe(topic, &qos, None, on_frames)?;
    }
    Ok(())
}

/// Reports the loss and the return of base and laser, and the death of the node.
struct LinkWatch {
    is_over: Arc<AtomicBool>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl LinkWatch {
    fn start(shared: Arc<Shared>, monitors: BaseMonitors, node: Arc<NodeThread>) -> Result<Self, Ros2Error> {
        let is_over = Arc::<AtomicBool>::default();
        let over = Arc::clone(&is_over);
        let mut links = vec![WatchedLink::new(Device::Base, monitors.odom)];
        links.extend(monitors.scan.map(|monitor| WatchedLink::new(Device::Laser, monitor)));
        let watch = move || {
            while !over.load(Ordering::Relaxed) {
                links.iter_mut().for_each(|link| link.check(&shared, &node));
                std::thread::sleep(LINK_PERIOD);
            }
        };
        let thread = std::thread::Builder::new().name("ros2-links".to_owned()).spawn(watch)?;
        Ok(Self { is_over, thread: Some(thread) })
    }
}

impl Drop for LinkWatch {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread that watches the ROS 2 links panicked");
        }
    }
}

struct WatchedLink {
    device: Device,
    monitor: Arc<TopicMonitor>,
    is_up: bool,
}

impl WatchedLink {
    fn new(device: Device, monitor: Arc<TopicMonitor>) -> Self {
        Self { device, monitor, is_up: true }
    }

    fn check(&mut self, shared: &Shared, node: &NodeThread) {
        let problem = node.death().or_else(|| self.monitor.stall(Instant::now()));
        let is_up = problem.is_none();
        if let Some(problem) = problem {
            shared.diagnostics.report(&self.monitor.name, Level::Error, problem);
        }
        if is_up != self.is_up {
            self.is_up = is_up;
            let kind = BodyEventKind::Link(Link { device: self.device, is_up });
            shared.send(SensorEvent::Body(BodyEvent { stamp: shared.clock.now(), kind }));
        }
    }
}
