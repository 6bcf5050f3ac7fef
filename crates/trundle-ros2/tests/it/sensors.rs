//! Topics of the sensors.

use super::{Domain, wait_until};
use std::sync::{Arc, Mutex};
use trundle_core::{
    ColorImage, DepthImage, DifferentialDrive, Distortion, GyroRate, PinholeCamera, RgbdImage, SensorEvent,
    Stamp, WheelTicks,
};
use trundle_ros2::convert::image::compressed_depth_from_ros;
use trundle_ros2::generated::sensor_msgs::{CameraInfoMessage, CompressedImage, Imu, JointState};
use trundle_ros2::node::qos;
use trundle_ros2::outputs::FrameNames;
use trundle_ros2::server::{SensorTopics, ServerSettings};

/// The newest message of a topic.
#[derive(Clone)]
struct Newest<M>(Arc<Mutex<Option<M>>>);

impl<M: Clone + Send + 'static> Newest<M> {
    fn new() -> (Self, impl FnMut(M) + Send + 'static) {
        let own = Self(Arc::default());
        let kept = own.clone();
        (own, move |message| *kept.0.lock().unwrap() = Some(message))
    }

    fn get(&self) -> Option<M> {
        self.0.lock().unwrap().clone()
    }
}

#[test]
fn the_sensors_of_a_body_reach_reliable_readers_and_images_flow_from_the_first_reader_on() {
    let domain = Domain::new();
    let (mut sender, mut receiver) = (domain.node("sender"), domain.node("receiver"));
    let settings = ServerSettings::new(FrameNames::default(), true);
    let camera = PinholeCamera::new((4, 2), (3.0, 3.0), (1.5, 0.5), Distortion::default()).unwrap();
    let drive = DifferentialDrive::KOBUKI;
    let mut topics = SensorTopics::new(&mut sender, &settings, camera, drive).unwrap();
    let (imu, on_imu) = Newest::<Imu>::new();
    let (joints, on_joints) = Newest::<JointState>::new();
    let (info, on_info) = Newest::<CameraInfoMessage>::new();
    let (depth, on_depth) = Newest::<CompressedImage>::new();
    receiver.subscribe("imu", &qos::reliable(5), None, on_imu).unwrap();
    receiver.subscribe("joint_states", &qos::reliable(5), None, on_joints).unwrap();
    receiver.subscribe("camera/color/camera_info", &qos::reliable(5), None, on_info).unwrap();
    let depth_topic = "camera/depth/image_raw/compressedDepth";
    receiver.subscribe(depth_topic, &qos::sensor(5), None, on_depth).unwrap();
    let (_sending, _receiving) = (sender.start().unwrap(), receiver.start().unwrap());
    let stamp = Stamp::from_nanos(7);
    let (color, metres) = (ColorImage::filled(4, 2, [9; 3]), DepthImage::filled(4, 2, 1.25));
    let events = [
        SensorEvent::Gyro(GyroRate { stamp, omega: 0.5 }),
        SensorEvent::Wheels(WheelTicks { stamp, left: 1, right: 2 }),
        SensorEvent::Rgbd(RgbdImage::new(stamp, color, metres).unwrap()),
    ];
    wait_until("every topic", || {
        events.iter().for_each(|event| topics.publish(event, stamp));
        imu.get().is_some() && joints.get().is_some() && info.get().is_some() && depth.get().is_some()
    });
    assert_eq!(imu.get().unwrap().angular_velocity.z, 0.5);
    assert_eq!(joints.get().unwrap().name, ["wheel_left_joint", "wheel_right_joint"]);
    assert_eq!((info.get().unwrap().width, info.get().unwrap().height), (4, 2));
    let raw = compressed_depth_from_ros(depth.get().unwrap()).unwrap();
    assert_eq!(raw.bytes, [1.25_f32.to_le_bytes(); 8].concat());
}

#[test]
fn the_intrinsics_come_to_a_reader_that_reads_no_image() {
    let domain = Domain::new();
    let (mut sender, mut receiver) = (domain.node("sender"), domain.node("receiver"));
    let settings = ServerSettings::new(FrameNames::default(), true);
    let camera = PinholeCamera::new((4, 2), (3.0, 3.0), (1.5, 0.5), Distortion::default()).unwrap();
    let mut topics = SensorTopics::new(&mut sender, &settings, camera, DifferentialDrive::KOBUKI).unwrap();
    let (info, on_info) = Newest::<CameraInfoMessage>::new();
    receiver.subscribe("camera/depth/camera_info", &qos::reliable(5), None, on_info).unwrap();
    let (_sending, _receiving) = (sender.start().unwrap(), receiver.start().unwrap());
    let stamp = Stamp::from_nanos(7);
    let (color, metres) = (ColorImage::filled(4, 2, [9; 3]), DepthImage::filled(4, 2, 1.25));
    let event = SensorEvent::Rgbd(RgbdImage::new(stamp, color, metres).unwrap());
    wait_until("camera_info", || {
        topics.publish(&event, stamp);
        info.get().is_some()
    });
    assert_eq!(info.get().unwrap().header.stamp.nanosec, 7);
}
