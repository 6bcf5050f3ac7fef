//! Topics of a body's own sensors: gyro, wheels and camera.

use super::ServerSettings;
use super::image_publisher::ImagePublisher;
use crate::Ros2Error;
use crate::convert::{imu, stamp};
use crate::generated::sensor_msgs::{Imu, JointState};
use crate::node::{RosNode, qos};
use crate::outputs::OutputTopic;
use trundle_core::{DifferentialDrive, PinholeCamera, SensorEvent, Stamp, WheelTicks};

/// The topics `imu`, `joint_states` and those of the camera.
pub struct SensorTopics {
    imu: OutputTopic<Imu>,
    joints: OutputTopic<JointState>,
    images: ImagePublisher,
    wheels: Wheels,
    drive: DifferentialDrive,
    base_frame: String,
}

impl SensorTopics {
    /// Adds the topics to a node.
    ///
    /// # Errors
    /// When a topic cannot be created or the system refuses a thread.
    pub fn new(
        node: &mut RosNode,
        settings: &ServerSettings,
        camera: PinholeCamera,
        drive: DifferentialDrive,
    ) -> Result<Self, Ros2Error> {
        Ok(Self {
            imu: OutputTopic::new(node, "imu", &qos::reliable(10))?,
            joints: OutputTopic::new(node, "joint_states", &qos::reliable(10))?,
            images: ImagePublisher::start(node, settings, camera)?,
            wheels: Wheels::default(),
            drive,
            base_frame: settings.frames.base.clone(),
        })
    }

    /// Publishes an event of these sensors, stamped `at` on the ROS clock. Other events are not published.
    pub fn publish(&mut self, event: &SensorEvent, at: Stamp) {
        match event {
            SensorEvent::Gyro(gyro) => self.imu.publish(imu::to_ros(gyro.omega, None, at, &self.base_frame)),
            SensorEvent::Wheels(ticks) => self.joints.publish(self.wheels.joints(ticks, &self.drive, at)),
            SensorEvent::Rgbd(image) => self.images.publish(image, at),
            _ => {}
        }
    }
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
