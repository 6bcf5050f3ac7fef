//! Colour sampled from the colour camera into the output camera.

use super::checks::{check_size, is_same_lens};
use trundle_core::{ColorImage, Invalid, PinholeCamera, Vector2};

/// Positions of the output pixels in the colour image.
#[derive(Debug, Clone)]
pub(super) struct ColorMap {
    camera: PinholeCamera,
    output: PinholeCamera,
    /// Position of each output pixel in the colour image \[px\]; `None` outside. Empty if both cameras are the same.
    places: Vec<Option<[f32; 2]>>,
    /// Numbers of samples in columns and rows for one output pixel. For 1, bilinear interpolation uses four pixels.
    samples: [usize; 2],
}

impl ColorMap {
    pub(super) fn new(camera: PinholeCamera, output: PinholeCamera) -> Self {
        let place = |(x, y): (usize, usize)| {
            let ray = output.unproject(output.undistort(Vector2::new(x as f64, y as f64)), 1.0);
            let pixel = camera.distort(camera.project(ray)?);
            camera.contains(pixel).then_some([pixel.x as f32, pixel.y as f32])
        };
        let pixels = (0..output.height()).flat_map(|y| (0..output.width()).map(move |x| (x, y)));
        let places = if is_same_lens(&camera, &output) { Vec::new() } else { pixels.map(place).collect() };
        let samples = [camera.fx() / output.fx(), camera.fy() / output.fy()];
        Self { camera, output, places, samples: samples.map(|scale| scale.round().max(1.0) as usize) }
    }

    /// Samples `color` into `mapped`; black outside the colour image.
    ///
    /// # Errors
    /// When `color` has not the size of the colour camera.
    pub(super) fn remap(&self, color: &ColorImage, mapped: &mut ColorImage) -> Result<(), Invalid> {
        check_size("colour image", color.width(), color.height(), &self.camera)?;
        check_size("registered colour image", mapped.width(), mapped.height(), &self.output)?;
        if self.places.is_empty() {
            mapped.data_mut().copy_from_slice(color.data());
            return Ok(());
        }
        let is_single = self.samples == [1, 1];
        for (target, place) in mapped.data_mut().iter_mut().zip(&self.places) {
            *target = match place {
                None => [0; 3],
                Some(place) if is_single => bilinear(color, *place),
                Some(place) => mean(color, *place, self.samples),
            };
        }
        Ok(())
    }
}

/// The four pixels around a place, by their nearness.
fn bilinear(color: &ColorImage, [x, y]: [f32; 2]) -> [u8; 3] {
    let (x, y) = (x.clamp(0.0, (color.width() - 1) as f32), y.clamp(0.0, (color.height() - 1) as f32));
    let (x0, y0) = (x as usize, y as usize);
    let (x1, y1) = ((x0 + 1).min(color.width() - 1), (y0 + 1).min(color.height() - 1));
    let (right, down) = (x - x0 as f32, y - y0 as f32);
    let (upper, lower) = (color.row(y0), color.row(y1));
    std::array::from_fn(|c| {
        let upper = upper[x0][c] as f32 * (1.0 - right) + upper[x1][c] as f32 * right;
        let lower = lower[x0][c] as f32 * (1.0 - right) + lower[x1][c] as f32 * right;
        (upper * (1.0 - down) + lower * down + 0.5) as u8
    })
}

/// The mean of the pixels that one output pixel covers.
fn mean(color: &ColorImage, [x, y]: [f32; 2], [across, down]: [usize; 2]) -> [u8; 3] {
    let start = |at: f32, samples: usize, side: usize| {
        let first = (at - 0.5 * (samples - 1) as f32 + 0.5).max(0.0) as usize;
        (first.min(side - 1), (first + samples).min(side))
    };
    let ((x0, x1), (y0, y1)) = (start(x, across, color.width()), start(y, down, color.height()));
    let mut sum = [0u32; 3];
    for row in y0..y1 {
        for pixel in &color.row(row)[x0..x1] {
            (0..3).for_each(|c| sum[c] += pixel[c] as u32);
        }
    }
    let count = ((x1 - x0) * (y1 - y0)).max(1) as u32;
    sum.map(|sum| ((sum + count / 2) / count) as u8)
}
