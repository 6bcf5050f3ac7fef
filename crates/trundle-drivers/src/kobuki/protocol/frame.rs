//! The frame of a packet: header, length, sub-payloads and checksum.

use thiserror::Error;

/// Header bytes of every frame. Source: the protocol's "Header".
pub const FRAME_HEADER: [u8; 2] = [0xAA, 0x55];
/// Minimum number of bytes of a payload: a sub-payload with one byte of data. Source: the protocol's "Length".
pub const MIN_PAYLOAD_BYTES: usize = 3;
/// Maximum number of bytes of a payload. Source: the length field has one byte.
pub const MAX_PAYLOAD_BYTES: usize = 255;
/// Bytes of a frame in addition to its payload: header (2), length, checksum. Source: the protocol's "Structure of Bytestream".
pub const FRAME_OVERHEAD_BYTES: usize = 4;

/// A refused payload.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PayloadError {
    /// A sub-payload reaches beyond the end of the payload.
    #[error(
        "sub-payload {id} at byte {at} of the Kobuki packet has {bytes} bytes of data, {left} are left: the packet is damaged"
    )]
    Overrun {
        /// Identifier of the sub-payload.
        id: u8,
        /// Place of the sub-payload in the payload, bytes.
        at: usize,
        /// Length that the sub-payload states, bytes.
        bytes: usize,
        /// Bytes of the payload after the sub-payload's header.
        left: usize,
    },
    /// A known sub-payload is shorter than its fields.
    #[error(
        "sub-payload {id} of the Kobuki packet has {bytes} bytes of data, expected at least {expected}: damaged packet or unknown firmware"
    )]
    Short {
        /// Identifier of the sub-payload.
        id: u8,
        /// Length that the sub-payload states, bytes.
        bytes: usize,
        /// Minimum length, bytes.
        expected: usize,
    },
    /// The payload ends within the header of a sub-payload.
    #[error("the Kobuki packet ends inside the header of a sub-payload at byte {at}: the packet is damaged")]
    Truncated {
        /// Place of the sub-payload in the payload, bytes.
        at: usize,
    },
}

/// A part of a payload: an identifier and its data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SubPayload<'a> {
    /// Identifier.
    pub id: u8,
    /// Data, without identifier and length.
    pub data: &'a [u8],
}

/// XOR of `bytes`. The XOR over a frame from its length byte to its checksum is zero.
pub fn checksum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

/// The frame around `payload`; a payload longer than 255 bytes is cut to its whole sub-payloads below that.
pub fn frame(payload: &[u8]) -> Vec<u8> {
    let payload = fitting(payload);
    let mut bytes = Vec::with_capacity(payload.len() + FRAME_OVERHEAD_BYTES);
    bytes.extend(FRAME_HEADER);
    bytes.push(payload.len() as u8);
    bytes.extend(payload);
    bytes.push(checksum(&bytes[2..]));
    bytes
}

/// The longest beginning of whole sub-payloads that a frame can hold.
fn fitting(payload: &[u8]) -> &[u8] {
    if payload.len() <= MAX_PAYLOAD_BYTES {
        return payload;
    }
    let ends = sub_payloads(payload).scan(0, |end, part| {
        *end += part.data.len() + 2;
        Some(*end)
    });
    let end = ends.take_while(|end| *end <= MAX_PAYLOAD_BYTES).last().unwrap_or(0);
    &payload[..end]
}

/// Appends a sub-payload to a payload; data beyond 255 bytes are left out.
pub fn push_sub_payload(payload: &mut Vec<u8>, id: u8, data: &[u8]) {
    let data = &data[..data.len().min(MAX_PAYLOAD_BYTES)];
    payload.extend([id, data.len() as u8]);
    payload.extend(data);
}

/// The sub-payloads of a payload, up to the first damaged one.
pub fn sub_payloads(payload: &[u8]) -> impl Iterator<Item = SubPayload<'_>> {
    let mut rest = payload;
    std::iter::from_fn(move || {
        let [id, bytes, after @ ..] = rest else { return None };
        let (data, next) = after.split_at_checked(usize::from(*bytes))?;
        rest = next;
        Some(SubPayload { id: *id, data })
    })
}

/// Checks the sub-payloads of a payload of `total` bytes, of which `received` have arrived.
///
/// `min_bytes` is the minimum length of the data of an identifier, `None` for an unknown one. The error found in a partial payload is equal
/// to the one found in the whole payload.
///
/// # Errors
/// The first damaged sub-payload: beyond the end, too short, or cut in its header.
pub fn check_payload(
    received: &[u8],
    total: usize,
    min_bytes: fn(u8) -> Option<usize>,
) -> Result<(), PayloadError> {
    let mut at = 0;
    while at < total {
        if at + 1 == total {
            return Err(PayloadError::Truncated { at });
        }
        let (Some(id), Some(bytes)) = (received.get(at), received.get(at + 1)) else { return Ok(()) };
        let (id, bytes, left) = (*id, usize::from(*bytes), total - at - 2);
        if bytes > left {
            return Err(PayloadError::Overrun { id, at, bytes, left });
        }
        if let Some(expected) = min_bytes(id).filter(|expected| bytes < *expected) {
            return Err(PayloadError::Short { id, bytes, expected });
        }
        at += 2 + bytes;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn any_length(_: u8) -> Option<usize> {
        None
    }

    #[test]
    fn a_frame_has_header_length_and_checksum() {
        let bytes = frame(&[1, 4, 0x2C, 1, 0, 0]);
        assert_eq!(bytes, [0xAA, 0x55, 6, 1, 4, 0x2C, 1, 0, 0, 6 ^ 1 ^ 4 ^ 0x2C ^ 1]);
        assert_eq!(checksum(&bytes[2..]), 0);
    }

    #[test]
    fn a_payload_that_is_too_long_loses_whole_sub_payloads() {
        let mut payload = Vec::new();
        for id in 0..5 {
            push_sub_payload(&mut payload, id, &[id; 60]);
        }
        let bytes = frame(&payload);
        assert_eq!(bytes[2], 248);
        assert_eq!(sub_payloads(&bytes[3..bytes.len() - 1]).map(|p| p.id).collect::<Vec<_>>(), [0, 1, 2, 3]);
    }

    #[test]
    fn an_error_in_a_beginning_is_the_error_of_the_whole() {
        let damaged = [3, 3, 0, 0, 0, 6, 9, 1, 1];
        let error = check_payload(&damaged, damaged.len(), any_length);
        assert_eq!(error, Err(PayloadError::Overrun { id: 6, at: 5, bytes: 9, left: 2 }));
        assert_eq!(check_payload(&damaged[..7], damaged.len(), any_length), error);
        assert_eq!(check_payload(&damaged[..6], damaged.len(), any_length), Ok(()));
        assert_eq!(check_payload(&[3, 1, 0, 6], 4, any_length), Err(PayloadError::Truncated { at: 3 }));
        let short = check_payload(&[3, 1, 0], 3, |_| Some(3));
        assert_eq!(short, Err(PayloadError::Short { id: 3, bytes: 1, expected: 3 }));
    }
}
