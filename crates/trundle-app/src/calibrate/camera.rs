//! `[camera]` by images of a board.

use super::values::{CalibratedValue, Calibration};
use crate::{AppError, StepProgress, stop};
use std::path::{Path, PathBuf};
use trundle_core::{GrayImage, PinholeCamera, gray_from_color};
use trundle_io::{CameraModel, KINECT_V2_DEPTH_SCALE, decode_color, replace_file};
use trundle_vision::board::{Board, BoardView, CameraFit, CameraParameters, LensModel, calibrate_camera};

/// Images of a board, and the kind of the board.
#[derive(Debug, Clone)]
pub struct BoardRequest {
    /// Image files, JPEG or PNG, or folders of them.
    pub images: Vec<PathBuf>,
    /// The board.
    pub board: Board,
    /// Coefficients of the lens.
    pub lens: LensModel,
    /// The camera in use, for the table.
    pub in_use: PinholeCamera,
}

/// A calibrated camera with its table.
#[derive(Debug, Clone)]
pub struct CameraCalibration {
    /// The camera.
    pub camera: PinholeCamera,
    /// The table.
    pub calibration: Calibration,
}

/// Views of the board, and the images without one.
#[derive(Default)]
struct FoundViews {
    size: Option<(usize, usize)>,
    views: Vec<BoardView>,
    names: Vec<String>,
    /// Image and cause.
    rejected: Vec<String>,
}

/// Calibrates a camera by images of a board. Images without a board are named in the notes.
///
/// # Errors
/// When no image is given, the images differ in size, or too few show the board.
pub fn calibrate_board(
    request: &BoardRequest,
    progress: &dyn StepProgress,
) -> Result<CameraCalibration, AppError> {
    let files = image_files(&request.images)?;
    let mut found = FoundViews::default();
    progress.begin(Some(files.len()));
    for file in &files {
        if stop::is_requested(|| format!("{} of {} images", found.names.len(), files.len())) {
            progress.end();
            return Err(AppError::Stopped);
        }
        found.add(file, &request.board)?;
        progress.advance();
    }
    progress.end();
    let size = found.size.ok_or_else(|| {
        let cause = found.rejected.first().map_or("the folders hold none", String::as_str);
        AppError::Input(format!("no image can be read, expected JPEG or PNG: {cause}"))
    })?;
    let fit = calibrate_camera(&found.views, size, request.lens).map_err(|error| {
        let causes: Vec<String> = found.rejected.iter().take(3).cloned().collect();
        AppError::Input(
            format!("{} images: {error}; {}", files.len(), causes.join("; "))
                .trim_end_matches("; ")
                .to_owned(),
        )
    })?;
    let camera = fit.parameters.camera(size.0, size.1)?;
    Ok(CameraCalibration { camera, calibration: table(&fit, &found, &request.in_use, size) })
}

impl FoundViews {
    /// Searches the board in an image.
    fn add(&mut self, file: &Path, board: &Board) -> Result<(), AppError> {
        let name = file.display().to_string();
        let image = match read_gray(file) {
            Ok(image) => image,
            Err(error) => {
                self.rejected.push(error.to_string());
                return Ok(());
            }
        };
        let size = (image.width(), image.height());
        let first = *self.size.get_or_insert(size);
        if size != first {
            let (found, expected) =
                (format!("{} x {}", size.0, size.1), format!("{} x {}", first.0, first.1));
            return Err(AppError::Input(format!(
                "{name}: {found} px, expected {expected} px as in the first image; give images of one camera"
            )));
        }
        match board.find(&image) {
            Ok(view) => {
                self.views.push(view);
                self.names.push(name);
            }
            Err(problem) => self.rejected.push(format!("{name}: {problem}")),
        }
        Ok(())
    }
}

/// The files, and those in the folders by name.
fn image_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, AppError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let listed = std::fs::read_dir(path).map_err(|error| unreadable(path, &error))?;
        let is_image = |file: &PathBuf| {
            let ending = file.extension().map(|ending| ending.to_ascii_lowercase());
            ending.is_some_and(|ending| ["jpg", "jpeg", "png"].iter().any(|known| ending == **known))
        };
        let mut inside: Vec<PathBuf> = listed.flatten().map(|entry| entry.path()).filter(is_image).collect();
        inside.sort();
        files.extend(inside);
    }
    Ok(files)
}

fn unreadable(path: &Path, error: &std::io::Error) -> AppError {
    AppError::Input(format!("{}: cannot be read: {error}", path.display()))
}

fn read_gray(file: &Path) -> Result<GrayImage, AppError> {
    let bytes = std::fs::read(file).map_err(|error| unreadable(file, &error))?;
    let color =
        decode_color(&bytes).map_err(|error| AppError::Input(format!("{}: {error}", file.display())))?;
    Ok(gray_from_color(&color))
}

fn table(fit: &CameraFit, found: &FoundViews, in_use: &PinholeCamera, size: (usize, usize)) -> Calibration {
    let lens = in_use.distortion();
    let is_same_size = (in_use.width(), in_use.height()) == size;
    let before =
        [in_use.fx(), in_use.fy(), in_use.cx(), in_use.cy(), lens.k1, lens.k2, lens.p1, lens.p2, lens.k3];
    let mut values = vec![
        side("camera.width_px", size.0, in_use.width()),
        side("camera.height_px", size.1, in_use.height()),
    ];
    for (i, name) in CameraParameters::NAMES.iter().enumerate() {
        let (key, unit, decimals) = match i {
            0..4 => (format!("camera.{name}_px"), "px", 3),
            _ => (format!("camera.distortion.{name}"), "", 5),
        };
        let number = (fit.parameters.0[i], fit.sigmas[i]);
        let value = CalibratedValue::key(&key, number, unit, before[i], decimals);
        values.push(CalibratedValue { before: is_same_size.then_some(before[i]), ..value });
    }
    Calibration { values, notes: notes(fit, found) }
}

fn side(name: &str, pixels: usize, before: usize) -> CalibratedValue {
    let value = CalibratedValue::key(name, (pixels as f64, 0.0), "px", before as f64, 0);
    CalibratedValue { sigma: None, ..value }
}

/// Quality of the fit, what to improve, and the images that were left out.
fn notes(fit: &CameraFit, found: &FoundViews) -> Vec<String> {
    let mut notes = vec![format!(
        "residual {:.3} px over {} images, board tilted by up to {:.0} deg, corners in {:.0} % of the image",
        fit.residual_px,
        fit.coverage.views,
        fit.coverage.max_tilt_deg,
        fit.coverage.cells * 100.0
    )];
    notes.extend(fit.warnings().into_iter().map(|warning| format!("warning: {warning}")));
    notes.extend(found.rejected.iter().map(|image| format!("left out: {image}")));
    let unfit =
        fit.rejected.iter().map(|view| format!("left out: {}: {}", found.names[view.index], view.cause));
    notes.extend(unfit);
    notes
}

impl CameraCalibration {
    /// Writes a camera file, TOML, with depth in mm; the file is replaced whole.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_camera_file(&self, file: &Path) -> Result<(), AppError> {
        let model = CameraModel { camera: self.camera, depth_scale: KINECT_V2_DEPTH_SCALE };
        Ok(replace_file(file, model.to_toml().as_bytes())?)
    }
}
