//! Checkpoints: maps and mission in a file, for a resume after a restart.

pub(crate) mod schedule;

use crate::mission::MissionState;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use trundle_core::{Cell, GridGeometry, Invalid, MapAnnotations, OccupancyGrid, Vector2};
use trundle_estimation::{StationEstimate, VisualAnchor};
use trundle_slam::MapFileError;

/// State of a robot across a restart: its maps, their poses, and the state of its mission.
///
/// As bytes: `TRUNDLEM`, version (u32), checksum (CRC-32 of the rest), length of the notes (u32), the notes as JSON, one byte per cell of
/// the floor map (0 unknown, 1 free, 2 occupied), and the visual maps. Numbers are little endian.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    /// The visual maps, as [`trundle_slam::RgbdSlam::save`] gives them.
    pub visual: Vec<u8>,
    /// Pose and covariance of each visual map in the map, by the number of the visual map.
    pub visual_maps: BTreeMap<u32, VisualAnchor>,
    /// The floor map.
    pub grid: OccupancyGrid,
    /// Finished tasks, and remaining tasks.
    pub mission: MissionState,
    /// The charging station; `None` if unknown.
    pub station: Option<StationEstimate>,
    /// Zones and named places of the map.
    pub annotations: MapAnnotations,
}

/// Reason why a checkpoint is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file is not a checkpoint.
    #[error("this is not a checkpoint of trundle")]
    Foreign,
    /// The format version is not supported.
    #[error("checkpoint of version {found}, expected {FORMAT_VERSION}")]
    Version {
        /// Version of the checkpoint.
        found: u32,
    },
    /// The file is cut off or changed.
    #[error("checkpoint is damaged: {what}")]
    Damaged {
        /// The part that does not match.
        what: &'static str,
    },
    /// The notes are invalid.
    #[error("notes of the checkpoint: {0}")]
    Notes(String),
    /// The visual maps are refused.
    #[error("visual maps of the checkpoint: {0}")]
    Visual(#[from] MapFileError),
    /// A number of the checkpoint or of the robot's configuration is out of range.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// The notes: all data except the grid's cells and the visual maps.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Notes {
    visual_maps: BTreeMap<u32, VisualAnchor>,
    mission: MissionState,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    station: Option<StationEstimate>,
    #[serde(default, skip_serializing_if = "MapAnnotations::is_empty")]
    annotations: MapAnnotations,
    /// Resolution of the floor map, m.
    resolution: f64,
    /// Lower left corner of the floor map, map frame, m.
    origin: [f64; 2],
    /// Columns and rows of the floor map.
    cells: [usize; 2],
}

const MAGIC: &[u8; 8] = b"TRUNDLEM";
/// Version of the file format. Source: ours.
const FORMAT_VERSION: u32 = 2;

impl Checkpoint {
    /// The checkpoint as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let GridGeometry { resolution, origin, width, height } = *self.grid.geometry();
        let notes = Notes {
            visual_maps: self.visual_maps.clone(),
            mission: self.mission.clone(),
            station: self.station,
            annotations: self.annotations.clone(),
            resolution,
            origin: origin.into(),
            cells: [width, height],
        };
        let notes = serde_json::to_vec(&notes).expect("invariant: notes are plain data");
        let length = u32::try_from(notes.len()).expect("invariant: a mission of less than 4 GB");
        let cells = self.grid.cells().iter().map(|cell| code(*cell)).collect();
        let rest = [length.to_le_bytes().to_vec(), notes, cells, self.visual.clone()].concat();
        let checksum = crc32fast::hash(&rest).to_le_bytes();
        [MAGIC.as_slice(), &FORMAT_VERSION.to_le_bytes(), &checksum, &rest].concat()
    }

    /// Reads a checkpoint. The visual maps are decoded when the robot resumes.
    ///
    /// # Errors
    /// When the bytes are not a checkpoint, of another version, damaged or cut off, or contradict themselves. No input causes a panic.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(CheckpointError::Foreign)?;
        let (version, rest) = number(rest)?;
        if version != FORMAT_VERSION {
            return Err(CheckpointError::Version { found: version });
        }
        let (checksum, rest) = number(rest)?;
        require(crc32fast::hash(rest) == checksum, "its checksum is another")?;
        let (length, rest) = number(rest)?;
        let (notes, rest) = split(rest, length as usize)?;
        let notes: Notes =
            serde_json::from_slice(notes).map_err(|error| CheckpointError::Notes(error.to_string()))?;
        let [width, height] = notes.cells;
        let geometry = GridGeometry::new(notes.resolution, Vector2::from(notes.origin), width, height)?;
        let (cells, visual) = split(rest, geometry.len())?;
        let cells = cells.iter().map(|code| cell(*code)).collect::<Result<Vec<_>, _>>()?;
        require(notes.station.is_none_or(|station| station.is_finite()), "the station lies nowhere")?;
        require(notes.visual_maps.values().all(VisualAnchor::is_valid), "a visual map lies nowhere")?;
        Ok(Self {
            visual: visual.to_vec(),
            visual_maps: notes.visual_maps,
            grid: OccupancyGrid::new(geometry, cells)?,
            mission: notes.mission.validated()?,
            station: notes.station,
            annotations: notes.annotations.validated()?,
        })
    }
}

fn code(cell: Cell) -> u8 {
    match cell {
        Cell::Unknown => 0,
        Cell::Free => 1,
        Cell::Occupied => 2,
    }
}

fn cell(code: u8) -> Result<Cell, CheckpointError> {
    match code {
        0 => Ok(Cell::Unknown),
        1 => Ok(Cell::Free),
        2 => Ok(Cell::Occupied),
        _ => Err(CheckpointError::Damaged { what: "a cell is none" }),
    }
}

fn require(holds: bool, what: &'static str) -> Result<(), CheckpointError> {
    if holds { Ok(()) } else { Err(CheckpointError::Damaged { what }) }
}

fn number(bytes: &[u8]) -> Result<(u32, &[u8]), CheckpointError> {
    let (number, rest) =
        bytes.split_first_chunk().ok_or(CheckpointError::Damaged { what: "it is cut off" })?;
    Ok((u32::from_le_bytes(*number), rest))
}

fn split(bytes: &[u8], at: usize) -> Result<(&[u8], &[u8]), CheckpointError> {
    bytes.split_at_checked(at).ok_or(CheckpointError::Damaged { what: "it is cut off" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mission::{Mission, Task, TaskEnd, TaskRecord};
    use proptest::prelude::*;
    use trundle_core::{Pose2, Pose3, PoseBound, Stamp, Zone, ZoneKind};

    fn anchor(variance: f64) -> VisualAnchor {
        let covariance = nalgebra::Matrix3::from_diagonal_element(variance).into();
        VisualAnchor { map_from_visual: Pose3::identity(), covariance }
    }

    fn memory() -> Checkpoint {
        let mission = Mission::new(vec![Task::Explore, Task::go(Pose2::new(1.5, -2.0, 0.25)), Task::Return]);
        let mission = MissionState::new(mission.unwrap());
        let outline = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let stairs = Zone { id: 1, name: "stairs".to_owned(), kind: ZoneKind::NoGo, outline };
        let ended = TaskRecord {
            index: 1,
            task: Task::go(Pose2::new(0.1, 0.2, 0.3)),
            end: TaskEnd::Done,
            from: Stamp::from_nanos(5),
            to: Stamp::from_nanos(7),
            pose: Pose2::new(0.1, 0.21, 0.3),
            bound: Some(PoseBound { distance: 0.03, heading: 0.01 }),
            before_restart: false,
        };
        Checkpoint {
            visual: vec![7; 100],
            visual_maps: BTreeMap::from([(0, anchor(0.0)), (3, anchor(1e-4))]),
            grid: OccupancyGrid::from_ascii(0.05, "#.#\n?..\n").unwrap(),
            mission: MissionState { places: vec![0, 2, 3], ended: vec![ended], ..mission },
            station: Some(StationEstimate { pose: Pose2::new(1.0, 2.0, 0.5), covariance: [[0.25; 3]; 3] }),
            annotations: MapAnnotations { zones: vec![stairs], places: vec![] },
        }
    }

    #[test]
    fn it_comes_back_as_it_was() {
        assert_eq!(Checkpoint::from_bytes(&memory().to_bytes()), Ok(memory()));
    }

    #[test]
    fn bytes_that_are_not_a_checkpoint_are_refused_with_the_reason() {
        let error = |bytes: &[u8]| Checkpoint::from_bytes(bytes).unwrap_err().to_string();
        assert_eq!(error(b"P5 3 3 255"), "this is not a checkpoint of trundle");
        let mut bytes = memory().to_bytes();
        bytes[8] = 9;
        assert_eq!(error(&bytes), "checkpoint of version 9, expected 2");
    }

    proptest! {
        #[test]
        fn a_flipped_bit_or_a_missing_end_is_noticed(at in 0..300_usize, bit in 0..8_u8) {
            let whole = memory().to_bytes();
            let (at, mut flipped) = (at % whole.len(), whole.clone());
            flipped[at] ^= 1 << bit;
            prop_assert!(Checkpoint::from_bytes(&flipped).is_err());
            prop_assert!(Checkpoint::from_bytes(&whole[..at]).is_err());
        }
    }

    /// The checkpoint of `memory` with changed bytes and a correct checksum.
    fn with_new_checksum(change: impl FnOnce(&mut Vec<u8>)) -> Result<Checkpoint, CheckpointError> {
        let mut rest = memory().to_bytes().split_off(16);
        change(&mut rest);
        let checksum = crc32fast::hash(&rest).to_le_bytes();
        Checkpoint::from_bytes(&[MAGIC.as_slice(), &FORMAT_VERSION.to_le_bytes(), &checksum, &rest].concat())
    }

    /// The error of a checkpoint with `old` in the notes replaced by `new`.
    fn with_notes(old: &str, new: &str) -> CheckpointError {
        let change = |rest: &mut Vec<u8>| {
            let length = u32::from_le_bytes(*rest.first_chunk().unwrap()) as usize;
            let notes = String::from_utf8(rest[4..4 + length].to_vec()).unwrap();
            assert!(notes.contains(old), "{notes}");
            let notes = notes.replacen(old, new, 1).into_bytes();
            let cells = rest.split_off(4 + length);
            *rest = [(notes.len() as u32).to_le_bytes().to_vec(), notes, cells].concat();
        };
        with_new_checksum(change).unwrap_err()
    }

    #[test]
    fn notes_that_contradict_themselves_are_refused_by_name() {
        let text = |old, new| with_notes(old, new).to_string();
        assert!(text("\"mission\"", "\"mishap\"").contains("unknown field `mishap`"));
        assert!(text("\"resolution\":0.05", "\"resolution\":0.0").contains("resolution"));
        assert!(text("\"resolution\":0.05", "\"resolution\":-1.0").contains("resolution"));
        assert_eq!(text("\"cells\":[3,2]", "\"cells\":[3,2000]"), "checkpoint is damaged: it is cut off");
        assert_eq!(
            text("\"places\":[0,2,3]", "\"places\":[0,2]"),
            "places of tasks is 2, expected 3, one for each task"
        );
        assert!(matches!(with_notes("\"cells\":[3,2]", "\"cells\":[0,2]"), CheckpointError::Invalid(_)));
        assert!(matches!(with_notes("{", "["), CheckpointError::Notes(_)));
        let negative = with_notes("\"covariance\":[[0.0001,", "\"covariance\":[[-0.5,");
        assert_eq!(negative.to_string(), "checkpoint is damaged: a visual map lies nowhere");
    }

    #[test]
    fn a_cell_that_is_none_of_the_three_is_refused() {
        let length = memory().to_bytes().len() - 16;
        let error = with_new_checksum(|rest| rest[length - 101] = 3).unwrap_err();
        assert_eq!(error.to_string(), "checkpoint is damaged: a cell is none");
    }

    #[test]
    fn a_length_beyond_the_end_is_refused() {
        for length in [u32::MAX, 100_000] {
            let error =
                with_new_checksum(|rest| rest[..4].copy_from_slice(&length.to_le_bytes())).unwrap_err();
            assert_eq!(error, CheckpointError::Damaged { what: "it is cut off" });
        }
    }

    proptest! {
        #[test]
        fn bytes_with_a_fitting_checksum_are_read_as_they_are_written_or_refused_in_words(
            changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
            cut in prop::option::of(any::<prop::sample::Index>()),
        ) {
            let read = with_new_checksum(|rest| {
                changes.iter().for_each(|(at, byte)| *at.get_mut(rest) = *byte);
                cut.into_iter().for_each(|cut| rest.truncate(cut.index(rest.len())));
            });
            match read {
                Ok(read) => prop_assert_eq!(Checkpoint::from_bytes(&read.to_bytes()), Ok(read)),
                Err(error) => prop_assert!(error.to_string().len() > 10, "{}", error),
            }
        }
    }
}
