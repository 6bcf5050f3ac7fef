//! Heights over the floor as a 16-bit PNG and a YAML file with the meaning of its numbers.

use crate::IoError;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use std::path::Path;

/// Height of one step of the picture, m. Source: ours.
const STEP_M: f64 = 0.001;
/// Pixel of a cell whose height is unknown. Source: ours.
const UNKNOWN_PIXEL: u16 = u16::MAX;

/// Heights over the cells of the floor.
#[derive(Debug, Clone, Copy)]
pub struct HeightGrid<'a> {
    /// Side of a cell, m.
    pub resolution: f64,
    /// Lower left corner of the map, m.
    pub origin: [f64; 2],
    /// Number of cells along x.
    pub width: usize,
    /// Height of each cell, m, NaN for unknown; x fastest, from the lower left corner.
    pub heights: &'a [f32],
}

/// A picture and its description.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HeightFiles {
    /// The PNG.
    pub picture: Vec<u8>,
    /// The YAML.
    pub description: String,
}

/// Heights as a grey 16-bit PNG, the upper row first, in steps of 1 mm from the lowest height; 65535 is unknown. Heights more than 65.5 m
/// above the lowest one are unknown.
///
/// # Errors
/// When the picture cannot be encoded; `path` is named.
pub fn height_files(path: &Path, grid: &HeightGrid<'_>) -> Result<HeightFiles, IoError> {
    let known = || grid.heights.iter().filter(|height| height.is_finite());
    let lowest = f64::from(known().copied().reduce(f32::min).unwrap_or(0.0));
    let pixel = |height: f32| {
        let steps = ((f64::from(height) - lowest) / STEP_M).round();
        if steps.is_finite() && steps < f64::from(UNKNOWN_PIXEL) { steps as u16 } else { UNKNOWN_PIXEL }
    };
    let rows = grid.heights.chunks(grid.width.max(1)).rev();
    let bytes: Vec<u8> = rows.flatten().flat_map(|height| pixel(*height).to_ne_bytes()).collect();
    let size = (grid.width as u32, (grid.heights.len() / grid.width.max(1)) as u32);
    let mut picture = Vec::new();
    PngEncoder::new(&mut picture)
        .write_image(&bytes, size.0, size.1, ExtendedColorType::L16)
        .map_err(|error| IoError::malformed(path, error.to_string()))?;
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let [x, y] = grid.origin;
    let description = format!(
        "# Heights over the floor: lowest_m + pixel * step_m, m. Pixel {UNKNOWN_PIXEL} is unknown.\nimage: {name:?}\nresolution: \
         {resolution}\norigin: [{x}, {y}, 0.0]\nlowest_m: {lowest}\nstep_m: {STEP_M}\nunknown: {UNKNOWN_PIXEL}\n",
        resolution = grid.resolution
    );
    Ok(HeightFiles { picture, description })
}
