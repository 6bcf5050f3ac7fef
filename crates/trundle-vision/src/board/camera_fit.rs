//! A camera by the corners of a board in several images.
//!
//! Problem: intrinsics and lens from views of a plane. Idea \[Zhang00\]: each homography gives two constraints on the image of the absolute
//! conic. With the principal point in the middle of the image, they give the focal lengths in closed form. Levenberg-Marquardt then
//! minimises the reprojection error over camera and poses together. The poses are eliminated by the Schur complement, whose inverse is the
//! covariance of the camera. Cost: O(corners) a round, about 20 rounds.
//!
//! | \[Zhang00\] | here | unit |
//! |---|---|---|
//! | A: alpha, beta, u0, v0 | `CameraParameters` fx, fy, cx, cy | px |
//! | k1, k2 | k1, k2, and p1, p2, k3 of Brown and Conrady | |
//! | H | `homography` | |
//! | R, t | `camera_from_board` | m |

use super::board_view::{BoardPoint, BoardView};
use super::camera_parameters::{CameraParameters, LensModel, PARAMETER_COUNT};
use super::coverage::BoardCoverage;
use super::homography::homography;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Matrix6, SMatrix, Vector6};
use thiserror::Error;
use trundle_core::{Pose3, Vector2, Vector3};

/// A calibrated camera.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraFit {
    /// The camera.
    pub parameters: CameraParameters,
    /// Standard deviation of each parameter; 0 if it was not estimated.
    pub sigmas: [f64; PARAMETER_COUNT],
    /// Root mean square of the reprojection error over both axes, px.
    pub residual_px: f64,
    /// Root mean square of the reprojection error of each view, px, by index into the given views; `None` for a rejected view.
    pub view_residuals_px: Vec<Option<f64>>,
    /// Views that were left out.
    pub rejected: Vec<RejectedView>,
    /// Coverage of the image and of the tilts of the board by the views.
    pub coverage: BoardCoverage,
}

impl CameraFit {
    /// Advice, one sentence each; empty for sufficient views.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.coverage.warnings();
        if self.residual_px > GOOD_RESIDUAL_PX {
            warnings.push(format!(
                "the residual is {:.2} px, expected below {GOOD_RESIDUAL_PX} px: the board is bent or out of focus, or --board has a \
                 wrong number of columns, of rows, or a wrong gap",
                self.residual_px
            ));
        }
        warnings
    }
}

/// A view that was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct RejectedView {
    /// Index into the given views.
    pub index: usize,
    /// Reason.
    pub cause: String,
}

/// Reason why views give no camera.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CameraFitError {
    /// Too few views.
    #[error(
        "{found} images show the board, expected {MIN_VIEWS} or more; take 15 to 30 with different tilts"
    )]
    TooFewViews {
        /// Views that can be used.
        found: usize,
    },
    /// The views do not determine the focal length.
    #[error(
        "the focal length cannot be observed: the board is tilted by {tilt_deg:.1} deg at most, expected {MIN_TILT_DEG} deg or more; tilt the board about both axes"
    )]
    NoTilt {
        /// Largest tilt of the board, deg.
        tilt_deg: f64,
    },
    /// The fit does not converge.
    #[error(
        "the fit does not converge: residual {residual_px:.1} px; check columns, rows and gap of --board"
    )]
    NotConverged {
        /// Residual, px.
        residual_px: f64,
    },
}

/// Smallest number of views: 3. Source: \[Zhang00, sec. 3.1\]: each gives two constraints on five unknowns.
const MIN_VIEWS: usize = 3;
/// Smallest tilt of the board in the view with the largest tilt: 10 deg. Source: ours; \[Zhang00, fig. 3\] finds errors to grow fast below
/// it.
const MIN_TILT_DEG: f64 = 10.0;
/// Rounds of Levenberg-Marquardt. Source: ours.
const MAX_STEP_COUNT: usize = 60;
/// Relative change of the cost at which the fit has converged. Source: ours.
const CONVERGED_RATIO: f64 = 1e-10;
/// Largest residual of a view, over the median of all views. Source: ours.
const MAX_RESIDUAL_RATIO: f64 = 4.0;
/// Residual of a view that is never rejected, and of a fit without a warning: 0.5 px. Source: ours.
const GOOD_RESIDUAL_PX: f64 = 0.5;
/// Largest residual of a fit: 5 px. Source: ours.
const MAX_RESIDUAL_PX: f64 = 5.0;
/// Step of the numeric derivatives: over the size of a parameter, or absolute below 1. Source: ours, cube root of the rounding.
const DERIVATIVE_STEP: f64 = 1e-6;

/// A view with the pose of its board.
#[derive(Debug, Clone)]
struct PosedView {
    index: usize,
    points: Vec<BoardPoint>,
    camera_from_board: Pose3,
}

/// Calibrates a camera of `width` x `height` px by views of a board. Views that do not fit are left out and named.
///
/// # Errors
/// When fewer than three views can be used, the board is never tilted, or the fit does not converge.
pub fn calibrate_camera(
    views: &[BoardView],
    (width, height): (usize, usize),
    lens: LensModel,
) -> Result<CameraFit, CameraFitError> {
    let mut rejected = Vec::new();
    let (start, mut posed) = starting_fit(views, (width, height), &mut rejected)?;
    let mut fit = optimized(start, &mut posed, lens);
    while let Some(worst) = worst_view(&fit, &posed) {
        let view = posed.remove(worst);
        let residual = fit.parameters.residual(&view);
        let cause = format!("residual {residual:.2} px, others {:.2} px", fit.residual_px);
        rejected.push(RejectedView { index: view.index, cause });
        if posed.len() < MIN_VIEWS {
            return Err(CameraFitError::TooFewViews { found: posed.len() });
        }
        fit = optimized(fit.parameters, &mut posed, lens);
    }
    if !fit.residual_px.is_finite() || fit.residual_px > MAX_RESIDUAL_PX {
        return Err(CameraFitError::NotConverged { residual_px: fit.residual_px });
    }
    let coverage = coverage(&posed, (width, height));
    if coverage.max_tilt_deg < MIN_TILT_DEG {
        return Err(CameraFitError::NoTilt { tilt_deg: coverage.max_tilt_deg });
    }
    let mut view_residuals_px = vec![None; views.len()];
    for view in &posed {
        view_residuals_px[view.index] = Some(fit.parameters.residual(view));
    }
    let Optimum { parameters, sigmas, residual_px } = fit;
    Ok(CameraFit { parameters, sigmas, residual_px, view_residuals_px, rejected, coverage })
}

/// The view that fits worse than the others by far, if any.
fn worst_view(fit: &Optimum, views: &[PosedView]) -> Option<usize> {
    let residuals: Vec<f64> = views.iter().map(|view| fit.parameters.residual(view)).collect();
    let mut sorted = residuals.clone();
    sorted.sort_by(f64::total_cmp);
    let median = *sorted.get(sorted.len() / 2)?;
    let limit = (MAX_RESIDUAL_RATIO * median).max(GOOD_RESIDUAL_PX);
    let (worst, residual) = residuals.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (*residual > limit).then_some(worst)
}

/// Focal lengths in closed form, and the poses of the board; the principal point in the middle.
fn starting_fit(
    views: &[BoardView],
    (width, height): (usize, usize),
    rejected: &mut Vec<RejectedView>,
) -> Result<(CameraParameters, Vec<PosedView>), CameraFitError> {
    let centre = Vector2::new((width as f64 - 1.0) / 2.0, (height as f64 - 1.0) / 2.0);
    let found = views.iter().enumerate().filter_map(|(index, view)| {
        let plane = homography(&view.points);
        if plane.is_none() {
            rejected.push(RejectedView { index, cause: "the corners lie on a line".to_owned() });
        }
        Some((index, view, plane?))
    });
    let found: Vec<(usize, &BoardView, Matrix3<f64>)> = found.collect();
    if found.len() < MIN_VIEWS {
        return Err(CameraFitError::TooFewViews { found: found.len() });
    }
    let focal = focal_lengths(found.iter().map(|(_, _, plane)| plane), centre)
        .unwrap_or_else(|| Vector2::repeat(width.max(height) as f64));
    let start = CameraParameters([focal.x, focal.y, centre.x, centre.y, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let posed = found.into_iter().filter_map(|(index, view, plane)| {
        let camera_from_board = pose_of_plane(&plane, focal, centre)?;
        Some(PosedView { index, points: view.points.clone(), camera_from_board })
    });
    Ok((start, posed.collect()))
}

/// fx and fy by the constraints h1' w h2 = 0 and h1' w h1 = h2' w h2 with w = diag(1/fx^2, 1/fy^2, 1) \[Zhang00, eq. 3 and 4\].
fn focal_lengths<'a>(planes: impl Iterator<Item = &'a Matrix3<f64>>, centre: Vector2) -> Option<Vector2> {
    let (mut information, mut vector) = (Matrix2::zeros(), Vector2::zeros());
    let to_centre = Matrix3::new(1.0, 0.0, -centre.x, 0.0, 1.0, -centre.y, 0.0, 0.0, 1.0);
    for plane in planes {
        let centred = to_centre * plane;
        let scale = 1.0 / (centred.column(0).norm() * centred.column(1).norm());
        let (a, b) = (centred.column(0).into_owned(), centred.column(1).into_owned());
        let rows = [
            (Vector2::new(a.x * b.x, a.y * b.y), -a.z * b.z),
            (Vector2::new(a.x * a.x - b.x * b.x, a.y * a.y - b.y * b.y), b.z * b.z - a.z * a.z),
        ];
        for (row, right) in rows {
            information += row * row.transpose() * (scale * scale);
            vector += row * (right * scale * scale);
        }
    }
    let inverse_squares = information.try_inverse()? * vector;
    let focal = inverse_squares.map(|value| 1.0 / value.sqrt());
    let is_plausible = |f: f64| f.is_finite() && (0.1 * centre.x..100.0 * centre.x).contains(&f);
    (is_plausible(focal.x) && is_plausible(focal.y)).then_some(focal)
}

/// The pose of the board by its homography \[Zhang00, sec. 3.1\].
fn pose_of_plane(plane: &Matrix3<f64>, focal: Vector2, centre: Vector2) -> Option<Pose3> {
    let inverse = Matrix3::new(
        1.0 / focal.x,
        0.0,
        -centre.x / focal.x,
        0.0,
        1.0 / focal.y,
        -centre.y / focal.y,
        0.0,
        0.0,
        1.0,
    );
    let columns = inverse * plane;
    let scale = 2.0 / (columns.column(0).norm() + columns.column(1).norm());
    let scale = if columns[(2, 2)] < 0.0 { -scale } else { scale };
    let (x, y) = (columns.column(0) * scale, columns.column(1) * scale);
    let rough = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    let svd = rough.svd(true, true);
    let rotation = svd.u? * svd.v_t?;
    let translation = columns.column(2) * scale;
    (rotation.determinant() > 0.0 && translation.z > 0.0).then(|| Pose3::from_matrix(rotation, translation))
}

/// The result of the minimisation.
struct Optimum {
    parameters: CameraParameters,
    sigmas: [f64; PARAMETER_COUNT],
    residual_px: f64,
}

impl CameraParameters {
    /// Reprojection error of a corner, px.
    fn error(&self, camera_from_board: &Pose3, point: &BoardPoint) -> Vector2 {
        let p = camera_from_board.transform(Vector3::new(point.board.x, point.board.y, 0.0));
        self.project(p) - point.pixel
    }

    fn squares(&self, view: &PosedView) -> f64 {
        view.points.iter().map(|point| self.error(&view.camera_from_board, point).norm_squared()).sum()
    }

    /// Root mean square of the errors of a view over both axes, px.
    fn residual(&self, view: &PosedView) -> f64 {
        (self.squares(view) / (2.0 * view.points.len() as f64)).sqrt()
    }
}

/// Normal equations with the poses eliminated.
struct Reduced {
    /// Information of the camera, poses eliminated, and its gradient.
    camera: DMatrix<f64>,
    gradient: DVector<f64>,
    /// For each view: inverse of the pose's information, gradient of the pose, coupling.
    views: Vec<(Matrix6<f64>, Vector6<f64>, SMatrix<f64, PARAMETER_COUNT, 6>)>,
}

/// Levenberg-Marquardt over camera and poses.
fn optimized(start: CameraParameters, views: &mut [PosedView], lens: LensModel) -> Optimum {
    let mut parameters = start;
    let cost = |parameters: &CameraParameters, views: &[PosedView]| -> f64 {
        views.iter().map(|view| parameters.squares(view)).sum()
    };
    let (mut now, mut damping) = (cost(&parameters, views), 1e-3);
    for _ in 0..MAX_STEP_COUNT {
        let Some((next, moved)) = step(&parameters, views, lens, damping) else { break };
        let then = cost(&next, &moved);
        if then.is_finite() && then < now {
            let is_converged = now - then < CONVERGED_RATIO * now;
            (parameters, now, damping) = (next, then, damping * 0.1);
            views.clone_from_slice(&moved);
            if is_converged {
                break;
            }
        } else {
            damping *= 10.0;
        }
        if damping > 1e12 {
            break;
        }
    }
    let points: usize = views.iter().map(|view| view.points.len()).sum();
    let unknowns = lens.parameters() + 6 * views.len();
    let variance = now / (2.0 * points as f64 - unknowns as f64).max(1.0);
    let covariance = reduced(&parameters, views, lens, 0.0).and_then(|reduced| reduced.camera.try_inverse());
    let sigma = |i: usize| match &covariance {
        Some(covariance) if i < lens.parameters() => (covariance[(i, i)] * variance).sqrt(),
        Some(_) => 0.0,
        None => f64::INFINITY,
    };
    Optimum {
        parameters,
        sigmas: std::array::from_fn(sigma),
        residual_px: (now / (2.0 * points as f64)).sqrt(),
    }
}

/// One damped step of camera and poses.
fn step(
    parameters: &CameraParameters,
    views: &[PosedView],
    lens: LensModel,
    damping: f64,
) -> Option<(CameraParameters, Vec<PosedView>)> {
    let reduced = reduced(parameters, views, lens, damping)?;
    let delta = reduced.camera.lu().solve(&(-reduced.gradient))?;
    let mut next = *parameters;
    for (value, change) in next.0.iter_mut().zip(delta.iter()) {
        *value += change;
    }
    let full = SMatrix::<f64, PARAMETER_COUNT, 1>::from_fn(|i, _| delta.get(i).copied().unwrap_or(0.0));
    let moved = views.iter().zip(&reduced.views).map(|(view, (inverse, gradient, coupling))| {
        let change = -inverse * (gradient + coupling.transpose() * full);
        PosedView { camera_from_board: view.camera_from_board * Pose3::exp(change), ..view.clone() }
    });
    Some((next, moved.collect()))
}

/// The normal equations, each pose eliminated by its Schur complement.
fn reduced(
    parameters: &CameraParameters,
    views: &[PosedView],
    lens: LensModel,
    damping: f64,
) -> Option<Reduced> {
    let mut camera = SMatrix::<f64, PARAMETER_COUNT, PARAMETER_COUNT>::zeros();
    let mut gradient = SMatrix::<f64, PARAMETER_COUNT, 1>::zeros();
    let (mut eliminated, mut eliminated_gradient) = (camera, gradient);
    let mut parts = Vec::with_capacity(views.len());
    for view in views {
        let (mut pose, mut pose_gradient) = (Matrix6::zeros(), Vector6::zeros());
        let mut coupling = SMatrix::<f64, PARAMETER_COUNT, 6>::zeros();
        for point in &view.points {
            let error = parameters.error(&view.camera_from_board, point);
            let (by_camera, by_pose) = jacobians(parameters, &view.camera_from_board, point);
            camera += by_camera.transpose() * by_camera;
            gradient += by_camera.transpose() * error;
            pose += by_pose.transpose() * by_pose;
            pose_gradient += by_pose.transpose() * error;
            coupling += by_camera.transpose() * by_pose;
        }
        let damped = pose + Matrix6::from_diagonal(&pose.diagonal()) * damping;
        let inverse = damped.try_inverse()?;
        eliminated += coupling * inverse * coupling.transpose();
        eliminated_gradient += coupling * inverse * pose_gradient;
        parts.push((inverse, pose_gradient, coupling));
    }
    let damped = camera + SMatrix::from_diagonal(&camera.diagonal()) * damping;
    let n = lens.parameters();
    let camera = (damped - eliminated).view((0, 0), (n, n)).into_owned();
    let gradient = (gradient - eliminated_gradient).rows(0, n).into_owned();
    Some(Reduced {
        camera: DMatrix::from_column_slice(n, n, camera.as_slice()),
        gradient: DVector::from_column_slice(gradient.as_slice()),
        views: parts,
    })
}

/// Derivatives of a corner's error by the camera and by the pose (right perturbation), by central differences.
fn jacobians(
    parameters: &CameraParameters,
    pose: &Pose3,
    point: &BoardPoint,
) -> (SMatrix<f64, 2, PARAMETER_COUNT>, SMatrix<f64, 2, 6>) {
    let mut by_camera = SMatrix::<f64, 2, PARAMETER_COUNT>::zeros();
    for i in 0..PARAMETER_COUNT {
        let h = DERIVATIVE_STEP * parameters.0[i].abs().max(1.0);
        let moved = |h: f64| {
            let mut moved = *parameters;
            moved.0[i] += h;
            moved.error(pose, point)
        };
        by_camera.set_column(i, &((moved(h) - moved(-h)) / (2.0 * h)));
    }
    let mut by_pose = SMatrix::<f64, 2, 6>::zeros();
    for i in 0..6 {
        let moved = |h: f64| {
            let change = Vector6::from_fn(|k, _| if k == i { h } else { 0.0 });
            parameters.error(&(*pose * Pose3::exp(change)), point)
        };
        let h = DERIVATIVE_STEP;
        by_pose.set_column(i, &((moved(h) - moved(-h)) / (2.0 * h)));
    }
    (by_camera, by_pose)
}

/// Coverage of the image and of the tilts by the views.
fn coverage(views: &[PosedView], size: (usize, usize)) -> BoardCoverage {
    let tilts = views.iter().map(|view| {
        let normal = view.camera_from_board.rotate(Vector3::z());
        normal.z.abs().clamp(0.0, 1.0).acos().to_degrees()
    });
    let pixels = views.iter().flat_map(|view| view.points.iter().map(|point| point.pixel));
    BoardCoverage::of(views.len(), tilts, pixels, size)
}
