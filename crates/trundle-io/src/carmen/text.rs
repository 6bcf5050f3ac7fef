//! The lines of a text file, plain or compressed with gzip, one at a time.

use crate::IoError;
use flate2::bufread::MultiGzDecoder;
use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};

/// Longest line \[bytes\]. A longer line is refused, which bounds the memory requested by a compressed file. A scan of the largest number
/// of beams is shorter. Source: ours.
const MAX_LINE_BYTES: u64 = 1 << 23;
/// The first bytes of a gzip file. Source: RFC 1952.
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];
/// The mark of UTF-8 that some editors put at the beginning of a file.
const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Reads a text file line by line.
pub(super) struct TextLines {
    path: PathBuf,
    reader: Box<dyn BufRead>,
    is_compressed: bool,
    number: usize,
    buffer: Vec<u8>,
}

impl fmt::Debug for TextLines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, number, .. } = self;
        f.debug_struct("TextLines").field("path", path).field("number", number).finish_non_exhaustive()
    }
}

impl TextLines {
    pub(super) fn open(path: &Path) -> Result<Self, IoError> {
        let file = File::open(path).map_err(IoError::system(path, "read"))?;
        Self::new(path, BufReader::new(file))
    }

    pub(super) fn new(path: &Path, mut file: impl BufRead + 'static) -> Result<Self, IoError> {
        let start = file.fill_buf().map_err(IoError::system(path, "read"))?;
        let is_compressed = start.starts_with(&GZIP_MAGIC);
        let reader: Box<dyn BufRead> =
            if is_compressed { Box::new(BufReader::new(MultiGzDecoder::new(file))) } else { Box::new(file) };
        Ok(Self { path: path.to_owned(), reader, is_compressed, number: 0, buffer: Vec::new() })
    }

    /// The next line with content, with its number from 1: not blank, no comment (`#`).
    pub(super) fn next_content(&mut self) -> Result<Option<(usize, &str)>, IoError> {
        while self.read_line()? {
            let (start, end) = content(self.text()?);
            if start < end {
                return Ok(Some((self.number, &self.text()?[start..end])));
            }
        }
        Ok(None)
    }

    /// Reads the next line into the buffer. Returns whether a line was read.
    fn read_line(&mut self) -> Result<bool, IoError> {
        self.buffer.clear();
        let mut limited = self.reader.by_ref().take(MAX_LINE_BYTES);
        match read_to_line_end(&mut limited, &mut self.buffer) {
            Ok(0) => return Ok(false),
            Ok(_) => self.number += 1,
            Err(error) if self.is_compressed => {
                let problem = broken_gzip(self.number, &error);
                return Err(IoError::malformed(&self.path, problem));
            }
            Err(error) => return Err(IoError::system(&self.path, "read")(error)),
        }
        if self.buffer.len() as u64 == MAX_LINE_BYTES && !self.buffer.ends_with(b"\n") {
            let problem = format!("is longer than {MAX_LINE_BYTES} bytes, expected lines of a CARMEN log");
            return Err(IoError::line(&self.path, self.number, problem));
        }
        Ok(true)
    }

    fn text(&self) -> Result<&str, IoError> {
        std::str::from_utf8(&self.buffer)
            .map_err(|_| IoError::line(&self.path, self.number, "is not UTF-8 text"))
    }
}

/// Appends a line to `buffer`, its end as LF: LF, CR LF, or CR alone. Returns the length of the line \[bytes\]; 0 at the end.
fn read_to_line_end(reader: &mut impl BufRead, buffer: &mut Vec<u8>) -> std::io::Result<usize> {
    loop {
        let available = match reader.fill_buf() {
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            available => available?,
        };
        let Some(at) = available.iter().position(|byte| matches!(byte, b'\n' | b'\r')) else {
            let len = available.len();
            if len == 0 {
                return Ok(buffer.len());
            }
            buffer.extend_from_slice(available);
            reader.consume(len);
            continue;
        };
        let is_cr = available[at] == b'\r';
        buffer.extend_from_slice(&available[..at]);
        buffer.push(b'\n');
        reader.consume(at + 1);
        // An error behind the line is that of the next line.
        if is_cr && reader.fill_buf().is_ok_and(|rest| rest.first() == Some(&b'\n')) {
            reader.consume(1);
        }
        return Ok(buffer.len());
    }
}

/// The problem of compressed data that end, or cannot be unpacked, after a line.
fn broken_gzip(line: usize, error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::UnexpectedEof => format!("the gzip file is cut off after line {line}"),
        // flate2 reports a stream that ends too early only by this text.
        _ if error.to_string().contains("incomplete") => {
            format!("the gzip file is cut off after line {line}")
        }
        _ => format!("the gzip data is broken after line {line}: {error}"),
    }
}

/// Positions of the first and one past the last content byte of a line; equal for a line without content.
fn content(line: &str) -> (usize, usize) {
    let rest = line.trim_start_matches(BYTE_ORDER_MARK).trim_start();
    let text = rest.trim_end();
    let start = line.len() - rest.len();
    if text.starts_with('#') { (start, start) } else { (start, start + text.len()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::{Compression, write::GzEncoder};
    use std::io::{Cursor, Write};

    fn lines(bytes: Vec<u8>) -> Result<Vec<(usize, String)>, String> {
        let name = |error: IoError| error.to_string();
        let mut reader = TextLines::new(Path::new("a.log"), Cursor::new(bytes)).map_err(name)?;
        let mut all = Vec::new();
        while let Some((number, line)) = reader.next_content().map_err(name)? {
            all.push((number, line.to_owned()));
        }
        Ok(all)
    }

    fn zipped(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn marks_ends_of_lines_and_comments_are_ignored() {
        let found = lines("\u{feff}# x\r\n a b \r\n\r\nc".into()).unwrap();
        assert_eq!(found, [(2, "a b".to_owned()), (4, "c".to_owned())]);
        assert_eq!(lines("\u{feff}a".into()).unwrap(), [(1, "a".to_owned())]);
        assert_eq!(lines(Vec::new()).unwrap(), []);
        let of_old_mac = lines(b"a\r# c\r\rb\r\nd\r".to_vec()).unwrap();
        assert_eq!(of_old_mac, [(1, "a".to_owned()), (4, "b".to_owned()), (5, "d".to_owned())]);
    }

    #[test]
    fn a_compressed_file_has_the_same_lines() {
        let text = "a\nb\n";
        assert_eq!(lines(zipped(text.as_bytes())).unwrap(), lines(text.into()).unwrap());
        let two = [zipped(b"a\n"), zipped(b"b\n")].concat();
        assert_eq!(lines(two).unwrap(), lines(text.into()).unwrap());
    }

    #[test]
    fn bytes_that_are_not_text_are_refused_by_line() {
        assert_eq!(lines(b"a\n\xff".to_vec()).unwrap_err(), "a.log, line 2: is not UTF-8 text");
        let many: Vec<u8> =
            (0..9000_u32).flat_map(|i| format!("{}\n", i.wrapping_mul(2_654_435_761)).into_bytes()).collect();
        let whole = zipped(&many);
        let cut = lines(whole[..whole.len() / 2].to_vec()).unwrap_err();
        assert!(cut.starts_with("a.log: the gzip file is cut off after line "), "{cut}");
    }

    #[test]
    fn a_compressed_file_cannot_ask_for_much_memory() {
        let bomb = zipped(&vec![b'7'; 1 << 25]);
        assert!(lines(bomb).unwrap_err().starts_with("a.log, line 1: is longer than 8388608 bytes"));
    }
}
