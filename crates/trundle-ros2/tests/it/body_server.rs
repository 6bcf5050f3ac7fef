//! A body that is offered as a ROS 2 robot.

use super::Domain;
use std::convert::Infallible;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use trundle_core::{
    Beam, DifferentialDrive, Distortion, PinholeCamera, Pose3, RobotBody, Scan, SensorEvent, Stamp, Twist2,
    Vector2, WheelTicks,
};
use trundle_ros2::convert::twist;
use trundle_ros2::generated::geometry_msgs::TwistStamped;
use trundle_ros2::generated::sensor_msgs::LaserScan;
use trundle_ros2::node::qos;
use trundle_ros2::outputs::FrameNames;
use trundle_ros2::server::{BodyServer, OfferedBody, ServerSettings};

/// Period of commands \[ns\]: 20 per second, as of Nav2. Source: ours.
const SEND_PERIOD_NS: i64 = 50_000_000;

/// A standing body with wheels and a laser, which keeps its commands.
#[derive(Default)]
struct PlayedBody {
    events: i64,
    commands: Arc<Mutex<Vec<Twist2>>>,
}

impl RobotBody for PlayedBody {
    type Error = Infallible;

    fn next_event(&mut self) -> Result<Option<SensorEvent>, Infallible> {
        self.events += 1;
        let stamp = Stamp::from_nanos(self.events * 10_000_000);
        let beams = vec![Beam::Hit { range: 1.0 }; 5];
        Ok(Some(if self.events % 2 == 0 {
            SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 })
        } else {
            SensorEvent::Scan(Scan::new(stamp, Vector2::zeros(), -0.5, 0.25, beams).unwrap())
        }))
    }

    fn command(&mut self, twist: Twist2) -> Result<(), Infallible> {
        self.commands.lock().unwrap().push(twist);
        Ok(())
    }
}

#[test]
fn a_command_that_is_not_a_number_is_named_and_stops_the_base_and_reliable_readers_get_the_scan() {
    let domain = Domain::new();
    let (mut person, mut own) = (domain.node("person"), domain.node("robot"));
    let commands = person.publisher::<TwistStamped>("cmd_vel", &qos::reliable(1)).unwrap();
    let scans = Arc::<Mutex<usize>>::default();
    let counted = Arc::clone(&scans);
    let on_scan = move |_: LaserScan| *counted.lock().unwrap() += 1;
    person.subscribe("scan", &qos::reliable(5), None, on_scan).unwrap();
    let camera = PinholeCamera::new((4, 2), (3.0, 3.0), (1.5, 0.5), Distortion::default()).unwrap();
    let drive = DifferentialDrive::KOBUKI;
    let offered = OfferedBody { camera, base_from_camera: Pose3::identity(), drive };
    let settings = ServerSettings::new(FrameNames::default(), true);
    let mut server = BodyServer::new(&mut own, settings, offered).unwrap();
    let diagnostics = own.diagnostics();
    let (_person, _own) = (person.start().unwrap(), own.start().unwrap());
    let mut body = PlayedBody::default();
    let done = Arc::clone(&body.commands);
    let (end, mut has_driven, mut named) = (Instant::now() + Duration::from_secs(20), false, None);
    server
        .run(&mut body, |at| {
            let newest = done.lock().unwrap().last().copied();
            has_driven |= newest == Some(Twist2::new(0.2, 0.0));
            if at.nanos % SEND_PERIOD_NS == 0 {
                let v = if has_driven { f64::NAN } else { 0.2 };
                let message = twist::stamped(Twist2::new(v, 0.0), Stamp::default(), "base_link");
                commands.publish(message).unwrap();
            }
            if diagnostics.summary().contains("/cmd_vel: linear.x is NaN m/s") {
                named.get_or_insert(at);
            }
            let stop = named.filter(|_| newest == Some(Twist2::ZERO)).map(|since| at - since);
            // A command that was only ignored would let the base drive on for 0.5 s.
            assert!(stop.is_none_or(|wait| wait < 0.3), "stopped {stop:?} s after the report");
            (stop.is_some() && *scans.lock().unwrap() > 0) || Instant::now() > end
        })
        .unwrap();
    let counts = (has_driven, *scans.lock().unwrap(), diagnostics.summary());
    assert!(Instant::now() < end, "driven, scans, reports: {counts:?}");
}
