//! Faults that frames show.

use crate::fixtures::{frame, info, slow_info};
use trundle_core::{DepthImage, Distortion, PinholeCamera};
use trundle_drivers::camera::frame_monitor::faults_of_info;
use trundle_drivers::camera::{CameraFault, FrameMonitor};

fn faults(mut monitor: FrameMonitor, frames: impl Iterator<Item = (i64, u8)>) -> Vec<(usize, CameraFault)> {
    let faults = frames.enumerate().map(|(i, (stamp, seed))| (i, monitor.on_frame(&frame(stamp, seed))));
    faults.filter_map(|(i, fault)| Some((i, fault?))).collect()
}

#[test]
fn the_same_bytes_or_the_same_stamp_are_a_stuck_camera() {
    let monitor = || FrameMonitor::new(&info(), true);
    assert_eq!(faults(monitor(), (0..100).map(|i| (i as i64, i))), []);
    let same_bytes = faults(monitor(), (0..45).map(|i| (i, 7)));
    assert_eq!(same_bytes, [(29, CameraFault::Stuck { frames: 30 })]);
    let same_stamp = faults(monitor(), (0..8).map(|i| (42, i)));
    assert_eq!(same_stamp, [(4, CameraFault::Stuck { frames: 5 })]);
    assert!(same_stamp[0].1.needs_reopening());
    let rendered = faults(FrameMonitor::new(&info(), false), (0..100).map(|i| (i, 7)));
    assert_eq!(rendered, [], "rendered images repeat where nothing moves");
}

#[test]
fn depth_that_stays_away_is_reported_once_a_second() {
    let mut monitor = FrameMonitor::new(&info(), true);
    let empty = DepthImage::filled(4, 4, 0.0);
    let mut one = empty.clone();
    one.data_mut()[15] = 1.0;
    let mut reports = |count, image: &DepthImage| (0..count).filter_map(|_| monitor.on_depth(image)).count();
    assert_eq!((reports(29, &empty), reports(1, &one), reports(29, &empty)), (0, 0, 0));
    assert_eq!(reports(31, &empty), 2);
}

#[test]
fn an_image_of_another_size_is_named_with_both_sizes() {
    let mut wrong = frame(0, 0);
    wrong.depth.width = 5;
    let fault = FrameMonitor::new(&info(), true).on_frame(&wrong).unwrap();
    assert_eq!(fault.to_string(), "the depth image is 5 x 4 px, expected 4 x 4: open the camera anew");
    assert!(fault.needs_reopening());
}

#[test]
fn wrong_intrinsics_and_slow_ports_are_found_before_the_first_frame() {
    assert_eq!(faults_of_info(&info()), []);
    let mut slow = slow_info();
    let of_full_hd = ((1080.0, 1080.0), (4.0, 3.0));
    slow.color.camera =
        PinholeCamera::new((640, 480), of_full_hd.0, of_full_hd.1, Distortion::default()).unwrap();
    let sentences: Vec<String> = faults_of_info(&slow).iter().map(|fault| fault.to_string()).collect();
    assert!(
        sentences[0].starts_with("the camera is connected by USB 2 (480 Mbit/s), expected USB 3"),
        "{sentences:?}"
    );
    let cx = "the intrinsics of the colour camera are not plausible: cx is 4 px, expected 160 to 480";
    assert!(sentences[1].starts_with(cx), "{sentences:?}");
    assert!(!faults_of_info(&slow)[0].needs_reopening());
}
