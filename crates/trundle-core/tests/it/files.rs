//! Formats of core types in files.

use serde_json::{from_str, json, to_value};
use trundle_core::{Cell, DifferentialDrive, DriveLimits, FrameId, PinholeCamera, Pose3, Stamp};

#[test]
fn a_stamp_is_its_nanoseconds() {
    assert_eq!(to_value(Stamp::from_nanos(-5)).unwrap(), json!(-5));
    assert_eq!(from_str::<Stamp>("1305031229528748000").unwrap().nanos, 1_305_031_229_528_748_000);
}

#[test]
fn a_pose_in_space_is_seven_numbers_and_its_quaternion_is_normalised_on_reading() {
    let pose: Pose3 = from_str("[1, 2, 3, 0, 0, 0, 4]").unwrap();
    assert_eq!(to_value(pose).unwrap(), json!([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]));
    assert!(from_str::<Pose3>("[1, 2, 3]").is_err());
}

#[test]
fn cells_and_frames_have_lower_case_names() {
    for (cell, name) in [(Cell::Unknown, "unknown"), (Cell::Free, "free"), (Cell::Occupied, "occupied")] {
        assert_eq!(to_value(cell).unwrap(), json!(name));
    }
    for (frame, name) in [
        (FrameId::Map, "map"),
        (FrameId::Odom, "odom"),
        (FrameId::Camera, "camera"),
        (FrameId::Visual, "visual"),
        (FrameId::World, "world"),
    ] {
        assert_eq!(to_value(frame).unwrap(), json!(name));
        assert_eq!(frame.to_string(), name);
    }
    // REP 105 calls the base's frame base_link.
    assert_eq!(
        (to_value(FrameId::Base).unwrap(), FrameId::Base.to_string()),
        (json!("base"), "base_link".into())
    );
}

#[test]
fn a_camera_comes_back_from_a_file_and_a_global_shutter_is_not_written() {
    for camera in [PinholeCamera::kinect_v2(), PinholeCamera::kinect_v1().with_readout(0.02).unwrap()] {
        let written = to_value(camera).unwrap();
        assert_eq!(written.get("readout").is_some(), camera.readout() > 0.0);
        assert_eq!(serde_json::from_value::<PinholeCamera>(written).unwrap(), camera);
    }
}

#[test]
fn a_camera_of_a_file_is_checked_as_one_of_the_constructor() {
    let good = json!({"width": 64, "height": 48, "fx": 50.0, "fy": 50.0, "cx": 32.0, "cy": 24.0});
    let refused = |key: &str, value: serde_json::Value| {
        let mut camera = good.clone();
        camera[key] = value;
        serde_json::from_value::<PinholeCamera>(camera).unwrap_err().to_string()
    };
    assert!(serde_json::from_value::<PinholeCamera>(good.clone()).is_ok());
    assert!(refused("fx", json!(-1.0)).contains("fx is -1 px"));
    assert!(refused("readout", json!(1.0)).contains("readout is 1 s, expected 0 to 0.05"));
    assert!(refused("focal", json!(1.0)).contains("unknown field `focal`"));
    assert!(refused("distortion", json!({"k4": 0.1})).contains("unknown field `k4`"));
}

#[test]
fn keys_that_are_missing_take_their_default_and_unknown_keys_are_refused() {
    let drive: DifferentialDrive = from_str(r#"{"wheelbase": 0.3}"#).unwrap();
    assert_eq!(drive, DifferentialDrive { wheelbase: 0.3, ..DifferentialDrive::KOBUKI });
    assert!(from_str::<DifferentialDrive>(r#"{"wheel_base": 0.3}"#).is_err());
    assert_eq!(from_str::<DriveLimits>("{}").unwrap(), DriveLimits::KOBUKI);
    assert!(from_str::<DriveLimits>(r#"{"speed": 0.3}"#).is_err());
}
