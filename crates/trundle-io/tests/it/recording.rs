//! Recordings: round trip, order, cut and damaged files.

use crate::frame;
use proptest::prelude::*;
use serde_json::json;
use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::time::Instant;
use trundle_core::*;
use trundle_io::*;

fn stamp(millis: i64) -> Stamp {
    Stamp::from_nanos(1_305_031_229_528_748_001 + millis * 1_000_000)
}

fn events() -> Vec<EncodedEvent> {
    let image = SensorEvent::Rgbd(frame(stamp(33), 64, 48));
    vec![
        EncodedEvent::Wheels(WheelTicks { stamp: stamp(0), left: 65_535, right: 3 }),
        EncodedEvent::Gyro(GyroRate { stamp: stamp(1), omega: 0.1 + 0.2 }),
        EncodedEvent::encode(&image).unwrap(),
        EncodedEvent::Touch(Touch { stamp: stamp(40), pressed: true }),
        EncodedEvent::Cliff(Cliff { stamp: stamp(41), over_edge: true }),
        EncodedEvent::Scan(scan(stamp(45))),
        EncodedEvent::Odometry(odometry(stamp(46))),
        EncodedEvent::Body(BodyEvent::new(stamp(47), BodyEventKind::Silence)),
        EncodedEvent::Body(BodyEvent::new(stamp(48), battery())),
        EncodedEvent::Truth { stamp: stamp(50), pose: Pose2 { x: 1.0 / 3.0, y: -0.0, theta: -2.0 / 3.0 } },
    ]
}

fn odometry(stamp: Stamp) -> Odometry {
    let (pose, twist) = (Pose2 { x: 0.1, y: -0.0, theta: 1.0 / 3.0 }, Twist2::new(0.3, -0.7));
    Odometry {
        stamp,
        pose,
        twist,
        covariance: nalgebra::Matrix3::from_fn(|i, j| 0.1 / (1 + i + 3 * j) as f64),
    }
}

fn battery() -> BodyEventKind {
    let source = PowerSource::ChargingStation;
    BodyEventKind::Battery(Battery { voltage_v: 15.7, charge: Some(1.0 / 3.0), source, is_charging: true })
}

fn scan(stamp: Stamp) -> Scan {
    let beams = vec![Beam::Hit { range: 1.0 / 3.0 }, Beam::Free { range: 5.6 }, Beam::Unseen];
    Scan::new(stamp, Vector2::new(0.1, 0.0), -1.0 / 7.0, 0.1, beams).unwrap()
}

fn recording() -> Vec<u8> {
    let mut recorder = Recorder::new(Cursor::new(Vec::new()), Path::new("a.mcap")).unwrap();
    recorder.record_json("/config", "trundle.Config", stamp(0), &json!({"seed": 3, "rate": 0.1})).unwrap();
    recorder.set_camera(PinholeCamera::kinect_v2());
    for event in events() {
        recorder.record_event(&event).unwrap();
        let pose = PoseInFrame::planar(event.stamp(), "map", Pose2::new(0.1, 0.2, 0.3));
        recorder.record_json("/pose", PoseInFrame::SCHEMA, event.stamp(), &pose).unwrap();
    }
    recorder.finish().unwrap().into_inner()
}

fn on_disk(bytes: &[u8]) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), bytes).unwrap();
    file
}

/// All messages of a file, or its error; the path is replaced by FILE.
fn read(bytes: &[u8]) -> Result<Vec<RecordedMessage>, String> {
    let file = on_disk(bytes);
    let all = RecordingReader::open(file.path()).and_then(Iterator::collect);
    all.map_err(|error: IoError| error.to_string().replace(&file.path().display().to_string(), "FILE"))
}

#[test]
fn a_recording_gives_back_every_bit_in_order() {
    let file = on_disk(&recording());
    let reader = RecordingReader::open(file.path()).unwrap();
    assert_eq!(reader.config(), Some(&json!({"seed": 3, "rate": 0.1})));
    let all: Vec<_> = reader.map(Result::unwrap).collect();
    assert_eq!(all.len(), 20);
    let back: Vec<_> = RecordingReader::open(file.path()).unwrap().events().map(Result::unwrap).collect();
    assert_eq!(back, events());
    assert!(matches!(back[9], EncodedEvent::Truth { pose, .. } if pose.y.is_sign_negative()));
    let RecordedMessage::Json { topic, schema, stamp: at, value } = &all[1] else { panic!("{:?}", all[1]) };
    assert_eq!((topic.as_str(), schema.as_str(), *at), ("/pose", PoseInFrame::SCHEMA, stamp(0)));
    let pose: PoseInFrame = serde_json::from_value(value.clone()).unwrap();
    assert_eq!(pose.pose2(), Some(Pose2::new(0.1, 0.2, 0.3)));
}

#[test]
fn the_same_run_is_the_same_bytes() {
    assert_eq!(recording(), recording());
}

#[test]
fn the_mcap_library_s_own_index_finds_all() {
    let bytes = recording();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let stats = summary.stats.unwrap();
    // A configuration, ten poses, ten events; colour, depth and twice camera_info; gyro, a scan with its frame, truth.
    assert_eq!((stats.message_count, stats.channel_count), (29, 19));
    assert_eq!(stats.message_start_time, stamp(0).nanos as u64);
    let schemas: Vec<_> = summary.schemas.values().map(|s| (s.name.clone(), s.encoding.clone())).collect();
    assert!(schemas.contains(&("sensor_msgs/msg/CompressedImage".to_owned(), "ros2msg".to_owned())));
    assert_eq!(stats.chunk_count, 4, "the configuration; depth, colour, the rest");
    assert!(summary.chunk_indexes.iter().any(|chunk| chunk.compression == "zstd"));
    let (mut at, mut counted) = (0, 0);
    for chunk in &summary.chunk_indexes {
        assert!(chunk.chunk_start_offset > at, "chunks in the order of the file");
        at = chunk.chunk_start_offset;
        counted += chunk.message_index_offsets.len();
    }
    assert_eq!(counted, 19, "an index a channel");
}

#[test]
fn broken_files_are_named_with_their_fault() {
    let bytes = recording();
    assert_eq!(
        read(b"hello, this is not it").unwrap_err(),
        "FILE: this is a text file of no known kind, expected a trundle recording (recording.mcap)"
    );
    let half = read(&bytes[..bytes.len() / 2]).unwrap_err();
    assert!(half.starts_with("FILE: the recording is truncated: it ends "), "{half}");
    assert!(read(&[]).unwrap_err().starts_with("FILE: this is an empty file, expected a trundle recording"));
    let missing = RecordingReader::open(Path::new("no.mcap")).err().unwrap().to_string();
    assert_eq!(missing, "cannot read no.mcap: it does not exist");
    assert!(RecordingReader::open(Path::new("/")).err().unwrap().to_string().contains("this is a folder"));
    for len in (0..bytes.len()).step_by(97) {
        assert!(read(&bytes[..len]).is_err(), "cut at {len} of {}", bytes.len());
    }
}

/// A recording of an earlier version: JSON, with images in JSON (base64) or in CDR, depth as PNG.
fn old_form(is_base64: bool) -> (Vec<u8>, EncodedEvent) {
    use base64::Engine;
    let image = frame(stamp(33), 64, 48);
    let color_jpeg = encode_color(image.color(), JPEG_QUALITY).unwrap();
    let image = EncodedRgbd { stamp: stamp(33), color_jpeg, depth: encode_depth(image.depth()).unwrap() };
    let options = mcap::WriteOptions::new().compression(None).profile("").library("trundle");
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    let mut write = |topic: &str, schema: &str, data: &[u8], encodings: (&str, &str)| {
        let schema = writer.add_schema(schema, encodings.0, b"").unwrap();
        let channel = writer.add_channel(schema, topic, encodings.1, &Default::default()).unwrap();
        let time = stamp(33).nanos as u64;
        let header = mcap::records::MessageHeader {
            channel_id: channel,
            sequence: 1,
            log_time: time,
            publish_time: time,
        };
        writer.write_to_known_channel(&header, data).unwrap();
    };
    let (sec, nsec) = (stamp(33).nanos / 1_000_000_000, stamp(33).nanos % 1_000_000_000);
    write("/config", "trundle.Config", br#"{"seed": 3}"#, ("jsonschema", "json"));
    for (topic, bytes) in [("/camera/color", &image.color_jpeg), ("/camera/depth", &image.depth)] {
        if is_base64 {
            let data = base64::engine::general_purpose::STANDARD.encode(bytes);
            let message =
                json!({"timestamp": {"sec": sec, "nsec": nsec}, "frame_id": "camera", "data": data});
            write(topic, "foxglove.CompressedImage", message.to_string().as_bytes(), ("jsonschema", "json"));
        } else {
            let message = ros_message::color_image(stamp(33), "camera", bytes);
            write(topic, message.kind(), message.bytes(), ("ros2msg", "cdr"));
        }
    }
    let gyro = json!({"stamp": {"sec": sec, "nsec": nsec}, "omega_rad_s": 0.5}).to_string();
    write("/gyro", "trundle.GyroRate", gyro.as_bytes(), ("jsonschema", "json"));
    writer.finish().unwrap();
    (writer.into_inner().into_inner(), EncodedEvent::Rgbd(image))
}

#[test]
fn recordings_of_earlier_versions_are_read_too() {
    for is_base64 in [false, true] {
        let (bytes, image) = old_form(is_base64);
        let gyro = EncodedEvent::Gyro(GyroRate { stamp: stamp(33), omega: 0.5 });
        let expected = [image.clone(), gyro].map(RecordedMessage::Event);
        assert_eq!(read(&bytes).unwrap(), expected);
        let seen = image.decode().unwrap();
        let SensorEvent::Rgbd(seen) = seen else { unreachable!("it is an image") };
        let again = EncodedRgbd::encode(&seen).unwrap().decode().unwrap();
        assert_eq!(seen.depth(), again.depth(), "PNG and RVL hold the same depth");
    }
}

/// Reads a recording up to its cut: its messages, and the position of the cut.
fn read_to_cut(bytes: &[u8]) -> Result<(Vec<RecordedMessage>, Option<u64>), String> {
    let file = on_disk(bytes);
    let reader = RecordingReader::open_to_cut(file.path()).map_err(|error| error.to_string())?;
    let cut = reader.cut().map(|cut| cut.byte);
    let all = reader.collect::<Result<Vec<_>, IoError>>().map_err(|error| error.to_string())?;
    Ok((all, cut))
}

#[test]
fn a_recording_cut_at_any_byte_is_read_to_the_cut() {
    let bytes = recording();
    let all = read(&bytes).unwrap();
    assert_eq!(read_to_cut(&bytes).unwrap(), (all.clone(), None));
    let (mut last, mut refused) = (0, 0);
    let ends = (0..bytes.len()).filter(|len| *len > bytes.len() - 400 || len % 7 == 0);
    for len in ends {
        match read_to_cut(&bytes[..len]) {
            Ok((messages, cut)) => {
                assert_eq!(cut, Some(len as u64));
                assert!(messages[..] == all[..messages.len()], "cut at {len}");
                assert!(messages.len() >= last, "cut at {len}: fewer messages than of a shorter file");
                last = messages.len();
            }
            Err(error) => {
                assert!(last == 0, "cut at {len}: {error}");
                refused += 1;
            }
        }
    }
    assert_eq!(last, all.len(), "a file that lacks only its index holds every message");
    assert!(refused > 1);
    assert!(read_to_cut(&bytes[..60]).unwrap_err().contains("before its first message"));
    assert!(read_to_cut(b"hello, this is not it").is_err());
}

#[test]
fn a_damaged_recording_is_refused_or_read_to_the_damage() {
    let whole = recording();
    let all = read(&whole).unwrap();
    for at in (20..whole.len() - 20).step_by(37) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x55;
        if read(&damaged).is_ok_and(|messages| messages == all) {
            continue;
        }
        if let Err(error) = read(&damaged) {
            let names_place = error.contains(" at byte ") || error.contains("messages on ");
            assert!(error.starts_with("FILE: ") && names_place, "byte {at}: {error}");
        }
        if let Ok((messages, _)) = read_to_cut(&damaged) {
            assert!(messages[..] == all[..messages.len()], "byte {at}");
        }
    }
}

#[test]
fn messages_that_lie_are_errors_with_topic_and_time() {
    let with = |topic: &str, schema: &str, value: serde_json::Value| {
        let mut recorder = Recorder::new(Cursor::new(Vec::new()), Path::new("a.mcap")).unwrap();
        recorder.record_json(topic, schema, Stamp::from_nanos(5), &value).unwrap();
        read(recorder.finish().unwrap().get_ref()).unwrap_err()
    };
    let error = with("/gyro", "trundle.GyroRate", json!({"stamp": {"sec": 1, "nsec": 0}}));
    assert!(
        error.starts_with("FILE: message on /gyro at 0.000000005 s: missing field `omega_rad_s`"),
        "{error}"
    );
    let time = json!({"stamp": {"sec": 1, "nsec": 1_000_000_000}, "omega_rad_s": 0.0});
    assert!(with("/gyro", "trundle.GyroRate", time).ends_with("expected nsec below 1e9"));
    let place = json!({"stamp": {"sec": 1, "nsec": 0}});
    assert!(with("/image", "trundle.Image", place).ends_with("no colour image for 1.000000000 s"));
    assert!(with("/camera/depth", "x", json!({})).contains("a depth image without its colour image"));
    assert!(with("/camera/color", "x", json!({})).contains("a colour image without its depth image"));
}

#[test]
fn events_that_cannot_be_recorded_are_refused() {
    let mut recorder = Recorder::new(Cursor::new(Vec::new()), Path::new("a.mcap")).unwrap();
    let gyro = EncodedEvent::Gyro(GyroRate { stamp: stamp(0), omega: f64::NAN });
    let error = recorder.record_event(&gyro).unwrap_err().to_string();
    assert_eq!(error, "a.mcap: gyro omega is NaN rad/s, expected a finite number");
    let early = EncodedEvent::Touch(Touch { stamp: Stamp::from_nanos(-1), pressed: true });
    let error = recorder.record_event(&early).unwrap_err().to_string();
    assert_eq!(error, "a.mcap: stamp on /touch is -0.000000001 s, expected 0 or later");
    recorder.record_json("/a", "trundle.Status", stamp(0), &json!({})).unwrap();
    let error = recorder.record_json("/a", "trundle.Goal", stamp(0), &json!({})).unwrap_err().to_string();
    assert_eq!(error, "a.mcap: schema of /a is trundle.Goal, expected trundle.Status");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_reported() {
    let mut recorder = Recorder::create(Path::new("/dev/full")).unwrap();
    let image = EncodedEvent::encode(&SensorEvent::Rgbd(frame(stamp(0), 64, 48))).unwrap();
    let result =
        (0..2000).try_for_each(|_| recorder.record_event(&image)).and_then(|()| recorder.finish().map(drop));
    assert_eq!(result.unwrap_err().to_string(), "cannot write /dev/full: the disk is full");
}

#[test]
fn a_recording_in_an_output_folder_appears_at_commit() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    let out = OutputFolder::create(&target).unwrap();
    let mut recorder = out.recorder("recording.mcap").unwrap();
    events().iter().for_each(|event| recorder.record_event(event).unwrap());
    recorder.finish().unwrap();
    assert!(!target.exists());
    let folder = out.commit().unwrap();
    assert_eq!(RecordingReader::open(&folder.join("recording.mcap")).unwrap().events().count(), 10);
}

/// The minimum of many times, ms: the cost without disturbance by other programs.
fn min_ms(mut work: impl FnMut()) -> f64 {
    let times = (0..15).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    });
    times.fold(f64::INFINITY, f64::min)
}

#[test]
fn the_wire_costs_milliseconds() {
    let image = frame(stamp(0), 512, 424);
    let encoded = EncodedRgbd::encode(&image).unwrap();
    let color_in = min_ms(|| drop(encode_color(image.color(), JPEG_QUALITY).unwrap()));
    let depth_in = min_ms(|| drop(encode_depth_rvl(image.depth()).unwrap()));
    let color_out = min_ms(|| drop(decode_color(&encoded.color_jpeg).unwrap()));
    let depth_out = min_ms(|| drop(decode_depth(&encoded.depth).unwrap()));
    let (jpeg, rvl) = (encoded.color_jpeg.len() / 1024, encoded.depth.len() / 1024);
    eprintln!(
        "512 x 424: colour encode {color_in:.2} ms, decode {color_out:.2} ms, {jpeg} KiB; \
         depth encode {depth_in:.2} ms, decode {depth_out:.2} ms, {rvl} KiB"
    );
    assert!(color_in + depth_in < 60.0 && color_out + depth_out < 60.0, "an order of magnitude too slow");
}

#[test]
fn recording_costs_less_than_encoding() {
    let image = EncodedEvent::encode(&SensorEvent::Rgbd(frame(stamp(0), 512, 424))).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.mcap");
    let frames = 20;
    let write = min_ms(|| {
        let mut recorder = Recorder::create(&path).unwrap();
        (0..frames).for_each(|_| recorder.record_event(&image).unwrap());
        recorder.finish().unwrap();
    });
    let read = min_ms(|| assert_eq!(RecordingReader::open(&path).unwrap().events().count(), frames));
    let (write, read) = (write / frames as f64, read / frames as f64);
    eprintln!("an image of 512 x 424: record {write:.2} ms, read {read:.2} ms");
    assert!(write < 60.0 && read < 60.0, "an order of magnitude too slow");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_number_loses_a_bit(omega in prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO, nanos in 0..i64::MAX) {
        let event = EncodedEvent::Gyro(GyroRate { stamp: Stamp::from_nanos(nanos), omega });
        let mut recorder = Recorder::new(Cursor::new(Vec::new()), Path::new("a.mcap")).unwrap();
        recorder.record_event(&event).unwrap();
        let back = read(recorder.finish().unwrap().get_ref()).unwrap();
        prop_assert_eq!(back, vec![RecordedMessage::Event(event)]);
    }

    #[test]
    fn damaged_recordings_do_not_panic(at in any::<prop::sample::Index>(), with in any::<[u8; 8]>(), cut in any::<prop::sample::Index>()) {
        let mut bytes = recording();
        let at = at.index(bytes.len() - 8);
        bytes[at..at + 8].copy_from_slice(&with);
        let _ = read(&bytes);
        bytes.truncate(cut.index(bytes.len()));
        let _ = read(&bytes);
    }

    #[test]
    fn random_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = read(&bytes);
        let _ = read(&[&b"\x89MCAP0\r\n"[..], &bytes].concat());
    }
}
