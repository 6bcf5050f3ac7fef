//! The robot as a ROS 2 node: its outputs, its actions and services, and its body if that comes by topics.

use crate::body::{BodyDescription, BodySettings, Ros2Body};
use crate::clock::RosClock;
use crate::navigation::{self, ActiveGoal, Parameters};
use crate::node::{NodeThread, RosNode};
use crate::outputs::{OutputSettings, OutputSources, PublishedMap, RobotOutputs, RobotTopics, RunFrames};
use crate::server::{SensorTopics, ServerSettings};
use crate::{Ros2Error, Ros2Options};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use trundle_app::AppError;
use trundle_app::operator::{Operator, OperatorLink, operator_link};
use trundle_app::real_time::{EventObserver, LiveBody, TimedEvent};
use trundle_core::SensorEvent;
use trundle_runtime::real_time::InboxSender;
use trundle_runtime::{CameraMount, RangeSource, RobotConfig};

/// The robot as a running ROS 2 node. A drop ends its threads.
pub struct RobotNode {
    // Declared first: the outputs end before the node.
    _outputs: RobotOutputs,
    thread: Arc<NodeThread>,
    /// Publishes the sensors of trundle's own body. `None` if the body comes by topics.
    observer: Option<EventObserver>,
}

/// A robot whose body comes by topics, all of them active.
pub struct Ros2Robot {
    /// The node.
    pub node: RobotNode,
    /// The run's end of the link to those who give goals.
    pub link: OperatorLink,
    body: Ros2Body,
    described: BodyDescription,
}

impl Ros2Robot {
    /// Joins the network and waits until the robot's topics are active. Camera and mount of `robot` are replaced by those of the topics; a
    /// mount without a transform does not change.
    ///
    /// # Errors
    /// When the network cannot be joined, or topics are silent for `timeout`.
    pub fn connect(
        options: &Ros2Options,
        settings: BodySettings,
        robot: &mut RobotConfig,
        timeout: Duration,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Self, Ros2Error> {
        let mut node = RosNode::new(&options.node)?;
        let has_laser = settings.scan.is_some();
        let body = Ros2Body::new(&mut node, settings, robot.drive)?;
        let (operator, link) = operator_link();
        let outputs =
            OutputSettings { publishes_scan: !has_laser, ..OutputSettings::of(options, robot, false) };
        let frames = RunFrames { names: options.frames.clone(), body_odometry: Some(body.odometry()) };
        let parts = Parts::new(&mut node, options, robot, outputs, frames, (operator, body.clock()))?;
        let thread = Arc::new(node.start()?);
        let described = body.wait(timeout, is_cancelled)?;
        robot.camera = described.camera;
        if let Some(pose) = &described.base_from_camera {
            let broken =
                |error| Ros2Error::create("the robot with the camera where /tf_static has it", error);
            robot.mount = CameraMount::of_pose(pose).map_err(broken)?;
        } else {
            tracing::warn!("no transform leads to the camera's frame: the mount of the robot file is used");
        }
        if has_laser {
            robot.sight = RangeSource::Laser;
        }
        let node = parts.start(thread, robot)?;
        Ok(Self { node, link, body, described })
    }

    /// Starts the body of a run: events go to `events`. The node continues in the second value.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn into_parts(self) -> (RobotNode, OperatorLink, BodyStart) {
        let thread = Arc::clone(&self.node.thread);
        (self.node, self.link, BodyStart { body: self.body, described: self.described, thread })
    }
}

/// A body that is ready to begin.
pub struct BodyStart {
    body: Ros2Body,
    described: BodyDescription,
    thread: Arc<NodeThread>,
}

impl BodyStart {
    /// Starts the body: events go to `events`.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(self, events: InboxSender<TimedEvent>) -> Result<LiveBody, AppError> {
        self.body.start(self.described.camera, &self.described, events, self.thread)
    }
}

impl RobotNode {
    /// Offers a run on trundle's own body, whose stamps count from `origin`. Images are published raw or as JPEG and PNG files.
    ///
    /// # Errors
    /// When the network cannot be joined, or a topic cannot be created.
    pub fn offer(
        options: &Ros2Options,
        raw_images: bool,
        robot: &RobotConfig,
        origin: Instant,
    ) -> Result<(Self, OperatorLink), Ros2Error> {
        let mut node = RosNode::new(&options.node)?;
        let (operator, link) = operator_link();
        let outputs = OutputSettings::of(options, robot, true);
        let clock = RosClock::system_from(origin);
        let (frames, stamped_commands) = (options.frames.clone(), options.stamped_commands);
        let settings = ServerSettings { frames, stamped_commands, raw_images };
        let sensors = observer(&mut node, &settings, robot, clock.clone())?;
        let frames = RunFrames::of_own_odometry(options.frames.clone());
        let parts = Parts::new(&mut node, options, robot, outputs, frames, (operator, clock))?;
        let thread = Arc::new(node.start()?);
        let offered = parts.start(thread, robot)?;
        Ok((Self { observer: Some(sensors), ..offered }, link))
    }

    /// Publishes the sensors of trundle's own body, from any thread. `None` if the body comes by topics.
    #[must_use]
    pub fn observer(&self) -> Option<EventObserver> {
        self.observer.clone()
    }
}

/// Publishes the events of the sensors of `robot`.
fn observer(
    node: &mut RosNode,
    settings: &ServerSettings,
    robot: &RobotConfig,
    clock: RosClock,
) -> Result<EventObserver, Ros2Error> {
    let topics = Mutex::new(SensorTopics::new(node, settings, robot.camera, robot.drive)?);
    Ok(Arc::new(move |event: &SensorEvent| {
        let at = clock.to_ros(event.stamp());
        topics.lock().unwrap_or_else(PoisonError::into_inner).publish(event, at);
    }))
}

/// Topics and services of a node, before it runs.
struct Parts {
    topics: RobotTopics,
    settings: OutputSettings,
    frames: RunFrames,
    operator: Operator,
    clock: RosClock,
    diagnostics: crate::node::Diagnostics,
    published_map: PublishedMap,
}

impl Parts {
    fn new(
        node: &mut RosNode,
        options: &Ros2Options,
        robot: &RobotConfig,
        settings: OutputSettings,
        frames: RunFrames,
        (operator, clock): (Operator, RosClock),
    ) -> Result<Self, Ros2Error> {
        let diagnostics = node.diagnostics();
        let topics = RobotTopics::new(node, &settings)?;
        let active = ActiveGoal::new(operator.clone(), clock.clone(), diagnostics.clone());
        let published_map = PublishedMap::default();
        navigation::offer(node, &active, options, &frames, &published_map, robot)?;
        Parameters::of(robot, options.use_sim_time).offer(node, &active)?;
        Ok(Self { topics, settings, frames, operator, clock, diagnostics, published_map })
    }

    fn start(self, thread: Arc<NodeThread>, robot: &RobotConfig) -> Result<RobotNode, Ros2Error> {
        let sources = OutputSources {
            operator: self.operator,
            clock: self.clock,
            diagnostics: self.diagnostics,
            frames: self.frames,
            base_from_camera: robot.mount.base_from_camera(),
            published_map: self.published_map,
            node: Arc::clone(&thread),
        };
        let outputs = RobotOutputs::start(self.topics, self.settings, sources)?;
        Ok(RobotNode { _outputs: outputs, thread, observer: None })
    }
}
