//! The records in an MCAP chunk, which may be compressed with lz4 (frames) or zstd.

use mcap::records::{Record, op};
use mcap::{McapError, McapResult, parse_record};
use std::io::{self, Read};

/// A record: its opcode and its content.
pub(super) type OwnedRecord = (u8, Vec<u8>);

/// Length of a decoded chunk \[bytes\]. A longer chunk is refused, a bound for broken chunks. Source: ours, chunks are some MB.
const MAX_CHUNK: u64 = 1 << 28;
/// Length of a record's head: opcode and length \[bytes\]. Source: MCAP specification, "Records".
pub(super) const HEAD_BYTES: usize = 1 + 8;
/// Length of a chunk's head before the name of its compression: times, size, checksum \[bytes\]. Source: MCAP specification, "Chunk".
pub(super) const CHUNK_HEAD_BYTES: usize = 8 + 8 + 8 + 4;

/// The records of a whole chunk.
///
/// # Errors
/// When the chunk cannot be decoded, has another checksum or length than declared, or its last record is truncated.
pub(super) fn records_of_chunk(chunk: &[u8]) -> McapResult<Vec<OwnedRecord>> {
    let (head, packed) = match parse_record(op::CHUNK, require_compression(chunk)?)? {
        Record::Chunk { header, data } => (header, data),
        _ => return Err(McapError::UnexpectedEoc),
    };
    let decoded = decoded(&head.compression, &packed)?;
    if decoded.len() as u64 != head.uncompressed_size {
        return Err(McapError::UnexpectedEoc);
    }
    let (saved, calculated) = (head.uncompressed_crc, crc32fast::hash(&decoded));
    if saved != 0 && saved != calculated {
        return Err(McapError::BadChunkCrc { saved, calculated });
    }
    let (records, rest) = split_records(&decoded);
    if rest.is_empty() { Ok(records) } else { Err(McapError::UnexpectedEoc) }
}

/// The chunk, if the name of its compression is within it.
fn require_compression(chunk: &[u8]) -> McapResult<&[u8]> {
    let length =
        chunk.get(CHUNK_HEAD_BYTES..).and_then(<[u8]>::first_chunk).ok_or(McapError::UnexpectedEof)?;
    let length = u32::from_le_bytes(*length) as usize;
    chunk.get(CHUNK_HEAD_BYTES + 4 + length..).ok_or(McapError::UnexpectedEof)?;
    Ok(chunk)
}

/// The complete records at the beginning of the bytes, and the rest.
pub(super) fn split_records(mut bytes: &[u8]) -> (Vec<OwnedRecord>, &[u8]) {
    let mut records = Vec::new();
    while let Some((head, rest)) = bytes.split_at_checked(HEAD_BYTES) {
        let length = u64::from_le_bytes(head[1..].try_into().unwrap_or_default());
        let content = usize::try_from(length).ok().and_then(|length| rest.split_at_checked(length));
        let Some((content, rest)) = content else { break };
        records.push((head[0], content.to_vec()));
        bytes = rest;
    }
    (records, bytes)
}

fn decoded(compression: &str, packed: &[u8]) -> McapResult<Vec<u8>> {
    let decode = decoder(compression.as_bytes())
        .ok_or_else(|| McapError::UnsupportedCompression(compression.to_owned()))?;
    let mut decoded = Vec::new();
    decode(packed, &mut decoded).map_err(|error| McapError::DecompressionError(error.to_string()))?;
    if decoded.len() as u64 >= MAX_CHUNK {
        return Err(McapError::DecompressionError(format!("a chunk of more than {MAX_CHUNK} bytes")));
    }
    Ok(decoded)
}

/// The decodable beginning of a chunk; `None` if the compression is unknown.
pub(super) fn decoded_prefix(compression: &[u8], bytes: &[u8]) -> Option<Vec<u8>> {
    let mut decoded = Vec::new();
    // The error is the cut itself; the data before the cut is available.
    let _ = decoder(compression)?(bytes, &mut decoded);
    Some(decoded)
}

/// Decodes bytes into a buffer.
type Decode = fn(&[u8], &mut Vec<u8>) -> io::Result<()>;

/// The decoder of an MCAP compression.
fn decoder(compression: &[u8]) -> Option<Decode> {
    match compression {
        b"" => Some(plain),
        b"lz4" => Some(lz4),
        b"zstd" => Some(zstd),
        _ => None,
    }
}

fn plain(source: &[u8], to: &mut Vec<u8>) -> io::Result<()> {
    to.extend_from_slice(source);
    Ok(())
}

fn lz4(source: &[u8], to: &mut Vec<u8>) -> io::Result<()> {
    lz4_flex::frame::FrameDecoder::new(source).take(MAX_CHUNK).read_to_end(to).map(drop)
}

fn zstd(source: &[u8], to: &mut Vec<u8>) -> io::Result<()> {
    let decoder = ruzstd::decoding::StreamingDecoder::new(source).map_err(io::Error::other)?;
    decoder.take(MAX_CHUNK).read_to_end(to).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chunk with these records and this length of the first one.
    fn chunk(first_length: u64) -> Vec<u8> {
        let records = [&[op::SCHEMA][..], &first_length.to_le_bytes(), b"abc"].concat();
        let crc = crc32fast::hash(&records);
        let head =
            [[0; 16].to_vec(), (records.len() as u64).to_le_bytes().to_vec(), crc.to_le_bytes().to_vec()];
        let compression = 0_u32.to_le_bytes();
        let length = (records.len() as u64).to_le_bytes();
        [&head.concat()[..], &compression, &length, &records].concat()
    }

    #[test]
    fn a_record_that_is_longer_than_its_chunk_is_refused() {
        assert_eq!(records_of_chunk(&chunk(3)).unwrap(), [(op::SCHEMA, b"abc".to_vec())]);
        for length in [4, 0, u64::MAX] {
            assert!(matches!(records_of_chunk(&chunk(length)), Err(McapError::UnexpectedEoc)), "{length}");
        }
        let whole = chunk(3);
        for end in 0..whole.len() {
            assert!(records_of_chunk(&whole[..end]).is_err(), "{end}");
        }
        let mut broken = whole.clone();
        *broken.last_mut().unwrap() = b'x';
        assert!(matches!(records_of_chunk(&broken), Err(McapError::BadChunkCrc { .. })));
    }
}
