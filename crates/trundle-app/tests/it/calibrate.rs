//! Calibration of the simulated robot, with wrong values in the robot file.

use crate::body::{run_into, setup};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use trundle_app::RunSetup;
use trundle_app::calibrate::{
    Calibration, CalibrationInput, calibrate_delay, calibrate_mount, calibrate_wheels,
};
use trundle_app::sequence_input::{SequenceInput, SequenceOptions};
use trundle_core::{DepthImage, DifferentialDrive, PinholeCamera, RgbdImage, RobotBody, SensorEvent, Stamp};
use trundle_io::{EncodedEvent, OutputFolder, Recorder, RecordingReader};
use trundle_runtime::settings::RobotFile;
use trundle_runtime::{CameraMount, Mission, RobotConfig, Task};
use trundle_sim::{CommandScript, Scene, SimConfig, Simulator};

/// True pose of the camera's mount.
const MOUNT: CameraMount =
    CameraMount { x: 0.09, y: -0.025, z: 0.48, yaw_deg: 2.5, pitch_deg: 14.0, roll_deg: -1.5 };
/// True delay of the images' stamps, s.
const DELAY_S: f64 = 0.042;
/// True wheels; the robot file has the Kobuki's 0.035 m and 0.230 m.
const DRIVE: DifferentialDrive =
    DifferentialDrive { wheel_radius: 0.0365, wheelbase: 0.238, ..DifferentialDrive::KOBUKI };

/// 0.8 m forward and back, turns on the spot both ways with pauses, 0.8 m forward and a curve back: `t v omega`.
const TURNS_AND_STRAIGHT: &str = "0.5 0.2 0\n4.5 0 0\n5 -0.2 0\n9 0 0\n9.5 0 0.7\n14 0 0\n14.5 0 -0.7\n19 0 0\n19.5 0 -0.7\n\
    23.5 0 0\n24 0 0.7\n28 0 0\n28.5 0.2 0\n32.5 0 0\n33 -0.2 0.2\n36 0 0\n36.5 0 0\n";
/// Turns on the spot both ways: `t v omega`.
const TURNS: &str = "0.5 0 0.7\n3 0 0\n3.5 0 -0.7\n6 0 0\n6.5 0 0.7\n9 0 0\n";
/// Forward only.
const STRAIGHT: &str = "0.5 0.2 0\n4.5 0 0\n";

/// Events of the simulated robot by a script, as a recording with the default robot file: `change` alters or drops each event.
fn record(
    file: &Path,
    config: SimConfig,
    script: &str,
    change: impl FnMut(SensorEvent) -> Option<SensorEvent>,
) {
    record_with(file, &RobotConfig::default(), config, script, change);
}

/// Records with the robot `in_use`.
fn record_with(
    file: &Path,
    in_use: &RobotConfig,
    config: SimConfig,
    script: &str,
    mut change: impl FnMut(SensorEvent) -> Option<SensorEvent>,
) {
    let script = CommandScript::parse(script).unwrap();
    let mut robot = in_use.clone();
    robot.camera = config.camera;
    let mission = Mission::new(vec![Task::Return]).unwrap();
    let setup = RunSetup::new("room", mission, robot);
    let mut recorder = Recorder::create(file).unwrap();
    recorder.record_json("/config", "trundle.Config", Stamp::default(), &setup).unwrap();
    let mut body = Simulator::new(Scene::by_name("room", 1).unwrap(), config, 1).unwrap();
    loop {
        let event = body.next_event().unwrap().unwrap();
        let time = event.stamp() - Stamp::default();
        if time > script.duration() {
            break;
        }
        if matches!(event, SensorEvent::Wheels(_)) {
            body.command(script.at(time)).unwrap();
        }
        if let Some(event) = change(event) {
            recorder.record_event(&EncodedEvent::encode(&event).unwrap()).unwrap();
        }
    }
    assert_eq!(body.contacts(), 0);
    recorder.finish().unwrap();
}

/// The simulated robot with another mount, other wheels and a small image.
fn robot() -> SimConfig {
    let mut config = SimConfig::default();
    config.camera = PinholeCamera::from_field_of_view((320, 264), (1.232, 1.047)).unwrap();
    config.base_from_camera = MOUNT.base_from_camera();
    config.kobuki.drive = DRIVE;
    config
}

/// An image whose stamp is late by the delay.
fn late(event: SensorEvent) -> SensorEvent {
    let SensorEvent::Rgbd(image) = event else { return event };
    let (color, depth) = (image.color().clone(), image.depth().clone());
    SensorEvent::Rgbd(RgbdImage::new(image.stamp().after(DELAY_S), color, depth).unwrap())
}

/// The drive with turns and straight parts, images late; recorded once.
fn late_drive() -> CalibrationInput {
    static FILE: OnceLock<PathBuf> = OnceLock::new();
    let file = FILE.get_or_init(|| recorded("calibrate-late.mcap", |event| Some(late(event))));
    CalibrationInput::open(file, false).unwrap()
}

/// The drive with images on time.
fn drive_on_time() -> CalibrationInput {
    static FILE: OnceLock<PathBuf> = OnceLock::new();
    let file = FILE.get_or_init(|| recorded("calibrate-on-time.mcap", Some));
    CalibrationInput::open(file, false).unwrap()
}

/// Records the drive into a file of the build folder: a temporary folder of a static is never removed.
fn recorded(name: &str, change: impl Fn(SensorEvent) -> Option<SensorEvent>) -> PathBuf {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    record(&file, robot(), TURNS_AND_STRAIGHT, change);
    file
}

/// Asserts that the error of the calibrated value is within `limit`, and its standard deviation too.
#[track_caller]
fn assert_found(calibration: &Calibration, name: &str, truth: f64, limit: f64) {
    let found = calibration.value(name).unwrap_or_else(|| panic!("{name}: {calibration:?}"));
    let sigma = found.sigma.unwrap();
    // Read by `cargo xtask results --measure calibration`.
    let error = (found.value - truth).abs();
    println!(
        "error of {name}: {error:.6} {}\nrelative error of {name}: {:.4} %",
        found.unit,
        100.0 * error / truth.abs()
    );
    assert!(error <= limit, "{found:?}, truth {truth}");
    assert!(sigma > 0.0 && sigma <= limit, "{found:?}");
}

#[test]
fn the_delay_is_found_within_3_ms_and_written() {
    let found = calibrate_delay(&late_drive(), &()).unwrap();
    assert_found(&found, "image_delay_s", DELAY_S, 0.003);
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("robot.toml");
    std::fs::write(&file, "# mine\n[mount]\nz_m = 0.6\n").unwrap();
    found.write(&file).unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    let robot = RobotFile::parse(&text, &[]).unwrap().config;
    assert!((robot.image_delay - DELAY_S).abs() < 0.003 && robot.mount.z == 0.6, "{text}");
    assert!(text.contains("# mine"), "{text}");
}

#[test]
fn a_delay_in_use_is_subtracted_from_the_images_and_part_of_the_delay_that_is_found() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("recording.mcap");
    let mut in_use = RobotConfig::default();
    in_use.image_delay = 0.03;
    let mut first = None;
    let keep_first = |event| {
        let event = late(event);
        if let SensorEvent::Rgbd(image) = &event {
            first.get_or_insert(image.stamp());
        }
        Some(event)
    };
    record_with(&file, &in_use, robot(), TURNS, keep_first);
    let options = SequenceOptions::new(&file);
    let images = SequenceInput::open(&options).unwrap();
    let stamp = images.frames().unwrap().next().unwrap().unwrap().stamp();
    assert!((first.unwrap() - stamp - 0.03).abs() < 1e-9);
    let found = calibrate_delay(&CalibrationInput::open(&file, false).unwrap(), &()).unwrap();
    assert_found(&found, "image_delay_s", DELAY_S, 0.003);
    assert_eq!(found.value("image_delay_s").unwrap().before, Some(0.03));
}

#[test]
fn a_run_subtracts_the_delay_and_its_recording_keeps_the_stamps() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&scratch.path().join("run")).unwrap();
    let mut setup = setup().with_time_limit(0.3);
    setup.robot.image_delay = 0.01;
    setup.robot.camera = robot().camera;
    let mut body = Simulator::new(Scene::by_name("room", 1).unwrap(), robot(), 1).unwrap();
    let run = run_into(&setup, &mut body, &folder).unwrap();
    let (stamp, _) = run.robot.slam().unwrap().trajectory()[0];
    assert_eq!(stamp, Stamp::default().after(-0.01));
    let reader = RecordingReader::open(&folder.commit().unwrap().join("recording.mcap")).unwrap();
    let is_image = |event: &EncodedEvent| matches!(event, EncodedEvent::Rgbd(_));
    let first = reader.events().map(Result::unwrap).find(is_image).unwrap();
    assert_eq!(first.stamp(), Stamp::default());
}

#[test]
fn the_mount_is_found_within_3_mm_and_a_fifth_of_a_degree() {
    let found = calibrate_mount(&drive_on_time(), &()).unwrap();
    assert_found(&found, "mount.z_m", MOUNT.z, 0.003);
    assert_found(&found, "mount.pitch_deg", MOUNT.pitch_deg, 0.2);
    assert_found(&found, "mount.roll_deg", MOUNT.roll_deg, 0.2);
    assert_found(&found, "mount.x_m", MOUNT.x, 0.003);
    assert_found(&found, "mount.y_m", MOUNT.y, 0.003);
    assert_found(&found, "mount.yaw_deg", MOUNT.yaw_deg, 0.2);
}

#[test]
fn the_wheels_are_found_within_one_percent() {
    let found = calibrate_wheels(&drive_on_time(), &()).unwrap();
    let scene = Scene::by_name("room", 1).unwrap();
    let truth = Simulator::new(scene, robot(), 1).unwrap().true_wheels();
    let radius = (truth.left_radius + truth.right_radius) / 2.0;
    assert_found(&found, "drive.wheel_radius_m", radius, 0.01 * radius);
    assert_found(&found, "drive.wheelbase_m", truth.wheelbase, 0.01 * truth.wheelbase);
    assert_found(&found, "radius of the left wheel", truth.left_radius, 0.01 * truth.left_radius);
    assert_found(&found, "radius of the right wheel", truth.right_radius, 0.01 * truth.right_radius);
    // The gyro's scale is off by 0.3 % (one sigma) in the simulator.
    assert_found(&found, "gyro, true over measured rate", 1.0, 0.01);
}

#[test]
fn a_drive_without_turns_is_refused_or_leaves_the_offset_open() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("recording.mcap");
    record(&file, robot(), STRAIGHT, Some);
    let input = CalibrationInput::open(&file, false).unwrap();
    for refused in [calibrate_delay(&input, &()), calibrate_wheels(&input, &())] {
        let error = refused.unwrap_err().to_string();
        assert!(error.contains("recording.mcap: the turn of the camera cannot be observed"), "{error}");
        assert!(error.contains("turn the robot on the spot"), "{error}");
    }
    let mount = calibrate_mount(&input, &()).unwrap();
    assert!(mount.value("mount.z_m").is_some() && mount.value("mount.x_m").is_none(), "{mount:?}");
    assert!(mount.notes.iter().any(|note| note.starts_with("not found: mount.x_m")), "{mount:?}");
}

#[test]
fn missing_sensors_are_named() {
    let scratch = tempfile::tempdir().unwrap();
    let turn = "0.5 0 0.7\n4 0 0\n4.5 0 -0.7\n8 0 0\n";
    let file = scratch.path().join("recording.mcap");
    record(&file, robot(), turn, |event| (!matches!(event, SensorEvent::Gyro(_))).then_some(event));
    let input = CalibrationInput::open(&file, false).unwrap();
    let error = calibrate_delay(&input, &()).unwrap_err().to_string();
    assert!(error.contains("the gyro: 0 readings"), "{error}");
    record(&file, robot(), turn, |event| (!matches!(event, SensorEvent::Wheels(_))).then_some(event));
    let input = CalibrationInput::open(&file, false).unwrap();
    let error = calibrate_wheels(&input, &()).unwrap_err().to_string();
    assert!(error.contains("segments with motion of camera and wheels: 0 readings"), "{error}");
}

#[test]
fn an_image_without_depth_shows_no_floor() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("recording.mcap");
    let blind = |event| {
        let SensorEvent::Rgbd(image) = event else { return Some(event) };
        let (width, height) = (image.color().width(), image.color().height());
        let depth = DepthImage::filled(width, height, 0.0);
        Some(SensorEvent::Rgbd(RgbdImage::new(image.stamp(), image.color().clone(), depth).unwrap()))
    };
    record(&file, robot(), STRAIGHT, blind);
    let error = calibrate_mount(&CalibrationInput::open(&file, false).unwrap(), &()).map(drop).unwrap_err();
    assert!(error.to_string().contains("expected 5 or more: no image has depth"), "{error}");
}

#[test]
fn a_folder_is_refused_with_what_to_record() {
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("rgb.txt"), "").unwrap();
    let error = CalibrationInput::open(scratch.path(), false).map(drop).unwrap_err().to_string();
    assert!(error.contains("--record all") || error.contains("neither"), "{error}");
}
