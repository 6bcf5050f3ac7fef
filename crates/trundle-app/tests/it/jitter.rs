//! Events that arrive out of order, on their way from drivers into a run in real time.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::{Duration, Instant};
use trundle_app::real_time::{
    DeviceReport, EventFeed, EventOrderCounts, LiveBody, RealTimeReport, run_in_real_time,
};
use trundle_app::{FinishedRun, Progress, RunLog, RunSetup};
use trundle_core::{DifferentialDrive, GyroRate, SensorEvent, Stamp, WheelTicks};
use trundle_io::{EncodedEvent, OutputFolder, RecordedMessage, RecordingReader};
use trundle_runtime::{Mission, RobotConfig};

/// Length of the drive \[ms\]. Source: ours.
const DRIVE_MS: i64 = 4000;
/// Largest delay of an event \[ms\]. Source: the requirement, 50 ms of jitter.
const JITTER_MS: i64 = 50;
/// Speed of the base \[m/s\]. Source: ours.
const SPEED: f64 = 0.3;

fn ms(time: i64) -> Stamp {
    Stamp::from_nanos(time * 1_000_000)
}

/// Turn rate and heading of the base at a time \[ms\]: it swings.
fn swing(time: i64) -> (f64, f64) {
    let t = time as f64 * 1e-3;
    ((4.0 * t).sin(), (1.0 - (4.0 * t).cos()) / 4.0)
}

/// Readings of the gyro every 10 ms and of the wheels every 20 ms, by their stamps \[ms\].
fn readings() -> Vec<(i64, SensorEvent)> {
    let drive = DifferentialDrive::KOBUKI;
    let ticks = |metres: f64| (metres / drive.metres_per_tick()).round() as i64 as u16;
    let reading = |i: i64| {
        let time = i * 10;
        let (omega, heading) = swing(time);
        let (path, half) = (SPEED * time as f64 * 1e-3, drive.wheelbase / 2.0 * heading);
        let wheels = WheelTicks { stamp: ms(time), left: ticks(path - half), right: ticks(path + half) };
        let gyro = SensorEvent::Gyro(GyroRate { stamp: ms(time), omega });
        [Some(gyro), (i % 2 == 0).then_some(SensorEvent::Wheels(wheels))]
    };
    (0..DRIVE_MS / 10)
        .flat_map(|i| reading(i).into_iter().flatten().map(move |event| (i * 10, event)))
        .collect()
}

/// The readings in the order of their arrival, each delayed by up to `jitter` ms.
fn arrivals(jitter: i64) -> Vec<(i64, SensorEvent)> {
    let mut state = 7_u32;
    let mut delayed: Vec<_> = readings()
        .into_iter()
        .map(|(stamp, event)| {
            // A linear congruential generator.
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (stamp + i64::from(state >> 16) * jitter / 65_536, event)
        })
        .collect();
    delayed.sort_by_key(|(arrival, _)| *arrival);
    delayed
}

/// A run on events that arrive with `jitter` ms, at the times of a clock that goes from one arrival to the next.
fn run(jitter: i64, folder: &Path) -> (FinishedRun, RealTimeReport, Vec<Stamp>) {
    let mut setup = RunSetup::new("nowhere", Mission::default(), RobotConfig::default());
    setup = setup.operated().with_time_limit((DRIVE_MS - 200) as f64 * 1e-3);
    setup.real_time = true;
    let out = OutputFolder::create(folder).unwrap();
    let start = move |events, _| {
        let time = Arc::<AtomicI64>::default();
        let clock = Arc::clone(&time);
        let feed =
            EventFeed::with_clock(events, Instant::now(), Arc::new(move || ms(clock.load(Ordering::SeqCst))));
        let sink = feed.clone();
        let driver = std::thread::spawn(move || {
            for (arrival, event) in arrivals(jitter) {
                time.store(arrival, Ordering::SeqCst);
                sink.send(&event);
                std::thread::sleep(Duration::from_micros(300));
            }
        });
        LiveBody::start(feed, None, move || {
            driver.join().unwrap();
            DeviceReport::default()
        })
    };
    let (run, report) =
        run_in_real_time(&setup, start, &out, None, RunLog::default(), Progress::hidden()).unwrap();
    let file = out.commit().unwrap().join("recording.mcap");
    let motion = |event: EncodedEvent| {
        matches!(event, EncodedEvent::Wheels(_) | EncodedEvent::Gyro(_)).then(|| event.stamp())
    };
    let mut reader = RecordingReader::open(&file).unwrap();
    let messages = std::iter::from_fn(|| reader.next_message().unwrap());
    let stamps = messages.filter_map(|message| match message {
        RecordedMessage::Event(event) => motion(event),
        RecordedMessage::Json { .. } => None,
    });
    (run, report, stamps.collect())
}

#[test]
fn readings_with_50_ms_of_jitter_reach_the_robot_in_order_and_nearly_all() {
    let scratch = tempfile::tempdir().unwrap();
    let (run, report, stamps) = run(JITTER_MS, &scratch.path().join("run"));
    let EventOrderCounts { reordered, late, .. } = report.body.order;
    println!("{} readings used, {reordered} put in order, {late} too late", stamps.len());
    assert!(stamps.is_sorted(), "the robot gets readings by rising stamps");
    // The hold grows with the ages of the first overtaken readings, some of which are late.
    assert!(reordered > 200 && (1..=8).contains(&late), "{reordered} put in order, {late} too late");
    let last = *stamps.last().unwrap();
    let sent = readings().into_iter().filter(|(stamp, _)| ms(*stamp) <= last && *stamp >= 1000).count();
    let used = stamps.iter().filter(|stamp| **stamp >= ms(1000)).count();
    assert_eq!(used, sent, "from 1 s on none is lost");
    let rows = report.rows();
    let row = rows.iter().find(|row| row[0] == "events put in order, too late").unwrap();
    assert_eq!(row[1], format!("{reordered}, {late}"));
    assert_heading(&run);
}

#[test]
fn readings_in_order_are_neither_held_nor_counted() {
    let scratch = tempfile::tempdir().unwrap();
    let (run, report, stamps) = run(0, &scratch.path().join("run"));
    assert_eq!((report.body.order.reordered, report.body.order.late), (0, 0));
    let last = *stamps.last().unwrap();
    assert_eq!(stamps.len(), readings().iter().filter(|(stamp, _)| ms(*stamp) <= last).count());
    assert_heading(&run);
}

/// The heading by gyro and wheels is that of the swinging base.
fn assert_heading(run: &FinishedRun) {
    let estimate = run.robot.estimate();
    let (_, heading) = swing(estimate.stamp.nanos / 1_000_000);
    let error = estimate.pose.theta - heading;
    println!("heading off by {error:.4} rad at {} s", estimate.stamp);
    assert!(error.abs() < 0.01, "{error} rad off at {} s", estimate.stamp);
}
