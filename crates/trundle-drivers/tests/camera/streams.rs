//! Streams of frames: written and read, damaged, through FIFOs and pipes, and arbitrary bytes.

use crate::fixtures::{frame, info};
use proptest::prelude::*;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};
use trundle_drivers::camera::pipe::{
    FrameLimits, FrameParser, ProcessCamera, StreamCamera, StreamWriter, header_line, parse_header,
};
use trundle_drivers::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera};

const LONG: Duration = Duration::from_secs(20);

fn stream(info: &CameraInfo, frames: &[CameraFrame]) -> Vec<u8> {
    let mut writer = StreamWriter::new(Vec::new(), info).unwrap();
    frames.iter().for_each(|frame| writer.write(frame).unwrap());
    writer.into_inner()
}

fn frames(count: u8) -> Vec<CameraFrame> {
    (0..count).map(|i| frame(1000 * i as i64, i)).collect()
}

/// All frames up to the end or an error.
fn read_all(camera: &mut StreamCamera) -> (Vec<CameraFrame>, Option<CameraError>) {
    let mut found = Vec::new();
    let started = Instant::now();
    while started.elapsed() < LONG {
        match camera.next_frame(Duration::from_millis(50)) {
            Ok(Some(frame)) => found.push(frame),
            Ok(None) if camera.has_ended() => return (found, None),
            Ok(None) => {}
            Err(error) => return (found, Some(error)),
        }
    }
    panic!("the stream did not end: {} frames", found.len());
}

#[test]
fn a_file_gives_the_frames_written_and_ends() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.trfr");
    std::fs::write(&path, stream(&info(), &frames(5))).unwrap();
    let mut camera = StreamCamera::open(&path, LONG).unwrap();
    assert_eq!(camera.info(), &CameraInfo { is_live: false, ..info() }, "a file is a recording");
    let (found, error) = read_all(&mut camera);
    assert!(error.is_none() && found == frames(5));
    assert_eq!((camera.counts().frames, camera.counts().skipped_bytes), (5, 0));
}

#[test]
#[cfg(unix)]
fn a_process_that_crashes_is_reported_as_a_lost_camera() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.trfr");
    std::fs::write(&path, stream(&info(), &frames(2))).unwrap();
    let mut crashing = std::process::Command::new("sh");
    crashing.args(["-c", "cat \"$0\"; kill -SEGV $$"]).arg(&path);
    let mut camera = ProcessCamera::start(crashing, "crashing", LONG).unwrap();
    for _ in 0..2 {
        assert!(camera.next_frame(LONG).unwrap().is_some());
    }
    assert!(matches!(camera.next_frame(LONG), Err(CameraError::Unplugged { .. })));
}

#[test]
fn a_stream_recovers_after_garbage_and_after_lost_bytes() {
    let (header, frames) = (header_line(&info()).unwrap().len(), frames(4));
    let whole = stream(&info(), &frames);
    let length = (whole.len() - header) / 4;
    let part = |i: usize| &whole[header + i * length..header + (i + 1) * length];
    let garbage = b"TRFTRFR\xff\xff\xff\xff garbage TRF";
    let bytes = [garbage, part(0), &part(1)[30..], part(2), garbage, garbage, part(3)].concat();
    for step in [1, 7, 64, bytes.len()] {
        let mut parser = FrameParser::new(FrameLimits::of(&info()));
        let mut stamps = Vec::new();
        for chunk in bytes.chunks(step) {
            parser.push(chunk);
            stamps.extend(std::iter::from_fn(|| parser.next_frame()).map(|frame| frame.stamp.nanos));
        }
        assert_eq!(stamps, [0, 2000, 3000], "in steps of {step}");
        assert_eq!(parser.counts().skipped_bytes as usize, 3 * garbage.len() + length - 30);
    }
}

#[test]
fn a_reader_may_join_midway_at_a_repeated_header() {
    let bytes = stream(&info(), &frames(70));
    let joined = bytes[5000..].to_vec();
    let mut camera = StreamCamera::from_reader(Box::new(std::io::Cursor::new(joined)), "x", LONG).unwrap();
    let (found, _) = read_all(&mut camera);
    assert_eq!(found, frames(70)[30..], "the first header after the cut comes before frame 30");
    let all =
        read_all(&mut StreamCamera::from_reader(Box::new(std::io::Cursor::new(bytes)), "x", LONG).unwrap());
    assert_eq!(all.0, frames(70), "repeated headers disturb no frame");
}

#[test]
fn either_length_out_of_range_is_not_a_frame() {
    let whole = stream(&info(), &frames(1));
    let good = &whole[header_line(&info()).unwrap().len()..];
    for field in [12, 16] {
        let mut wrong = good.to_vec();
        wrong[field..field + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        let mut parser = FrameParser::new(FrameLimits::of(&info()));
        parser.push(&[&wrong, good].concat());
        let found: Vec<_> = std::iter::from_fn(|| parser.next_frame()).collect();
        assert_eq!(
            (found.len(), parser.counts().skipped_bytes as usize),
            (1, good.len()),
            "field at {field}"
        );
    }
}

#[cfg(unix)]
fn make_fifo(path: &Path) {
    assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn a_fifo_may_be_opened_before_its_writer_and_ends_as_unplugged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera");
    make_fifo(&path);
    let silent = StreamCamera::open(&path, Duration::from_millis(40)).unwrap_err().to_string();
    assert!(silent.contains("none came within 0.0 s"), "{silent}");
    let written = path.clone();
    let writer = std::thread::spawn(move || {
        let file = std::fs::OpenOptions::new().write(true).open(written).unwrap();
        let mut writer = StreamWriter::new(file, &info()).unwrap();
        frames(20).iter().for_each(|frame| writer.write(frame).unwrap());
    });
    let mut camera = StreamCamera::open(&path, LONG).unwrap();
    let (found, error) = read_all(&mut camera);
    writer.join().unwrap();
    assert_eq!(found, frames(20));
    assert!(matches!(error, Some(CameraError::Unplugged { .. })), "{error:?}");
}

#[test]
fn a_pipe_gives_frames_as_they_come_and_times_out_between() {
    let (reader, mut writer) = std::io::pipe().unwrap();
    let bytes = stream(&info(), &frames(2));
    let cut = bytes.len() - 10;
    writer.write_all(&bytes[..cut]).unwrap();
    let mut camera = StreamCamera::from_reader(Box::new(reader), "a pipe", LONG).unwrap();
    assert_eq!(camera.next_frame(LONG).unwrap().as_ref(), Some(&frame(0, 0)));
    assert_eq!(camera.next_frame(Duration::from_millis(20)).unwrap(), None);
    assert!(!camera.has_ended());
    writer.write_all(&bytes[cut..]).unwrap();
    assert_eq!(camera.next_frame(LONG).unwrap(), Some(frame(1000, 1)));
    drop(writer);
    let error = camera.next_frame(LONG).unwrap_err().to_string();
    assert_eq!(error, "the camera a pipe is disconnected: check its cable and its power supply");
}

#[test]
fn headers_that_do_not_suit_name_the_field() {
    let good = header_line(&info()).unwrap();
    assert_eq!(parse_header(good.as_bytes()).unwrap(), info());
    let cases = [
        (r#""version":1"#, r#""version":2"#, "version is 2, expected 1"),
        ("trundle-camera", "other", r#"magic is "other", expected "trundle-camera""#),
        (r#""fx":8.0"#, r#""fx":0.0"#, "fx is 0 px, expected a finite number above 0"),
        (r#""fx":8.0"#, r#""fx":800.0"#, "color.camera.fx is 800 px, expected 2.4 to 24"),
        (r#""format":"rgb8""#, r#""format":"depth16""#, "color.format is depth16, expected a colour format"),
        (r#""depth_unit_m":0.001"#, r#""depth_unit_m":0"#, "depth_unit_m is 0 m"),
        (r#""rate_hz":30.0"#, r#""rate_hz":-1"#, "color.rate_hz is -1 Hz"),
        ("0.0,0.0,0.0,1.0]", "0.0,0.0,0.0,0.0]", "color_from_depth is not a pose"),
        (r#""serial""#, r#""surprise""#, "unknown field `surprise`"),
    ];
    for (from, to, expected) in cases {
        assert!(good.contains(from), "{from} in {good}");
        let error = parse_header(good.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
    let short = StreamCamera::from_reader(Box::new(&b"{\"magic\":"[..]), "x", LONG).unwrap_err().to_string();
    assert!(short.contains("the stream ended before or within it: see docs/camera-stream.md"), "{short}");
    let long = [br#"{"magic":"trundle-camera""#.to_vec(), vec![b' '; 1 << 17]].concat();
    let error = StreamCamera::from_reader(Box::new(std::io::Cursor::new(long)), "x", LONG).unwrap_err();
    assert!(error.to_string().contains("no line ends within 65536 bytes"), "{error}");
}

#[test]
fn the_writer_refuses_frames_of_another_form_and_drops_padding() {
    let mut writer = StreamWriter::new(Vec::new(), &info()).unwrap();
    let mut wrong = frame(0, 0);
    wrong.depth.bytes.pop();
    let error = writer.write(&wrong).unwrap_err().to_string();
    assert!(error.contains("length of the depth image is 31 bytes, expected 32 to 32"), "{error}");
    let mut padded = frame(5, 3);
    padded.color.bytes = padded.color.bytes.chunks(24).flat_map(|row| [row, &[0xee; 8]].concat()).collect();
    padded.color.stride = 32;
    writer.write(&padded).unwrap();
    assert_eq!(writer.into_inner(), stream(&info(), &[frame(5, 3)]));
}

proptest! {
    #[test]
    fn no_bytes_make_the_header_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = parse_header(&bytes);
    }

    #[test]
    fn no_edit_of_a_header_makes_it_panic(at in 0usize..700, with in "[0-9eE.,:\\-\"{}a-z]{0,4}") {
        let mut text = header_line(&info()).unwrap();
        let at = at % text.len();
        text.replace_range(at..(at + with.len()).min(text.len()), &with);
        if let Ok(info) = parse_header(text.as_bytes()) {
            prop_assert!(header_line(&info).is_ok());
        }
    }

    #[test]
    fn no_bytes_make_the_parser_panic_or_hold_more_than_a_frame(
        pieces in prop::collection::vec(
            prop_oneof![
                Just(b"TRFR".to_vec()),
                prop::collection::vec(any::<u8>(), 0..60),
                Just(vec![0; 300]),
                Just(stream(&info(), &frames(1))[header_line(&info()).unwrap().len()..].to_vec()),
            ],
            0..12,
        ),
    ) {
        let mut parser = FrameParser::new(FrameLimits::of(&info()));
        let (mut total, mut found) = (0, 0);
        for piece in &pieces {
            parser.push(piece);
            total += piece.len();
            while let Some(frame) = parser.next_frame() {
                found += 20 + frame.color.len() + frame.depth.len();
            }
            prop_assert!(parser.pending_bytes() < 20 + 144 + 32);
            prop_assert_eq!(total, found + parser.counts().skipped_bytes as usize + parser.pending_bytes());
        }
    }
}
