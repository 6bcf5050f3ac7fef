//! The bytes of a raw image (`sensor_msgs/msg/Image`), row by row.

use crate::codec::CodecError;

/// A raw image with the bytes of its message.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawImage {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) encoding: String,
    pub(super) is_big_endian: bool,
    /// Bytes of a row, those behind its last pixel among them.
    pub(super) step: usize,
    pub(super) data: Vec<u8>,
}

impl RawImage {
    /// The rows without padding, for `bytes` per pixel.
    pub(super) fn rows(
        &self,
        kind: &'static str,
        bytes: usize,
    ) -> Result<impl Iterator<Item = &[u8]>, CodecError> {
        let Self { width, height, step, data, .. } = self;
        let row = width.checked_mul(bytes).filter(|row| row <= step);
        let all = step.checked_mul(*height).filter(|all| *all <= data.len() && *width > 0 && *height > 0);
        match (row, all) {
            (Some(row), Some(_)) => Ok(data.chunks_exact(*step).take(*height).map(move |line| &line[..row])),
            _ => Err(CodecError::decode(
                kind,
                format!(
                    "{width} x {height} px of '{}' with {step} bytes per row do not fit into {} bytes",
                    self.encoding,
                    data.len()
                ),
            )),
        }
    }
}
