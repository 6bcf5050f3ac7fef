//! A robot whose body comes by topics, played by another node.

use super::{Domain, wait_until};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use trundle_app::real_time::{BackgroundBody, LiveBody, TimedEvent};
use trundle_core::{
    BodyEvent, BodyEventKind, ColorImage, DepthImage, Device, Distortion, Link, Odometry, PinholeCamera,
    Pose2, SensorEvent, Stamp, Twist2,
};
use trundle_ros2::body::BodySettings;
use trundle_ros2::clock::RosClock;
use trundle_ros2::convert::odometry::OdometryFrames;
use trundle_ros2::convert::{camera_info, image, odometry, transform};
use trundle_ros2::generated::diagnostic_msgs::DiagnosticArray;
use trundle_ros2::generated::nav_msgs::OdometryMessage;
use trundle_ros2::generated::sensor_msgs::{CameraInfoMessage, ImageMessage};
use trundle_ros2::generated::tf2_msgs::TFMessage;
use trundle_ros2::node::{Networks, NodeThread, qos};
use trundle_ros2::wire::Bytes;
use trundle_ros2::{RobotNode, Ros2Options, Ros2Robot};
use trundle_runtime::RobotConfig;
use trundle_runtime::real_time::{Inbox, Input, LoopTimer, LoopTimerConfig};

/// Size of the images \[px\].
const SIZE: (usize, usize) = (32, 24);
/// Depth of all pixels but one \[m\], no whole number of millimetres.
const DEPTH_M: f32 = 1.2345;
/// Period of the played messages.
const PERIOD: Duration = Duration::from_millis(20);

/// What the played robot publishes.
#[derive(Default)]
struct Played {
    is_over: AtomicBool,
    has_no_odom: AtomicBool,
    has_transform: AtomicBool,
}

/// A robot that stands: odometry, and raw images with depth in metres.
struct PlayedRobot {
    played: Arc<Played>,
    thread: Option<JoinHandle<()>>,
    reports: Receiver<String>,
    _node: NodeThread,
}

impl PlayedRobot {
    fn start(domain: &Domain) -> Self {
        let mut node = domain.node("driver");
        let odom = node.publisher::<OdometryMessage>("odom", &qos::reliable(10)).unwrap();
        let color = node.publisher::<ImageMessage>("camera/color/image_raw", &qos::sensor(2)).unwrap();
        let depth = node.publisher::<ImageMessage>("camera/depth/image_raw", &qos::sensor(2)).unwrap();
        let info =
            node.publisher::<CameraInfoMessage>("camera/color/camera_info", &qos::reliable(1)).unwrap();
        let frames = node.publisher::<TFMessage>("/tf", &qos::reliable(10)).unwrap();
        let mounts = node.publisher::<TFMessage>("/tf_static", &qos::latched()).unwrap();
        let (sender, reports) = channel();
        let on_report = move |array: DiagnosticArray| {
            array.status.iter().for_each(|status| {
                let _ = sender.send(format!("{}: {}", status.name, status.message));
            });
        };
        node.subscribe("/diagnostics", &qos::reliable(10), None, on_report).unwrap();
        let node = node.start().unwrap();
        let mount = RobotConfig::default().mount.base_from_camera();
        let mount = transform::to_ros(&mount, Stamp::default(), "base_link", "camera");
        mounts.publish(TFMessage { transforms: vec![mount] }).unwrap();
        let (played, clock) = (Arc::<Played>::default(), RosClock::system());
        let own = Arc::clone(&played);
        let play = move || {
            let _mounts = mounts;
            while !own.is_over.load(Ordering::Relaxed) {
                let at = clock.ros_now();
                let _ = info.publish(camera_info::to_ros(&camera(), at, "camera"));
                let _ = color.publish(image::color_to_ros(&picture(), at, "camera"));
                let _ = depth.publish(metres(at));
                if !own.has_no_odom.load(Ordering::Relaxed) {
                    let _ = odom.publish(reading(at));
                }
                if own.has_transform.load(Ordering::Relaxed) {
                    let base = transform::planar_to_ros(&Pose2::IDENTITY, at, "odom", "base_link");
                    let _ = frames.publish(TFMessage { transforms: vec![base] });
                }
                std::thread::sleep(PERIOD);
            }
        };
        Self { played, thread: Some(std::thread::spawn(play)), reports, _node: node }
    }

    /// Whether a diagnostic that holds both texts has come since the last call.
    fn has_report(&self, name: &str, cause: &str) -> bool {
        self.reports.try_iter().any(|report| report.contains(name) && report.contains(cause))
    }
}

impl Drop for PlayedRobot {
    fn drop(&mut self) {
        self.played.is_over.store(true, Ordering::Relaxed);
        self.thread.take().into_iter().for_each(|thread| thread.join().unwrap());
    }
}

fn camera() -> PinholeCamera {
    PinholeCamera::new(SIZE, (30.0, 30.0), (15.5, 11.5), Distortion::default()).unwrap()
}

fn picture() -> ColorImage {
    let pixels = (0..SIZE.0 * SIZE.1).map(|i| [(i % 251) as u8; 3]).collect();
    ColorImage::new(SIZE.0, SIZE.1, pixels).unwrap()
}

/// A raw depth image in metres, its first pixel without depth.
fn metres(at: Stamp) -> ImageMessage {
    let mut message = image::depth_to_ros(&DepthImage::filled(SIZE.0, SIZE.1, 1.0), at, "camera");
    let mut depths = vec![DEPTH_M; SIZE.0 * SIZE.1];
    depths[0] = f32::NAN;
    message.encoding = "32FC1".to_owned();
    message.step = (SIZE.0 * 4) as u32;
    message.data = Bytes(depths.iter().flat_map(|depth| depth.to_le_bytes()).collect());
    message
}

fn reading(at: Stamp) -> OdometryMessage {
    let own =
        Odometry { stamp: at, pose: Pose2::IDENTITY, twist: Twist2::ZERO, covariance: Default::default() };
    odometry::to_ros(&own, at, OdometryFrames { odom: "odom", base: "base_link" })
}

/// Trundle's side of the played robot, without a run.
struct Connected {
    events: Inbox<TimedEvent>,
    timer: LoopTimer,
    body: Option<LiveBody>,
    _node: RobotNode,
}

impl Connected {
    fn to(domain: &Domain) -> Self {
        let options = Ros2Options::read("trundle", Some(domain.0), Networks::Loopback, &[]).unwrap();
        let mut settings = BodySettings::default();
        settings.imu = None;
        (settings.color, settings.depth) = ("camera/color/image_raw".into(), "camera/depth/image_raw".into());
        let (mut robot, timeout) = (RobotConfig::default(), Duration::from_secs(20));
        let connected = Ros2Robot::connect(&options, settings, &mut robot, timeout, || false).unwrap();
        assert_eq!(robot.camera, camera());
        let (node, _link, body) = connected.into_parts();
        let events = Inbox::new(1000);
        let body = body.start(events.sender()).unwrap();
        Self { events, timer: LoopTimer::new(LoopTimerConfig::default()), body: Some(body), _node: node }
    }

    /// The first event for which `pick` has a value.
    fn wait_for<T>(&mut self, what: &str, pick: impl Fn(SensorEvent) -> Option<T>) -> T {
        let end = Instant::now() + Duration::from_secs(20);
        while Instant::now() < end {
            if let Some(Input::Event(timed)) = self.events.next(&self.timer, Duration::from_millis(100))
                && let Some(picked) = pick(timed.event.decode().unwrap())
            {
                return picked;
            }
        }
        panic!("{what} did not come within 20 s")
    }

    /// Waits until the link to the base is lost, or up again.
    fn wait_for_base(&mut self, is_up: bool) {
        let expected = BodyEventKind::Link(Link { device: Device::Base, is_up });
        self.wait_for("a change of the base's link", |event| match event {
            SensorEvent::Body(BodyEvent { kind, .. }) if kind == expected => Some(()),
            _ => None,
        });
    }
}

impl Drop for Connected {
    fn drop(&mut self) {
        self.body.take().into_iter().for_each(|body| drop(body.stop()));
    }
}

#[test]
fn raw_depth_in_metres_arrives_and_odometry_that_stops_loses_the_base_until_it_returns() {
    let domain = Domain::new();
    let played = PlayedRobot::start(&domain);
    let mut own = Connected::to(&domain);
    let image = own.wait_for("an image", |event| match event {
        SensorEvent::Rgbd(image) => Some(image),
        _ => None,
    });
    let depths = image.depth().data().to_vec();
    assert_eq!(depths[0], 0.0, "a pixel without depth");
    assert!(depths[1..].iter().all(|depth| (depth - DEPTH_M).abs() < 6e-4), "{:?}", &depths[..4]);
    assert!(!played.has_report("/odom", "no message for"));
    played.played.has_no_odom.store(true, Ordering::Relaxed);
    own.wait_for_base(false);
    wait_until("its cause", || played.has_report("trundle: /odom", "no message for"));
    played.played.has_no_odom.store(false, Ordering::Relaxed);
    own.wait_for_base(true);
}

#[test]
fn a_node_that_begins_to_publish_odom_to_base_is_named() {
    let domain = Domain::new();
    let played = PlayedRobot::start(&domain);
    let _own = Connected::to(&domain);
    wait_until("the first diagnostics", || played.has_report("trundle: robot", "has not begun"));
    played.played.has_transform.store(true, Ordering::Relaxed);
    let cause = "another node has begun to publish odom -> base_link";
    wait_until("the report", || played.has_report("trundle: /tf", cause));
}
