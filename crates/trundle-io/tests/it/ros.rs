use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use trundle_core::{Beam, Pose2};
use trundle_io::{LaserLog, LaserLogOptions, RosBagOptions, read_laser_log, read_ros_bag};

fn bag(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/ros2").join(name)
}

fn read(path: &Path) -> LaserLog {
    read_laser_log(path, &LaserLogOptions::default()).unwrap()
}

/// The bags of `data/ros2/make_bags.py`: a laser upside down, turned and to the side, in a room with walls at x = -2, 6, y = -2, 2.
fn is_the_room(log: &LaserLog) {
    assert_eq!((log.scans.len(), log.odometry.len(), log.skipped.len()), (10, 61, 0), "{:?}", log.skipped);
    assert_eq!((log.bad_ranges, log.max_range), (20, Some(20.0)), "NaN and -1 of each scan");
    for entry in &log.scans {
        let hits: Vec<_> = entry.scan.hits().map(|p| entry.odom_from_base.transform(p)).collect();
        assert_eq!((entry.scan.beams().len(), hits.len()), (270, 267));
        for p in hits {
            let to_wall = [p.x + 2.0, p.x - 6.0, p.y + 2.0, p.y - 2.0].map(f64::abs);
            assert!(to_wall.into_iter().fold(f64::INFINITY, f64::min) < 2e-5, "{p} is on no wall");
        }
        let seconds = (entry.scan.stamp().nanos - 1_700_000_000_000_000_000) as f64 * 1e-9;
        assert!((entry.odom_from_base.x - 0.5 * seconds).abs() < 1e-9, "between two odometry messages");
    }
}

#[test]
fn little_endian_in_zstd_chunks() {
    is_the_room(&read(&bag("zstd.mcap")));
}

#[test]
fn big_endian_in_lz4_chunks_with_odometry_as_transforms() {
    is_the_room(&read(&bag("lz4.mcap")));
}

#[test]
fn a_rosbag2_folder_with_a_database_and_its_file_alone() {
    is_the_room(&read(&bag("sqlite")));
    is_the_room(&read(&bag("sqlite/bag_0.db3")));
}

#[test]
fn a_folder_with_mcap_files() {
    let scratch = tempfile::tempdir().unwrap();
    fs::copy(bag("zstd.mcap"), scratch.path().join("x_0.mcap")).unwrap();
    is_the_room(&read(scratch.path()));
    let yaml = |mode: &str, file: &str| {
        let text = format!(
            "rosbag2_bagfile_information:\n  relative_file_paths:\n    - {file}\n  compression_mode: '{mode}'\n"
        );
        fs::write(scratch.path().join("metadata.yaml"), text).unwrap();
    };
    yaml("", "old_name/x_0.mcap");
    is_the_room(&read(scratch.path()));
    yaml("FILE", "x_0.mcap.zstd");
    let problem = refusal(scratch.path());
    assert!(
        problem.contains("compression_mode is FILE") && problem.contains("ros2 bag convert"),
        "{problem}"
    );
}

fn refusal(path: &Path) -> String {
    read_laser_log(path, &LaserLogOptions::default()).unwrap_err().to_string()
}

/// A message in little-endian CDR.
#[derive(Default)]
struct Cdr(Vec<u8>);

impl Cdr {
    fn put<const N: usize>(mut self, bytes: [u8; N]) -> Self {
        self.0.resize(self.0.len().next_multiple_of(N), 0);
        self.0.extend(bytes);
        self
    }

    fn text(self, text: &str) -> Self {
        let mut cdr = self.put((text.len() as u32 + 1).to_le_bytes());
        cdr.0.extend(text.bytes().chain([0]));
        cdr
    }

    fn header(self, seconds: f64, frame: &str) -> Self {
        let nanos = ((seconds - seconds.floor()) * 1e9).round() as u32;
        self.put((seconds.floor() as i32).to_le_bytes()).put(nanos.to_le_bytes()).text(frame)
    }

    fn f64s(self, values: &[f64]) -> Self {
        values.iter().fold(self, |cdr, value| cdr.put(value.to_le_bytes()))
    }

    fn f32s(self, values: &[f32]) -> Self {
        values.iter().fold(self, |cdr, value| cdr.put(value.to_le_bytes()))
    }

    fn bytes(self) -> Vec<u8> {
        [&[0, 1, 0, 0], &self.0[..]].concat()
    }
}

const SCAN: (&str, &str) = ("/scan", "sensor_msgs/msg/LaserScan");
const ODOM: (&str, &str) = ("/odom", "nav_msgs/msg/Odometry");

fn scan(seconds: f64, ranges: &[f32]) -> ((&'static str, &'static str), Vec<u8>) {
    let head = Cdr::default().header(seconds, "laser").f32s(&[-1.0, 1.0, 0.1, 0.0, 0.1, 0.05, 8.0]);
    (SCAN, head.put((ranges.len() as u32).to_le_bytes()).f32s(ranges).put(0_u32.to_le_bytes()).bytes())
}

fn odometry(seconds: f64, x: f64) -> ((&'static str, &'static str), Vec<u8>) {
    let head = Cdr::default().header(seconds, "odom").text("laser");
    (ODOM, head.f64s(&[x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).f64s(&[0.0; 36 + 6 + 36]).bytes())
}

/// The log of an MCAP file with these messages; the laser's frame is the base's.
fn log_of(messages: &[((&str, &str), Vec<u8>)], encoding: &str) -> Result<LaserLog, String> {
    let mut bytes = Vec::new();
    let options = mcap::WriteOptions::new().compression(None);
    let mut writer = options.create(std::io::Cursor::new(&mut bytes)).unwrap();
    let mut channels = BTreeMap::new();
    for ((topic, kind), data) in messages {
        let channel = *channels.entry(topic).or_insert_with(|| {
            let schema = writer.add_schema(kind, "ros2msg", b"").unwrap();
            writer.add_channel(schema, topic, encoding, &BTreeMap::new()).unwrap()
        });
        let header =
            mcap::records::MessageHeader { channel_id: channel, sequence: 0, log_time: 1, publish_time: 1 };
        writer.write_to_known_channel(&header, data).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    read_bytes(&bytes)
}

fn read_bytes(bytes: &[u8]) -> Result<LaserLog, String> {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), bytes).unwrap();
    let name = file.path().display().to_string();
    read_ros_bag(file.path(), &RosBagOptions::default()).map_err(|e| e.to_string().replace(&name, "BAG"))
}

#[test]
fn bad_messages_are_named_and_left_out() {
    let (mut cut, mut nan) = (scan(1.2, &[1.0; 9]), odometry(1.25, 0.0));
    cut.1.truncate(70);
    nan.1 = odometry(1.25, f64::NAN).1;
    let messages = [
        odometry(1.0, 0.0),
        scan(1.0, &[1.0; 4]),
        scan(0.5, &[1.0; 4]),
        cut,
        nan,
        odometry(1.5, 5.5),
        odometry(1.4, 0.0),
        scan(1.25, &[1.0; 9]),
        scan(9.0, &[1.0; 4]),
        scan(1.5, &[]),
        scan(1.5, &[-2.0, f32::NAN, f32::INFINITY, 3.0]),
    ];
    let log = log_of(&messages, "cdr").unwrap();
    let problems: Vec<&str> = log.skipped.iter().map(|skip| skip.problem.as_str()).collect();
    assert_eq!(
        problems,
        [
            "message 3 on /scan: time goes back from 1.000000000 s to 0.500000000 s",
            "message 4 on /scan: sensor_msgs/msg/LaserScan: ranges at byte 52: 9 elements announced, 14 bytes left",
            "message 5 on /odom: the pose is not finite, or its quaternion is none",
            "message 7 on /odom: time goes back from 1.500000000 s to 1.400000000 s",
            "message 9 on /scan: no odometry about 9.000000000 s",
            "message 10 on /scan: 0 ranges, expected 1 to 100000",
        ]
    );
    // Beams may change in number, and odometry that jumps 5 m is for the mapper to judge.
    assert_eq!(log.scans.iter().map(|s| s.scan.beams().len()).collect::<Vec<_>>(), [4, 9, 4]);
    assert_eq!(log.scans[2].odom_from_base, Pose2::new(5.5, 0.0, 0.0));
    assert_eq!((log.bad_ranges, log.scans[2].scan.beams()[3]), (2, Beam::Hit { range: 3.0 }));
}

#[test]
fn bags_without_what_it_takes_are_refused_by_name() {
    let (one_scan, one_pose) = (scan(1.0, &[1.0]), odometry(1.0, 0.0));
    assert_eq!(
        log_of(std::slice::from_ref(&one_pose), "cdr").unwrap_err(),
        "BAG: no sensor_msgs/msg/LaserScan in it"
    );
    assert_eq!(
        log_of(std::slice::from_ref(&one_scan), "cdr").unwrap_err(),
        "BAG: no nav_msgs/msg/Odometry and no transform below odom in it"
    );
    assert_eq!(
        log_of(std::slice::from_ref(&one_scan), "json").unwrap_err(),
        "BAG: no sensor_msgs/msg/LaserScan in it"
    );
    let elsewhere = (
        ODOM,
        Cdr::default().header(1.0, "odom").text("base").f64s(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).bytes(),
    );
    let problem = log_of(&[one_scan.clone(), elsewhere], "cdr").unwrap_err();
    assert!(
        problem.contains("no transform leads from base to laser, the frame of /scan (transforms: none)"),
        "{problem}"
    );
    let late = scan(100.0, &[1.0]);
    assert_eq!(
        log_of(&[late, one_pose], "cdr").unwrap_err(),
        "BAG: no scan can be used: message 1 on /scan: no odometry about 100.000000000 s"
    );
    assert!(refusal(Path::new("/nowhere/at.mcap")).contains("it does not exist"));
}

#[test]
fn where_the_laser_sits_can_be_given() {
    let laser =
        LaserLogOptions { laser_x: Some(0.5), laser_turn: None, upside_down: true, max_range: Some(3.0) };
    let log = read_laser_log(&bag("zstd.mcap"), &laser).unwrap();
    let scan = &log.scans[0].scan;
    assert_eq!((scan.origin().x, log.max_range), (0.5, Some(3.0)));
    assert!(scan.beams().iter().all(|beam| !matches!(beam, Beam::Hit { range } if *range >= 3.0)));
    let as_told = read_laser_log(&bag("zstd.mcap"), &LaserLogOptions::default()).unwrap();
    let turned = LaserLogOptions { laser_turn: Some(0.25), ..LaserLogOptions::default() };
    let turned = read_laser_log(&bag("zstd.mcap"), &turned).unwrap();
    assert_eq!(turned.scans[0].scan.origin(), as_told.scans[0].scan.origin(), "only the turn was given");
}

#[test]
fn what_breaks_off_is_worth_what_it_holds() {
    let whole = fs::read(bag("zstd.mcap")).unwrap();
    let log = read_bytes(&whole[..whole.len() * 3 / 4]).unwrap();
    assert!((1..10).contains(&log.scans.len()));
    assert!(log.skipped.last().unwrap().problem.contains("the recording is truncated"), "{:?}", log.skipped);
    assert!(read_bytes(&whole[..300]).unwrap_err().contains("truncated"));
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 0x10;
    let _ = read_bytes(&flipped);
    let database = fs::read(bag("sqlite/bag_0.db3")).unwrap();
    for cut in [50, 99, 1024, 40_000] {
        let _ = read_bytes(&database[..cut]);
    }
    for at in (0..database.len()).step_by(997) {
        let mut flipped = database.clone();
        flipped[at] ^= 0x41;
        let _ = read_bytes(&flipped);
    }
}

#[test]
fn a_database_with_an_unfinished_log_says_so() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("a.db3");
    fs::copy(bag("sqlite/bag_0.db3"), &file).unwrap();
    fs::write(scratch.path().join("a.db3-wal"), "x").unwrap();
    assert!(refusal(&file).contains("its last messages are in a -wal file"), "{}", refusal(&file));
}
