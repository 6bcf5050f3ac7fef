//! Sizes and frequencies of the depth sensor.

/// Columns of the depth image \[px\]. Source: \[Lawin16\].
pub const COLUMNS: usize = 512;
/// Rows of the depth image \[px\]. Source: \[Lawin16\].
pub const ROWS: usize = 424;
/// Pixels of one image.
pub const PIXEL_COUNT: usize = COLUMNS * ROWS;
/// Modulation frequencies. Source: \[Lawin16\].
pub const FREQUENCY_COUNT: usize = 3;
/// Shifted measurements at each frequency. Source: \[Lawin16\].
pub const SHIFT_COUNT: usize = 3;
/// Images in one frame: nine measurements and one of ambient light.
pub const IMAGE_COUNT: usize = FREQUENCY_COUNT * SHIFT_COUNT + 1;
/// Bits of one pixel. Source: assumed; it agrees with \[Freenect2\].
pub const PIXEL_BITS: usize = 11;
/// Bytes of one row: 704.
pub const ROW_BYTES: usize = COLUMNS * PIXEL_BITS / 8;
/// Bytes of one image: 298,496.
pub const IMAGE_BYTES: usize = ROW_BYTES * ROWS;
/// Modulation frequencies in the order of the images \[Hz\]. Source: \[Lawin16\]; the order is assumed.
pub const MODULATION_HZ: [f64; FREQUENCY_COUNT] = [80e6, 16e6, 120e6];
/// Speed of light \[m/s\]. Source: SI.
pub const LIGHT_SPEED_M_PER_S: f64 = 299_792_458.0;

/// Distance at which the phase of a frequency comes round \[m\]: half a wavelength of the modulation.
pub fn wrap_distance_m(frequency: usize) -> f64 {
    LIGHT_SPEED_M_PER_S / (2.0 * MODULATION_HZ[frequency])
}
