//! Odometry, gyro, laser and battery of a ROS 2 robot as events.

use super::{BodySettings, FrameTree};
use crate::Ros2Error;
use crate::clock::RosClock;
use crate::convert::{battery, imu, odometry, scan, stamp};
use crate::generated::builtin_interfaces::Time;
use crate::generated::nav_msgs::OdometryMessage;
use crate::generated::sensor_msgs::{BatteryState, Imu, LaserScan};
use crate::generated::std_msgs::Header;
use crate::node::{Diagnostics, RosNode, TopicMonitor, qos};
use std::collections::VecDeque;
use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use trundle_core::{BodyEvent, BodyEventKind, DifferentialDrive, Odometry, Pose2, Pose3, SensorEvent, Stamp};
use trundle_estimation::OdometryEvents;

/// Silence of the odometry after which the base counts as lost \[s\]: ten readings at 20 Hz. Source: ours.
pub const MAX_ODOM_SILENCE: Duration = Duration::from_millis(500);
/// Silence of a laser after which it counts as lost: five sweeps at 5 Hz. Source: ours.
pub const MAX_SCAN_SILENCE: Duration = Duration::from_secs(1);

/// Wait for transforms of sensors from the start on. Source: ours; two heartbeats of Fast DDS (3 s each), which repeat `/tf_static` after a
/// loss of its first copy.
pub(super) const FRAME_WAIT: Duration = Duration::from_secs(7);
/// Maximum number of stored odometry readings: 2 s at 50 Hz. Source: ours.
const ODOMETRY_HISTORY: usize = 100;

/// Receives events; replaced when a run begins.
pub type Sink = Box<dyn Fn(SensorEvent) + Send>;

/// State that the handlers of a robot's topics share.
pub struct Shared {
    /// Receives events. `None` before the run.
    pub sink: Mutex<Option<Sink>>,
    /// Frames.
    pub frames: Mutex<FrameTree>,
    /// The newest odometry as received, `odom_from_base`, in the order of arrival.
    pub odometry: Mutex<VecDeque<Odometry>>,
    /// Whether a usable gyro reading has come.
    pub has_gyro: AtomicBool,
    /// Whether the run takes the heading from the gyro: decided at its start.
    pub uses_gyro: AtomicBool,
    /// The odometry's frame.
    pub odom_frame: Mutex<Option<String>>,
    /// The time.
    pub clock: RosClock,
    /// Conditions of topics.
    pub diagnostics: Diagnostics,
    /// Time of the subscription.
    pub start: Instant,
}

impl Shared {
    /// The state before the first message.
    pub(super) fn new(clock: RosClock, diagnostics: Diagnostics) -> Self {
        Self {
            sink: Mutex::default(),
            frames: Mutex::default(),
            odometry: Mutex::default(),
            has_gyro: AtomicBool::default(),
            uses_gyro: AtomicBool::default(),
            odom_frame: Mutex::default(),
            clock,
            diagnostics,
            start: Instant::now(),
        }
    }

    /// Sends an event into the run, if one is active.
    pub fn send(&self, event: SensorEvent) {
        if let Some(sink) = &*lock(&self.sink) {
            sink(event);
        }
    }

    /// The run's stamp of a message, or a report with the topic. A message before the first of `/clock` has no time.
    pub(super) fn stamp(&self, topic: &str, time: &Time) -> Option<Stamp> {
        if !self.clock.has_begun() {
            return None;
        }
        self.accept(topic, stamp::from_ros(time).and_then(|ros| self.clock.checked_to_run(ros)))
    }

    /// The value, or a report with the topic.
    pub(super) fn accept<T>(&self, topic: &str, value: Result<T, impl Display>) -> Option<T> {
        value.map_err(|error| self.diagnostics.warn(topic, error.to_string())).ok()
    }

    /// The pose of the header's frame on the base, or a report with the topic.
    fn base_from(&self, topic: &str, base: &str, header: &Header) -> Option<Pose3> {
        let pose = lock(&self.frames).pose(base, &header.frame_id);
        if pose.is_none() && header.frame_id != base && self.start.elapsed() > FRAME_WAIT {
            let frame = &header.frame_id;
            let message = format!(
                "no transform from {base} to its frame '{frame}' on /tf_static: start robot_state_publisher or static_transform_publisher"
            );
            self.diagnostics.warn(topic, message);
        }
        pose.or_else(|| (header.frame_id == base).then(Pose3::identity))
    }
}

/// The value of a mutex, also after a panic of a thread that held it.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Monitors of the topics required by the base.
pub struct BaseMonitors {
    /// Monitor of the time, if a simulator publishes it.
    pub clock: Option<Arc<TopicMonitor>>,
    /// Odometry.
    pub odom: Arc<TopicMonitor>,
    /// Gyro.
    pub imu: Option<Arc<TopicMonitor>>,
    /// Laser.
    pub scan: Option<Arc<TopicMonitor>>,
}

/// Subscribes to odometry, gyro, laser and battery.
///
/// # Errors
/// When a topic cannot be created.
pub fn subscribe(
    node: &mut RosNode,
    settings: &BodySettings,
    drive: DifferentialDrive,
    shared: &Arc<Shared>,
) -> Result<BaseMonitors, Ros2Error> {
    let odom = subscribe_odometry(node, settings, drive, shared)?;
    let imu = settings.imu.as_deref().map(|topic| subscribe_imu(node, topic, &settings.base_frame, shared));
    let scan =
        settings.scan.as_deref().map(|topic| subscribe_scan(node, topic, &settings.base_frame, shared));
    if let Some(topic) = &settings.battery {
        subscribe_battery(node, topic, shared)?;
    }
    Ok(BaseMonitors { clock: None, odom, imu: imu.transpose()?, scan: scan.transpose()? })
}

fn subscribe_odometry(
    node: &mut RosNode,
    settings: &BodySettings,
    drive: DifferentialDrive,
    shared: &Arc<Shared>,
) -> Result<Arc<TopicMonitor>, Ros2Error> {
    let (shared, name) = (Arc::clone(shared), node.names().resolve(&settings.odom));
    let mut events = OdometryEvents::new(drive);
    let base = settings.base_frame.clone();
    let on_odometry = move |message: OdometryMessage| {
        let Some(at) = shared.stamp(&name, &message.header.stamp) else { return };
        let Some(own) = shared.accept(&name, odometry::from_ros(&message, at)) else { return };
        let Some(own) = on_base(own, &message.child_frame_id, &base, &shared) else { return };
        let frame = message.header.frame_id.trim_start_matches('/').to_owned();
        lock(&shared.odom_frame).get_or_insert(frame);
        note(&mut lock(&shared.odometry), own);
        let (event, jump) = events.add(&own, shared.uses_gyro.load(Ordering::Relaxed));
        jump.into_iter().for_each(|jump| shared.diagnostics.warn(&name, jump.to_string()));
        shared.send(event);
    };
    node.subscribe(&settings.odom, &qos::sensor(5), Some(MAX_ODOM_SILENCE), on_odometry)
}

fn note(history: &mut VecDeque<Odometry>, newest: Odometry) {
    if history.len() >= ODOMETRY_HISTORY {
        history.pop_front();
    }
    history.push_back(newest);
}

/// Odometry of another frame of the base (`base_footprint`), used as that of `base`: both have the same heading, and usually the same
/// position on the floor.
fn on_base(own: Odometry, child: &str, base: &str, shared: &Shared) -> Option<Odometry> {
    let offset = lock(&shared.frames).pose(child, base).map_or(Pose2::IDENTITY, |pose| pose.to_pose2());
    Some(Odometry { pose: own.pose * offset, ..own })
}

fn subscribe_imu(
    node: &mut RosNode,
    topic: &str,
    base: &str,
    shared: &Arc<Shared>,
) -> Result<Arc<TopicMonitor>, Ros2Error> {
    let (shared, name, base) = (Arc::clone(shared), node.names().resolve(topic), base.to_owned());
    let on_imu = move |message: Imu| {
        let Some(at) = shared.stamp(&name, &message.header.stamp) else { return };
        let Some(base_from_imu) = shared.base_from(&name, &base, &message.header) else { return };
        let rate = imu::from_ros(&message, at, &base_from_imu.rotation);
        if let Some(rate) = shared.accept(&name, rate) {
            shared.has_gyro.store(true, Ordering::Relaxed);
            if shared.uses_gyro.load(Ordering::Relaxed) {
                shared.send(SensorEvent::Gyro(rate));
            }
        }
    };
    node.subscribe(topic, &qos::sensor(10), Some(MAX_ODOM_SILENCE), on_imu)
}

fn subscribe_scan(
    node: &mut RosNode,
    topic: &str,
    base: &str,
    shared: &Arc<Shared>,
) -> Result<Arc<TopicMonitor>, Ros2Error> {
    let (shared, name, base) = (Arc::clone(shared), node.names().resolve(topic), base.to_owned());
    let on_scan = move |message: LaserScan| {
        let Some(at) = shared.stamp(&name, &message.header.stamp) else { return };
        let Some(base_from_laser) = shared.base_from(&name, &base, &message.header) else { return };
        let sweep = scan::from_ros(&message, at, &base_from_laser);
        shared.accept(&name, sweep).into_iter().for_each(|sweep| shared.send(SensorEvent::Scan(sweep)));
    };
    node.subscribe(topic, &qos::sensor(5), Some(MAX_SCAN_SILENCE), on_scan)
}

fn subscribe_battery(node: &mut RosNode, topic: &str, shared: &Arc<Shared>) -> Result<(), Ros2Error> {
    let (shared, name) = (Arc::clone(shared), node.names().resolve(topic));
    let on_battery = move |message: BatteryState| {
        let stamp = shared.clock.now();
        if let Some(battery) = shared.accept(&name, battery::from_ros(&message)) {
            shared.send(SensorEvent::Body(BodyEvent::new(stamp, BodyEventKind::Battery(battery))));
        }
    };
    node.subscribe(topic, &qos::sensor(1), None, on_battery).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::node::{Names, Networks, NodeSettings};

    /// A domain that no other test has. Source: ours, below those of `tests/it`.
    const DOMAIN: u16 = 98;

    fn node(name: &str) -> RosNode {
        RosNode::new(&NodeSettings::new(Names::of_node(name), DOMAIN, Networks::Loopback)).unwrap()
    }

    #[test]
    fn a_battery_reaches_the_run_and_a_broken_one_is_named() {
        let (mut driver, mut own) = (node("battery_driver"), node("battery_reader"));
        let publisher = driver.publisher::<BatteryState>("battery_state", &qos::reliable(1)).unwrap();
        let shared = Arc::new(Shared::new(RosClock::system(), own.diagnostics()));
        let charges = Arc::<Mutex<Vec<Option<f64>>>>::default();
        let kept = Arc::clone(&charges);
        *lock(&shared.sink) = Some(Box::new(move |event| match event {
            SensorEvent::Body(BodyEvent { kind: BodyEventKind::Battery(battery), .. }) => {
                lock(&kept).push(battery.charge);
            }
            other => panic!("{other:?}"),
        }));
        let mut settings = BodySettings::default();
        (settings.imu, settings.battery) = (None, Some("battery_state".to_owned()));
        subscribe(&mut own, &settings, DifferentialDrive::KOBUKI, &shared).unwrap();
        let (_driving, _reading) = (driver.start().unwrap(), own.start().unwrap());
        let end = Instant::now() + Duration::from_secs(20);
        while lock(&charges).is_empty() || !shared.diagnostics.summary().contains("/battery_state: voltage") {
            assert!(Instant::now() < end, "{:?}, {}", lock(&charges), shared.diagnostics.summary());
            for (voltage, percentage) in [(14.0, 0.5), (f32::NAN, 0.5)] {
                publisher.publish(BatteryState { voltage, percentage, ..BatteryState::default() }).unwrap();
                std::thread::sleep(Duration::from_millis(20));
            }
        }
        assert!(lock(&charges).iter().all(|charge| *charge == Some(0.5)), "{:?}", lock(&charges));
    }
}
