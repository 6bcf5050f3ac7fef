//! Recordings of runs as inputs of SLAM and of mapping, whole and cut.

use crate::body::{run_into, setup, stamp};
use std::path::{Path, PathBuf};
use trundle_app::RecordingContent;
use trundle_app::laser_map::{LaserMapRequest, map_log, read_log};
use trundle_app::sequence::{FirstCamera, SequenceRequest, track_sequence};
use trundle_app::sequence_input::{RecordedRun, SequenceInput, SequenceOptions};
use trundle_core::{Beam, GyroRate, Pose2, RgbdImage, Scan, Stamp, Vector2, WheelTicks};
use trundle_io::{EncodedEvent, LaserLogOptions, MapImage, OutputFolder, RosSequenceOptions};
use trundle_sim::{Scene, SimConfig, Simulator};

/// A second and a half of the simulated robot, recorded with images.
fn recording(scratch: &Path) -> PathBuf {
    let mut body = Simulator::new(Scene::by_name("demo", 1).unwrap(), SimConfig::default(), 1).unwrap();
    let folder = OutputFolder::create(&scratch.join("live")).unwrap();
    let setup = setup().with_time_limit(1.5);
    run_into(&setup, &mut body, &folder).unwrap();
    folder.commit().unwrap().join("recording.mcap")
}

fn options(path: &Path, recover: bool) -> SequenceOptions<'_> {
    let mut options = SequenceOptions::new(path);
    options.recover = recover;
    options
}

fn request(path: &Path) -> SequenceRequest {
    SequenceRequest {
        topics: RosSequenceOptions::default(),
        path: path.to_owned(),
        camera: None,
        depth_scale: None,
        frames: None,
        recover: false,
        first_camera: FirstCamera::default(),
        map: None,
        localize_only: false,
        vocabulary: None,
        seed: 1,
        map_image: MapImage::Pgm,
        visual_only: false,
        record: RecordingContent::All,
        robot: None,
    }
}

fn map_request(log: &Path, recover: bool) -> LaserMapRequest {
    LaserMapRequest {
        topics: RosSequenceOptions::default(),
        log: log.to_owned(),
        recover,
        poses: None,
        poses_drift: false,
        particles: 2,
        seed: 1,
        resolution: 0.05,
        laser: LaserLogOptions::default(),
        map: None,
        deskew: true,
        map_image: MapImage::Pgm,
    }
}

fn images(input: &SequenceInput) -> Vec<RgbdImage> {
    input.frames().unwrap().map(|frame| frame.unwrap().decode().unwrap()).collect()
}

#[test]
fn slam_tracks_the_images_of_a_recording_with_its_wheels_and_its_camera() {
    let scratch = tempfile::tempdir().unwrap();
    let request = request(&recording(scratch.path()));
    let input = request.open().unwrap();
    assert!(input.len() > 15 && input.camera.model.camera == input.robot.camera);
    let folder = OutputFolder::create(&scratch.path().join("slam")).unwrap();
    let run = track_sequence(&request, &input, &folder, &(), None).unwrap();
    assert_eq!(run.failure(), None);
    assert_eq!((run.counts.ok, run.odometry_priors()), (input.len(), input.len() - 1));
    let (_, first) = run.slam.trajectory()[0];
    let mount = input.robot.mount.base_from_camera();
    assert!((first.translation - mount.translation).norm() < 1e-9, "the robot's mount is the first pose");
    let (stamp, last) = *run.slam.trajectory().last().unwrap();
    let truth = input.ground_truth().unwrap();
    let at = |stamp: Stamp| truth.iter().min_by_key(|(t, _)| (*t - stamp).abs().to_bits()).unwrap().1;
    let moved = at(run.slam.trajectory()[0].0).inverse() * at(stamp);
    assert!(((first.inverse() * last).translation - moved.translation).norm() < 0.01);
}

#[test]
fn the_depth_images_of_a_recording_make_a_map() {
    let scratch = tempfile::tempdir().unwrap();
    let request = map_request(&recording(scratch.path()), false);
    let mut input = read_log(&request, &()).unwrap();
    assert!(input.depth.as_ref().is_some_and(|depth| depth.by_wheels) && input.log.scans.len() > 5);
    let folder = OutputFolder::create(&scratch.path().join("map")).unwrap();
    let run = map_log(&request, false, &mut input, &folder, &(), None).unwrap();
    assert_eq!(run.failure, None);
}

/// Cuts at many places of the file: all data before the cut is read, and no other data.
#[test]
fn a_cut_recording_is_read_up_to_the_cut() {
    let scratch = tempfile::tempdir().unwrap();
    let whole_file = recording(scratch.path());
    let bytes = std::fs::read(&whole_file).unwrap();
    let whole = SequenceInput::open(&options(&whole_file, false)).unwrap();
    let (all, odometry) = (images(&whole), whole.odometry().unwrap());
    let cut_file = scratch.path().join("cut.mcap");
    let mut last_count = 0;
    for part in 0..40 {
        let byte = bytes.len() * part / 40 + part; // not at multiples of anything
        std::fs::write(&cut_file, &bytes[..byte]).unwrap();
        let Ok(cut) = SequenceInput::open(&options(&cut_file, true)) else {
            assert!(last_count == 0, "byte {byte}: fewer images than of a shorter file");
            continue;
        };
        let found = images(&cut);
        assert_eq!(found, all[..found.len()], "byte {byte}");
        assert_eq!(cut.odometry().unwrap_or_default(), &odometry[..cut.odometry().map_or(0, <[_]>::len)]);
        assert!(found.len() >= last_count && cut.cut_report().unwrap().contains(&format!("byte {byte};")));
        last_count = found.len();
        let refusal = SequenceInput::open(&options(&cut_file, false)).err().unwrap().to_string();
        assert!(refusal.contains("truncated") && refusal.contains("--recover"), "{refusal}");
    }
    // The data lost by a cut is the unflushed part, about 1 MB.
    assert!(last_count + 6 >= all.len(), "{last_count} of {} images before the last cut", all.len());
}

#[test]
fn the_scans_of_a_recorded_laser_make_a_log() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&scratch.path().join("laser")).unwrap();
    let mut recorder = folder.recorder("recording.mcap").unwrap();
    let config = serde_json::to_value(setup()).unwrap();
    recorder.record_json("/config", "trundle.Config", Stamp::default(), &config).unwrap();
    for i in 0..100 {
        let (stamp, ticks) = (stamp(i), u16::try_from(i).unwrap() * 40);
        recorder.record_event(&EncodedEvent::Gyro(GyroRate { stamp, omega: 0.0 })).unwrap();
        recorder
            .record_event(&EncodedEvent::Wheels(WheelTicks { stamp, left: ticks, right: ticks }))
            .unwrap();
        if i % 5 == 0 {
            let beams = vec![Beam::Hit { range: 2.0 }; 181];
            let scan = Scan::new(stamp, Vector2::zeros(), -1.5, 3.0 / 180.0, beams).unwrap();
            recorder.record_event(&EncodedEvent::Scan(scan)).unwrap();
        }
    }
    recorder.finish().unwrap();
    let file = folder.commit().unwrap().join("recording.mcap");
    let input = read_log(&map_request(&file, false), &()).unwrap();
    assert!(input.depth.is_none());
    let (first, last) = (&input.log.scans[0], input.log.scans.last().unwrap());
    let offset = last.odom_from_base.position() - first.odom_from_base.position();
    assert!((offset - Vector2::new(offset.norm(), 0.0)).norm() < 1e-9 && offset.norm() > 0.3, "{offset}");
    assert_eq!(first.odom_from_base, Pose2::IDENTITY);
    let refusal = SequenceInput::open(&options(&file, false)).err().unwrap().to_string();
    assert!(refusal.contains("the recording holds no images"), "{refusal}");
    assert!(RecordedRun::read(&file, false).unwrap().cut_report().is_none());
}
