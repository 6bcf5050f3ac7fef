//! Watches the links of a running ROS 2 robot: base, laser, camera, the order of events, and the node itself.

use super::base_sensors::{BaseMonitors, Shared};
use crate::Ros2Error;
use crate::node::{Level, NodeThread, TopicMonitor};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use trundle_app::real_time::EventFeed;
use trundle_core::{BodyEvent, BodyEventKind, Device, Link, SensorEvent};
use trundle_drivers::camera::camera_thread::CameraThread;

/// Period of checks of the links. Source: ours.
const LINK_PERIOD: Duration = Duration::from_millis(50);
/// Name of the order of events among the diagnostics.
const ORDER_NAME: &str = "order of events";

/// Reports the loss and the return of base and laser, faults of the camera, and a crash of the node.
pub(super) struct LinkWatch {
    is_over: Arc<AtomicBool>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl LinkWatch {
    /// Starts the thread.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        shared: Arc<Shared>,
        monitors: BaseMonitors,
        mut camera: WatchedCamera,
        mut order: WatchedOrder,
        node: Arc<NodeThread>,
    ) -> Result<Self, Ros2Error> {
        let is_over = Arc::<AtomicBool>::default();
        let over = Arc::clone(&is_over);
        let base = monitors.clock.into_iter().chain([monitors.odom]).collect();
        let mut links = vec![WatchedLink::new(Device::Base, base)];
        links.extend(monitors.scan.map(|monitor| WatchedLink::new(Device::Laser, vec![monitor])));
        let watch = move || {
            while !over.load(Ordering::Relaxed) {
                links.iter_mut().for_each(|link| link.check(&shared, &node));
                camera.check(&shared);
                order.check(&shared);
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

/// A device and its required topics.
struct WatchedLink {
    device: Device,
    monitors: Vec<Arc<TopicMonitor>>,
    is_up: bool,
}

impl WatchedLink {
    fn new(device: Device, monitors: Vec<Arc<TopicMonitor>>) -> Self {
        Self { device, monitors, is_up: true }
    }

    fn check(&mut self, shared: &Shared, node: &NodeThread) {
        let death = node.death();
        let mut is_up = true;
        for monitor in &self.monitors {
            if let Some(problem) = death.clone().or_else(|| monitor.stall()) {
                is_up = false;
                shared.diagnostics.report(&monitor.name, Level::Error, problem);
            }
        }
        if is_up != self.is_up {
            self.is_up = is_up;
            let kind = BodyEventKind::Link(Link { device: self.device, is_up });
            shared.send(SensorEvent::Body(BodyEvent::new(shared.clock.now(), kind)));
        }
    }
}

/// A camera whose faults are reported under the name of its topic.
pub(super) struct WatchedCamera {
    camera: Arc<CameraThread>,
    topic: String,
    /// Frames that were broken or stuck, and losses, so far.
    faults: u64,
    last_fault: Option<String>,
}

impl WatchedCamera {
    /// Watches `camera`, whose colour images come on `topic`.
    pub fn new(camera: Arc<CameraThread>, topic: String) -> Self {
        Self { camera, topic, faults: 0, last_fault: None }
    }

    /// Reports the last fault while the camera is lost, and once for each new one.
    fn check(&mut self, shared: &Shared) {
        let counters = self.camera.counters();
        let faults = counters.broken + counters.stuck + counters.lost;
        let (is_up, fault) = (self.camera.is_up(), self.camera.last_fault());
        let is_new = faults != self.faults || fault != self.last_fault;
        if let (true, Some(fault)) = (is_new || !is_up, &fault) {
            let level = if is_up { Level::Warning } else { Level::Error };
            shared.diagnostics.report(&self.topic, level, fault.clone());
        }
        (self.faults, self.last_fault) = (faults, fault);
    }
}

/// The order of the events of a run, whose late ones are reported.
pub(super) struct WatchedOrder {
    feed: EventFeed,
    late: u64,
}

impl WatchedOrder {
    /// Watches the events of `feed`.
    pub fn new(feed: EventFeed) -> Self {
        Self { feed, late: 0 }
    }

    /// Reports events that came too late since the last check.
    fn check(&mut self, shared: &Shared) {
        let late = self.feed.order_counts().late;
        if late > self.late {
            let message = format!(
                "{late} events so far came over 0.1 s late and behind newer ones, expected less: they are dropped; \
                 check the network, and the clocks of the robot's computers"
            );
            shared.diagnostics.warn(ORDER_NAME, message);
        }
        self.late = late;
    }
}
