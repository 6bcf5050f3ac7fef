//! Images of a board by a known camera: anti-aliased, blurred, noisy. Shares the camera's model with no code of the calibration.

use nalgebra::UnitQuaternion;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{GrayImage, PinholeCamera, Pose3, Vector2, Vector3};
use trundle_vision::board::TagBoard;
use trundle_vision::board::tags::{TAG_CELLS, tag_cells};

/// Brightness on a sheet around its middle, m.
pub struct Pattern {
    /// Grey value at a position; `None` off the sheet.
    paint: Box<dyn Fn(Vector2) -> Option<f64>>,
    /// Half width and half height of the sheet, m.
    half: Vector2,
    /// From the middle to the first corner, m.
    first: Vector2,
}

/// Settings of a rendered image.
pub struct Shot {
    /// Standard deviation of the blur, px.
    pub blur_px: f64,
    /// Standard deviation of the noise, grey values.
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// Samples along each side of a pixel.
const SAMPLES: usize = 3;

impl Pattern {
    /// A checkerboard with this number of inner corners, a white margin of one square.
    pub fn checkerboard((columns, rows): (usize, usize), square: f64) -> Self {
        let cells = Vector2::new(columns as f64 + 1.0, rows as f64 + 1.0);
        let half = (cells / 2.0 + Vector2::repeat(1.0)) * square;
        let paint = move |at: Vector2| {
            let cell = at / square + cells / 2.0;
            if cell.x < -1.0 || cell.y < -1.0 || cell.x > cells.x + 1.0 || cell.y > cells.y + 1.0 {
                return None;
            }
            let is_inside = cell.x >= 0.0 && cell.y >= 0.0 && cell.x < cells.x && cell.y < cells.y;
            let is_dark = is_inside && (cell.x.floor() + cell.y.floor()) as i64 % 2 == 0;
            Some(if is_dark { 35.0 } else { 215.0 })
        };
        let first = (Vector2::repeat(1.0) - cells / 2.0) * square;
        Self { paint: Box::new(paint), half, first }
    }

    /// A board of markers, with the black squares of Kalibr between them or without, and a white margin of one gap.
    pub fn tags(board: TagBoard, has_squares: bool) -> Self {
        let TagBoard { columns, rows, side, gap_ratio, .. } = board;
        let gap = side * gap_ratio;
        let length = |count: usize| count as f64 * (side + gap) - gap;
        let size = Vector2::new(length(columns), length(rows));
        let cells: Vec<_> = board.ids().map(|id| tag_cells(id).unwrap()).collect();
        let paint = move |at: Vector2| {
            let at = at + size / 2.0;
            if at.x < -gap || at.y < -gap || at.x > size.x + gap || at.y > size.y + gap {
                return None;
            }
            let (column, row) = ((at.x / (side + gap)).floor(), (at.y / (side + gap)).floor());
            let inside = (at - Vector2::new(column, row) * (side + gap)) * (TAG_CELLS as f64 / side);
            let is_on_board =
                column >= 0.0 && row >= 0.0 && (column as usize) < columns && (row as usize) < rows;
            let is_dark = match (inside.x < TAG_CELLS as f64, inside.y < TAG_CELLS as f64) {
                (true, true) if is_on_board => {
                    let tag = &cells[(rows - 1 - row as usize) * columns + column as usize];
                    !tag[inside.y as usize][inside.x as usize]
                }
                (false, false) => has_squares,
                _ => false,
            };
            Some(if is_dark { 35.0 } else { 215.0 })
        };
        Self { paint: Box::new(paint), half: size / 2.0 + Vector2::repeat(gap), first: -size / 2.0 }
    }

    /// The same sheet covered with grey disks of this radius, m.
    pub fn covered(self, middles: Vec<Vector2>, radius: f64) -> Self {
        let paint = move |at: Vector2| {
            let is_covered = middles.iter().any(|middle| (middle - at).norm() < radius);
            if is_covered { Some(120.0) } else { (self.paint)(at) }
        };
        Self { paint: Box::new(paint), half: self.half, first: self.first }
    }

    /// The board's frame at its first corner.
    pub fn camera_from_first_corner(&self, camera_from_sheet: &Pose3) -> Pose3 {
        let shift = Vector3::new(self.first.x, self.first.y, 0.0);
        *camera_from_sheet * Pose3::new(UnitQuaternion::identity(), shift)
    }

    /// The board's frame at the opposite corner, turned by 180 deg: as good for a checkerboard.
    pub fn camera_from_last_corner(&self, camera_from_sheet: &Pose3) -> Pose3 {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
        let shift = Vector3::new(-self.first.x, -self.first.y, 0.0);
        *camera_from_sheet * Pose3::new(turn, shift)
    }
}

/// Poses `camera_from_sheet` about the image, tilted by up to `tilt` rad about both axes.
pub fn poses(pattern: &Pattern, tilt: f64, count: usize) -> Vec<Pose3> {
    let pose = |i: usize| {
        let phase = i as f64 * 2.399_963;
        let (sin, cos) = phase.sin_cos();
        let turn = UnitQuaternion::from_euler_angles(tilt * sin, tilt * cos, 0.25 * (1.7 * phase).sin());
        let far = pattern.half.norm() * (2.6 + 0.5 * (0.9 * phase).cos());
        let aside = Vector2::new((1.3 * phase).cos() * 0.36, (1.3 * phase).sin() * 0.26) * far;
        Pose3::new(turn, Vector3::new(aside.x, aside.y, far))
    };
    (0..count).map(pose).collect()
}

/// Directions of the samples of each pixel, camera frame, z = 1: the part of an image that no pose changes.
pub struct Rays {
    size: (usize, usize),
    rays: Vec<Vector3>,
}

impl Rays {
    pub fn new(camera: &PinholeCamera) -> Self {
        let (width, height) = (camera.width(), camera.height());
        let ray = |i: usize| {
            let (pixel, sample) = (i / (SAMPLES * SAMPLES), i % (SAMPLES * SAMPLES));
            let at =
                |pixel: usize, sample: usize| pixel as f64 + (sample as f64 + 0.5) / SAMPLES as f64 - 0.5;
            let raw = Vector2::new(at(pixel % width, sample % SAMPLES), at(pixel / width, sample / SAMPLES));
            camera.unproject(camera.undistort(raw), 1.0)
        };
        Self { size: (width, height), rays: (0..width * height * SAMPLES * SAMPLES).map(ray).collect() }
    }
}

/// The image of a sheet at `camera_from_sheet`.
pub fn render(rays: &Rays, camera_from_sheet: &Pose3, pattern: &Pattern, shot: &Shot) -> GrayImage {
    let (width, height) = rays.size;
    let sheet_from_camera = camera_from_sheet.inverse();
    let from = sheet_from_camera.translation;
    let turn = sheet_from_camera.rotation_matrix();
    let brightness = |ray: &Vector3| {
        let along = turn * ray;
        let at = from - along * (from.z / along.z);
        // A room of mild texture behind the sheet.
        let room = 110.0 + 25.0 * (ray.x * 14.0).sin() * (ray.y * 10.0).cos();
        (pattern.paint)(Vector2::new(at.x, at.y)).unwrap_or(room)
    };
    let mean = |samples: &[Vector3]| samples.iter().map(brightness).sum::<f64>() / samples.len() as f64;
    let sharp: Vec<f64> = rays.rays.chunks(SAMPLES * SAMPLES).map(mean).collect();
    let blurred = blurred(&sharp, (width, height), shot.blur_px);
    let mut rng = ChaCha8Rng::seed_from_u64(shot.seed);
    let mut noise = || shot.noise * ((0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0);
    let data = blurred.iter().map(|value| (value + noise()).round().clamp(0.0, 255.0) as u8).collect();
    GrayImage::new(width, height, data).unwrap()
}

fn blurred(values: &[f64], (width, height): (usize, usize), sigma: f64) -> Vec<f64> {
    let weights: Vec<f64> = (-3..=3).map(|i| (-0.5 * (f64::from(i) / sigma).powi(2)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    let pass = |values: &[f64], (dx, dy): (i64, i64)| -> Vec<f64> {
        (0..width * height)
            .map(|i| {
                let (x, y) = ((i % width) as i64, (i / width) as i64);
                let value = |k: i64| {
                    let x = (x + dx * k).clamp(0, width as i64 - 1) as usize;
                    let y = (y + dy * k).clamp(0, height as i64 - 1) as usize;
                    values[y * width + x]
                };
                (-3..=3).map(|k| weights[(k + 3) as usize] * value(k)).sum::<f64>() / sum
            })
            .collect()
    };
    pass(&pass(values, (1, 0)), (0, 1))
}
