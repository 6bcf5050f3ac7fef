//! Laser data of ROS bags: MCAP, SQLite, byte orders, and compression.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use trundle_core::{Beam, Pose2};
use trundle_io::{LaserLog, LaserLogOptions, LaserLogScans, LaserLogSkip, read_laser_log, read_ros_bag};

fn bag(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/ros2").join(name)
}

fn read(path: &Path) -> LaserLog {
    let log = read_laser_log(path, &LaserLogOptions::default()).unwrap();
    assert_eq!(one_at_a_time(path), log);
    log
}

/// The log whose scans are read one at a time.
fn one_at_a_time(path: &Path) -> LaserLog {
    let (mut log, mut scans) = LaserLogScans::open(path, &LaserLogOptions::default()).unwrap();
    while let Some(scan) = scans.next_scan(&mut log).unwrap() {
        log.scans.push(scan);
        assert!(log.scans.len() <= log.statistics.scans + scans.left());
    }
    assert_eq!((log.statistics.scans, scans.left()), (log.scans.len(), 0));
    log
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
    for (mode, file) in [("FILE", "x_0.db3.zstd"), ("MESSAGE", "x_0.mcap")] {
        yaml(mode, file);
        let problem = refusal(scratch.path());
        let expected = format!("compression_mode is {mode}");
        assert!(problem.contains(&expected) && problem.contains("ros2 bag convert"), "{problem}");
    }
}

#[test]
fn an_mcap_file_packed_with_zstd() {
    let scratch = tempfile::tempdir().unwrap();
    let plain = fs::read(bag("lz4.mcap")).unwrap();
    let packed =
        |bytes: &[u8]| ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest);
    let (first, second) = plain.split_at(plain.len() / 3);
    for (name, bytes) in
        [("a.mcap.zst", packed(&plain)), ("b.mcap.zstd", [packed(first), packed(second)].concat())]
    {
        let file = scratch.path().join(name);
        fs::write(&file, bytes).unwrap();
        is_the_room(&read(&file));
    }
    fs::remove_file(scratch.path().join("a.mcap.zst")).unwrap();
    is_the_room(&read(scratch.path()));
    let text =
        "rosbag2_bagfile_information:\n  relative_file_paths:\n    - b.mcap.zstd\n  compression_mode: FILE\n";
    fs::write(scratch.path().join("metadata.yaml"), text).unwrap();
    is_the_room(&read(scratch.path()));
    let whole = packed(&plain);
    let problem = read_bytes(&whole[..whole.len() / 9]).unwrap_err();
    assert!(problem.contains("the zstd data is truncated or broken"), "{problem}");
    let problem = read_bytes(&packed(b"SQLite format 3")).unwrap_err();
    assert!(problem.contains("not an MCAP recording"), "{problem}");
}

#[test]
fn topics_are_named_and_can_be_chosen() {
    let on = |topic: &'static str, (of, data): ((&'static str, &'static str), Vec<u8>)| ((topic, of.1), data);
    let mut messages = vec![odometry(1.0, 0.0), on("/odom_fused", odometry(1.0, 7.0)), scan(1.0, &[1.0; 4])];
    messages.extend([on("/scan_rear", scan(1.0, &[2.0; 4])), scan(1.0, &[3.0; 4])]);
    let log = log_of(&messages, "cdr").unwrap();
    let left = |log: &LaserLog| log.sources.left.clone();
    assert_eq!((log.sources.scans.as_str(), log.sources.odometry.as_str()), ("/scan", "/odom"));
    assert_eq!(left(&log), [("/scan_rear".to_owned(), 1), ("/odom_fused".to_owned(), 1)]);
    let asked = |scans: &str, odometry: &str| {
        let mut options = LaserLogOptions::default();
        options.scan_topic = Some(scans.to_owned());
        options.odometry_topic = Some(odometry.to_owned());
        options
    };
    let log = log_with(&messages, "cdr", &asked("scan_rear", "/odom_fused")).unwrap();
    assert_eq!((log.scans.len(), log.scans[0].odom_from_base.x), (1, 7.0));
    assert_eq!(left(&log), [("/scan".to_owned(), 2), ("/odom".to_owned(), 1)]);
    assert_eq!(
        log_with(&messages, "cdr", &asked("/laser", "/odom")).unwrap_err(),
        "BAG: no sensor_msgs/msg/LaserScan on /laser, expected one of: /scan (2), /scan_rear (1)"
    );
    assert!(
        log_with(&messages, "cdr", &asked("/scan", "/x")).unwrap_err().contains("/odom (1), /odom_fused (1)")
    );
}

#[test]
fn a_quaternion_that_is_none_is_named() {
    let pose = |quaternion: [f64; 4]| [&[0.5, 0.0, 0.0][..], &quaternion].concat();
    let odometry = |base: &str, quaternion: [f64; 4]| {
        (ODOM, Cdr::default().header(1.0, "odom").text(base).f64s(&pose(quaternion)).bytes())
    };
    let transform = |quaternion: [f64; 4]| {
        let cdr = Cdr::default().put(1_u32.to_le_bytes()).header(0.0, "base").text("laser");
        (("/tf_static", "tf2_msgs/msg/TFMessage"), cdr.f64s(&pose(quaternion)).bytes())
    };
    let good = [0.0, 0.0, 0.0, 1.0];
    assert_eq!(
        log_of(&[odometry("laser", [0.0; 4]), scan(1.0, &[1.0])], "cdr").unwrap_err(),
        "BAG: none of the 1 poses on /odom can be used: the quaternion is 0 0 0 0 (x y z w), which is not a rotation, \
         expected length 1"
    );
    let problem =
        log_of(&[odometry("base", good), scan(1.0, &[1.0]), transform([0.0; 4])], "cdr").unwrap_err();
    assert!(
        problem.contains(
            "the transform base > laser: the quaternion is 0 0 0 0 (x y z w), which is not a rotation"
        ),
        "{problem}"
    );
    assert!(log_of(&[odometry("base", good), scan(1.0, &[1.0]), transform(good)], "cdr").is_ok());
}

#[test]
fn a_laser_is_upside_down_where_that_is_given() {
    let ranges: Vec<f32> = (1..6_u8).map(f32::from).collect();
    let messages = [odometry(1.0, 0.0), scan(1.0, &ranges)];
    let read = |upside_down| {
        let mut options = LaserLogOptions::default();
        options.upside_down = upside_down;
        log_with(&messages, "cdr", &options).unwrap()
    };
    let (plain, turned) = (read(false), read(true));
    assert_eq!((plain.mount.upside_down, turned.mount.upside_down), (false, true));
    let points = |log: &LaserLog| log.scans[0].scan.hits().collect::<Vec<_>>();
    let (plain, mut turned) = (points(&plain), points(&turned));
    turned.reverse();
    for (a, b) in plain.iter().zip(&turned) {
        assert!((a.x - b.x).abs() < 1e-9 && (a.y + b.y).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn scans_without_returns_are_counted_and_limits_in_the_wrong_order_refused() {
    let infinite = scan(1.0, &[f32::INFINITY; 5]);
    let log = log_of(&[odometry(1.0, 0.0), infinite, scan(1.0, &[1.0; 5])], "cdr").unwrap();
    assert_eq!((log.scans.len(), log.scans_without_return(), log.bad_ranges), (2, 1, 0));
    let head = Cdr::default().header(1.0, "laser").f32s(&[-1.0, 1.0, 0.1, 0.0, 0.1, 8.0, 0.05]);
    let swapped = head.put(1_u32.to_le_bytes()).f32s(&[1.0]).put(0_u32.to_le_bytes()).bytes();
    let problem = log_of(&[odometry(1.0, 0.0), (SCAN, swapped)], "cdr").unwrap_err();
    assert!(problem.contains("range_min is 8 m and range_max 0.05"), "{problem}");
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
    log_with(messages, encoding, &LaserLogOptions::default())
}

fn log_with(
    messages: &[((&str, &str), Vec<u8>)],
    encoding: &str,
    options: &LaserLogOptions,
) -> Result<LaserLog, String> {
    read_with(&mcap_of(messages, encoding, None), options)
}

/// An MCAP file with these messages, in chunks of about `chunk_size` bytes.
fn mcap_of(messages: &[((&str, &str), Vec<u8>)], encoding: &str, chunk_size: Option<u64>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let written = mcap::WriteOptions::new().compression(None);
    let written = if chunk_size.is_some() { written.chunk_size(chunk_size) } else { written };
    let mut writer = written.create(std::io::Cursor::new(&mut bytes)).unwrap();
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
    bytes
}

fn read_bytes(bytes: &[u8]) -> Result<LaserLog, String> {
    read_with(bytes, &LaserLogOptions::default())
}

fn read_with(bytes: &[u8], options: &LaserLogOptions) -> Result<LaserLog, String> {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), bytes).unwrap();
    let name = file.path().display().to_string();
    read_ros_bag(file.path(), options).map_err(|e| e.to_string().replace(&name, "BAG"))
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
            "message 5 on /odom: the position is NaN 0 0 m, expected finite numbers",
            "message 7 on /odom: time goes back from 1.500000000 s to 1.400000000 s",
            "message 9 on /scan: no odometry about 9.000000000 s",
            "message 10 on /scan: 0 ranges, expected 1 to 100000",
        ]
    );
    // Beams may change in number, and odometry that jumps 5 m is for the mapper to evaluate.
    assert_eq!(log.scans.iter().map(|s| s.scan.beams().len()).collect::<Vec<_>>(), [4, 9, 4]);
    assert_eq!(log.scans[2].odom_from_base, Pose2::new(5.5, 0.0, 0.0));
    assert_eq!((log.bad_ranges, log.scans[2].scan.beams()[3]), (2, Beam::Hit { range: 3.0 }));
}

#[test]
fn bags_without_what_it_takes_are_refused_by_name() {
    let (one_scan, one_pose) = (scan(1.0, &[1.0]), odometry(1.0, 0.0));
    assert_eq!(
        log_of(std::slice::from_ref(&one_pose), "cdr").unwrap_err(),
        "BAG: no sensor_msgs/msg/LaserScan in it, expected one; its topics: /odom (nav_msgs/msg/Odometry, 1 messages)"
    );
    assert_eq!(
        log_of(std::slice::from_ref(&one_scan), "cdr").unwrap_err(),
        "BAG: no nav_msgs/msg/Odometry and no transform below odom in it, expected one of both; \
         its topics: /scan (sensor_msgs/msg/LaserScan, 1 messages)"
    );
    assert_eq!(
        log_of(std::slice::from_ref(&one_scan), "json").unwrap_err(),
        "BAG: no sensor_msgs/msg/LaserScan in it, expected one; its topics: none with messages in CDR"
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
        "BAG: no scan can be used: scans from 100.000000000 s to 100.000000000 s, odometry from 1.000000000 s to \
         1.000000000 s: their clocks differ, expected one clock for both"
    );
    assert!(refusal(Path::new("/nowhere/at.mcap")).contains("it does not exist"));
}

#[test]
fn where_the_laser_sits_can_be_given() {
    let mut laser = LaserLogOptions::default();
    laser.laser_x = Some(0.5);
    laser.upside_down = true;
    laser.max_range = Some(3.0);
    let log = read_laser_log(&bag("zstd.mcap"), &laser).unwrap();
    let scan = &log.scans[0].scan;
    assert_eq!((scan.origin().x, log.max_range), (0.5, Some(3.0)));
    assert!(scan.beams().iter().all(|beam| !matches!(beam, Beam::Hit { range } if *range >= 3.0)));
    let as_told = read_laser_log(&bag("zstd.mcap"), &LaserLogOptions::default()).unwrap();
    let mut turned = LaserLogOptions::default();
    turned.laser_turn = Some(0.25);
    let turned = read_laser_log(&bag("zstd.mcap"), &turned).unwrap();
    assert_eq!(turned.scans[0].scan.origin(), as_told.scans[0].scan.origin(), "only the turn was given");
}

/// Opcode, start and end of each record of an MCAP file.
fn records(bytes: &[u8]) -> Vec<(u8, usize, usize)> {
    let mut records = Vec::new();
    let mut at = mcap::MAGIC.len();
    while let Some(head) = bytes.get(at..at + 9) {
        let end = at + 9 + u64::from_le_bytes(head[1..].try_into().unwrap()) as usize;
        records.push((head[0], at, end));
        at = end;
    }
    records
}

#[test]
fn a_damaged_chunk_of_a_bag_costs_its_own_messages() {
    let messages: Vec<_> = (0..40)
        .flat_map(|n| {
            let time = 1.0 + 0.1 * f64::from(n);
            [odometry(time, 0.01 * f64::from(n)), scan(time, &[1.0; 9])]
        })
        .collect();
    let whole = mcap_of(&messages, "cdr", Some(4000));
    assert_eq!(read_bytes(&whole).unwrap().scans.len(), 40);
    let chunks: Vec<_> = records(&whole).into_iter().filter(|record| record.0 == 6).collect();
    assert!(chunks.len() > 4, "{chunks:?}");
    for (_, start, end) in chunks {
        // The content of the chunk, and its length: the messages may be intact then.
        for (at, is_content) in
            [((start + end) / 2, true), (start + 60, true), (start + 1, false), (start + 7, false)]
        {
            let mut damaged = whole.clone();
            damaged[at] ^= 0x55;
            let log = read_bytes(&damaged).unwrap();
            let scans = if is_content { 28..40 } else { 28..41 };
            assert!(scans.contains(&log.scans.len()), "byte {at}: {} scans", log.scans.len());
            let is_named = |skip: &LaserLogSkip| {
                let names_place = !is_content || skip.problem.contains(&format!("at byte {start};"));
                skip.problem.starts_with("the bag is damaged at") && names_place
            };
            assert!(log.skipped.iter().any(is_named), "byte {at}: {:?}", log.skipped);
        }
    }
}

/// Found by the fuzzer: the definition was read again for ever.
#[test]
fn a_bag_with_a_damaged_chunk_and_a_damaged_definition_is_read_to_its_end() {
    const CHUNK: u8 = 6;
    const CHANNEL: u8 = 4;
    let messages: Vec<_> =
        (0..9).map(f64::from).flat_map(|n| [odometry(1.0 + n, 0.01 * n), scan(1.0 + n, &[1.0; 9])]).collect();
    let mut bytes = mcap_of(&messages, "cdr", Some(2000));
    let records = records(&bytes);
    let (_, start, end) = records.iter().find(|record| record.0 == CHUNK).unwrap();
    let (_, channel, _) = records.iter().find(|record| record.0 == CHANNEL).unwrap();
    bytes[(start + end) / 2] ^= 0x55;
    // The length of the topic.
    bytes[channel + 9 + 4..channel + 9 + 8].fill(0xff);
    let skipped = read_bytes(&bytes).map_or_else(|error| error, |log| format!("{:?}", log.skipped));
    assert!(skipped.contains("damaged"), "{skipped}");
}

#[test]
fn a_bag_that_breaks_off_is_read_to_its_end() {
    let whole = fs::read(bag("zstd.mcap")).unwrap();
    let log = read_bytes(&whole[..whole.len() * 3 / 4]).unwrap();
    assert!((1..10).contains(&log.scans.len()));
    assert!(log.skipped.last().unwrap().problem.contains("the bag was cut at byte"), "{:?}", log.skipped);
    assert!(read_bytes(&whole[..300]).unwrap_err().contains("cut at byte 300, before its first scan"));
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

/// A message in the format of ROS 1: a number before the header, no alignment, no zero after texts.
mod ros1 {
    pub fn header(seconds: u32, nanos: u32, frame: &str) -> Vec<u8> {
        let numbers = [7, seconds, nanos, frame.len() as u32];
        [&numbers.map(u32::to_le_bytes).concat(), frame.as_bytes()].concat()
    }

    pub fn text(text: &str) -> Vec<u8> {
        [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
    }

    pub fn f64s(values: &[f64]) -> Vec<u8> {
        values.iter().flat_map(|value| value.to_le_bytes()).collect()
    }

    pub fn f32s(values: &[f32]) -> Vec<u8> {
        values.iter().flat_map(|value| value.to_le_bytes()).collect()
    }

    /// A record: its fields and its data, each with its length.
    pub fn record(fields: &[(&str, &[u8])], data: &[u8]) -> Vec<u8> {
        let field = |(name, value): &(&str, &[u8])| part(&[name.as_bytes(), b"=", value].concat());
        let header: Vec<u8> = fields.iter().flat_map(field).collect();
        [part(&header), part(data)].concat()
    }

    fn part(bytes: &[u8]) -> Vec<u8> {
        [&(bytes.len() as u32).to_le_bytes(), bytes].concat()
    }

    pub fn connection(id: u32, topic: &str, kind: &str) -> Vec<u8> {
        let about = part(&[b"type=", kind.as_bytes()].concat());
        record(&[("op", &[7]), ("conn", &id.to_le_bytes()), ("topic", topic.as_bytes())], &about)
    }

    pub fn message(id: u32, data: &[u8]) -> Vec<u8> {
        record(&[("op", &[2]), ("conn", &id.to_le_bytes()), ("time", &[0; 8])], data)
    }

    /// A bag with one chunk, compressed by `compression`.
    pub fn bag(records: &[Vec<u8>], compression: &str) -> Vec<u8> {
        let chunk = records.concat();
        let packed = if compression == "lz4" { lz4(&chunk) } else { chunk.clone() };
        let size = (chunk.len() as u32).to_le_bytes();
        let fields: [(&str, &[u8]); 3] =
            [("op", &[5]), ("compression", compression.as_bytes()), ("size", &size)];
        let head = record(&[("op", &[3]), ("index_pos", &[0; 8])], &[b' '; 64]);
        let index = record(&[("op", &[4]), ("conn", &[0; 4])], &[0; 12]);
        [b"#ROSBAG V2.0\n", &head[..], &record(&fields, &packed), &index].concat()
    }

    fn lz4(bytes: &[u8]) -> Vec<u8> {
        use std::io::Write;
        let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }
}

/// A laser half a metre ahead and upside down that drives along x, in a ROS 1 bag.
fn ros1_bag(compression: &str) -> Vec<u8> {
    let upside_down = [0.5, 0.0, 0.25, 1.0, 0.0, 0.0, 0.0];
    let transform = [
        1_u32.to_le_bytes().to_vec(),
        ros1::header(0, 0, "/base"),
        ros1::text("/laser"),
        ros1::f64s(&upside_down),
    ]
    .concat();
    let odometry = |seconds: u32, x: f64| {
        let pose = ros1::f64s(&[x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        [ros1::header(seconds, 0, "odom"), ros1::text("base"), pose, ros1::f64s(&[0.0; 78])].concat()
    };
    let head = ros1::f32s(&[-1.0, 1.0, 1.0, 0.0, 0.1, 0.05, 8.0]);
    let ranges = [3_u32.to_le_bytes().to_vec(), ros1::f32s(&[1.0, 2.0, 3.0]), vec![0; 4]].concat();
    let scan = [ros1::header(10, 500_000_000, "laser"), head, ranges].concat();
    let records = [
        ros1::connection(0, "/tf_static", "tf/tfMessage"),
        ros1::message(0, &transform),
        ros1::connection(1, "/odom", "nav_msgs/Odometry"),
        ros1::connection(2, "/scan", "sensor_msgs/LaserScan"),
        ros1::message(1, &odometry(10, 0.0)),
        ros1::message(2, &scan),
        ros1::message(1, &odometry(11, 1.0)),
    ];
    ros1::bag(&records, compression)
}

#[test]
fn the_laser_of_a_ros1_bag_is_read() {
    for compression in ["none", "lz4"] {
        let log = read_bytes(&ros1_bag(compression)).unwrap();
        assert_eq!((log.scans.len(), log.skipped.len()), (1, 0), "{:?}", log.skipped);
        let LaserLog { scans, sources, mount, .. } = &log;
        assert_eq!((scans[0].odom_from_base.x, scans[0].scan.origin().x), (0.5, 0.5));
        assert_eq!(scans[0].scan.stamp().nanos, 10_500_000_000);
        let first = scans[0].scan.hits().next().unwrap() - scans[0].scan.origin();
        assert!((first.norm() - 3.0).abs() < 1e-6 && first.y < 0.0, "beams run clockwise: {first}");
        assert!(mount.upside_down && sources.scans == "/scan" && sources.odometry == "/odom");
    }
    let packed = read_bytes(&ros1_bag("bz2")).unwrap_err();
    assert!(packed.contains("packed with bz2") && packed.contains("`rosbags-convert"), "{packed}");
}

#[test]
fn a_broken_ros1_bag_is_an_error_or_worth_what_it_holds() {
    let whole = ros1_bag("none");
    for cut in 13..whole.len() {
        let _ = read_bytes(&whole[..cut]);
        let mut flipped = whole.clone();
        flipped[cut] ^= 0x41;
        let _ = read_bytes(&flipped);
    }
    for compression in ["none", "lz4"] {
        let whole = ros1_bag(compression);
        let log = (1..whole.len()).rev().find_map(|len| {
            let log = read_bytes(&whole[..len]).ok()?;
            log.skipped.last()?.problem.contains("the bag is truncated: ").then_some(log)
        });
        assert_eq!(log.map(|log| log.scans.len()), Some(1), "{compression}: up to the cut");
    }
    let cut = read_bytes(&whole[..200]).unwrap_err();
    assert!(cut.contains("the bag is truncated: ") && cut.contains("`rosbag reindex`"), "{cut}");
    assert!(read_bytes(b"#ROSBAG V1.2\n").unwrap_err().contains("format '#ROSBAG V1.2', expected"));
}

#[test]
fn inner_topics_of_services_and_actions_are_not_listed_and_disturb_nothing() {
    let event = (("/set/_service_event", "std_srvs/srv/SetBool_Event"), vec![0, 1, 0, 0, 7]);
    let status = (("/go/_action/status", "action_msgs/msg/GoalStatusArray"), vec![0, 1, 0, 0]);
    let feedback = (("/feedback", "nav2_msgs/action/NavigateToPose_FeedbackMessage"), Vec::new());
    let messages = [event, odometry(1.0, 0.0), status, scan(1.0, &[1.0; 4]), feedback];
    let log = log_of(&messages, "cdr").unwrap();
    assert_eq!((log.scans.len(), log.skipped.len(), log.sources.left.len()), (1, 0, 0));
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), mcap_of(&messages, "cdr", None)).unwrap();
    let topics = trundle_io::RosTopics::read(file.path()).unwrap();
    let names: Vec<String> = topics.rows().map(|[name, ..]| name).collect();
    assert_eq!(names, ["/odom", "/scan"]);
    let problem = log_of(&messages[..3], "cdr").unwrap_err();
    assert!(problem.ends_with("its topics: /odom (nav_msgs/msg/Odometry, 1 messages)"), "{problem}");
}
