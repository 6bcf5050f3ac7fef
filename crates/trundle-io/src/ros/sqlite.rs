//! Reader of the tables of an SQLite file, without SQL.

use crate::IoError;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Reads the tables of an SQLite file, row by row in the order of their ids, without other features of SQL.
///
/// Source: the file format as SQLite documents it (`sqlite.org/fileformat.html`, sections 1.3 and 1.6).
pub(super) struct Sqlite {
    path: PathBuf,
    file: File,
    page_size: usize,
    /// Bytes of a page that are used.
    usable: usize,
    pages: u32,
}

/// A value of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Null,
    Integer(i64),
    Real(f64),
    Text(String),
    Blob(Vec<u8>),
}

/// Position of the reading in a table: the pages down to here, each with the number of its next cell.
#[derive(Debug, Clone)]
pub(super) struct TableRows {
    path_down: Vec<(Vec<u8>, u32, usize)>,
    next_page: Option<u32>,
    /// Pages read so far: a tree has each page once.
    read: u32,
}

impl TableRows {
    /// Position before the first row of the table whose tree begins at page `root`.
    pub(super) fn new(root: u32) -> Self {
        Self { path_down: Vec::new(), next_page: Some(root), read: 0 }
    }
}

/// Largest depth of a tree \[pages\]. Source: SQLite, `BTCURSOR_MAX_DEPTH`.
const MAX_TREE_DEPTH: usize = 20;

impl Sqlite {
    pub(super) fn open(path: &Path) -> Result<Self, IoError> {
        let system = || IoError::system(path, "read");
        let mut file = File::open(path).map_err(system())?;
        let length = file.metadata().map_err(system())?.len();
        let mut header = [0; 100];
        file.read_exact(&mut header)
            .map_err(|_| IoError::malformed(path, "not an SQLite file: too short"))?;
        let page_size = match u16::from_be_bytes([header[16], header[17]]) {
            1 => 65_536,
            size => usize::from(size),
        };
        let usable = page_size.saturating_sub(usize::from(header[20]));
        if !page_size.is_power_of_two() || page_size < 512 || usable < 480 {
            return Err(IoError::malformed(
                path,
                format!("page size is {page_size} bytes, expected 512 to 65536"),
            ));
        }
        let mut log = path.as_os_str().to_owned();
        log.push("-wal");
        if std::fs::metadata(Path::new(&log)).is_ok_and(|meta| meta.len() > 0) {
            let problem = "its last messages are in a -wal file beside it: `sqlite3 FILE 'PRAGMA wal_checkpoint'` brings them in";
            return Err(IoError::malformed(path, problem));
        }
        let pages = u32::try_from(length / page_size as u64).unwrap_or(u32::MAX);
        Ok(Self { path: path.to_owned(), file, page_size, usable, pages })
    }

    /// The first page of a table's tree.
    pub(super) fn table(&mut self, name: &str) -> Result<Option<u32>, IoError> {
        let mut rows = TableRows::new(1);
        while let Some((_, values)) = self.next_row(&mut rows)? {
            if let [Value::Text(kind), Value::Text(own), _, Value::Integer(root), ..] = &values[..]
                && kind == "table"
                && own == name
            {
                return Ok(u32::try_from(*root).ok());
            }
        }
        Ok(None)
    }

    /// The id and the values of the next row.
    pub(super) fn next_row(&mut self, rows: &mut TableRows) -> Result<Option<(i64, Vec<Value>)>, IoError> {
        loop {
            if let Some(page) = rows.next_page.take() {
                rows.read += 1;
                if rows.path_down.len() >= MAX_TREE_DEPTH || rows.read > self.pages {
                    return Err(self.broken(page, "the tree does not end"));
                }
                rows.path_down.push((self.page(page)?, page, 0));
            }
            let Some((page, number, cell)) = rows.path_down.last_mut() else { return Ok(None) };
            let (number, at) = (*number, *cell);
            *cell += 1;
            match Node::of(page, number, at) {
                Some(Node::Row(offset)) => return self.row(page, number, offset).map(Some),
                Some(Node::Below(next)) => rows.next_page = Some(next),
                Some(Node::End) => drop(rows.path_down.pop()),
                None => return Err(self.broken(number, "not a page of a table")),
            }
        }
    }

    fn row(&mut self, page: &[u8], number: u32, offset: usize) -> Result<(i64, Vec<Value>), IoError> {
        let short = || IoError::malformed(&self.path, format!("page {number}: a row ends early"));
        let mut at = offset;
        let length = varint(page, &mut at).and_then(|length| usize::try_from(length).ok());
        let length = length.filter(|length| *length <= self.file_bytes()).ok_or_else(short)?;
        let id = varint(page, &mut at).ok_or_else(short)?;
        let local = local_bytes(length, self.usable);
        let mut record = page.get(at..at + local).ok_or_else(short)?.to_vec();
        if local < length {
            let next = page.get(at + local..at + local + 4).ok_or_else(short)?;
            self.follow(u32::from_be_bytes([next[0], next[1], next[2], next[3]]), length, &mut record)?;
        }
        values(&record).map(|values| (id, values)).ok_or_else(|| self.broken(number, "a row is broken"))
    }

    /// Appends what does not fit on a row's own page.
    fn follow(&mut self, mut next: u32, length: usize, record: &mut Vec<u8>) -> Result<(), IoError> {
        while record.len() < length {
            let page = self.page(next)?;
            let take = (length - record.len()).min(self.usable - 4);
            record.extend_from_slice(&page[4..4 + take]);
            next = u32::from_be_bytes([page[0], page[1], page[2], page[3]]);
        }
        Ok(())
    }

    fn page(&mut self, number: u32) -> Result<Vec<u8>, IoError> {
        if number == 0 || number > self.pages {
            return Err(self.broken(number, "the file ends before it"));
        }
        let mut page = vec![0; self.page_size];
        let start = u64::from(number - 1) * self.page_size as u64;
        let read = self.file.seek(SeekFrom::Start(start)).and_then(|_| self.file.read_exact(&mut page));
        read.map_err(IoError::system(&self.path, "read"))?;
        Ok(page)
    }

    /// Bytes of all pages: no row is longer.
    fn file_bytes(&self) -> usize {
        self.page_size.saturating_mul(self.pages as usize)
    }

    fn broken(&self, page: u32, problem: &str) -> IoError {
        IoError::malformed(&self.path, format!("page {page}: {problem}"))
    }
}

/// Content of a page of a tree at a place.
enum Node {
    /// A row, at this byte.
    Row(usize),
    /// A page with more.
    Below(u32),
    End,
}

impl Node {
    fn of(page: &[u8], number: u32, cell: usize) -> Option<Self> {
        let start = if number == 1 { 100 } else { 0 };
        let u16_at =
            |at: usize| Some(usize::from(u16::from_be_bytes(page.get(at..at + 2)?.try_into().ok()?)));
        let u32_at = |at: usize| Some(u32::from_be_bytes(page.get(at..at + 4)?.try_into().ok()?));
        let count = u16_at(start + 3)?;
        match page.get(start)? {
            0x0d if cell < count => Some(Self::Row(u16_at(start + 8 + 2 * cell)?)),
            0x0d => Some(Self::End),
            0x05 if cell < count => u32_at(u16_at(start + 12 + 2 * cell)?).map(Self::Below),
            0x05 if cell == count => u32_at(start + 8).map(Self::Below),
            0x05 => Some(Self::End),
            _ => None,
        }
    }
}

/// Number of a row's bytes on its own page.
fn local_bytes(length: usize, usable: usize) -> usize {
    let max = usable - 35;
    if length <= max {
        return length;
    }
    let min = (usable - 12) * 32 / 255 - 23;
    let fitting = min + (length - min) % (usable - 4);
    if fitting <= max { fitting } else { min }
}

/// Seven bits per byte, the highest first; of a ninth byte all eight.
fn varint(bytes: &[u8], at: &mut usize) -> Option<i64> {
    let mut value = 0_u64;
    for i in 0..9 {
        let byte = *bytes.get(*at)?;
        *at += 1;
        if i == 8 {
            return Some((value << 8 | u64::from(byte)).cast_signed());
        }
        value = value << 7 | u64::from(byte & 0x7f);
        if byte < 0x80 {
            break;
        }
    }
    Some(value.cast_signed())
}

/// The values of a row: a head with their types, then themselves.
fn values(record: &[u8]) -> Option<Vec<Value>> {
    let mut head = 0;
    let end = usize::try_from(varint(record, &mut head)?).ok()?;
    let mut body = end;
    let mut values = Vec::new();
    while head < end {
        let kind = varint(record, &mut head)?;
        let length = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            12.. => usize::try_from((kind - 12) / 2).ok()?,
            _ => return None,
        };
        let bytes = record.get(body..body.checked_add(length)?)?;
        body += length;
        values.push(value(kind, bytes)?);
    }
    Some(values)
}

fn value(kind: i64, bytes: &[u8]) -> Option<Value> {
    let integer = || {
        let sign = if bytes.first().is_some_and(|b| *b >= 0x80) { -1_i64 } else { 0 };
        bytes.iter().fold(sign, |value, byte| value << 8 | i64::from(*byte))
    };
    Some(match kind {
        0 => Value::Null,
        1..=6 => Value::Integer(integer()),
        7 => Value::Real(f64::from_be_bytes(bytes.try_into().ok()?)),
        8 | 9 => Value::Integer(kind - 8),
        _ if kind % 2 == 0 => Value::Blob(bytes.to_vec()),
        _ => Value::Text(String::from_utf8(bytes.to_vec()).ok()?),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_of_many_lengths() {
        let read = |bytes: &[u8]| varint(bytes, &mut 0);
        assert_eq!(read(&[0x7f]), Some(127));
        assert_eq!(read(&[0x81, 0x00]), Some(128));
        assert_eq!(read(&[0xff; 9]), Some(-1));
        assert_eq!(read(&[0x81]), None);
        assert_eq!(value(1, &[0xfe]), Some(Value::Integer(-2)));
        assert_eq!(value(3, &[0x01, 0x00, 0x00]), Some(Value::Integer(65_536)));
    }

    #[test]
    fn a_row_of_each_kind() {
        // Head of 5 bytes: null, one byte, the number 1, a text of two bytes; then the bytes.
        let record = [5, 0, 1, 9, 17, 0x2a, b'o', b'k'];
        let expected = vec![Value::Null, Value::Integer(42), Value::Integer(1), Value::Text("ok".to_owned())];
        assert_eq!(values(&record), Some(expected));
        assert_eq!(values(&record[..7]), None);
    }

    /// The first row of the table at the second of two pages of 512 bytes, which `second` makes.
    fn first_row(second: impl Fn(&mut [u8])) -> Result<Option<i64>, String> {
        let mut bytes = vec![0; 1024];
        bytes[..16].copy_from_slice(b"SQLite format 3\0");
        bytes[16] = 2;
        second(&mut bytes[512..]);
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), &bytes).unwrap();
        let mut sqlite = Sqlite::open(file.path()).unwrap();
        let row = sqlite.next_row(&mut TableRows::new(2)).map_err(|error| error.to_string())?;
        Ok(row.map(|(id, _)| id))
    }

    #[test]
    fn a_ring_of_pages_ends() {
        // An inner page whose 100 cells all name the page itself: 100^20 pages of a tree.
        let ring = |page: &mut [u8]| {
            (page[0], page[4]) = (0x05, 100);
            page[400..404].copy_from_slice(&[0, 0, 0, 2]);
            for cell in 0..100 {
                page[12 + 2 * cell..14 + 2 * cell].copy_from_slice(&400_u16.to_be_bytes());
            }
        };
        assert!(first_row(ring).unwrap_err().contains("the tree does not end"));
    }

    #[test]
    fn a_row_longer_than_the_file_is_refused_before_it_is_read() {
        // A row of 2^27 bytes whose overflow page is its own successor.
        let long = |page: &mut [u8]| {
            (page[0], page[4]) = (0x0d, 1);
            page[8..10].copy_from_slice(&100_u16.to_be_bytes());
            page[100..104].copy_from_slice(&[0xc0, 0x80, 0x80, 0x00]);
        };
        assert!(first_row(long).unwrap_err().contains("a row ends early"));
    }

    proptest! {
        #[test]
        fn any_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..60), cell in 0..9_usize) {
            let _ = values(&bytes);
            let _ = Node::of(&bytes, 2, cell);
        }
    }
}
