//! A body offered as a ROS 2 robot: its sensors are published, commands come by `cmd_vel`.

use super::ServerSettings;
use super::clock_publisher::ClockPublisher;
use super::sensor_topics::SensorTopics;
use crate::convert::odometry::OdometryFrames;
use crate::convert::{battery, odometry, scan, transform};
use crate::generated::nav_msgs::OdometryMessage;
use crate::generated::sensor_msgs::{BatteryState, LaserScan};
use crate::generated::tf2_msgs::TFMessage;
use crate::node::{RosNode, qos};
use crate::outputs::OutputTopic;
use crate::twist_topic::subscribe_twists;
use crate::{Ros2Error, Ros2Options};
use nalgebra::Matrix3;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use trundle_app::AppError;
use trundle_app::real_time::RealTimePacer;
use trundle_core::{
    BodyEventKind, DifferentialDrive, Odometry, PinholeCamera, Pose2, Pose3, RobotBody, SensorEvent, Stamp,
    Twist2,
};
use trundle_estimation::{OdometryConfig, WheelOdometry};

/// Time for which the base follows the newest command. Source: ours; Nav2 sends 20 per second.
const COMMAND_LIFETIME: Duration = Duration::from_millis(500);
/// Range of a laser's beams without echo \[m\]. Source: the simulated lasers reach 12 m.
const LASER_RANGE_M: f64 = 12.0;

/// Description of a body that is offered.
#[derive(Debug, Clone, Copy)]
pub struct OfferedBody {
    /// The camera.
    pub camera: PinholeCamera,
    /// `base_from_camera`.
    pub base_from_camera: Pose3,
    /// Geometry of the base.
    pub drive: DifferentialDrive,
}

/// Offers `body` as a ROS 2 robot, in real time, until it ends or `is_over` (called with the body's time) returns true.
///
/// # Errors
/// When the network cannot be joined, a topic cannot be created, or the body fails.
pub fn serve_body<B: RobotBody>(
    options: &Ros2Options,
    raw_images: bool,
    offered: OfferedBody,
    body: &mut B,
    mut is_over: impl FnMut(Stamp) -> bool,
) -> Result<(), AppError> {
    let (frames, stamped_commands) = (options.frames.clone(), options.stamped_commands);
    let mut node = RosNode::new(&options.node)?;
    let mut server =
        BodyServer::new(&mut node, ServerSettings { frames, stamped_commands, raw_images }, offered)?;
    let running = node.start()?;
    let ran = server.run(body, |at| is_over(at) || running.is_dead());
    ran.map_err(|error| AppError::Input(error.to_string()))?;
    running.death().map_or(Ok(()), |death| Err(AppError::Environment(death)))
}

/// The topics of a body that is offered as a ROS 2 robot.
pub struct BodyServer {
    settings: ServerSettings,
    body: OfferedBody,
    odom: OutputTopic<OdometryMessage>,
    truth: OutputTopic<OdometryMessage>,
    scan: OutputTopic<LaserScan>,
    battery: OutputTopic<BatteryState>,
    tf: OutputTopic<TFMessage>,
    tf_static: OutputTopic<TFMessage>,
    clock: ClockPublisher,
    sensors: SensorTopics,
    odometry: WheelOdometry,
    command: NewestCommand,
}

impl BodyServer {
    /// Adds the topics of a body to a node.
    ///
    /// # Errors
    /// When a topic cannot be created.
    pub fn new(node: &mut RosNode, settings: ServerSettings, body: OfferedBody) -> Result<Self, Ros2Error> {
        let config = OdometryConfig::default();
        let odometry =
            WheelOdometry::new(body.drive, config).map_err(|error| Ros2Error::create("odometry", error))?;
        Ok(Self {
            odom: OutputTopic::new(node, "odom", &qos::reliable(10))?,
            truth: OutputTopic::new(node, "ground_truth", &qos::reliable(10))?,
            scan: OutputTopic::new(node, "scan", &qos::reliable(5))?,
            battery: OutputTopic::new(node, "battery_state", &qos::reliable(1))?,
            tf: OutputTopic::new(node, "/tf", &qos::reliable(100))?,
            tf_static: OutputTopic::new(node, "/tf_static", &qos::latched())?,
            clock: ClockPublisher::new(node)?,
            sensors: SensorTopics::new(node, &settings, body.camera, body.drive)?,
            command: subscribe_commands(node, settings.stamped_commands)?,
            settings,
            body,
            odometry,
        })
    }

    /// Runs `body` in real time until it ends or `is_over` (called with the body's time) returns true. The node must have been started.
    ///
    /// # Errors
    /// When the body fails.
    pub fn run<B: RobotBody>(
        &mut self,
        body: &mut B,
        mut is_over: impl FnMut(Stamp) -> bool,
    ) -> Result<(), B::Error> {
        self.publish_static();
        let mut pacer = RealTimePacer::start();
        while let Some(event) = body.next_event()? {
            pacer.wait_for(event.stamp().as_secs());
            if is_over(event.stamp()) {
                break;
            }
            let is_control_step = matches!(event, SensorEvent::Wheels(_) | SensorEvent::Odometry(_));
            self.publish(event);
            if is_control_step {
                body.command(self.present_command())?;
            }
        }
        body.command(Twist2::ZERO)
    }

    /// The newest command, if it is recent enough.
    fn present_command(&self) -> Twist2 {
        let command = *self.command.lock().unwrap_or_else(PoisonError::into_inner);
        command.filter(|(_, at)| at.elapsed() <= COMMAND_LIFETIME).map_or(Twist2::ZERO, |(twist, _)| twist)
    }

    fn publish(&mut self, event: SensorEvent) {
        let at = self.clock.ros_time(event.stamp());
        self.clock.publish(at);
        self.sensors.publish(&event, at);
        let frames = &self.settings.frames;
        match event {
            SensorEvent::Gyro(gyro) => {
                self.odometry.step_gyro(&gyro);
            }
            SensorEvent::Wheels(ticks) => {
                let odometry = self.odometry.step_wheels(&ticks);
                self.publish_odometry(&odometry, at);
            }
            SensorEvent::Odometry(odometry) => self.publish_odometry(&odometry, at),
            SensorEvent::Scan(sweep) => {
                self.scan.publish(scan::to_ros(&sweep, at, &frames.scan, LASER_RANGE_M))
            }
            SensorEvent::Body(event) => {
                if let BodyEventKind::Battery(own) = event.kind {
                    self.battery.publish(battery::to_ros(&own, at, &frames.base));
                }
            }
            SensorEvent::Truth { stamp, pose } => {
                let covariance = Matrix3::zeros();
                let truth = Odometry { stamp, pose, twist: Twist2::ZERO, covariance };
                let frames = OdometryFrames { odom: "world", base: &frames.base };
                self.truth.publish(odometry::to_ros(&truth, at, frames));
            }
            _ => {}
        }
    }

    fn publish_odometry(&self, own: &Odometry, at: Stamp) {
        let frames = &self.settings.frames;
        let names = OdometryFrames { odom: &frames.odom, base: &frames.base };
        self.odom.publish(odometry::to_ros(own, at, names));
        let transforms = vec![transform::planar_to_ros(&own.pose, at, &frames.odom, &frames.base)];
        self.tf.publish(TFMessage { transforms });
    }

    fn publish_static(&self) {
        let (frames, at) = (&self.settings.frames, self.clock.ros_time(Stamp::default()));
        let camera = transform::to_ros(&self.body.base_from_camera, at, &frames.base, &frames.camera);
        let scan = transform::planar_to_ros(&Pose2::IDENTITY, at, &frames.base, &frames.scan);
        self.tf_static.publish(TFMessage { transforms: vec![camera, scan] });
    }
}

/// The newest command and its time.
type NewestCommand = Arc<Mutex<Option<(Twist2, Instant)>>>;

/// Keeps the newest command; one that is not usable is reported and stops the base.
fn subscribe_commands(node: &mut RosNode, is_stamped: bool) -> Result<NewestCommand, Ros2Error> {
    let command = NewestCommand::default();
    let kept = Arc::clone(&command);
    subscribe_twists(node, "cmd_vel", is_stamped, move |twist| {
        let newest = (twist.unwrap_or_default(), Instant::now());
        *kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(newest);
    })?;
    Ok(command)
}
