//! Boards drawn with a known camera: found, and the camera calibrated.

use crate::board_renderer::{Pattern, Rays, Shot, poses, render};
use std::sync::OnceLock;
use trundle_core::{Distortion, GrayImage, PinholeCamera, Vector2, Vector3};
use trundle_vision::board::{
    Board, BoardProblem, BoardView, CameraFit, CameraFitError, CameraParameters, LensModel, calibrate_camera,
};

/// A camera with a strong lens, the principal point off the middle.
fn camera() -> PinholeCamera {
    let lens = Distortion { k1: -0.21, k2: 0.06, p1: 0.0011, p2: -0.0007, k3: 0.0 };
    PinholeCamera::new((640, 480), (531.0, 527.0), (329.5, 234.0), lens).unwrap()
}

fn board() -> Board {
    "checkerboard:9x6:25mm".parse().unwrap()
}

fn shot(seed: u64) -> Shot {
    Shot { blur_px: 0.8, noise: 3.0, seed }
}

fn rays() -> &'static Rays {
    static RAYS: OnceLock<Rays> = OnceLock::new();
    RAYS.get_or_init(|| Rays::new(&camera()))
}

/// 24 views of the checkerboard, tilted by up to 34 deg.
fn tilted_views() -> &'static [BoardView] {
    static VIEWS: OnceLock<Vec<BoardView>> = OnceLock::new();
    VIEWS.get_or_init(|| views(&Pattern::checkerboard((9, 6), 0.025), &board(), 0.6, 24))
}

/// Views of the board from many sides.
fn views(pattern: &Pattern, board: &Board, tilt: f64, count: usize) -> Vec<BoardView> {
    let posed = poses(pattern, tilt, count).into_iter().enumerate();
    posed.filter_map(|(i, pose)| board.find(&render(rays(), &pose, pattern, &shot(i as u64))).ok()).collect()
}

/// Largest error of a corner against the drawn one, px, and their root mean square.
fn corner_errors(
    view: &BoardView,
    camera: &PinholeCamera,
    camera_from_board: &trundle_core::Pose3,
) -> (f64, f64) {
    let errors: Vec<f64> = view
        .points
        .iter()
        .map(|point| {
            let p = camera_from_board.transform(Vector3::new(point.board.x, point.board.y, 0.0));
            (camera.distort(camera.project(p).unwrap()) - point.pixel).norm()
        })
        .collect();
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    (errors.iter().copied().fold(0.0, f64::max), (squares / errors.len() as f64).sqrt())
}

#[track_caller]
fn assert_camera(fit: &CameraFit, truth: &PinholeCamera) {
    let lens = truth.distortion();
    let truth = [truth.fx(), truth.fy(), truth.cx(), truth.cy(), lens.k1, lens.k2, lens.p1, lens.p2, lens.k3];
    for (i, name) in CameraParameters::NAMES.iter().enumerate() {
        let (found, sigma) = (fit.parameters.0[i], fit.sigmas[i]);
        println!("{name}: {found:.5} +- {sigma:.5}, truth {:.5}", truth[i]);
        assert!(
            (found - truth[i]).abs() <= 5.0 * sigma + 1e-12,
            "{name}: {found} +- {sigma}, truth {}",
            truth[i]
        );
    }
    for i in 0..4 {
        assert!((fit.parameters.0[i] - truth[i]).abs() < 0.005 * truth[0], "{}", CameraParameters::NAMES[i]);
    }
}

#[test]
fn corners_are_found_to_a_fraction_of_a_pixel() {
    let pattern = Pattern::checkerboard((9, 6), 0.025);
    for (i, pose) in poses(&pattern, 0.6, 6).iter().enumerate() {
        let image = render(rays(), pose, &pattern, &shot(i as u64));
        let view = board().find(&image).unwrap_or_else(|error| panic!("view {i}: {error}"));
        assert!(view.points.len() >= 44, "view {i}: {} corners", view.points.len());
        let (worst, rms) = corner_errors(&view, &camera(), &pattern.camera_from_first_corner(pose));
        let flipped = pattern.camera_from_last_corner(pose);
        let (worst_flipped, rms_flipped) = corner_errors(&view, &camera(), &flipped);
        let (worst, rms) = (worst.min(worst_flipped), rms.min(rms_flipped));
        assert!(worst < 0.3 && rms < 0.15, "view {i}: {worst:.3} px, rms {rms:.3} px");
    }
}

#[test]
fn a_camera_is_calibrated_within_its_own_standard_deviations() {
    let views = tilted_views();
    assert!(views.len() >= 20, "{}", views.len());
    let fit = calibrate_camera(views, (640, 480), LensModel::FourCoefficients).unwrap();
    println!("residual {:.3} px, {:?}", fit.residual_px, fit.coverage);
    assert!(fit.residual_px < 0.12 && fit.rejected.is_empty(), "{fit:?}");
    assert_eq!(fit.coverage.warnings(), Vec::<String>::new());
    assert_camera(&fit, &camera());
}

#[test]
fn a_third_radial_coefficient_is_estimated_on_request() {
    let fit = calibrate_camera(tilted_views(), (640, 480), LensModel::FiveCoefficients).unwrap();
    assert!(fit.sigmas[8] > 0.0);
    assert!((fit.parameters.0[0] - 531.0).abs() < 3.0, "{:?}", fit.parameters);
}

#[test]
fn a_board_without_tilt_leaves_the_focal_length_open_and_says_so() {
    let views = views(&Pattern::checkerboard((9, 6), 0.025), &board(), 0.0, 8);
    assert!(views.len() >= 5);
    let error = calibrate_camera(&views, (640, 480), LensModel::FourCoefficients).unwrap_err();
    assert!(matches!(error, CameraFitError::NoTilt { .. } | CameraFitError::NotConverged { .. }), "{error}");
}

#[test]
fn too_few_views_are_refused_and_few_ones_warned_of() {
    let views = &tilted_views()[..5];
    let error = calibrate_camera(&views[..2], (640, 480), LensModel::FourCoefficients).unwrap_err();
    assert_eq!(error, CameraFitError::TooFewViews { found: 2 });
    let fit = calibrate_camera(views, (640, 480), LensModel::FourCoefficients).unwrap();
    assert!(fit.coverage.warnings()[0].contains("expected 10 or more"), "{:?}", fit.coverage);
}

#[test]
fn a_view_whose_corners_are_moved_is_rejected_by_index() {
    let mut views = tilted_views()[..12].to_vec();
    for (i, point) in views[3].points.iter_mut().enumerate() {
        point.pixel += Vector2::new(((i * 7) % 5) as f64, ((i * 3) % 4) as f64);
    }
    let fit = calibrate_camera(&views, (640, 480), LensModel::FourCoefficients).unwrap();
    assert_eq!(fit.rejected.iter().map(|view| view.index).collect::<Vec<_>>(), vec![3]);
    assert_eq!(fit.view_residuals_px[3], None);
    assert_camera(&fit, &camera());
}

#[test]
fn another_board_and_no_board_are_named() {
    let pattern = Pattern::checkerboard((7, 5), 0.025);
    let image = render(rays(), &poses(&pattern, 0.3, 1)[0], &pattern, &shot(1));
    let problem = board().find(&image).unwrap_err();
    assert!(
        matches!(
            problem,
            BoardProblem::WrongSize { columns: 7, rows: 5, .. }
                | BoardProblem::WrongSize { columns: 5, rows: 7, .. }
        ),
        "{problem}"
    );
    assert!(problem.to_string().contains("expected a checkerboard of 9 x 6"), "{problem}");
    let noise = GrayImage::from_fn(640, 480, |x, y| ((x * 31 + y * 17) ^ (x * y)) as u8);
    for image in [GrayImage::filled(640, 480, 128), GrayImage::filled(4, 4, 0), noise] {
        assert!(board().find(&image).is_err());
    }
}
