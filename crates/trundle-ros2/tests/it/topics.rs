//! Messages between two participants.

use super::{Domain, wait_until};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use trundle_core::{OccupancyGrid, Stamp, Twist2};
use trundle_ros2::convert::{grid, twist};
use trundle_ros2::generated::geometry_msgs::TwistStamped;
use trundle_ros2::generated::nav_msgs::OccupancyGridMessage;
use trundle_ros2::generated::sensor_msgs::ImageMessage;
use trundle_ros2::generated::std_msgs::Bool;
use trundle_ros2::node::qos;
use trundle_ros2::wire::Bytes;

fn kept<M: Clone + Send + 'static>() -> (Arc<Mutex<Vec<M>>>, impl FnMut(M) + Send + 'static) {
    let kept = Arc::<Mutex<Vec<M>>>::default();
    let own = Arc::clone(&kept);
    (kept, move |message| own.lock().unwrap().push(message))
}

#[test]
fn commands_and_images_arrive_as_they_were_sent() {
    let domain = Domain::new();
    let (mut sender, mut receiver) = (domain.node("sender"), domain.node("receiver"));
    let commands = sender.publisher::<TwistStamped>("cmd_vel", &qos::reliable(10)).unwrap();
    let images = sender.publisher::<ImageMessage>("image", &qos::sensor(2)).unwrap();
    let (got_commands, on_command) = kept::<TwistStamped>();
    let (got_images, on_image) = kept::<ImageMessage>();
    receiver.subscribe("cmd_vel", &qos::reliable(10), None, on_command).unwrap();
    receiver.subscribe("/image", &qos::sensor(2), None, on_image).unwrap();
    let (_sending, _receiving) = (sender.start().unwrap(), receiver.start().unwrap());
    let command = twist::stamped(Twist2::new(0.25, -0.5), Stamp::from_nanos(1_234_567_890), "base_link");
    let data = Bytes((0..640 * 480 * 3).map(|i: u32| (i % 251) as u8).collect());
    let image = ImageMessage {
        height: 480,
        width: 640,
        step: 1920,
        encoding: "rgb8".into(),
        data,
        ..ImageMessage::default()
    };
    wait_until("a command and an image", || {
        commands.publish(command.clone()).unwrap();
        images.publish(image.clone()).unwrap();
        !got_commands.lock().unwrap().is_empty() && !got_images.lock().unwrap().is_empty()
    });
    assert_eq!(got_commands.lock().unwrap()[0], command);
    assert_eq!(got_images.lock().unwrap()[0], image);
}

#[test]
fn a_late_subscriber_receives_the_map_cell_for_cell() {
    let domain = Domain::new();
    let mut sender = domain.node("sender");
    let map = sender.publisher::<OccupancyGridMessage>("map", &qos::latched()).unwrap();
    let _sending = sender.start().unwrap();
    let own = OccupancyGrid::from_ascii(0.05, "#..\n#??\n###").unwrap();
    map.publish(grid::to_ros(&own, Stamp::default(), "map")).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    let mut receiver = domain.node("receiver");
    let (maps, on_map) = kept::<OccupancyGridMessage>();
    receiver.subscribe("map", &qos::latched(), None, on_map).unwrap();
    let _receiving = receiver.start().unwrap();
    wait_until("the map", || !maps.lock().unwrap().is_empty());
    assert_eq!(grid::from_ros(&maps.lock().unwrap()[0]).unwrap().cells(), own.cells());
}

#[test]
fn another_type_under_the_same_name_and_a_stalled_topic_are_named() {
    let domain = Domain::new();
    let (mut sender, mut receiver) = (domain.node("sender"), domain.node("receiver"));
    let _wrong = sender.publisher::<Bool>("odom", &qos::reliable(1)).unwrap();
    let flags = sender.publisher::<Bool>("flag", &qos::reliable(1)).unwrap();
    let (_, on_odom) = kept::<TwistStamped>();
    let (got, on_flag) = kept::<Bool>();
    receiver.subscribe("odom", &qos::reliable(1), None, on_odom).unwrap();
    receiver.subscribe("flag", &qos::reliable(1), Some(Duration::from_millis(200)), on_flag).unwrap();
    let diagnostics = receiver.diagnostics();
    let (_sending, _receiving) = (sender.start().unwrap(), receiver.start().unwrap());
    wait_until("a flag", || {
        flags.publish(Bool { data: true }).unwrap();
        !got.lock().unwrap().is_empty()
    });
    wait_until("both reports", || {
        let summary = diagnostics.summary();
        summary.contains("/odom: somebody publishes std_msgs::msg::dds_::Bool_")
            && summary.contains("/flag: no message for")
    });
}
