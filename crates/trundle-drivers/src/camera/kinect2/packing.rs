//! Images from packed 11-bit numbers. The orders of bits, columns and rows are assumptions; see [`super`].

use super::companding::Companding;
use super::layout::{COLUMNS, IMAGE_BYTES, PIXEL_BITS, ROW_BYTES, ROWS};
use trundle_core::{Image, Invalid};

/// Pixels in a group of whole bytes. Source: assumed; it agrees with \[Freenect2\].
const GROUP_PIXELS: usize = 8;
/// Bytes of a group.
const GROUP_BYTES: usize = PIXEL_BITS;
/// Columns of an interleaved block. Source: assumed; it agrees with \[Freenect2\].
const BLOCK_COLUMNS: usize = 128;
/// Interleaved blocks in a row.
const BLOCK_COUNT: usize = COLUMNS / BLOCK_COLUMNS;
/// Bits of one code.
const CODE_MASK: u128 = (1 << PIXEL_BITS) - 1;

/// Unpacks one image of 512 x 424 px into measurements.
///
/// # Errors
/// When `packed` has not 298,496 bytes or `image` has another size.
pub fn unpack(packed: &[u8], table: &Companding, image: &mut Image<i16>) -> Result<(), Invalid> {
    if packed.len() != IMAGE_BYTES {
        return Err(Invalid::new(
            "packed image of a Kinect V2",
            packed.len(),
            "bytes",
            IMAGE_BYTES.to_string(),
        ));
    }
    if (image.width(), image.height()) != (COLUMNS, ROWS) {
        let size = format!("{} x {}", image.width(), image.height());
        return Err(Invalid::new("image of a Kinect V2", size, "px", format!("{COLUMNS} x {ROWS}")));
    }
    for (stored, bytes) in packed.chunks_exact(ROW_BYTES).enumerate() {
        unpack_row(bytes, table, image.row_mut(row_of_stored(stored)));
    }
    Ok(())
}

/// The image row of a stored row: both halves from the middle outwards, the lower half first.
pub fn row_of_stored(stored: usize) -> usize {
    if stored < ROWS / 2 { ROWS / 2 + stored_from_middle(stored) } else { stored - ROWS / 2 }
}

fn stored_from_middle(stored: usize) -> usize {
    ROWS / 2 - 1 - stored
}

/// The image column of a stored column: four interleaved blocks.
pub fn column_of_stored(stored: usize) -> usize {
    stored % BLOCK_COLUMNS * BLOCK_COUNT + stored / BLOCK_COLUMNS
}

fn unpack_row(bytes: &[u8], table: &Companding, row: &mut [i16]) {
    let (groups, _) = bytes.as_chunks::<GROUP_BYTES>();
    for (index, group) in groups.iter().enumerate() {
        let mut wide = [0; 16];
        wide[..GROUP_BYTES].copy_from_slice(group);
        let bits = u128::from_le_bytes(wide);
        for i in 0..GROUP_PIXELS {
            let code = (bits >> (i * PIXEL_BITS)) & CODE_MASK;
            row[column_of_stored(index * GROUP_PIXELS + i)] = table.measurement(code as u16);
        }
    }
}
