//! Maps that last: saved as bytes, loaded with every number checked.
//!
//! | bytes | |
//! |---|---|
//! | 7 | `trundlM` |
//! | 1 | version |
//! | 8 | checksum of the rest (FNV-1a by words of 8 bytes) |
//! | 18 x 8 | camera and ORB settings, f64 |
//! | 4, then each | number of maps; a map: its number, keyframes with the ways between them by the wheels, the axis of the floor, landmarks with their observations and looks, loops |
//!
//! All little endian. What follows from the rest is not saved: rectified pixels, words, spanning tree. The trajectory is
//! no part of a map.

mod bytes;
mod error;
mod frame;
mod look;
mod map;
mod settings;

use crate::config::SlamConfig;
use crate::map::LandmarkMap;
use crate::report::MapId;
use crate::sensor::Sensor;
use bytes::{Reader, Writer, checksum};
pub use error::MapFileError;
use trundle_core::PinholeCamera;

const MAGIC: &[u8; 7] = b"trundlM";
const VERSION: u8 = 3;
/// Bytes before those that the checksum is of.
const HEAD: usize = 16;

/// Maps with their numbers, by rising number, and what they were made with.
pub(crate) fn save<'a>(
    camera: &PinholeCamera,
    config: &SlamConfig,
    maps: impl ExactSizeIterator<Item = (MapId, &'a LandmarkMap)>,
) -> Vec<u8> {
    let mut out = Writer::default();
    out.0.extend(MAGIC);
    out.u8(VERSION);
    out.u64(0);
    settings::write(&mut out, camera, &config.orb);
    out.count(maps.len());
    for (id, map) in maps {
        out.u32(id.0);
        map::write(&mut out, map);
    }
    let mut bytes = out.0;
    let sum = checksum(&bytes[HEAD..]);
    bytes[HEAD - 8..HEAD].copy_from_slice(&sum.to_le_bytes());
    bytes
}

/// Reads [`save`].
///
/// # Errors
/// When the bytes are no map, of another version, damaged, cut off, made with other settings, or contradict themselves.
pub(crate) fn load(
    bytes: &[u8],
    sensor: &Sensor,
    config: &SlamConfig,
) -> Result<Vec<(MapId, LandmarkMap)>, MapFileError> {
    let mut body = checked_body(bytes)?;
    settings::check(&mut body, &sensor.camera, &config.orb)?;
    let mut maps: Vec<(MapId, LandmarkMap)> = Vec::new();
    for _ in 0..body.count(12)? {
        let id = body.u32()?;
        let rises = maps.last().is_none_or(|(last, _)| last.0 < id) && id < u32::MAX;
        body.require(rises, "number of a map", id, || "rising numbers".to_owned())?;
        maps.push((MapId(id), map::read(&mut body, sensor)?));
    }
    body.end()?;
    Ok(maps)
}

fn checked_body(bytes: &[u8]) -> Result<Reader<'_>, MapFileError> {
    let Some((magic, rest)) = bytes.split_first_chunk::<7>().filter(|(magic, _)| *magic == MAGIC) else {
        return Err(MapFileError::Foreign);
    };
    let _ = magic;
    let mut head = Reader::new(rest, "head");
    let found = head.u8()?;
    if found != VERSION {
        return Err(MapFileError::Version { found, expected: VERSION });
    }
    let sum = head.u64()?;
    let body = &bytes[HEAD..];
    if checksum(body) != sum {
        return Err(MapFileError::Checksum);
    }
    Ok(Reader::new(body, "settings"))
}
