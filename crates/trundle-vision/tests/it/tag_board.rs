//! Boards of AprilTags drawn with a known camera: found whole and in part, and the camera calibrated.

use crate::board_renderer::{Pattern, Rays, Shot, poses, render};
use nalgebra::UnitQuaternion;
use std::sync::OnceLock;
use trundle_core::{Distortion, GrayImage, PinholeCamera, Pose3, Vector2, Vector3};
use trundle_vision::board::tags::{Tag, find_tags};
use trundle_vision::board::{
    Board, BoardProblem, BoardView, CameraFit, CameraFitError, LensModel, TagBoard, calibrate_camera,
};

const TEXT: &str = "apriltag:6x5:60mm:0.3";
const SIZE: (usize, usize) = (640, 480);

fn camera() -> PinholeCamera {
    let lens = Distortion { k1: -0.21, k2: 0.06, p1: 0.0011, p2: -0.0007, k3: 0.0 };
    PinholeCamera::new(SIZE, (531.0, 527.0), (329.5, 234.0), lens).unwrap()
}

fn rays() -> &'static Rays {
    static RAYS: OnceLock<Rays> = OnceLock::new();
    RAYS.get_or_init(|| Rays::new(&camera()))
}

fn board(text: &str) -> Board {
    text.parse().unwrap()
}

fn tag_board(text: &str) -> TagBoard {
    let Board::AprilTag(board) = board(text) else { panic!("{text}") };
    board
}

fn images(pattern: &Pattern, count: usize) -> Vec<(Pose3, GrayImage)> {
    let shot = |seed: u64| Shot { blur_px: 0.8, noise: 3.0, seed };
    let drawn = poses(pattern, 0.6, count).into_iter().enumerate();
    drawn.map(|(i, pose)| (pose, render(rays(), &pose, pattern, &shot(i as u64)))).collect()
}

/// 20 images of the board of `TEXT`.
fn whole() -> &'static [(Pose3, GrayImage)] {
    static IMAGES: OnceLock<Vec<(Pose3, GrayImage)>> = OnceLock::new();
    IMAGES.get_or_init(|| images(&Pattern::tags(tag_board(TEXT), false), 20))
}

fn views(images: &[(Pose3, GrayImage)], board: &Board) -> Vec<BoardView> {
    images.iter().map(|(_, image)| board.find(image).unwrap_or_else(|error| panic!("{error}"))).collect()
}

fn calibrated(views: &[BoardView]) -> Result<CameraFit, CameraFitError> {
    calibrate_camera(views, SIZE, LensModel::FourCoefficients)
}

/// Errors of the corners, px.
fn corner_errors(tags: &[Tag], pattern: &Pattern, camera_from_sheet: &Pose3) -> Vec<f64> {
    let camera_from_board = pattern.camera_from_first_corner(camera_from_sheet);
    let error = |board: Vector2, pixel: Vector2| {
        let p = camera_from_board.transform(Vector3::new(board.x, board.y, 0.0));
        (camera().distort(camera().project(p).unwrap()) - pixel).norm()
    };
    let corners = |tag: &Tag| tag_board(TEXT).corners(tag.id).unwrap().into_iter().zip(tag.corners);
    tags.iter().flat_map(corners).map(|(board, pixel)| error(board, pixel)).collect()
}

/// Number of markers whose corners are at least 10 px inside the image.
fn visible_tags(pattern: &Pattern, camera_from_sheet: &Pose3) -> usize {
    let camera_from_board = pattern.camera_from_first_corner(camera_from_sheet);
    let is_inside = |corner: &Vector2| {
        let p = camera_from_board.transform(Vector3::new(corner.x, corner.y, 0.0));
        let at = camera().distort(camera().project(p).unwrap());
        (10.0..629.0).contains(&at.x) && (10.0..469.0).contains(&at.y)
    };
    tag_board(TEXT).ids().filter(|id| tag_board(TEXT).corners(*id).unwrap().iter().all(is_inside)).count()
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

#[track_caller]
fn assert_focal_lengths(fit: &CameraFit, largest_ratio: f64) {
    println!("{:?} +- {:?}, residual {:.3} px", fit.parameters.0, fit.sigmas, fit.residual_px);
    for (i, truth) in [531.0, 527.0].into_iter().enumerate() {
        let ratio = fit.parameters.0[i] / truth - 1.0;
        assert!(ratio.abs() < largest_ratio, "{}: {:.3} %", fit.parameters.0[i], 100.0 * ratio);
    }
    assert!(fit.residual_px < 0.2, "residual {} px", fit.residual_px);
}

#[test]
fn the_corners_of_markers_are_found_to_a_fraction_of_a_pixel() {
    let pattern = Pattern::tags(tag_board(TEXT), false);
    let (mut all, mut count, mut visible) = (Vec::new(), 0, 0);
    for (i, (pose, image)) in whole().iter().enumerate() {
        let found = find_tags(image);
        assert!(found.mirrored == 0 && found.tags.iter().all(|tag| tag.id < 30), "view {i}: {found:?}");
        count += found.tags.len();
        visible += visible_tags(&pattern, pose);
        all.extend(corner_errors(&found.tags, &pattern, pose));
    }
    let worst = all.iter().copied().fold(0.0, f64::max);
    println!("{count} of {visible} markers, rms {:.3} px, worst {worst:.3} px", rms(&all));
    assert!(count * 100 >= visible * 95, "{count} of {visible} markers");
    assert!(rms(&all) < 0.13 && worst < 0.8, "rms {} px, worst {worst} px", rms(&all));
}

#[test]
fn a_camera_is_calibrated_within_a_thousandth() {
    let fit = calibrated(&views(whole(), &board(TEXT))).unwrap();
    assert_focal_lengths(&fit, 0.001);
    assert!(fit.rejected.is_empty() && fit.warnings().is_empty(), "{fit:?}");
}

#[test]
fn black_squares_between_the_markers_change_nothing() {
    let fit = calibrated(&views(&images(&Pattern::tags(tag_board(TEXT), true), 14), &board(TEXT))).unwrap();
    assert_focal_lengths(&fit, 0.001);
}

#[test]
fn a_board_that_is_partly_covered_counts() {
    let disks = vec![Vector2::new(-0.12, -0.1), Vector2::new(0.1, 0.05), Vector2::new(0.2, -0.15)];
    let drawn = images(&Pattern::tags(tag_board(TEXT), false).covered(disks, 0.05), 14);
    let views = views(&drawn, &board(TEXT));
    let markers: usize = views.iter().map(|view| view.points.len() / 4).sum();
    assert!((14 * 12..14 * 26).contains(&markers), "{markers}");
    assert_focal_lengths(&calibrated(&views).unwrap(), 0.002);
}

#[test]
fn a_marker_is_found_in_every_orientation_with_its_corners_in_order() {
    let pattern = Pattern::tags(tag_board("apriltag:1x1:60mm:0.3:17"), false);
    for degrees in (0..360).step_by(15) {
        let turn = UnitQuaternion::from_euler_angles(0.3, -0.2, f64::from(degrees).to_radians());
        let pose = Pose3::new(turn, Vector3::new(0.03, -0.02, 0.3));
        let image = render(rays(), &pose, &pattern, &Shot { blur_px: 0.8, noise: 3.0, seed: 1 });
        let found = find_tags(&image).tags;
        assert_eq!(found.iter().map(|tag| tag.id).collect::<Vec<_>>(), vec![17], "{degrees} deg");
        let upper_left = pattern.camera_from_first_corner(&pose).translation;
        let expected = camera().distort(camera().project(upper_left).unwrap());
        let error = (found[0].corners[0] - expected).norm();
        assert!(error < 0.3, "{degrees} deg: {error:.3} px");
    }
}

#[test]
fn a_wrong_side_changes_no_camera() {
    let views_of = |text: &str| views(&whole()[..8], &board(text));
    let (right, wrong) =
        (calibrated(&views_of(TEXT)).unwrap(), calibrated(&views_of("apriltag:6x5:75mm:0.3")).unwrap());
    for i in 0..4 {
        assert!((right.parameters.0[i] - wrong.parameters.0[i]).abs() < 1e-3, "{right:?}, {wrong:?}");
    }
}

#[test]
fn a_wrong_gap_is_refused_or_warned_of() {
    for text in ["apriltag:6x5:60mm:0.2", "apriltag:6x5:60mm:0.4"] {
        match calibrated(&views(whole(), &board(text))) {
            Ok(fit) => assert!(fit.warnings().iter().any(|warning| warning.contains("wrong gap")), "{fit:?}"),
            Err(error) => assert!(error.to_string().contains("gap"), "{error}"),
        }
    }
}

#[test]
fn one_image_is_refused() {
    let error = calibrated(&views(&whole()[..1], &board(TEXT))).unwrap_err();
    assert_eq!(error, CameraFitError::TooFewViews { found: 1 });
}

#[test]
fn a_mirrored_image_other_ids_and_a_strange_family_are_named() {
    let image = &whole()[0].1;
    let mirrored = GrayImage::from_fn(640, 480, |x, y| image.data()[y * 640 + 639 - x]);
    let problem = board(TEXT).find(&mirrored).unwrap_err();
    assert!(matches!(problem, BoardProblem::Mirrored { tags } if tags > 20), "{problem}");
    let problem = board("apriltag:5x5:60mm:0.3").find(image).unwrap_err();
    assert!(matches!(&problem, BoardProblem::ForeignTags { ids, .. } if ids.starts_with("25")), "{problem}");
    let negative = GrayImage::from_fn(640, 480, |x, y| 255 - image.data()[y * 640 + x]);
    assert!(board(TEXT).find(&negative).is_err());
    let problem = board(TEXT).find(&other_family()).unwrap_err();
    assert!(matches!(problem, BoardProblem::OtherFamily { squares, .. } if squares >= 4), "{problem}");
}

/// Six black squares of 8 x 8 cells of 6 px with cells of no marker.
fn other_family() -> GrayImage {
    GrayImage::from_fn(640, 480, |x, y| {
        let (column, row) = ((x % 90) as i64 / 6 - 3, (y % 90) as i64 / 6 - 3);
        let is_tag = (0..8).contains(&column) && (0..8).contains(&row) && x < 270 && y < 180;
        let is_border = column == 0 || row == 0 || column == 7 || row == 7;
        let is_white_cell = (column * 7 + row * row * 3 + (x / 90) as i64) % 3 == 0;
        if is_tag && (is_border || !is_white_cell) { 30 } else { 210 }
    })
}

#[test]
fn images_without_markers_are_refused() {
    let noise = GrayImage::from_fn(640, 480, |x, y| ((x * 31 + y * 17) ^ (x * y)) as u8);
    let dark = GrayImage::filled(640, 480, 0);
    for image in [
        GrayImage::filled(640, 480, 128),
        GrayImage::filled(4, 4, 0),
        GrayImage::filled(1, 1, 9),
        noise,
        dark,
    ] {
        let problem = board(TEXT).find(&image).unwrap_err();
        assert!(
            matches!(problem, BoardProblem::NoTags { .. } | BoardProblem::OtherFamily { .. }),
            "{problem}"
        );
    }
}

#[test]
fn few_markers_and_a_marker_twice_are_refused() {
    let pattern = Pattern::tags(tag_board("apriltag:3x1:60mm:0.3"), false);
    let turn = UnitQuaternion::from_euler_angles(0.3, -0.2, 0.1);
    let pose = Pose3::new(turn, Vector3::new(0.0, 0.0, 0.45));
    let few = &render(rays(), &pose, &pattern, &Shot { blur_px: 0.8, noise: 3.0, seed: 1 });
    let problem = board(TEXT).find(few).unwrap_err();
    assert_eq!(problem, BoardProblem::TooFewTags { found: 3, minimum: 4 });
    assert_eq!(board("apriltag:3x1:60mm:0.3").find(few).unwrap().points.len(), 12);
    let twice = GrayImage::from_fn(1280, 480, |x, y| few.data()[y * 640 + x % 640]);
    let problem = board(TEXT).find(&twice).unwrap_err();
    assert_eq!(problem, BoardProblem::RepeatedTag { id: 0 });
}

#[test]
fn uneven_light_hides_no_marker() {
    let dim = |(x, y): (usize, usize), value: u8| {
        (f64::from(value) * (0.25 + 0.75 * (x + y) as f64 / 1120.0)) as u8
    };
    let image = &whole()[0].1;
    let dimmed = GrayImage::from_fn(640, 480, |x, y| dim((x, y), image.data()[y * 640 + x]));
    assert!(find_tags(&dimmed).tags.len() >= find_tags(image).tags.len() - 1);
}
