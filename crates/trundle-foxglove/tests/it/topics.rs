//! What a viewer receives.

use crate::shown_run::{ShownRun, served};
use crate::viewer::Viewer;
use foxglove::Decode;
use foxglove::messages::{FrameTransforms, Grid, LaserScan, Log, Odometry};
use serde_json::{Value, json};
use std::time::{Duration, Instant};
use trundle_app::operator::{Activity, MapView, RunView};
use trundle_core::{Beam, OccupancyGrid, Pose2, Scan, Stamp, Twist2, Vector2};

/// Number of the channel of a topic.
pub fn channel(advertise: &Value, topic: &str) -> u64 {
    let channels = advertise["channels"].as_array().unwrap();
    let found = channels.iter().find(|channel| channel["topic"] == topic);
    found.unwrap_or_else(|| panic!("{topic}: {advertise}"))["id"].as_u64().unwrap()
}

#[test]
fn a_viewer_is_offered_the_topics_with_foxgloves_schemas() {
    let run = ShownRun::start();
    let mut viewer = Viewer::enter(run.server.address());
    let info = viewer.wait_for("serverInfo");
    assert_eq!((&info["name"], &info["capabilities"]), (&json!("run: nowhere"), &json!([])));
    let advertise = viewer.wait_for("advertise");
    for (topic, schema, encoding) in [
        ("/tf", "foxglove.FrameTransforms", "protobuf"),
        ("/map", "foxglove.Grid", "protobuf"),
        ("/scan", "foxglove.LaserScan", "protobuf"),
        ("/camera", "foxglove.CompressedImage", "protobuf"),
        ("/plan", "foxglove.PosesInFrame", "protobuf"),
        ("/goal", "foxglove.PosesInFrame", "protobuf"),
        ("/pose", "foxglove.Odometry", "protobuf"),
        ("/state", "foxglove.Log", "protobuf"),
        ("/telemetry", "trundle.Telemetry", "json"),
    ] {
        let id = channel(&advertise, topic);
        let offered = advertise["channels"].as_array().unwrap();
        let offered = offered.iter().find(|channel| channel["id"] == id).unwrap();
        assert_eq!((&offered["schemaName"], &offered["encoding"]), (&json!(schema), &json!(encoding)));
    }
}

#[test]
fn a_subscribed_pose_arrives_with_the_stamps_of_the_run() {
    let run = ShownRun::start();
    let mut viewer = Viewer::enter(run.server.address());
    let advertise = viewer.wait_for("advertise");
    for (id, topic) in [(1, "/tf"), (2, "/pose"), (3, "/state"), (4, "/telemetry")] {
        viewer.subscribe(id, channel(&advertise, topic));
    }
    let (first, next) = (viewer.wait_for_data(1), viewer.wait_for_data(1));
    assert!(first.nanos > 0 && next.nanos > first.nanos && next.nanos < 60_000_000_000, "{first:?}");
    let frames = FrameTransforms::decode(&next.content[..]).unwrap().transforms;
    let names: Vec<_> =
        frames.iter().map(|frame| (frame.parent_frame_id.as_str(), frame.child_frame_id.as_str())).collect();
    assert_eq!(names, [("map", "odom"), ("odom", "base_link")]);
    let pose = Odometry::decode(&viewer.wait_for_data(2).content[..]).unwrap();
    assert_eq!((pose.pose_covariance.len(), pose.frame_id.as_str()), (36, "map"));
    let numbers: Value = serde_json::from_slice(&viewer.wait_for_data(4).content).unwrap();
    assert_eq!(numbers["speed"], 0.0);
}

#[test]
fn a_late_viewer_receives_the_state_the_map_and_the_scan_once() {
    let (server, mut link) = served();
    let mut view = at_rest(5);
    let pose = view.estimate.pose;
    let grid = OccupancyGrid::from_ascii(0.5, "???\n?#.\n???").unwrap();
    view.map = Some(MapView { number: 0, revision: 1, grid }.into());
    let beams = vec![Beam::Hit { range: 2.0 }; 3];
    let scan = Scan::new(Stamp::from_nanos(4), Vector2::new(0.1, 0.0), 0.0, 0.1, beams).unwrap();
    (view.scan, view.scan_pose) = (Some(scan.into()), Some(pose));
    for _ in 0..2 {
        view.stamp = Stamp::from_nanos(5);
        link.publish_view(view.clone());
        let mut viewer = Viewer::enter(server.address());
        let advertise = viewer.wait_for("advertise");
        for (id, topic) in [(1, "/state"), (2, "/map"), (3, "/scan"), (4, "/telemetry")] {
            viewer.subscribe(id, channel(&advertise, topic));
        }
        let state = Log::decode(&viewer.wait_for_data(1).content[..]).unwrap();
        assert_eq!((state.message.as_str(), state.level), ("tracking: the camera is dark", 3));
        let map = viewer.wait_for_data(2);
        let grid = Grid::decode(&map.content[..]).unwrap();
        assert_eq!((map.nanos, grid.column_count, grid.data.len()), (5, 2, 8));
        assert_eq!(grid.pose.unwrap().position.unwrap().x, 0.5);
        let scan = viewer.wait_for_data(3);
        let beams = LaserScan::decode(&scan.content[..]).unwrap();
        assert_eq!((scan.nanos, beams.ranges.as_slice()), (4, &[2.0; 3][..]));
        assert_eq!(beams.pose.unwrap().position.unwrap().x, 1.1);
        assert_eq!(viewer.wait_for_data(4).nanos, 5);
        view.stamp = Stamp::from_nanos(6);
        link.publish_view(view.clone());
        let next = viewer.next_data();
        assert_eq!((next.subscription, next.nanos), (4, 6), "map, scan and state are the same");
    }
}

#[test]
fn map_scan_and_image_are_copied_only_for_their_viewers() {
    let (server, mut link) = served();
    let mut viewer = Viewer::enter(server.address());
    let advertise = viewer.wait_for("advertise");
    viewer.subscribe(1, channel(&advertise, "/pose"));
    // A run counts as watched for its first second.
    std::thread::sleep(Duration::from_millis(1100));
    link.publish_view(at_rest(5));
    viewer.wait_for_data(1);
    assert!(!link.is_watched());
    viewer.subscribe(2, channel(&advertise, "/map"));
    let start = Instant::now();
    while !link.is_watched() {
        assert!(start.elapsed() < Duration::from_secs(5), "a viewer of the map is noticed");
        link.publish_view(at_rest(6));
    }
}

fn at_rest(nanos: i64) -> RunView {
    let activity = Activity { name: "tracking", reason: Some("the camera is dark".to_owned()) };
    RunView::of_activity(Stamp::from_nanos(nanos), Pose2::new(1.0, 2.0, 0.0), Twist2::ZERO, activity)
}
