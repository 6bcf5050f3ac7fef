//! Kinds of files that a command takes, and the refusal of others.

use super::{FileKind, packed, words};
use crate::IoError;
use FileKind as K;
use std::path::Path;

/// Kind of file that an argument expects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expected {
    /// A map, or a mask, by its YAML file.
    Map,
    /// The room of a simulation.
    Scene,
    /// Laser scans with odometry.
    LaserLog,
    /// Obstacles about a goal.
    Docking,
    /// RGB-D images.
    Sequence,
    /// A recorded run.
    Recording,
    /// The intrinsics of a camera.
    Camera,
    /// Poses with stamps.
    Trajectory,
    /// Settings of a robot, faults, places or a scene.
    Toml,
    /// Way-points and lanes.
    Graph,
    /// Zones and places of a map.
    Annotations,
    /// A saved particle filter.
    FilterMap,
    /// A map to be found in: a saved particle filter, or a map by its YAML file.
    LocalizationMap,
    /// A saved landmark map.
    VisualMap,
    /// The memory of a run.
    Checkpoint,
    /// Visual words in trundle's own form.
    Vocabulary,
    /// Visual words in the text form of DBoW2.
    Dbow2Vocabulary,
}

impl Expected {
    /// Refuses a file or folder that is certainly of another kind; returns the kind of an accepted one. A file without a signature is
    /// accepted: its reader decides.
    ///
    /// # Errors
    /// When the file cannot be read, or is of another kind: the message gives the kind and the remedy.
    pub fn check(self, path: &Path) -> Result<FileKind, IoError> {
        let found = FileKind::of(path)?;
        if self.takes(found) {
            packed::check(path, found, self.name())?;
            return Ok(found);
        }
        let wants_map = self.kinds().contains(&K::MapYaml);
        Err(IoError::WrongKind {
            path: path.to_owned(),
            found: words::name(found),
            expected: self.name(),
            remedy: self.remedy(found, wants_map),
        })
    }

    /// Remedy for a file of the kind `found`; a vocabulary of the other form is exchanged.
    fn remedy(self, found: FileKind, wants_map: bool) -> &'static str {
        match (self, found) {
            (Self::Vocabulary, K::Dbow2Vocabulary) => {
                "`trundle vocabulary import FILE --out OWN.voc` makes one of it"
            }
            (Self::Sequence, K::Folder) => {
                "name its lists of colour and depth images rgb.txt and depth.txt; each line is: timestamp filename"
            }
            (Self::Dbow2Vocabulary, K::Vocabulary) => "it needs no import: it goes with --vocabulary",
            _ => words::remedy(found, wants_map),
        }
    }

    fn takes(self, found: FileKind) -> bool {
        found == K::Stream && !self.is_read_twice() || self.kinds().contains(&found)
    }

    /// Whether files of this kind are read twice, which a pipe cannot be.
    fn is_read_twice(self) -> bool {
        matches!(self, Self::LaserLog | Self::Sequence | Self::Recording)
    }

    /// The accepted kinds. Readers of text accept text of no known kind too: their errors name the line.
    fn kinds(self) -> &'static [FileKind] {
        match self {
            Self::Map => &[K::MapYaml, K::Yaml, K::Json, K::Text],
            Self::Scene => &[K::Toml, K::Glb, K::Gltf, K::MapYaml],
            Self::LaserLog => &[
                K::CarmenLog,
                K::Text,
                K::Gzip,
                K::Ros2Mcap,
                K::OtherMcap,
                K::Zstd,
                K::Ros1Bag,
                K::Ros2Sqlite,
                K::Ros2BagFolder,
            ],
            Self::Docking => &[K::MapYaml, K::CarmenLog, K::Gzip, K::CorridorProblems, K::Text],
            Self::Sequence => &[K::SequenceFolder],
            Self::Recording => &[K::TrundleRecording, K::OtherMcap],
            Self::Camera => &[
                K::CameraToml,
                K::OrbSlamYaml,
                K::StellaVslamYaml,
                K::RosCameraYaml,
                K::KalibrCameraYaml,
                K::Open3dCamera,
                K::Toml,
                K::Yaml,
                K::Json,
                K::Text,
            ],
            Self::Trajectory => {
                &[K::TumTrajectory, K::PlanarTrajectory, K::KittiTrajectory, K::EurocTrajectory, K::Text]
            }
            Self::Toml => &[K::Toml, K::CameraToml, K::Text, K::Empty],
            Self::Graph | Self::Annotations => &[K::GeoJson, K::Json, K::Text],
            Self::FilterMap => &[K::FilterMap],
            Self::LocalizationMap => &[K::FilterMap, K::MapYaml],
            Self::VisualMap => &[K::VisualMap],
            Self::Checkpoint => &[K::Checkpoint],
            Self::Vocabulary => &[K::Vocabulary],
            Self::Dbow2Vocabulary => &[K::Dbow2Vocabulary, K::Text],
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Map => "a map's YAML file",
            Self::Scene => "a built-in scene, a scene file (.toml), a glTF scene or a map's YAML file",
            Self::LaserLog => "a CARMEN log, a ROS bag, a trundle recording or a TUM RGB-D folder",
            Self::Docking => "a map's YAML file, a CARMEN log or a file of docking problems",
            Self::Sequence => {
                "a TUM RGB-D folder (rgb.txt and depth.txt, or associations.txt), a ROS bag or a trundle recording"
            }
            Self::Recording => "a trundle recording (recording.mcap)",
            Self::Camera => {
                "a camera file (TOML, ORB-SLAM's, stella_vslam's, Kalibr's or ROS's YAML, Open3D's JSON)"
            }
            Self::Trajectory => "a trajectory (TUM, KITTI or EuRoC form)",
            Self::Toml => "a TOML file",
            Self::Graph => "a GeoJSON file of way-points",
            Self::Annotations => "a GeoJSON file of zones and places",
            Self::FilterMap => "a saved filter (filter.map of `trundle map`)",
            Self::LocalizationMap => "a saved filter (filter.map of `trundle map`) or a map's YAML file",
            Self::VisualMap => "a visual map (visual.map of `trundle slam`)",
            Self::Checkpoint => "a checkpoint (--checkpoint of run or demo)",
            Self::Vocabulary => "a visual vocabulary (of `trundle vocabulary train` or `import`)",
            Self::Dbow2Vocabulary => "a vocabulary in the text form of DBoW2",
        }
    }
}
