//! Maps as the bytes of a file, and back.

use crate::config::SlamConfig;
use crate::frame::observation_model::ObservationModel;
use crate::ids::MapId;
use crate::map::landmark_map::LandmarkMap;
use crate::persist::bytes::{Reader, Writer, checksum};
use crate::persist::error::MapFileError;
use crate::persist::{map, settings};
use trundle_core::PinholeCamera;

/// First bytes of a map file. Source: ours.
const MAGIC: &[u8; 7] = b"trundlM";
/// Version of the format. Source: ours.
const FORMAT_VERSION: u8 = 3;
/// Bytes before those that the checksum covers.
const HEAD_BYTES: usize = 16;

/// Maps with their ids, by rising id, and the settings of their features, as bytes.
pub(crate) fn save<'a>(
    camera: &PinholeCamera,
    config: &SlamConfig,
    maps: impl ExactSizeIterator<Item = (MapId, &'a LandmarkMap)>,
) -> Vec<u8> {
    let mut out = Writer::default();
    out.0.extend(MAGIC);
    out.u8(FORMAT_VERSION);
    out.u64(0);
    settings::write(&mut out, camera, &config.orb);
    out.count(maps.len());
    for (id, map) in maps {
        out.u32(id.0);
        map::write(&mut out, map);
    }
    let mut bytes = out.0;
    let sum = checksum(&bytes[HEAD_BYTES..]);
    bytes[HEAD_BYTES - 8..HEAD_BYTES].copy_from_slice(&sum.to_le_bytes());
    bytes
}

/// Reads [`save`].
///
/// # Errors
/// When the bytes are not a map, of another version, damaged, cut off, made with other settings, or contradict themselves.
pub(crate) fn load(
    bytes: &[u8],
    model: &ObservationModel,
    config: &SlamConfig,
) -> Result<Vec<(MapId, LandmarkMap)>, MapFileError> {
    let mut body = checked_body(bytes)?;
    settings::check(&mut body, &model.camera, &config.orb)?;
    let mut maps: Vec<(MapId, LandmarkMap)> = Vec::new();
    for _ in 0..body.count(12)? {
        let id = body.u32()?;
        let rises = maps.last().is_none_or(|(last, _)| last.0 < id) && id < u32::MAX;
        body.require(rises, "number of a map", id, || "rising numbers".to_owned())?;
        maps.push((MapId(id), map::read(&mut body, model)?));
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
    if found != FORMAT_VERSION {
        return Err(MapFileError::Version { found, expected: FORMAT_VERSION });
    }
    let sum = head.u64()?;
    let body = &bytes[HEAD_BYTES..];
    if checksum(body) != sum {
        return Err(MapFileError::Checksum);
    }
    Ok(Reader::new(body, "settings"))
}
