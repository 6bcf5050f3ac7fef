//! A file with the calibration and the packets of a Kinect V2.
//!
//! | part | content |
//! |---|---|
//! | header | one line of JSON, at most 65,536 bytes: `magic` "trundle-kinect2", `version` 1, `camera`, `range_offset_m` (default 0) |
//! | P0 tables | 3 x 512 x 424 numbers of 16 bits, rows from the top left, in the order 80, 16, 120 MHz |
//! | packets | `KV2P`, then four numbers of 32 bits: time \[0.125 ms\], sequence, subsequence, length; then the bytes |
//!
//! Numbers are little endian. Packets may be missing; a frame without all ten packets is dropped.

use super::decoder::Kinect2Calibration;
use super::layout::{IMAGE_BYTES, PIXEL_COUNT};
use super::packets::{FrameAssembler, PackedFrame, SubPacket};
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, Read, Write};
use trundle_core::{Invalid, PinholeCamera, require_in};

/// First word of the header.
const DUMP_MAGIC: &str = "trundle-kinect2";
/// Version of the form. Source: ours.
const DUMP_VERSION: u32 = 1;
/// First bytes of a packet. Source: ours.
const PACKET_MAGIC: [u8; 4] = *b"KV2P";
/// Longest header \[bytes\]. Source: ours; a header has about 300 bytes.
const MAX_HEADER_BYTES: u64 = 65_536;
/// Largest offset of the range \[m\]. Source: ours; a larger one is a mistyped number.
const MAX_RANGE_OFFSET_M: f64 = 1.0;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    magic: String,
    version: u32,
    camera: PinholeCamera,
    #[serde(default)]
    range_offset_m: f64,
}

/// Camera and range offset \[m\] from the header of a dump.
///
/// # Errors
/// A sentence that names the field.
pub fn parse_dump_header(bytes: &[u8]) -> Result<(PinholeCamera, f64), String> {
    let header: Header = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
    if (header.magic.as_str(), header.version) != (DUMP_MAGIC, DUMP_VERSION) {
        let found = (header.magic, header.version);
        return Err(format!("magic and version are {found:?}, expected {:?}", (DUMP_MAGIC, DUMP_VERSION)));
    }
    let limit = MAX_RANGE_OFFSET_M;
    require_in("range_offset_m", header.range_offset_m, "m", -limit, limit).map_err(|e| e.to_string())?;
    Ok((header.camera, header.range_offset_m))
}

/// Reads a dump.
#[derive(Debug)]
pub struct DumpReader<R: BufRead> {
    reader: R,
    calibration: Kinect2Calibration,
    assembler: FrameAssembler,
}

impl<R: BufRead> DumpReader<R> {
    /// Reads header and tables.
    ///
    /// # Errors
    /// When reading fails, or the header is not valid (kind `InvalidData`).
    pub fn new(mut reader: R) -> io::Result<Self> {
        let mut line = Vec::new();
        (&mut reader).take(MAX_HEADER_BYTES).read_until(b'\n', &mut line)?;
        let (camera, range_offset_m) =
            parse_dump_header(&line).map_err(|problem| invalid(format!("header of the dump: {problem}")))?;
        let p0 = [table(&mut reader)?, table(&mut reader)?, table(&mut reader)?];
        let calibration = Kinect2Calibration { p0, camera, range_offset_m };
        Ok(Self { reader, calibration, assembler: FrameAssembler::default() })
    }

    /// The calibration of the device.
    pub fn calibration(&self) -> &Kinect2Calibration {
        &self.calibration
    }

    /// Frames dropped since a packet was missing.
    pub fn dropped(&self) -> u64 {
        self.assembler.dropped()
    }

    /// The next whole frame; `None` at the end. A packet that ends within itself is the end.
    ///
    /// # Errors
    /// When reading fails, or a packet has another magic or length (kind `InvalidData`).
    pub fn next_frame(&mut self) -> io::Result<Option<PackedFrame>> {
        while let Some(packet) = self.packet()? {
            if let Some(frame) = self.assembler.push(packet) {
                return Ok(Some(frame));
            }
        }
        Ok(None)
    }

    fn packet(&mut self) -> io::Result<Option<SubPacket>> {
        let Some([magic, fields @ ..]) = self.words()? else { return Ok(None) };
        if magic != PACKET_MAGIC {
            return Err(invalid(format!(
                "a packet of the dump begins with {magic:?}, expected {PACKET_MAGIC:?}"
            )));
        }
        let [ticks, sequence, subsequence, length] = fields.map(u32::from_le_bytes);
        if length as usize != IMAGE_BYTES {
            return Err(invalid(format!("a packet of the dump has {length} bytes, expected {IMAGE_BYTES}")));
        }
        let bytes = read_or_end(&mut self.reader, IMAGE_BYTES)?;
        Ok(bytes.map(|bytes| SubPacket { ticks, sequence, subsequence, bytes }))
    }

    fn words(&mut self) -> io::Result<Option<[[u8; 4]; 5]>> {
        let bytes = read_or_end(&mut self.reader, 20)?;
        Ok(bytes.and_then(|bytes| bytes.as_chunks::<4>().0.first_chunk().copied()))
    }
}

/// Writes a dump.
#[derive(Debug)]
pub struct DumpWriter<W: Write> {
    writer: W,
}

impl<W: Write> DumpWriter<W> {
    /// Writes header and tables.
    ///
    /// # Errors
    /// When writing fails, or a table has not 512 x 424 numbers (kind `InvalidData`).
    pub fn new(mut writer: W, calibration: &Kinect2Calibration) -> io::Result<Self> {
        let (magic, version) = (DUMP_MAGIC.to_owned(), DUMP_VERSION);
        let (camera, range_offset_m) = (calibration.camera, calibration.range_offset_m);
        let header = serde_json::to_string(&Header { magic, version, camera, range_offset_m })?;
        writeln!(writer, "{header}")?;
        for table in &calibration.p0 {
            if table.len() != PIXEL_COUNT {
                let problem = Invalid::new("P0 table", table.len(), "numbers", PIXEL_COUNT.to_string());
                return Err(invalid(problem.to_string()));
            }
            writer.write_all(&table.iter().flat_map(|step| step.to_le_bytes()).collect::<Vec<u8>>())?;
        }
        Ok(Self { writer })
    }

    /// Writes a packet.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write(&mut self, packet: &SubPacket) -> io::Result<()> {
        self.writer.write_all(&PACKET_MAGIC)?;
        for field in [packet.ticks, packet.sequence, packet.subsequence, packet.bytes.len() as u32] {
            self.writer.write_all(&field.to_le_bytes())?;
        }
        self.writer.write_all(&packet.bytes)
    }

    /// The writer, after the last packet.
    pub fn into_inner(self) -> W {
        self.writer
    }
}

fn table(reader: &mut impl Read) -> io::Result<Vec<u16>> {
    let missing = || invalid("the dump ends within its P0 tables".into());
    let bytes = read_or_end(reader, 2 * PIXEL_COUNT)?.ok_or_else(missing)?;
    Ok(bytes.as_chunks::<2>().0.iter().map(|pair| u16::from_le_bytes(*pair)).collect())
}

/// `length` bytes; `None` if the reader ends before.
fn read_or_end(reader: &mut impl Read, length: usize) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    reader.take(length as u64).read_to_end(&mut bytes)?;
    Ok(Some(bytes).filter(|bytes| bytes.len() == length))
}

fn invalid(problem: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, problem)
}
