//! The rows of an uncompressed image, checked for size.

use crate::camera::RawImage;
use trundle_core::Invalid;

/// Largest number of columns or rows \[px\]. A larger number indicates a damaged header. Source: the limit of
/// [`trundle_core::PinholeCamera`].
const MAX_SIDE_PX: usize = 16_384;

/// The rows of an uncompressed image, without their padding.
///
/// # Errors
/// When the format is compressed, a side is out of range, or the number of bytes is wrong.
pub(super) fn rows(raw: &RawImage) -> Result<impl Iterator<Item = &[u8]>, Invalid> {
    let pixel = raw.format.bytes_per_pixel().ok_or_else(|| {
        Invalid::new("pixel format", raw.format, "", "an uncompressed format in an image by rows")
    })?;
    check_size(raw)?;
    let row = raw.width * pixel;
    let stride = if raw.stride == 0 { row } else { raw.stride };
    if stride < row {
        let expected = format!("{row} bytes or more for {} px of {}", raw.width, raw.format);
        return Err(Invalid::new("row stride of an image", stride, "bytes", expected));
    }
    check_length(raw, row, stride)?;
    Ok(raw.bytes.chunks(stride).take(raw.height).map(move |chunk| &chunk[..row]))
}

/// Refuses images without pixels and of absurd size.
///
/// # Errors
/// When a side is out of range.
pub(super) fn check_size(raw: &RawImage) -> Result<(), Invalid> {
    let is_a_side = |pixels: usize| (1..=MAX_SIDE_PX).contains(&pixels);
    if is_a_side(raw.width) && is_a_side(raw.height) {
        return Ok(());
    }
    let value = format!("{} x {}", raw.width, raw.height);
    Err(Invalid::new(format!("size of a {} image", raw.format), value, "px", "1 x 1 to 16384 x 16384"))
}

/// The padding of the last row is optional, and no bytes may follow it.
fn check_length(raw: &RawImage, row: usize, stride: usize) -> Result<(), Invalid> {
    let too_large =
        || Invalid::new("row stride of an image", stride, "bytes", "a stride that fits in memory");
    let whole = stride.checked_mul(raw.height).ok_or_else(too_large)?;
    let shortest = whole - (stride - row);
    if (shortest..=whole).contains(&raw.bytes.len()) {
        return Ok(());
    }
    let place = format!("length of a {} image", raw.format);
    let expected = format!("{shortest} to {whole} bytes for {} x {} px", raw.width, raw.height);
    Err(Invalid::new(place, raw.bytes.len(), "bytes", expected))
}
