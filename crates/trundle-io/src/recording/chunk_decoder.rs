//! Decompression of MCAP chunks: lz4 and zstd.

use mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use mcap::{McapError, McapResult};
use std::io::{self, Read};

/// Decodes the compressed chunks of MCAP files, in Rust alone: `lz4` (frames) and `zstd`.
///
/// A chunk is decoded once all of it is there: chunks are some MB, and written whole.
pub(super) struct ChunkDecoder {
    name: &'static str,
    decode: fn(&[u8], &mut Vec<u8>) -> io::Result<()>,
    decoded: Vec<u8>,
    told: usize,
}

/// Longest decoded chunk, bytes: bounds what a broken one can ask for.
const MAX_CHUNK: u64 = 1 << 28;

impl ChunkDecoder {
    /// One for each of the compressions that MCAP names.
    pub(super) fn all() -> [Self; 2] {
        let of = |name, decode| Self { name, decode, decoded: Vec::new(), told: 0 };
        [of("lz4", lz4), of("zstd", zstd)]
    }
}

/// What can be decoded of the beginning of a chunk; `None` where the compression is unknown.
pub(super) fn decoded_prefix(compression: &[u8], bytes: &[u8]) -> Option<Vec<u8>> {
    if compression.is_empty() {
        return Some(bytes.to_vec());
    }
    let decoder = ChunkDecoder::all().into_iter().find(|known| known.name.as_bytes() == compression)?;
    let mut decoded = Vec::new();
    // The error is the cut itself; what comes before it is there.
    let _ = (decoder.decode)(bytes, &mut decoded);
    Some(decoded)
}

fn lz4(source: &[u8], to: &mut Vec<u8>) -> io::Result<()> {
    lz4_flex::frame::FrameDecoder::new(source).take(MAX_CHUNK).read_to_end(to).map(drop)
}

fn zstd(source: &[u8], to: &mut Vec<u8>) -> io::Result<()> {
    let decoder = ruzstd::decoding::StreamingDecoder::new(source).map_err(io::Error::other)?;
    decoder.take(MAX_CHUNK).read_to_end(to).map(drop)
}

impl Decompressor for ChunkDecoder {
    fn next_read_size(&self) -> usize {
        0
    }

    /// Nothing until the input is whole: the reader then asks again with more of it, and gives up at its end.
    fn decompress(&mut self, source: &[u8], to: &mut [u8]) -> McapResult<DecompressResult> {
        let mut consumed = 0;
        if self.told == self.decoded.len() && !source.is_empty() {
            (self.told, consumed) = (0, source.len());
            self.decoded.clear();
            if (self.decode)(source, &mut self.decoded).is_err() {
                (self.decoded, consumed) = (Vec::new(), 0);
            }
            if self.decoded.len() as u64 >= MAX_CHUNK {
                return Err(McapError::DecompressionError(format!("a chunk of more than {MAX_CHUNK} bytes")));
            }
        }
        let rest = &self.decoded[self.told..];
        let wrote = rest.len().min(to.len());
        to[..wrote].copy_from_slice(&rest[..wrote]);
        self.told += wrote;
        Ok(DecompressResult { consumed, wrote })
    }

    fn reset(&mut self) -> McapResult<()> {
        (self.told, self.decoded) = (0, Vec::new());
        Ok(())
    }

    fn name(&self) -> &'static str {
        self.name
    }
}
