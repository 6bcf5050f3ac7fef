//! Messages of a run for other programs: transforms, odometry, map, scan, plan, goal and state as messages of ROS 2.

use crate::{RunRecorder, RunSetup};
use trundle_core::{FrameId, OccupancyGrid, Pose2, Pose3, Stamp};
use trundle_io::ros_message::RosMessage;
use trundle_io::{PoseInFrame, PosesInFrame, ros_message};
use trundle_runtime::{DriveState, Robot, StepReport};

/// Time between two maps of a recording \[s\]. Source: ours.
const MAP_PERIOD_S: f64 = 2.0;
/// Time between two scans of a recording \[s\]: slightly less than the map's period. Source: ours.
const SCAN_PERIOD_S: f64 = 0.19;
/// The frame of the scans, at their origin.
const SCAN_FRAME: &str = "scan";

/// Records the outputs of a run in messages of ROS 2, each when it changes.
#[derive(Default)]
pub(crate) struct RunMessages {
    has_mount: bool,
    map: Option<(Stamp, OccupancyGrid)>,
    scan: Option<Stamp>,
    goal: Option<Pose2>,
    state: Option<String>,
}

impl RunMessages {
    /// Records the changes of the step at `stamp`.
    pub(crate) fn record(
        &mut self,
        stamp: Stamp,
        report: &StepReport,
        robot: &Robot,
        setup: &RunSetup,
        to: &mut RunRecorder,
    ) {
        if !self.has_mount {
            self.has_mount = true;
            let (base, camera) = (FrameId::Base.to_string(), FrameId::Camera.to_string());
            let mount = setup.robot.mount.base_from_camera();
            write(to, "/tf_static", stamp, move || {
                ros_message::transforms(&[(stamp, &base, &camera, mount)])
            });
        }
        record_motion(stamp, report, robot, to);
        self.record_scan(robot, to);
        self.record_map(stamp, robot, to);
        self.record_goal(stamp, robot, to);
        if let (true, Some(plan)) = (report.replanned, robot.plan()) {
            let poses: Vec<Pose2> = plan.trajectory.points().iter().map(|point| point.pose).collect();
            let (map, exact) = (FrameId::Map.to_string(), poses.clone());
            to.write(move |file| {
                let exact = PosesInFrame::planar(stamp, &map, exact);
                file.record_json("/trajectory", PosesInFrame::SCHEMA, stamp, &exact)
            });
            write(to, "/plan", stamp, move || ros_message::path(stamp, &FrameId::Map.to_string(), &poses));
        }
        self.record_state(stamp, &report.state, to);
    }

    fn record_scan(&mut self, robot: &Robot, to: &mut RunRecorder) {
        let Some(scan) = robot.scan() else { return };
        if self.scan.is_none_or(|last| scan.stamp() - last >= SCAN_PERIOD_S) {
            self.scan = Some(scan.stamp());
            let scan = scan.clone();
            to.write(move |file| file.record_scan("/scan", SCAN_FRAME, &scan));
        }
    }

    fn record_map(&mut self, stamp: Stamp, robot: &Robot, to: &mut RunRecorder) {
        let grid = robot.grid();
        let is_due = match &self.map {
            Some((last, before)) => stamp - *last >= MAP_PERIOD_S && before != grid,
            None => true,
        };
        if is_due {
            self.map = Some((stamp, grid.clone()));
            let grid = grid.clone();
            write(to, "/map", stamp, move || ros_message::map(stamp, &FrameId::Map.to_string(), &grid));
        }
    }

    fn record_goal(&mut self, stamp: Stamp, robot: &Robot, to: &mut RunRecorder) {
        let goal = robot.task().and_then(|task| RunSetup::goal_of(&task));
        if let Some(goal) = goal.filter(|goal| self.goal != Some(*goal)) {
            self.goal = Some(goal);
            let pose = Pose3::from_pose2(goal);
            write(to, "/goal_pose", stamp, move || ros_message::pose(stamp, &FrameId::Map.to_string(), pose));
        }
    }

    fn record_state(&mut self, stamp: Stamp, state: &DriveState, to: &mut RunRecorder) {
        let text = state.to_string();
        if self.state.as_ref() == Some(&text) {
            return;
        }
        self.state = Some(text.clone());
        let (name, reason) = (state.name().to_owned(), state.reason().map(ToString::to_string));
        let is_warning = matches!(state, DriveState::Lost { .. } | DriveState::Stopped { .. });
        write(to, "/diagnostics", stamp, move || {
            let values = [("state", name), ("reason", reason.unwrap_or_default())];
            ros_message::diagnostics(stamp, "trundle: state", is_warning, &text, &values)
        });
    }
}

/// Records command, odometry, the pose of the odometry's frame in the map, and the estimate at images.
fn record_motion(stamp: Stamp, report: &StepReport, robot: &Robot, to: &mut RunRecorder) {
    let (map, odom, base) = (FrameId::Map.to_string(), FrameId::Odom.to_string(), FrameId::Base.to_string());
    if let (Some(estimate), Some(_)) = (report.estimate, &report.track) {
        let exact = PoseInFrame::planar(stamp, &map, estimate.pose);
        to.write(move |file| file.record_json("/pose", PoseInFrame::SCHEMA, stamp, &exact));
        let (map, pose) = (map.clone(), Pose3::from_pose2(estimate.pose));
        write(to, "/pose", stamp, move || ros_message::pose(stamp, &map, pose));
    }
    let Some(twist) = report.twist else { return };
    to.write(move |file| file.record_json("/twist", "trundle.Twist", stamp, &twist));
    if let Some(odometry) = robot.odometry() {
        let map_from_odom = robot.estimate().pose * odometry.pose.inverse();
        let [map_from_odom, odom_from_base] = [map_from_odom, odometry.pose].map(Pose3::from_pose2);
        let (odom_again, base_again) = (odom.clone(), base.clone());
        write(to, "/odom", stamp, move || ros_message::odometry(&odom_again, &base_again, &odometry));
        let base = base.clone();
        write(to, "/tf", stamp, move || {
            let transforms =
                [(stamp, map.as_str(), odom.as_str(), map_from_odom), (stamp, &odom, &base, odom_from_base)];
            ros_message::transforms(&transforms)
        });
    }
    write(to, "/cmd_vel", stamp, move || ros_message::twist(stamp, &base, twist));
}

/// Records a message, which the recorder's thread makes.
fn write(
    to: &mut RunRecorder,
    topic: &'static str,
    stamp: Stamp,
    message: impl FnOnce() -> RosMessage + Send + 'static,
) {
    to.write(move |file| file.record_message(topic, stamp, &message()));
}
