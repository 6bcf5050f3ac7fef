//! The checkpoint writer: the newest checkpoint is in the file, whole, when the writer has ended.

use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_app::CheckpointWriter;
use trundle_core::OccupancyGrid;
use trundle_runtime::{Checkpoint, Mission, MissionState, Task};

/// A checkpoint identified by `number`.
fn checkpoint(number: u8) -> Checkpoint {
    Checkpoint {
        visual: vec![number; 1000],
        visual_maps: BTreeMap::new(),
        grid: OccupancyGrid::from_ascii(0.05, "#.#\n").unwrap(),
        mission: MissionState::new(Mission::new(vec![Task::Explore]).unwrap()),
        station: None,
        annotations: trundle_core::MapAnnotations::default(),
    }
}

#[test]
fn the_last_checkpoint_is_in_the_file() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("robot.checkpoint");
    let writer = CheckpointWriter::new(&file).unwrap();
    (0..20).for_each(|number| writer.write(Arc::new(checkpoint(number))));
    writer.finish(Some(checkpoint(99))).unwrap();
    assert_eq!(Checkpoint::from_bytes(&std::fs::read(&file).unwrap()).unwrap(), checkpoint(99));
    let files = std::fs::read_dir(scratch.path()).unwrap().count();
    assert_eq!(files, 1, "no temporary file is left");
}

#[test]
fn a_writer_without_checkpoints_leaves_the_file_as_it_was() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("robot.checkpoint");
    std::fs::write(&file, "an earlier run").unwrap();
    CheckpointWriter::new(&file).unwrap().finish(None).unwrap();
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "an earlier run");
}

#[test]
fn a_place_that_cannot_be_written_is_refused_at_once_and_a_lost_one_is_named_at_the_end() {
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("blocked"), "a file, no folder").unwrap();
    let file = scratch.path().join("blocked").join("robot.checkpoint");
    let refusal = CheckpointWriter::new(&file).err().unwrap().to_string();
    assert!(refusal.contains("robot.checkpoint"), "{refusal}");
    let folder = scratch.path().join("later");
    let file = folder.join("robot.checkpoint");
    let writer = CheckpointWriter::new(&file).unwrap();
    std::fs::remove_dir(&folder).unwrap();
    std::fs::write(&folder, "a file, no folder").unwrap();
    writer.write(Arc::new(checkpoint(1)));
    assert!(writer.finish(Some(checkpoint(9))).unwrap_err().to_string().contains("robot.checkpoint"));
}
