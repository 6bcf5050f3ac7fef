//! The robot's state as messages, from a separate thread: the robot never waits for it.

use super::node_guard::NodeGuard;
use super::published_map::PublishedMap;
use super::publishers::RobotTopics;
use super::{OutputSettings, RunFrames, costmap};
use crate::Ros2Error;
use crate::clock::RosClock;
use crate::convert::odometry::OdometryFrames;
use crate::convert::{battery, diagnostics, grid, odometry, path, pose, scan, stamp, transform};
use crate::generated::geometry_msgs::{PoseWithCovarianceStamped, TransformStamped};
use crate::generated::nav_msgs::OccupancyGridMessage;
use crate::generated::tf2_msgs::TFMessage;
use crate::node::{Condition, Diagnostics, Level, NodeThread};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use trundle_app::operator::{Operator, RunView};
use trundle_core::{OccupancyGrid, Pose2, Pose3, Stamp};

/// Period of transforms and odometry. Source: the robot's control rate, 50 Hz.
const POSE_PERIOD: Duration = Duration::from_millis(20);
/// Period of the pose with covariance, the map's updates, and the local costs. Source: ours.
const SLOW_PERIOD: Duration = Duration::from_millis(200);
/// Period of the whole map, the costs of the whole map, diagnostics and battery. Source: ours.
const SLOWEST_PERIOD: Duration = Duration::from_secs(1);
/// Time by which the map's transform is stamped ahead \[s\]: a look-up for a newer image then succeeds. Source: ours; AMCL's
/// `transform_tolerance` is 1 s.
const TRANSFORM_TOLERANCE_S: f64 = 0.1;

/// Inputs of the outputs.
pub struct OutputSources {
    /// The run.
    pub operator: Operator,
    /// The time.
    pub clock: RosClock,
    /// Conditions of the node's topics.
    pub diagnostics: Diagnostics,
    /// The frames. The robot's own odometry is published if the body publishes none.
    pub frames: RunFrames,
    /// `base_from_camera`, for the static transforms.
    pub base_from_camera: Pose3,
    /// Receives each map that is published as a whole.
    pub published_map: PublishedMap,
    /// The node; if it crashes, the robot is stopped.
    pub node: Arc<NodeThread>,
}

/// The publishing thread. A drop ends it.
pub struct RobotOutputs {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl RobotOutputs {
    /// Starts the thread.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        topics: RobotTopics,
        settings: OutputSettings,
        sources: OutputSources,
    ) -> Result<Self, Ros2Error> {
        let is_over = Arc::<AtomicBool>::default();
        let over = Arc::clone(&is_over);
        let mut loop_state = OutputLoop::new(topics, settings, sources);
        let run = move || {
            while !over.load(Ordering::Relaxed) {
                let next = Instant::now() + POSE_PERIOD;
                loop_state.step(Instant::now());
                std::thread::sleep(next.saturating_duration_since(Instant::now()));
            }
        };
        let thread = std::thread::Builder::new().name("ros2-outputs".to_owned()).spawn(run)?;
        Ok(Self { is_over, thread: Some(thread) })
    }
}

impl Drop for RobotOutputs {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread of the ROS 2 outputs panicked");
        }
    }
}

struct OutputLoop {
    topics: RobotTopics,
    settings: OutputSettings,
    sources: OutputSources,
    slow_due: Instant,
    slowest_due: Instant,
    /// The newest map that updates refer to, and its revision.
    map: Option<(u64, OccupancyGrid)>,
    /// Number of the map that was published, [`trundle_app::operator::MapView::number`].
    map_number: Option<u64>,
    /// Revision of the map that was published as a whole.
    whole: Option<u64>,
    costs: Vec<i8>,
    plan: Option<usize>,
    scan: Option<Stamp>,
    has_static: bool,
    /// Whether the transform from the odometry's frame to the base is published here.
    owns_odom_transform: bool,
    guard: NodeGuard,
}

impl OutputLoop {
    fn new(topics: RobotTopics, settings: OutputSettings, sources: OutputSources) -> Self {
        let now = Instant::now();
        let (node, operator) = (Arc::clone(&sources.node), sources.operator.clone());
        let guard = NodeGuard::new(node, operator, sources.diagnostics.clone());
        let owns_odom_transform = !sources.frames.has_foreign_odom_transform();
        Self {
            topics,
            settings,
            sources,
            slow_due: now,
            slowest_due: now,
            map: None,
            whole: None,
            map_number: None,
            costs: Vec::new(),
            plan: None,
            scan: None,
            has_static: false,
            owns_odom_transform,
            guard,
        }
    }

    fn step(&mut self, now: Instant) {
        self.guard.check();
        let view = self.sources.operator.view();
        let (is_slow, is_slowest) = (now >= self.slow_due, now >= self.slowest_due);
        if let Some(view) = &view {
            self.publish_poses(view);
            self.publish_static(view);
            self.publish_scan(view);
            self.publish_plan(view);
            if self.is_map_replaced(view) {
                self.publish_map(view, true);
            }
            if is_slow {
                self.slow_due = now + SLOW_PERIOD;
                self.publish_map(view, is_slowest);
                self.publish_pose(view);
            }
        }
        if is_slowest {
            self.slowest_due = now + SLOWEST_PERIOD;
            self.yield_odom_transform();
            self.publish_diagnostics(view.as_deref());
            view.iter().for_each(|view| self.publish_battery(view));
        }
    }

    /// Leaves the transform from the odometry's frame to the base to another node that has begun to publish it.
    fn yield_odom_transform(&mut self) {
        let frames = &self.sources.frames;
        if !self.owns_odom_transform || !frames.has_foreign_odom_transform() {
            return;
        }
        self.owns_odom_transform = false;
        let message = format!(
            "another node has begun to publish {} -> {}, as trundle did: trundle leaves it to that node from now on",
            frames.odom(),
            frames.names.base
        );
        self.sources.diagnostics.warn("/tf", message);
    }

    /// Transforms, and odometry if the body does not publish its own.
    fn publish_poses(&self, view: &RunView) {
        let (clock, frames) = (&self.sources.clock, &self.sources.frames.names);
        let Some(odom_from_base) = self.sources.frames.odom_from_base(view) else { return };
        let at = clock.to_ros(view.estimate.stamp);
        let map_from_odom = view.estimate.pose * odom_from_base.inverse();
        let odom = &*self.sources.frames.odom();
        let held = at.after(TRANSFORM_TOLERANCE_S);
        let mut transforms: Vec<TransformStamped> =
            vec![transform::planar_to_ros(&map_from_odom, held, &frames.map, odom)];
        if self.owns_odom_transform {
            transforms.push(transform::planar_to_ros(&odom_from_base, at, odom, &frames.base));
        }
        if let (Some(topic), Some(own)) = (&self.topics.odom, &view.odometry) {
            topic.publish(odometry::to_ros(own, at, OdometryFrames { odom, base: &frames.base }));
        }
        self.topics.tf.publish(TFMessage { transforms });
    }

    /// Base to camera and scan, once: late subscribers receive them too.
    fn publish_static(&mut self, view: &RunView) {
        if self.has_static {
            return;
        }
        let frames = &self.sources.frames.names;
        let at = self.sources.clock.to_ros(view.stamp);
        let mut transforms = Vec::new();
        if self.settings.has_own_body {
            transforms.push(transform::to_ros(
                &self.sources.base_from_camera,
                at,
                &frames.base,
                &frames.camera,
            ));
        }
        if self.topics.scan.is_some() {
            let Some(scan) = &view.scan else { return };
            let base_from_scan = Pose2::new(scan.origin().x, scan.origin().y, 0.0);
            transforms.push(transform::planar_to_ros(&base_from_scan, at, &frames.base, &frames.scan));
        }
        self.has_static = true;
        if !transforms.is_empty() {
            self.topics.tf_static.publish(TFMessage { transforms });
        }
    }

    fn publish_scan(&mut self, view: &RunView) {
        let (Some(topic), Some(scan)) = (&self.topics.scan, &view.scan) else { return };
        if self.scan.replace(scan.stamp()) == Some(scan.stamp()) {
            return;
        }
        let at = self.sources.clock.to_ros(scan.stamp());
        topic.publish(scan::to_ros(scan, at, &self.sources.frames.names.scan, self.settings.scan_range_m));
    }

    fn publish_plan(&mut self, view: &RunView) {
        // A plan that is the same is the same allocation.
        let identity = view.plan.as_ref().map(|plan| Arc::as_ptr(plan) as usize);
        if self.plan == identity {
            return;
        }
        self.plan = identity;
        let points = view.plan.iter().flat_map(|plan| plan.trajectory.points());
        let poses: Vec<Pose2> = points.map(|point| point.pose).collect();
        let at = self.sources.clock.to_ros(view.stamp);
        self.topics.plan.publish(path::to_ros(&poses, at, &self.sources.frames.names.map));
    }

    /// Whether another map replaced the published one: the new map is published as a whole, without updates.
    fn is_map_replaced(&mut self, view: &RunView) -> bool {
        let Some(map) = &view.map else { return false };
        let published = self.map_number.replace(map.number);
        let is_replaced = published.is_some_and(|published| published != map.number);
        if is_replaced {
            self.map = None;
        }
        is_replaced
    }

    /// The whole map if it changed and a second has passed, else the changes.
    fn publish_map(&mut self, view: &RunView, is_slowest: bool) {
        let Some(map) = &view.map else { return };
        let frame = &self.sources.frames.names.map;
        let at = self.sources.clock.to_ros(view.stamp);
        let has_changed = self.map.as_ref().is_none_or(|(revision, _)| *revision != map.revision);
        let is_same_place = self.map.as_ref().is_some_and(|(_, old)| old.geometry() == map.grid.geometry());
        if has_changed && let (true, Some((_, old))) = (is_same_place, &self.map) {
            grid::update(old, &map.grid, at, frame)
                .into_iter()
                .for_each(|update| self.topics.map_updates.publish(update));
        }
        if (is_slowest || !is_same_place) && self.whole != Some(map.revision) {
            self.whole = Some(map.revision);
            self.sources.published_map.set(Arc::clone(map), at);
            self.topics.map.publish(grid::to_ros(&map.grid, at, frame));
            self.costs = costmap::costs(&map.grid, self.settings.body_radius_m);
            let info = grid::info(map.grid.geometry(), at);
            let whole =
                OccupancyGridMessage { header: stamp::header(at, frame), info, data: self.costs.clone() };
            self.topics.global_costmap.publish(whole);
        }
        if has_changed {
            self.map = Some((map.revision, map.grid.clone()));
        }
        if self.costs.len() == map.grid.cells().len()
            && let Some((place, data)) = costmap::local(map.grid.geometry(), &self.costs, &view.estimate.pose)
        {
            let info = grid::info(&place, at);
            self.topics.local_costmap.publish(OccupancyGridMessage {
                header: stamp::header(at, frame),
                info,
                data,
            });
        }
    }

    fn publish_pose(&self, view: &RunView) {
        let at = self.sources.clock.to_ros(view.estimate.stamp);
        let pose = pose::with_covariance(&view.estimate.pose, &view.estimate.covariance);
        let header = stamp::header(at, &self.sources.frames.names.map);
        self.topics.amcl_pose.publish(PoseWithCovarianceStamped { header, pose });
    }

    fn publish_battery(&self, view: &RunView) {
        if let (Some(topic), Some(own)) = (&self.topics.battery, &view.battery) {
            let at = self.sources.clock.to_ros(view.stamp);
            topic.publish(battery::to_ros(own, at, &self.sources.frames.names.base));
        }
    }

    fn publish_diagnostics(&self, view: Option<&RunView>) {
        let mut conditions = self.sources.diagnostics.conditions();
        conditions.push(("robot".to_owned(), condition_of(view)));
        let at = self.sources.clock.ros_now();
        self.topics.diagnostics.publish(diagnostics::to_ros(&conditions, &self.settings.node, at));
    }
}

/// The robot's state as a condition.
fn condition_of(view: Option<&RunView>) -> Condition {
    let Some(view) = view else {
        return Condition { level: Level::Warning, message: "the robot has not begun".to_owned(), count: 1 };
    };
    let level = if view.hold.is_some() {
        Level::Error
    } else if view.state.reason().is_some() {
        Level::Warning
    } else {
        Level::Ok
    };
    let message = view.hold.map_or_else(|| view.state.to_string(), |hold| hold.to_string());
    Condition { level, message, count: 1 }
}
