//! The bytes of a file, decompressed if the file is packed with zstd.

use ruzstd::decoding::{FrameDecoder, StreamingDecoder};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};

/// First bytes of a file that is packed with zstd. Source: RFC 8878.
const ZSTD_MAGIC: &[u8] = b"\x28\xb5\x2f\xfd";

/// The bytes of a file, and whether it is packed.
pub(super) fn unpacked(file: File) -> io::Result<(Box<dyn Read + Send>, bool)> {
    let mut file = BufReader::with_capacity(1 << 16, file);
    if !file.fill_buf()?.starts_with(ZSTD_MAGIC) {
        return Ok((Box::new(file), false));
    }
    Ok((Box::new(ZstdFrames { decoder: Some(decoder(file)?) }), true))
}

/// The bytes of all frames of a zstd file, piece by piece.
struct ZstdFrames {
    /// Decoder of the present frame; `None` after the last one.
    decoder: Option<Decoder>,
}

type Decoder = StreamingDecoder<BufReader<File>, FrameDecoder>;

fn decoder(file: BufReader<File>) -> io::Result<Decoder> {
    StreamingDecoder::new(file).map_err(io::Error::other)
}

impl Read for ZstdFrames {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        while let Some(frame) = &mut self.decoder {
            let count = frame.read(to)?;
            if count > 0 || to.is_empty() {
                return Ok(count);
            }
            let mut rest = self.decoder.take().expect("invariant: a frame was read").into_inner();
            self.decoder = if rest.fill_buf()?.is_empty() { None } else { Some(decoder(rest)?) };
        }
        Ok(0)
    }
}
