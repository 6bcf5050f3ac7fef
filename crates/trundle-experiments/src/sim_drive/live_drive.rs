//! A drive displayed to viewers in real time. The viewers steer if no other driver is given.

use super::driver::SimDriver;
use super::teleop::Teleop;
use crate::pose_history::pose_at;
use std::sync::Arc;
use trundle_app::AppError;
use trundle_app::operator::{Activity, DepthViewpoint, MapView, OperatorLink, PerceptionView, RunView};
use trundle_app::real_time::RealTimePacer;
use trundle_core::{OccupancyGrid, Pose2, Pose3, RgbdImage, Scan, Stamp, Twist2};
use trundle_sim::Simulator;

/// Number of poses that are kept for late images: 5 s at 50 Hz. Source: ours; images of the simulator are at most 1 s late.
const KEPT_POSES: usize = 250;

/// Displays a drive; follows the requests of viewers if no other driver is given.
pub struct LiveDrive<'d> {
    driver: Option<Box<dyn SimDriver + 'd>>,
    teleop: Teleop,
    link: OperatorLink,
    pacer: RealTimePacer,
    map: Arc<MapView>,
    scan: Option<(Pose2, Arc<Scan>)>,
    /// The last true poses, at least [`KEPT_POSES`].
    poses: Vec<(Stamp, Pose2)>,
    /// Viewpoint of the shown depth image.
    viewpoint: Option<DepthViewpoint>,
    contacts: u32,
}

impl<'d> LiveDrive<'d> {
    /// Displays the drive of `driver` on `map`; without a driver the viewers drive. All poses are in the world frame.
    #[must_use]
    pub fn start(driver: Option<Box<dyn SimDriver + 'd>>, link: OperatorLink, map: OccupancyGrid) -> Self {
        let map = Arc::new(MapView { number: 0, revision: 1, grid: map });
        let (teleop, pacer) = (Teleop::default(), RealTimePacer::start());
        let (poses, viewpoint) = (Vec::with_capacity(2 * KEPT_POSES), None);
        Self { driver, teleop, link, pacer, map, scan: None, poses, viewpoint, contacts: 0 }
    }

    fn note_pose(&mut self, stamp: Stamp, pose: Pose2) {
        if self.poses.len() == self.poses.capacity() {
            self.poses.drain(..KEPT_POSES);
        }
        self.poses.push((stamp, pose));
    }

    fn activity(&self, twist: Twist2) -> Activity {
        let name = match (&self.driver, twist == Twist2::ZERO) {
            (_, true) => "standing",
            (None, false) => "driven by hand",
            (Some(_), false) => "driving",
        };
        let waypoints = self.driver.as_ref().and_then(|driver| driver.waypoints());
        let reached = waypoints.map(|(reached, all)| format!("{reached} of {all} way-points reached"));
        let touched = (self.contacts > 0).then(|| format!("contacts so far: {}", self.contacts));
        let texts: Vec<String> = reached.into_iter().chain(touched).collect();
        Activity { name, reason: (!texts.is_empty()).then(|| texts.join(", ")) }
    }

    fn publish(&mut self, stamp: Stamp, pose: Pose2, twist: Twist2) {
        let of_activity = RunView::of_activity(stamp, pose, twist, self.activity(twist));
        let perception = PerceptionView { depth_viewpoint: self.viewpoint, ..of_activity.perception };
        let view = RunView {
            twist,
            map: Some(Arc::clone(&self.map)),
            scan_pose: self.scan.as_ref().map(|(pose, _)| *pose),
            scan: self.scan.as_ref().map(|(_, scan)| Arc::clone(scan)),
            perception,
            ..of_activity
        };
        self.link.publish_view(view);
    }
}

impl SimDriver for LiveDrive<'_> {
    /// The twist of the driver or of the viewers; waits until real time reaches `stamp`.
    fn twist(&mut self, stamp: Stamp, pose: Pose2) -> Result<Twist2, AppError> {
        self.pacer.wait_for(stamp.as_secs());
        self.note_pose(stamp, pose);
        while let Some(request) = self.link.next_request() {
            self.teleop.execute(&request.command, stamp);
        }
        let twist = match &mut self.driver {
            Some(driver) => driver.twist(stamp, pose)?,
            None => self.teleop.twist(stamp),
        };
        self.publish(stamp, pose, twist);
        Ok(twist)
    }

    fn end_s(&self) -> Option<f64> {
        self.driver.as_ref()?.end_s()
    }

    fn waypoints(&self) -> Option<(usize, usize)> {
        self.driver.as_ref()?.waypoints()
    }

    fn show(&mut self, image: &RgbdImage, robot: &Simulator) {
        self.contacts = robot.contacts();
        if self.link.note_rgbd(image) {
            let map_from_base = pose_at(&self.poses, image.stamp()).map(Pose3::from_pose2);
            let map_from_camera = map_from_base.map(|base| base * robot.config().base_from_camera);
            self.viewpoint = Some(DepthViewpoint { camera: *robot.camera(), map_from_camera });
        }
    }

    fn show_scan(&mut self, scan: &Scan, robot: &Simulator) {
        if self.link.is_watched() {
            // A sweep has the stamp of its end. The robot receives the distorted sweep of a turning base.
            self.scan = Some((robot.true_pose(), Arc::new(scan.clone())));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::drive::drive_simulator;
    use super::super::driver::StillDriver;
    use super::*;
    use trundle_app::operator::operator_link;
    use trundle_runtime::OperatorCommand;
    use trundle_sim::{LaserConfig, Scene, SimConfig};

    fn drive(driver: Option<Box<dyn SimDriver>>) -> (f64, Arc<RunView>) {
        let mut config = SimConfig::default();
        config.laser = Some(LaserConfig::default());
        let mut robot = Simulator::new(Scene::by_name("room", 1).unwrap(), config, 1).unwrap();
        let (operator, link) = operator_link();
        operator.send(OperatorCommand::Drive(Twist2::new(0.3, 0.0))).unwrap();
        let map = OccupancyGrid::from_ascii(0.5, "##").unwrap();
        let mut live = LiveDrive::start(driver, link, map);
        let drive = drive_simulator(&mut robot, &mut live, Some(1.0), None, &()).unwrap();
        (drive.distance, operator.peek().unwrap())
    }

    #[test]
    fn those_who_watch_drive_and_their_silence_stops_the_robot() {
        let (distance, view) = drive(None);
        assert!((0.03..0.1).contains(&distance), "0.3 m/s for 0.3 s: {distance} m");
        assert_eq!((view.twist, view.state.name()), (Twist2::ZERO, "standing"));
        let seen = &view.perception;
        assert!(view.map.is_some() && view.scan.is_some() && seen.image.is_some() && seen.depth.is_some());
        let camera = seen.depth_viewpoint.unwrap().map_from_camera.unwrap();
        assert!((camera.translation.z - 0.45).abs() < 1e-9, "height of the mount: {camera:?}");
        assert!(
            (camera.translation.x - view.estimate.pose.x - 0.05).abs() < 0.05,
            "{camera:?} of a base at {:?}",
            view.estimate.pose
        );
    }

    #[test]
    fn a_driver_is_shown_and_not_disturbed() {
        let (distance, view) = drive(Some(Box::new(StillDriver::new(Some(0.5)))));
        assert!(distance < 1e-3 && view.stamp.as_secs() < 0.5, "{distance} m, {:?}", view.stamp);
    }
}
