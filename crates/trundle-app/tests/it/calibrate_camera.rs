//! A camera calibrated by image files of a board.

use std::path::Path;
use trundle_app::calibrate::{BoardRequest, calibrate_board};
use trundle_core::{ColorImage, PinholeCamera, Pose3, Vector2, Vector3};
use trundle_io::{CameraModel, encode_color_png};
use trundle_runtime::settings::RobotFile;
use trundle_vision::board::LensModel;

/// Inner corners of the board and side of a square, m.
const CORNERS: (usize, usize) = (7, 5);
const SQUARE_M: f64 = 0.03;

fn camera() -> PinholeCamera {
    PinholeCamera::new((320, 240), (271.0, 269.0), (163.0, 117.0), Default::default()).unwrap()
}

/// An image of the board, 4 x 4 samples per pixel.
fn draw(camera_from_board: &Pose3) -> ColorImage {
    let camera = camera();
    let board_from_camera = camera_from_board.inverse();
    let brightness = |x: f64, y: f64| {
        let along = board_from_camera.rotate(camera.unproject(Vector2::new(x, y), 1.0));
        let from = board_from_camera.translation;
        let at = (from - along * (from.z / along.z)) / SQUARE_M;
        let is_inside = at.x > -1.0 && at.y > -1.0 && at.x < CORNERS.0 as f64 && at.y < CORNERS.1 as f64;
        if is_inside && (at.x.floor() + at.y.floor()).rem_euclid(2.0) == 0.0 { 30.0 } else { 210.0 }
    };
    ColorImage::from_fn(camera.width(), camera.height(), |x, y| {
        let sample = |k: usize| {
            let offset = |k: usize| (k as f64 + 0.5) / 4.0 - 0.5;
            brightness(x as f64 + offset(k % 4), y as f64 + offset(k / 4))
        };
        [((0..16).map(sample).sum::<f64>() / 16.0) as u8; 3]
    })
}

/// Twelve images, and one without a board.
fn write_images(folder: &Path) {
    for i in 0..12 {
        let phase = f64::from(i) * 2.4;
        let turn = nalgebra::UnitQuaternion::from_euler_angles(0.6 * phase.sin(), 0.6 * phase.cos(), 0.2);
        let middle = turn * Vector3::new(3.0, 2.0, 0.0) * SQUARE_M;
        let aside = Vector3::new(0.06 * (1.3 * phase).cos(), 0.04 * (1.3 * phase).sin(), 0.36);
        let png = encode_color_png(&draw(&Pose3::new(turn, aside - middle))).unwrap();
        std::fs::write(folder.join(format!("{i:02}.png")), png).unwrap();
    }
    let wall = ColorImage::filled(320, 240, [120; 3]);
    std::fs::write(folder.join("wall.png"), encode_color_png(&wall).unwrap()).unwrap();
}

fn request(folder: &Path, board: &str) -> BoardRequest {
    BoardRequest {
        images: vec![folder.to_owned()],
        board: board.parse().unwrap(),
        lens: LensModel::FourCoefficients,
        in_use: PinholeCamera::kinect_v2(),
    }
}

#[test]
fn image_files_give_a_camera_within_one_percent_and_the_file_without_a_board_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    write_images(scratch.path());
    let found = calibrate_board(&request(scratch.path(), "checkerboard:7x5:30mm"), &()).unwrap();
    for (found, truth) in [(found.camera.fx(), 271.0), (found.camera.fy(), 269.0)] {
        assert!((found / truth - 1.0).abs() < 0.01, "{found}, truth {truth}");
    }
    assert!((found.camera.cx() - 163.0).abs() < 2.0 && (found.camera.cy() - 117.0).abs() < 2.0, "{found:?}");
    let is_named = |note: &String| note.starts_with("left out") && note.contains("wall.png: no board found");
    assert!(found.calibration.notes.iter().any(is_named), "{:?}", found.calibration.notes);

    let (robot, lens) = (scratch.path().join("robot.toml"), scratch.path().join("camera.toml"));
    std::fs::write(&robot, "[mount]\nz_m = 0.4 # by tape\n").unwrap();
    found.calibration.write(&robot).unwrap();
    found.write_camera_file(&lens).unwrap();
    let text = std::fs::read_to_string(&robot).unwrap();
    let read = RobotFile::parse(&text, &[]).unwrap().config;
    assert!(text.contains("z_m = 0.4 # by tape") && read.camera.width() == 320, "{text}");
    assert!((read.camera.fx() - found.camera.fx()).abs() < 0.001);
    assert_eq!(CameraModel::read(&lens).unwrap().camera, found.camera);
}

#[test]
fn a_wrong_board_is_refused_with_what_was_found() {
    let scratch = tempfile::tempdir().unwrap();
    write_images(scratch.path());
    let error =
        calibrate_board(&request(scratch.path(), "checkerboard:9x6:25mm"), &()).map(drop).unwrap_err();
    let error = error.to_string();
    assert!(error.contains("0 images show the board"), "{error}");
    assert!(error.contains("7 x 5") || error.contains("5 x 7"), "{error}");
}
