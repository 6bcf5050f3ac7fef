//! Checks the claimed size of an image against the number of its bytes.

use super::error::CodecError;

/// Longest side of an image that is read \[px\]: a bound for broken headers. Source: ours.
pub(super) const MAX_SIDE: u32 = 16_384;
/// Largest number of pixels of an image that is read. Source: ours.
pub(super) const MAX_PIXELS: usize = 1 << 26;
/// Greatest factor by which the compressions of images shrink: deflate's 1032. A larger claim is false. Source: \[RFC 1951\].
const MAX_COMPRESSION: usize = 1100;

/// Whether a file of `file_bytes` bytes can hold `pixels` pixels.
pub(crate) fn can_hold(file_bytes: usize, pixels: usize, bits_per_pixel: usize) -> bool {
    pixels / 8 <= file_bytes.saturating_mul(MAX_COMPRESSION) / bits_per_pixel.max(1)
}

/// Refuses an image that claims no pixel, more than the limit, or more than its file can hold.
pub(super) fn check_size(
    kind: &'static str,
    (width, height): (usize, usize),
    bits_per_pixel: usize,
    file_bytes: usize,
) -> Result<(), CodecError> {
    let pixels = width.checked_mul(height).filter(|pixels| (1..=MAX_PIXELS).contains(pixels));
    if pixels.is_some_and(|pixels| can_hold(file_bytes, pixels, bits_per_pixel)) {
        return Ok(());
    }
    let expected = format!("1 to {MAX_PIXELS} px that its {file_bytes} bytes can hold");
    Err(CodecError::decode(kind, format!("{width} x {height} px, expected {expected}")))
}
