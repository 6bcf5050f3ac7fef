//! A body offered as a ROS 2 robot: its sensors are published, commands come by `cmd_vel`.

use super::ServerSettings;
use super::clock_publisher::ClockPublisher;
use super::image_publisher::ImagePublisher;
use crate::convert::odometry::OdometryFrames;
use crate::convert::{battery, imu, odometry, scan, stamp, transform, twist};
use crate::generated::geometry_msgs::{Twist, TwistStamped};
use crate::generated::nav_msgs::Odometry as OdometryMessage;
use crate::generated::sensor_msgs::{BatteryState, Imu, JointState, LaserScan};
use crate::generated::tf2_msgs::TFMessage;
use crate::node::{RosNode, qos};
use crate::outputs::OutputTopic;
use crate::{Ros2Error, Ros2Options};
use nalgebra::Matrix3;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use trundle_app::AppError;
use trundle_app::real_time::RealTimePacer;
use trundle_core::{
    BodyEventKind, DifferentialDrive, Odometry, PinholeCamera, Pose2, Pose3, RobotBody, SensorEvent, Stamp,
    Twist2, WheelTicks,
};
use trundle_localization::{OdometryConfig, WheelOdometry};

/// Time after the newest command for which the base obeys it. Source: ours; Nav2 sends 20 a second.
const COMMAND_LIFETIME: Duration = Duration::from_millis(500);
/// Range of a laser's beams without echo \[m\]. Source: the simulated lasers reach 12 m.
const LASER_RANGE_M: f64 = 12.0;

/// What a body that is offered looks like.
#[derive(Debug, Clone, Copy)]
pub struct OfferedBody {
    /// The camera.
    pub camera: PinholeCamera,
    /// `base_from_camera`.
    pub base_from_camera: Pose3,
    /// Geometry of the base.
    pub drive: DifferentialDrive,
}

/// Offers `body` as a ROS 2 robot, in real time, until it ends or `is_over` (called with the body's time) says so.
///
/// # Errors
/// When the network cannot be joined, a topic cannot be made, or the body fails.
pub fn serve_body<B: RobotBody>(
    options: &Ros2Options,
    raw_images: bool,
    offered: OfferedBody,
    body: &mut B,
    is_over: impl FnMut(Stamp) -> bool,
) -> Result<(), AppError> {
    let (frames, stamped_commands) = (options.frames.clone(), options.stamped_commands);
    let mut node = RosNode::new(&options.node)?;
    let mut server =
        BodyServer::new(&mut node, ServerSettings { frames, stamped_commands, raw_images }, offered)?;
    let _running = node.start()?;
    server.run(body, is_over).map_err(|error| AppError::Input(error.to_string()))
}

/// The topics of a body that is offered as a ROS 2 robot.
pub struct BodyServer {
    settings: ServerSettings,
    body: OfferedBody,
    odom: OutputTopic<OdometryMessage>,
    truth: OutputTopic<OdometryMessage>,
    imu: OutputTopic<Imu>,
    joints: OutputTopic<JointState>,
    scan: OutputTopic<LaserScan>,
    battery: OutputTopic<BatteryState>,
    tf: OutputTopic<TFMessage>,
    tf_static: OutputTopic<TFMessage>,
    clock: ClockPublisher,
    images: ImagePublisher,
    odometry: WheelOdometry,
    wheels: Wheels,
    command: NewestCommand,
}

impl BodyServer {
    /// Adds the topics of a body to a node.
    ///
    /// # Errors
    /// When a topic cannot be made.
    pub fn new(node: &mut RosNode, settings: ServerSettings, body: OfferedBody) -> Result<Self, Ros2Error> {
        let config = OdometryConfig::default();
        let odometry =
            WheelOdometry::new(body.drive, config).map_err(|error| Ros2Error::create("odometry", error))?;
        Ok(Self {
            odom: OutputTopic::new(node, "odom", &qos::reliable(10))?,
            truth: OutputTopic::new(node, "ground_truth", &qos::reliable(10))?,
            imu: OutputTopic::new(node, "imu", &qos::sensor(10))?,
            joints: OutputTopic::new(node, "joint_states", &qos::reliable(10))?,
            scan: OutputTopic::new(node, "scan", &qos::sensor(5))?,
            battery: OutputTopic::new(node, "battery_state", &qos::reliable(1))?,
            tf: OutputTopic::new(node, "/tf", &qos::reliable(100))?,
            tf_static: OutputTopic::new(node, "/tf_static", &qos::latched())?,
            clock: ClockPublisher::new(node)?,
            images: ImagePublisher::start(node, &settings, body.camera)?,
            command: subscribe_commands(node, settings.stamped_commands)?,
            settings,
            body,
            odometry,
            wheels: Wheels::default(),
        })
    }

    /// Runs `body` in real time until it ends or `is_over` (called with the body's time) says so. The node must have been started.
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

    /// The newest command, as long as it counts.
    fn present_command(&self) -> Twist2 {
        let command = *self.command.lock().unwrap_or_else(PoisonError::into_inner);
        command.filter(|(_, at)| at.elapsed() <= COMMAND_LIFETIME).map_or(Twist2::ZERO, |(twist, _)| twist)
    }

    fn publish(&mut self, event: SensorEvent) {
        let at = self.clock.ros_time(event.stamp());
        self.clock.publish(at);
        let frames = &self.settings.frames;
        match event {
            SensorEvent::Gyro(gyro) => {
                self.odometry.step_gyro(&gyro);
                self.imu.publish(imu::to_ros(gyro.omega, None, at, &frames.base));
            }
            SensorEvent::Wheels(ticks) => {
                let odometry = self.odometry.step_wheels(&ticks);
                self.publish_odometry(&odometry, at);
                self.joints.publish(self.wheels.joints(&ticks, &self.body.drive, at));
            }
            SensorEvent::Odometry(odometry) => self.publish_odometry(&odometry, at),
            SensorEvent::Rgbd(image) => self.images.publish(image, at),
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

/// The newest command and when it came.
type NewestCommand = Arc<Mutex<Option<(Twist2, Instant)>>>;

/// Keeps the newest command; one that is not usable is reported and stops the base.
fn subscribe_commands(node: &mut RosNode, stamped: bool) -> Result<NewestCommand, Ros2Error> {
    let command = NewestCommand::default();
    let (kept, diagnostics, name) =
        (Arc::clone(&command), node.diagnostics(), node.names().resolve("cmd_vel"));
    let keep = move |message: &Twist| {
        let usable = twist::from_ros(message).map_err(|error| diagnostics.warn(&name, error.to_string()));
        *kept.lock().unwrap_or_else(PoisonError::into_inner) =
            Some((usable.unwrap_or_default(), Instant::now()));
    };
    if stamped {
        node.subscribe("cmd_vel", &qos::reliable(1), None, move |message: TwistStamped| {
            keep(&message.twist)
        })?;
    } else {
        node.subscribe("cmd_vel", &qos::reliable(1), None, move |message: Twist| keep(&message))?;
    }
    Ok(command)
}

/// Angles of the wheels, from counters that wrap.
#[derive(Debug, Default)]
struct Wheels {
    last: Option<WheelTicks>,
    /// Left and right \[rad\].
    angles: [f64; 2],
}

impl Wheels {
    fn joints(&mut self, ticks: &WheelTicks, drive: &DifferentialDrive, at: Stamp) -> JointState {
        let last = self.last.replace(*ticks).unwrap_or(*ticks);
        let turned = [ticks.left.wrapping_sub(last.left), ticks.right.wrapping_sub(last.right)];
        let steps =
            turned.map(|ticks| f64::from(ticks as i16) * std::f64::consts::TAU / drive.ticks_per_turn);
        let dt = ticks.stamp - last.stamp;
        self.angles.iter_mut().zip(steps).for_each(|(angle, step)| *angle += step);
        JointState {
            header: stamp::header(at, ""),
            name: vec!["wheel_left_joint".to_owned(), "wheel_right_joint".to_owned()],
            position: self.angles.to_vec(),
            velocity: steps.map(|step| if dt > 0.0 { step / dt } else { 0.0 }).to_vec(),
            effort: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheel_angles_go_through_the_wrap_of_the_counters() {
        let mut wheels = Wheels::default();
        let ticks = |at, left| WheelTicks { stamp: Stamp::from_nanos(at), left, right: 0 };
        wheels.joints(&ticks(0, u16::MAX), &DifferentialDrive::KOBUKI, Stamp::default());
        let joints = wheels.joints(&ticks(1_000_000_000, 9), &DifferentialDrive::KOBUKI, Stamp::default());
        let expected = 10.0 * std::f64::consts::TAU / DifferentialDrive::KOBUKI.ticks_per_turn;
        assert!(
            (joints.position[0] - expected).abs() < 1e-12 && (joints.velocity[0] - expected).abs() < 1e-12
        );
    }
}
