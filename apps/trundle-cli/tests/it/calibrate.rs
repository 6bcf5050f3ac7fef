//! `trundle calibrate` on rendered boards of tags.

use crate::program::{text, trundle};
use std::path::Path;

/// The board: 4 x 3 tags of 30 mm.
const BOARD: &str = "apriltag:4x3:30mm:0.3";
/// Size of the images, focal length and principal point, px.
const SIZE_PX: (u32, u32) = (480, 360);
const FOCAL_PX: f64 = 410.0;
const CENTER_PX: (f64, f64) = (243.0, 177.0);
/// Samples of a pixel along each side.
const SAMPLES: u32 = 3;

/// The black squares of a printed sheet: left, top, side, mm.
fn squares(svg: &str) -> Vec<(f64, f64, f64)> {
    let path = svg.split("<path d=\"").nth(1).unwrap().split('"').next().unwrap();
    let square = |part: &str| {
        let (x, rest) = part.split_once(' ').unwrap();
        let (y, rest) = rest.split_once('h').unwrap();
        let side = rest.split('v').next().unwrap();
        (x.parse().unwrap(), y.parse().unwrap(), side.parse().unwrap())
    };
    path.split('M').filter(|part| !part.is_empty()).map(square).collect()
}

/// The sheet seen by a camera: turned around its middle by `turn` (rad around x, then y), its middle at `at` (mm, camera frame).
fn photo(squares: &[(f64, f64, f64)], turn: (f64, f64), at: [f64; 3]) -> image::GrayImage {
    let extent = |f: fn(&(f64, f64, f64)) -> f64| squares.iter().map(f).fold(0.0, f64::max);
    let size = (extent(|s| s.0 + s.2), extent(|s| s.1 + s.2));
    let ((sin_a, cos_a), (sin_b, cos_b)) = (turn.0.sin_cos(), turn.1.sin_cos());
    // The sheet's axes in the camera frame.
    let x_axis = [cos_b, sin_a * sin_b, -cos_a * sin_b];
    let y_axis = [0.0, cos_a, sin_a];
    let normal = [sin_b, -sin_a * cos_b, cos_a * cos_b];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let shade = |u: f64, v: f64| {
        let ray = [(u - CENTER_PX.0) / FOCAL_PX, (v - CENTER_PX.1) / FOCAL_PX, 1.0];
        let depth = dot(normal, at) / dot(normal, ray);
        let from_middle = [depth * ray[0] - at[0], depth * ray[1] - at[1], depth * ray[2] - at[2]];
        let (x, y) = (dot(x_axis, from_middle) + size.0 / 2.0, dot(y_axis, from_middle) + size.1 / 2.0);
        let is_black = squares
            .iter()
            .any(|&(left, top, side)| (left..left + side).contains(&x) && (top..top + side).contains(&y));
        if is_black { 30.0 } else { 210.0 }
    };
    image::GrayImage::from_fn(SIZE_PX.0, SIZE_PX.1, |column, row| {
        let inside = |i: u32| (f64::from(i) + 0.5) / f64::from(SAMPLES) - 0.5;
        let samples = (0..SAMPLES * SAMPLES)
            .map(|i| shade(f64::from(column) + inside(i % SAMPLES), f64::from(row) + inside(i / SAMPLES)));
        image::Luma([(samples.sum::<f64>() / f64::from(SAMPLES * SAMPLES)).round() as u8])
    })
}

/// The value of a key in a robot file.
fn value(file: &Path, key: &str) -> f64 {
    let text = std::fs::read_to_string(file).unwrap();
    let line = text.lines().find(|line| line.starts_with(key)).unwrap_or_else(|| panic!("{key} in {text}"));
    line.split('=').nth(1).unwrap().trim().parse().unwrap()
}

#[test]
fn a_printed_board_of_tags_gives_the_camera_that_saw_it() {
    let scratch = tempfile::tempdir().unwrap();
    let (sheet, photos) = (scratch.path().join("board.svg"), scratch.path().join("photos"));
    let drawn = trundle(&["calibrate", "board", BOARD, "--out", text(&sheet), "--quiet"]);
    assert!(drawn.status.success(), "{}", String::from_utf8_lossy(&drawn.stderr));
    let squares = squares(&std::fs::read_to_string(&sheet).unwrap());
    std::fs::create_dir(&photos).unwrap();
    let views = [
        ((0.0, 0.0), [0.0, 0.0, 190.0]),
        ((0.5, 0.0), [0.0, 10.0, 220.0]),
        ((-0.5, 0.1), [-20.0, 0.0, 220.0]),
        ((0.0, 0.55), [25.0, -10.0, 230.0]),
        ((0.1, -0.55), [-25.0, 10.0, 230.0]),
        ((0.4, 0.4), [45.0, 30.0, 260.0]),
        ((-0.4, 0.4), [-45.0, 30.0, 260.0]),
        ((0.4, -0.4), [45.0, -30.0, 260.0]),
        ((-0.4, -0.4), [-45.0, -30.0, 260.0]),
        ((0.3, 0.0), [0.0, 0.0, 320.0]),
    ];
    for (i, (turn, at)) in views.into_iter().enumerate() {
        photo(&squares, turn, at).save(photos.join(format!("{i}.png"))).unwrap();
    }
    let robot = scratch.path().join("robot.toml");
    let found = trundle(&["calibrate", "camera", text(&photos), "--board", BOARD, "--write", text(&robot)]);
    let printed = String::from_utf8_lossy(&found.stdout).into_owned();
    assert!(found.status.success(), "{}", String::from_utf8_lossy(&found.stderr));
    assert!(!printed.contains("left out"), "{printed}");
    for (key, truth) in [("fx_px", FOCAL_PX), ("fy_px", FOCAL_PX)] {
        let error = value(&robot, key) / truth - 1.0;
        assert!(error.abs() < 0.003, "{key} is wrong by {error:.5}: {printed}");
    }
    for (key, truth) in [("cx_px", CENTER_PX.0), ("cy_px", CENTER_PX.1)] {
        let error = value(&robot, key) - truth;
        assert!(error.abs() < 1.0, "{key} is wrong by {error:.3} px: {printed}");
    }
}
