//! The camera thread: conversion, the newest frame wins, silence, unplugging, stuck frames, and recordings.

use crate::fixtures::{frame, info};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use trundle_core::{BodyEventKind, Device, Invalid, SensorEvent, Stamp};
use trundle_drivers::camera::camera_thread::{StampMapFactory, arrival_minus_delay, default_stamps};
use trundle_drivers::camera::pipe::{StreamCamera, StreamWriter};
use trundle_drivers::camera::{
    CameraError, CameraFrame, CameraInfo, CameraThread, CameraThreadConfig, CameraThreadParts, DepthCamera,
};

/// Answer of a scripted camera to one call.
enum Act {
    Frame(i64, u8),
    BadDepth(i64),
    Broken,
    Silence,
    Unplug,
    Panic,
}

/// A camera that follows a script, then is silent or ends.
struct ScriptedCamera {
    info: CameraInfo,
    script: VecDeque<Act>,
}

impl DepthCamera for ScriptedCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        match self.script.pop_front() {
            Some(Act::Frame(stamp, seed)) => Ok(Some(frame(stamp, seed))),
            Some(Act::BadDepth(stamp)) => {
                let mut frame = frame(stamp, stamp as u8);
                frame.depth.bytes.pop();
                Ok(Some(frame))
            }
            Some(Act::Broken) => Err(Invalid::new("test frame", 1, "bytes", "more").into()),
            Some(Act::Unplug) => Err(CameraError::Unplugged { device: "test".into() }),
            Some(Act::Panic) => panic!("a test driver panics on purpose"),
            Some(Act::Silence) | None if self.has_ended() => Ok(None),
            Some(Act::Silence) | None => {
                std::thread::sleep(timeout.min(Duration::from_millis(5)));
                Ok(None)
            }
        }
    }

    fn has_ended(&self) -> bool {
        !self.info.is_live && self.script.is_empty()
    }
}

type Events = Arc<Mutex<Vec<SensorEvent>>>;

/// A thread with cameras that are opened one after the other; `None` fails to open. After the last one, every opening fails.
struct Rig {
    events: Events,
    thread: CameraThread,
}

impl Rig {
    fn new(cameras: Vec<Option<Vec<Act>>>, info: CameraInfo, config: CameraThreadConfig) -> Self {
        Self::with_work(cameras, info, config, Duration::ZERO)
    }

    /// `work` is the time that the sink takes for an image.
    fn with_work(
        cameras: Vec<Option<Vec<Act>>>,
        info: CameraInfo,
        config: CameraThreadConfig,
        work: Duration,
    ) -> Self {
        let mut cameras = VecDeque::from(cameras);
        let factory = move || match cameras.pop_front().flatten() {
            Some(script) => Ok(Box::new(ScriptedCamera { info: info.clone(), script: script.into() })
                as Box<dyn DepthCamera>),
            None => Err(CameraError::NoDevice { kind: "test".into() }),
        };
        let events = Events::default();
        let seen = events.clone();
        let sink = move |event: SensorEvent| {
            if matches!(event, SensorEvent::Rgbd(_)) {
                std::thread::sleep(work);
            }
            seen.lock().unwrap().push(event);
        };
        let parts = CameraThreadParts {
            factory: Box::new(factory),
            sink: Box::new(sink),
            clock: clock(),
            stamps: device_stamps(),
        };
        Self { events, thread: CameraThread::start(parts, config.checked().unwrap()).unwrap() }
    }

    /// Waits until `is_reached`, at most 20 s.
    fn wait(&self, what: &str, is_reached: impl Fn(&Self) -> bool) {
        let started = Instant::now();
        while !is_reached(self) {
            let report = || (self.thread.counters(), self.thread.last_fault(), self.story());
            assert!(started.elapsed() < Duration::from_secs(20), "{what}: {:?}", report());
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Events as text: stamps of images, and `up` and `down`.
    fn story(&self) -> Vec<String> {
        let text = |event: &SensorEvent| match event {
            SensorEvent::Rgbd(image) => image.stamp().nanos.to_string(),
            SensorEvent::Body(event) => match event.kind {
                BodyEventKind::Link(link) if link.device == Device::Camera => {
                    if link.is_up {
                        "up".into()
                    } else {
                        "down".into()
                    }
                }
                other => panic!("{other:?}"),
            },
            other => panic!("{other:?}"),
        };
        self.events.lock().unwrap().iter().map(text).collect()
    }
}

/// Keeps the camera's stamps.
fn device_stamps() -> StampMapFactory {
    Box::new(|_| Box::new(|device, _| device))
}

fn quick() -> CameraThreadConfig {
    let mut config = CameraThreadConfig::default();
    config.max_silence_s = 1.0;
    config.min_reopen_wait_s = 0.005;
    config.max_reopen_wait_s = 0.02;
    config
}

fn recording() -> CameraInfo {
    CameraInfo { is_live: false, ..info() }
}

#[test]
fn every_frame_of_a_recording_is_converted_and_registered() {
    let script = (0..40).map(|i| Act::Frame(i, i as u8)).collect();
    let rig = Rig::with_work(vec![Some(script)], recording(), quick(), Duration::from_millis(2));
    rig.wait("end", |rig| rig.thread.has_ended());
    let expected: Vec<String> = std::iter::once("up".into()).chain((0..40).map(|i| i.to_string())).collect();
    assert_eq!(rig.story(), expected);
    let counters = rig.thread.counters();
    assert_eq!((counters.frames, counters.dropped, counters.broken, counters.lost), (40, 0, 0, 0));
    let events = rig.events.lock().unwrap();
    let SensorEvent::Rgbd(image) = &events[1] else { panic!("no image") };
    assert_eq!((image.color().width(), image.depth().width()), (8, 8), "depth has the size of colour");
    assert_eq!(image.color().data()[1], [21, 28, 35]);
    assert!(image.depth().data().iter().any(|depth| (depth - 1.05).abs() < 0.06));
}

#[test]
fn the_newest_frame_wins_when_the_sink_is_slow() {
    let script = (0..200).map(|i| Act::Frame(i, i as u8)).collect();
    let rig =
        Rig::with_work(vec![Some(script)], info(), CameraThreadConfig::default(), Duration::from_millis(30));
    rig.wait("the last frame", |rig| rig.story().last().is_some_and(|last| last == "199"));
    let counters = rig.thread.counters();
    assert_eq!(counters.frames + counters.dropped, 200);
    assert!(counters.dropped > 0 && counters.frames >= 1, "{counters:?}");
}

#[test]
fn a_silent_camera_is_lost_and_opened_anew() {
    let first = vec![Act::Frame(1, 1), Act::Silence];
    let second = vec![Act::Frame(2, 2)];
    let rig = Rig::new(vec![Some(first), None, None, Some(second)], info(), quick());
    rig.wait("the second camera", |rig| rig.story().contains(&"2".into()));
    assert_eq!(rig.story()[..5], ["up", "1", "down", "up", "2"]);
    assert!(rig.thread.counters().lost >= 3, "one silence, two attempts");
    rig.wait("the loss of the second camera", |rig| !rig.thread.is_up());
    rig.wait("an attempt", |rig| rig.thread.last_fault().unwrap().contains("no camera of kind test"));
}

#[test]
fn silence_is_named_with_its_length() {
    let mut config = quick();
    config.min_reopen_wait_s = 30.0;
    config.max_reopen_wait_s = 30.0;
    let rig = Rig::new(vec![Some(vec![Act::Frame(1, 1)])], info(), config);
    rig.wait("loss", |rig| rig.thread.counters().lost == 1);
    let fault = rig.thread.last_fault().unwrap();
    assert!(fault.starts_with("test camera delivered no good frame for 1."), "{fault}");
    assert_eq!(rig.story(), ["up", "1", "down"]);
    let started = Instant::now();
    drop(rig);
    assert!(
        started.elapsed() < Duration::from_secs(10),
        "the wait for the next attempt ends with the thread"
    );
}

#[test]
fn unplugging_is_reported_at_once() {
    let mut config = quick();
    config.max_silence_s = 60.0;
    let first = vec![Act::Frame(1, 1), Act::Silence, Act::Silence, Act::Silence, Act::Unplug];
    let rig = Rig::new(vec![Some(first), Some(vec![Act::Frame(9, 9)])], info(), config);
    rig.wait("the second camera", |rig| rig.story().contains(&"9".into()));
    let story = rig.story();
    assert_eq!(story[story.len() - 3..], ["down", "up", "9"]);
}

#[test]
fn a_driver_that_panics_is_a_lost_camera() {
    let cameras = vec![Some(vec![Act::Panic]), Some(vec![Act::Frame(5, 5)])];
    let rig = Rig::new(cameras, info(), quick());
    rig.wait("the second camera", |rig| rig.story().contains(&"5".into()));
    assert_eq!(rig.story()[..3], ["down", "up", "5"]);
}

#[test]
fn no_frame_of_a_lost_camera_follows_its_loss() {
    let script =
        |camera: i64| Some(vec![Act::Frame(camera * 10 + 1, 1), Act::Frame(camera * 10 + 2, 2), Act::Unplug]);
    let mut config = quick();
    config.max_silence_s = 60.0;
    let rig = Rig::with_work((0..40).map(script).collect(), info(), config, Duration::from_millis(3));
    rig.wait("all cameras", |rig| rig.thread.counters().lost > 40);
    let (mut next_camera, mut is_up) = (0, false);
    for event in rig.story() {
        match event.as_str() {
            "up" => is_up = true,
            "down" => is_up = false,
            stamp => {
                let camera = stamp.parse::<i64>().unwrap() / 10;
                assert!(is_up && camera >= next_camera, "{stamp}: {:?}", rig.story());
                next_camera = camera;
            }
        }
        if event == "down" {
            next_camera += 1;
        }
    }
    assert!(!rig.thread.is_up());
}

#[test]
fn a_camera_that_cannot_be_opened_is_down_once() {
    let rig = Rig::new(vec![], info(), quick());
    rig.wait("attempts", |rig| rig.thread.counters().lost >= 4);
    assert_eq!(rig.story(), ["down"]);
}

#[test]
fn a_stuck_camera_is_counted_and_opened_anew() {
    let stuck = (0..40).map(|i| Act::Frame(i, 7)).collect();
    let rig = Rig::new(vec![Some(stuck), Some(vec![Act::Frame(100, 1)])], info(), quick());
    rig.wait("the second camera", |rig| rig.story().contains(&"100".into()));
    assert_eq!(rig.thread.counters().stuck, 1);
    let mut rendered = quick();
    rendered.expects_noise = false;
    let same = (0..40).map(|i| Act::Frame(i, 7)).collect();
    let rig = Rig::new(vec![Some(same)], info(), rendered);
    rig.wait("the last frame", |rig| rig.story().contains(&"39".into()));
    assert_eq!(rig.thread.counters().stuck, 0);
}

#[test]
fn broken_frames_are_counted_and_the_camera_stays_open() {
    let script = vec![Act::Frame(1, 1), Act::Broken, Act::BadDepth(2), Act::Silence, Act::Frame(3, 3)];
    let rig = Rig::new(vec![Some(script)], recording(), quick());
    rig.wait("end", |rig| rig.thread.has_ended());
    assert_eq!(rig.story(), ["up", "1", "3"]);
    assert_eq!(rig.thread.counters().broken, 2);
    let fault = rig.thread.last_fault().unwrap();
    assert!(fault.contains("length of a depth16 image is 31 bytes"), "{fault}");
}

#[test]
fn a_camera_with_only_broken_frames_is_lost() {
    let broken = std::iter::repeat_with(|| Act::Broken).take(100_000).collect();
    let rig = Rig::new(vec![Some(broken)], info(), quick());
    rig.wait("loss", |rig| rig.thread.counters().lost >= 1);
    assert_eq!(rig.story(), ["down"]);
    assert!(rig.thread.counters().broken >= 30);
}

/// The time since the call.
fn clock() -> Arc<dyn Fn() -> Stamp + Send + Sync> {
    let start = Instant::now();
    Arc::new(move || Stamp::default().after(start.elapsed().as_secs_f64()))
}

/// The end of a writer is the loss of the camera; a new writer of the same FIFO restores it, as does the end of a pause.
#[cfg(unix)]
#[test]
fn a_fifo_is_opened_anew_after_its_writer_ended_or_paused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera");
    assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    let (opened, events) = (path.clone(), Events::default());
    let seen = events.clone();
    let parts = CameraThreadParts {
        factory: Box::new(move || {
            let camera = StreamCamera::open(&opened, Duration::from_millis(500))?;
            Ok(Box::new(camera) as Box<dyn DepthCamera>)
        }),
        sink: Box::new(move |event| seen.lock().unwrap().push(event)),
        clock: clock(),
        stamps: device_stamps(),
    };
    let rig = Rig { events, thread: CameraThread::start(parts, quick()).unwrap() };
    let open = || StreamWriter::new(std::fs::OpenOptions::new().write(true).open(&path).unwrap(), &info());
    let first = Instant::now();
    let mut stamp = 0;
    // Frames are repeated until one arrives: the first may go to a reader that is ending.
    let mut write_until_up = |writer: &mut StreamWriter<std::fs::File>| {
        while !rig.thread.is_up() {
            assert!(first.elapsed() < Duration::from_secs(60), "{:?}", rig.thread.last_fault());
            stamp += 1;
            let _ = writer.write(&frame(stamp, stamp as u8));
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    let mut writer = open().unwrap();
    write_until_up(&mut writer);
    drop(writer);
    rig.wait("the loss of the writer", |rig| !rig.thread.is_up());
    let mut writer = loop {
        if let Ok(writer) = open() {
            break writer;
        }
    };
    write_until_up(&mut writer);
    rig.wait("the pause of the writer", |rig| !rig.thread.is_up());
    write_until_up(&mut writer);
    let links: Vec<String> = rig.story().into_iter().filter(|text| text == "up" || text == "down").collect();
    let is_alternating = links.windows(2).all(|pair| pair[0] != pair[1]);
    assert!(is_alternating && links.iter().filter(|text| *text == "up").count() >= 3, "{links:?}");
}

#[test]
fn a_recording_keeps_its_stamps() {
    assert_eq!(default_stamps(&recording())(Stamp::from_nanos(7), Stamp::from_nanos(100)).nanos, 7);
    let live = default_stamps(&info())(Stamp::from_nanos(7), Stamp::from_nanos(100_000_000));
    assert_eq!(live.nanos, 80_000_000);
}

#[test]
fn the_simplest_stamp_is_the_arrival_minus_the_delay() {
    let mut map = arrival_minus_delay(&info());
    assert_eq!(map(Stamp::from_nanos(77), Stamp::from_nanos(1_000_000_000)).nanos, 980_000_000);
}
