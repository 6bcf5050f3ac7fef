//! Frames of packed measurements to depth.

use super::companding::Companding;
use super::edge_filter::remove_flying_pixels;
use super::layout::{COLUMNS, FREQUENCY_COUNT, IMAGE_COUNT, ROWS, SHIFT_COUNT};
use super::packing::unpack;
use super::phasors::{PhaseTables, PhasorImage};
use super::smoothing::smooth;
use super::unwrapping::Unwrapper;
use trundle_core::{DepthImage, Image, Invalid, PinholeCamera, Vector2, require_finite, require_in};

/// Largest distance that three frequencies distinguish \[m\]: c / (2 x 8 MHz). Source: \[Lawin16\].
const MAX_UNAMBIGUOUS_M: f64 = 18.73;

/// Calibration of one device.
#[derive(Debug, Clone, PartialEq)]
pub struct Kinect2Calibration {
    /// Offset of the phase of each pixel at each frequency \[1/65536 turn\]: 512 x 424 numbers each.
    pub p0: [Vec<u16>; FREQUENCY_COUNT],
    /// Intrinsics of the depth camera, 512 x 424 px.
    pub camera: PinholeCamera,
    /// Added to each distance \[m\]. Default 0.
    pub range_offset_m: f64,
}

/// Settings of the decoder.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DecoderConfig {
    /// Lowest amplitude of a valid pixel at each frequency \[1\], 1 to 10,000. Default 30. Source: ours; five times the noise of a
    /// measurement in the test's model.
    pub min_amplitude: f64,
    /// Nearest valid distance \[m\], 0 to 18.73. Default 0.4. Source: ours; nearer surfaces saturate.
    pub min_range_m: f64,
    /// Furthest valid distance \[m\], 0 to 18.73. Default 8. Source: \[Lawin16\], the intended use of the sensor.
    pub max_range_m: f64,
    /// Whether phasors are filtered. Default `true`.
    pub smooths_phasors: bool,
    /// Whether flying pixels are removed. Default `true`.
    pub removes_flying_pixels: bool,
}

impl Default for DecoderConfig {
    fn default() -> Self {
        Self {
            min_amplitude: 30.0,
            min_range_m: 0.4,
            max_range_m: 8.0,
            smooths_phasors: true,
            removes_flying_pixels: true,
        }
    }
}

impl DecoderConfig {
    /// The settings, each in its range.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self, Invalid> {
        require_in("min_amplitude", self.min_amplitude, "", 1.0, 10_000.0)?;
        require_in("min_range_m", self.min_range_m, "m", 0.0, MAX_UNAMBIGUOUS_M)?;
        require_in("max_range_m", self.max_range_m, "m", self.min_range_m, MAX_UNAMBIGUOUS_M)?;
        Ok(self)
    }
}

/// Computes depth from packed measurements. After construction, no memory is allocated.
#[derive(Debug, Clone)]
pub struct DepthDecoder {
    config: DecoderConfig,
    range_offset_m: f32,
    table: Companding,
    phases: PhaseTables,
    unwrapper: Unwrapper,
    /// Depth for one metre along the ray of each pixel.
    depth_per_range: Vec<f32>,
    images: [Image<i16>; FREQUENCY_COUNT * SHIFT_COUNT],
    phasors: PhasorImage,
    smoothed: PhasorImage,
    raw_depth: DepthImage,
    depth: DepthImage,
    amplitude: Image<f32>,
}

impl DepthDecoder {
    /// For one device.
    ///
    /// # Errors
    /// When a table or the camera has not 512 x 424 px, or a setting is out of range.
    pub fn new(calibration: &Kinect2Calibration, config: DecoderConfig) -> Result<Self, Invalid> {
        let config = config.checked()?;
        require_finite("range_offset_m", calibration.range_offset_m, "m")?;
        let empty = DepthImage::filled(COLUMNS, ROWS, 0.0);
        Ok(Self {
            config,
            range_offset_m: calibration.range_offset_m as f32,
            table: Companding::new(),
            phases: PhaseTables::new(&calibration.p0)?,
            unwrapper: Unwrapper::new(config.max_range_m, config.min_amplitude as f32),
            depth_per_range: depth_per_range(&calibration.camera)?,
            images: std::array::from_fn(|_| Image::filled(COLUMNS, ROWS, 0)),
            phasors: PhasorImage::empty(),
            smoothed: PhasorImage::empty(),
            raw_depth: empty.clone(),
            depth: empty.clone(),
            amplitude: empty,
        })
    }

    /// Decodes the ten packed images of a frame; the last one, ambient light, is ignored. The result is depth along the optical axis \[m\],
    /// 512 x 424 px, 0 for unknown.
    ///
    /// # Errors
    /// When an image has not 298,496 bytes.
    pub fn decode(&mut self, packed: &[Vec<u8>; IMAGE_COUNT]) -> Result<&DepthImage, Invalid> {
        for (image, packed) in self.images.iter_mut().zip(packed) {
            unpack(packed, &self.table, image)?;
        }
        self.phases.phasors(&self.images, &mut self.phasors);
        if self.config.smooths_phasors {
            smooth(&self.phasors, &mut self.smoothed);
            std::mem::swap(&mut self.phasors, &mut self.smoothed);
        }
        self.unwrap();
        if self.config.removes_flying_pixels {
            remove_flying_pixels(&self.raw_depth, &mut self.depth);
        } else {
            self.depth.data_mut().copy_from_slice(self.raw_depth.data());
        }
        Ok(&self.depth)
    }

    /// Mean amplitude of the last decoded frame \[1\]: an infrared image; 0 without depth.
    pub fn amplitude(&self) -> &Image<f32> {
        &self.amplitude
    }

    fn unwrap(&mut self) {
        let targets = self.raw_depth.data_mut().iter_mut().zip(self.amplitude.data_mut());
        let pixels = self.depth_per_range.iter().enumerate();
        for ((depth, amplitude), (pixel, depth_per_range)) in targets.zip(pixels) {
            let (range, found) = self.unwrapper.distance(&self.phasors.at(pixel)).unwrap_or_default();
            let range = range + self.range_offset_m;
            let is_valid = found > 0.0
                && range >= self.config.min_range_m as f32
                && range <= self.config.max_range_m as f32;
            *depth = if is_valid { range * depth_per_range } else { 0.0 };
            *amplitude = if is_valid { found } else { 0.0 };
        }
    }
}

/// Cosine of the angle between the ray of each pixel and the optical axis.
fn depth_per_range(camera: &PinholeCamera) -> Result<Vec<f32>, Invalid> {
    if (camera.width(), camera.height()) != (COLUMNS, ROWS) {
        let size = format!("{} x {}", camera.width(), camera.height());
        return Err(Invalid::new("depth camera of a Kinect V2", size, "px", format!("{COLUMNS} x {ROWS}")));
    }
    let cosine = |(x, y): (usize, usize)| {
        let pixel = camera.undistort(Vector2::new(x as f64, y as f64));
        (1.0 / camera.unproject(pixel, 1.0).norm()) as f32
    };
    Ok((0..ROWS).flat_map(|y| (0..COLUMNS).map(move |x| (x, y))).map(cosine).collect())
}
