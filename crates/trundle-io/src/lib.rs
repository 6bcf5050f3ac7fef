//! Data sets, maps, trajectories and recordings on disk: one file a format, described in `docs/formats.md`.
//!
//! Inputs: TUM RGB-D folders ([`TumSequence`]), CARMEN logs ([`read_carmen`]), ROS 2 bags ([`read_ros_bag`]), TUM trajectories
//! ([`read_trajectory`]), cameras ([`CameraModel`]), ROS maps ([`read_map`]) and recordings ([`RecordingReader`]). Outputs are collected in
//! an [`OutputFolder`], which never shows a partial result: maps, trajectories, tables, TUM folders ([`TumWriter`]), laser logs
//! ([`CarmenLog`]), recordings ([`Recorder`]) and the numbers of a run ([`Summary`]). [`EncodedEvent`] is the interface between body and
//! robot: the events of a live run equal those of the replay of its recording.
//!
//! Every error is an [`IoError`], one sentence with the file and the line or field. No input panics.
//!
//! ```
//! use trundle_core::OccupancyGrid;
//! use trundle_io::{OutputFolder, read_map, write_map};
//!
//! # let scratch = tempfile::tempdir().unwrap();
//! # let dir = scratch.path().join("run");
//! let grid = OccupancyGrid::from_ascii(0.05, "###\n#.#\n#??")?;
//! let out = OutputFolder::create(&dir)?;
//! write_map(&out, "map", &grid)?;
//! let folder = out.commit()?; // until here, `dir` does not exist
//! assert_eq!(read_map(&folder.join("map.yaml"))?, grid);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod camera;
mod carmen;
mod codec;
mod csv;
mod depth_statistics;
mod error;
mod even_sample;
mod excerpt;
mod file_kind;
mod files;
mod laser_log;
mod map;
mod output;
mod pgm;
mod recording;
mod ros;
mod sequence_camera;
mod stamp_text;
mod stamp_unit;
mod summary;
mod surface;
mod toml_text;
mod tum;
mod warnings;
mod yaml_document;

pub use camera::{CameraModel, KINECT_V2_DEPTH_SCALE, TUM_DEPTH_SCALE};
pub use carmen::{CarmenLog, read_carmen};
pub use codec::{
    CodecError, EncodedEvent, EncodedRgbd, JPEG_QUALITY, decode_color, decode_depth, decode_raw_depth,
    encode_color, encode_color_png, encode_depth, encode_depth_rvl,
};
pub use csv::{curve_csv, table_csv, trajectory_csv, waypoints_csv};
pub use depth_statistics::DepthStatistics;
pub use error::{FrameError, IoError};
pub use even_sample::EvenSample;
pub use file_kind::{Expected, FileKind};
pub use files::read_text;
pub use laser_log::{
    LaserLog, LaserLogOptions, LaserLogScan, LaserLogSkip, LaserLogSources, LaserLogStatistics, LaserMount,
    empty_map_cause, no_overlap_cause, no_return_cause, range_unit_hint,
};
pub use map::{
    GraphFile, KeepOutFile, MAX_CELL_M, MIN_CELL_M, MapDescription, MapFile, MapImage, NamedArea, PictureMap,
    SpeedFile, annotations_text, areas_text, degrees_hint, map_files, map_pgm, map_picture, map_yaml,
    parse_annotations, picture_size, read_annotations, read_graph, read_keep_out_mask, read_map,
    read_map_file, read_picture_map, read_places, read_speed_mask, write_map, write_map_as, write_speed_mask,
};
pub use output::{
    CommandOutputs, InputFiles, OutputFile, OutputFolder, RecordingFolder, abandon_outputs,
    abandon_unfinished, keep_aside, replace_file, require_replaceable, wait_for_abandonment,
};
pub use recording::{PoseInFrame, PosesInFrame, RecordedMessage, Recorder, RecordingCut, RecordingReader};
pub use ros::message as ros_message;
pub use ros::{
    ConvertedScan, ImuReading, LaserLogScans, LaserSweep, NoEcho, RosFrame, RosFrames, RosImageTopics,
    RosSequence, RosSequenceOptions, RosTopics, decode_compressed_depth, read_laser_log, read_ros_bag,
};
pub use sequence_camera::SequenceCamera;
pub use stamp_text::parse_stamp;
pub use summary::Summary;
pub use surface::{HeightFiles, HeightGrid, SurfaceData, glb_bytes, height_files, octomap_bytes, ply_bytes};
pub use tum::{
    TrajectoryFile, TumFrame, TumSequence, TumWriter, odometry_text, read_odometry, read_trajectory,
    read_trajectory_file, trajectory_text, trajectory_text_from_planar,
};
pub use warnings::{Warning, Warnings};
