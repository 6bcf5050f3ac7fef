//! The data sets of experiments that are not part of trundle: description, source, licence and download.

/// A data set that is not part of trundle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DataSet {
    /// Short name of the data set.
    pub name: &'static str,
    /// Description.
    pub what: &'static str,
    /// Authors and address.
    pub origin: &'static str,
    /// Licence of the data.
    pub licence: &'static str,
    /// The command that fetches the original.
    pub command: &'static str,
    /// Conversion of the original, and its place on disk.
    pub place: &'static str,
    /// The commands of trundle that read the data set.
    pub used_by: &'static str,
}

/// The house of `trundle experiment house`.
pub const SMALL_HOUSE: DataSet = DataSet {
    name: "small-house",
    what: "a furnished house: 145,844 triangles, 64 textures, 19 m x 11 m",
    origin: "AWS RoboMaker small house world, https://github.com/aws-robotics/aws-robomaker-small-house-world",
    licence: "MIT-0",
    command: "git clone https://github.com/aws-robotics/aws-robomaker-small-house-world",
    place: "the models placed as in its world file, as one glTF in metres, z up, floor at z = 0: scenes/small_house.glb; --mesh names it",
    used_by: "experiment house",
};

/// The worlds of `trundle experiment barn`.
pub const BARN: DataSet = DataSet {
    name: "barn",
    what: "worlds of cylinders with reference paths and optimal times",
    origin: "BARN challenge, https://github.com/Daffan/the-barn-challenge",
    licence: "MIT",
    command: "git clone https://github.com/Daffan/the-barn-challenge",
    place: "the worlds as tables: nav/barn/worlds.csv, obstacles.csv, reference_paths.csv; --data names the folder",
    used_by: "experiment barn",
};

/// The courses of `trundle experiment mrpb`.
pub const MRPB: DataSet = DataSet {
    name: "mrpb",
    what: "maps, pairs of start and goal, and walking people of the local-planning benchmark MRPB 1.0",
    origin: "Nankai University, NKU-MobFly, https://github.com/NKU-MobFly-Robotics/local-planning-benchmark",
    licence: "CC0-1.0",
    command: "git clone https://github.com/NKU-MobFly-Robotics/local-planning-benchmark",
    place: "its maps and tables: nav/mrpb/maps, start_goal.csv, actors.csv; --data names the folder",
    used_by: "experiment mrpb",
};

/// The RGB-D sequence of the documentation.
const FREIBURG1_RPY: DataSet = DataSet {
    name: "freiburg1_rpy",
    what: "a hand-held Kinect, turning fast, with motion capture ground truth; 400 frames are used",
    origin: "TUM RGB-D benchmark [Sturm12], https://cvg.cit.tum.de/data/datasets/rgbd-dataset",
    licence: "CC BY 4.0",
    command: "curl -O https://cvg.cit.tum.de/rgbd/dataset/freiburg1/rgbd_dataset_freiburg1_rpy.tgz",
    place: "unpacked as it is: tum_fr1_rpy_400",
    used_by: "slam, vocabulary",
};

/// The large laser log.
const KILLIAN: DataSet = DataSet {
    name: "killian",
    what: "the infinite corridor of MIT: 3,873 laser scans, 1.9 km, with a reference trajectory",
    origin: "rtb-data 2.0.0 on PyPI; surveyed relations of the SLAM benchmark of Kuemmerle et al. (2009)",
    licence: "MIT; the relations are facts of a published benchmark",
    command: "pip download --no-deps rtb-data==2.0.0",
    place: "the graph as a CARMEN log: laser/killian_g2o.log, and the relations beside it",
    used_by: "map, eval relations",
};

/// The small laser log.
const SENA: DataSet = DataSet {
    name: "sena",
    what: "one loop of 76 m: 225 laser scans with raw odometry",
    origin: "MRPT, https://github.com/MRPT/mrpt",
    licence: "BSD-3-Clause",
    command: "git clone https://github.com/MRPT/mrpt",
    place: "its SENA rawlog as a CARMEN log: laser/sena.log",
    used_by: "map",
};

/// Every data set.
pub const DATA_SETS: [DataSet; 6] = [SMALL_HOUSE, BARN, MRPB, FREIBURG1_RPY, KILLIAN, SENA];

impl DataSet {
    /// The message for a missing data set: its name, licence, the command, and further information.
    #[must_use]
    pub fn how_to_get(&self) -> String {
        format!(
            "the data set '{}' ({}) does not come with trundle; `{}` fetches the original, `trundle data fetch-list` lists all data sets",
            self.name, self.licence, self.command
        )
    }

    /// One line per fact about the data set.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let line = |name: &str, text: &str| format!("  {name:<8} {text}");
        vec![
            self.name.to_owned(),
            line("what", self.what),
            line("from", self.origin),
            line("licence", self.licence),
            line("get", self.command),
            line("then", self.place),
            line("used by", &format!("trundle {}", self.used_by)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fact_of_every_data_set_is_there() {
        for set in DATA_SETS {
            assert!(set.lines().iter().all(|line| line.trim_end().len() > 3), "{set:?}");
            assert!(set.how_to_get().contains(set.command) && set.how_to_get().contains(set.licence));
        }
    }
}
