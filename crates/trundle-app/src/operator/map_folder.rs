//! Maps of a folder that an operator may load.

use std::path::PathBuf;
use trundle_core::OccupancyGrid;
use trundle_io::read_map;
use trundle_runtime::{RobotConfig, require_loadable};

/// Most names that are offered. Source: ours.
const MAX_NAMES: usize = 200;

/// A folder of maps for a robot: each `NAME.yaml` with its picture.
#[derive(Debug, Clone)]
pub struct MapFolder {
    folder: PathBuf,
    robot: RobotConfig,
}

impl MapFolder {
    /// The maps of `folder` for a robot of this configuration.
    #[must_use]
    pub fn new(folder: PathBuf, robot: RobotConfig) -> Self {
        Self { folder, robot }
    }

    /// The names of the maps, sorted; none where the folder cannot be read.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let files = entries.map(|entry| PathBuf::from(entry.file_name()));
        let yaml = files.filter(|file| file.extension().is_some_and(|extension| extension == "yaml"));
        let mut names: Vec<String> =
            yaml.filter_map(|file| Some(file.file_stem()?.to_str()?.to_owned())).collect();
        names.sort();
        names.truncate(MAX_NAMES);
        names
    }

    /// The map of a name.
    ///
    /// # Errors
    /// In a sentence, when there is none of this name, its files are broken, or the robot cannot take it.
    pub fn read(&self, name: &str) -> Result<OccupancyGrid, String> {
        // Only names of the list: none leads out of the folder.
        if !self.names().iter().any(|known| known == name) {
            return Err(format!("There is no map '{name}' in the folder of maps."));
        }
        let grid = read_map(&self.folder.join(format!("{name}.yaml"))).map_err(|error| error.to_string())?;
        require_loadable(grid.geometry(), &self.robot)
            .map_err(|invalid| format!("Map '{name}': {invalid}"))?;
        Ok(grid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_io::{map_pgm, map_yaml};

    #[test]
    fn maps_of_the_folder_are_read_and_nothing_else() {
        let place = tempfile::tempdir().unwrap();
        let write = |name: &str, resolution: f64| {
            let grid = OccupancyGrid::from_ascii(resolution, "#.\n..").unwrap();
            std::fs::write(
                place.path().join(format!("{name}.yaml")),
                map_yaml(&grid, &format!("{name}.pgm")),
            )
            .unwrap();
            std::fs::write(place.path().join(format!("{name}.pgm")), map_pgm(&grid)).unwrap();
            grid
        };
        let (ground, _) = (write("ground floor", 0.05), write("coarse", 0.3));
        std::fs::create_dir(place.path().join("inner")).unwrap();
        std::fs::write(place.path().join("broken.yaml"), "image: none.pgm").unwrap();
        let maps = MapFolder::new(place.path().to_owned(), RobotConfig::default());
        assert_eq!(maps.names(), ["broken", "coarse", "ground floor"]);
        assert_eq!(maps.read("ground floor").unwrap(), ground);
        for wrong in ["../ground floor", "inner/x", "", "broken", "coarse"] {
            assert!(maps.read(wrong).is_err(), "{wrong}");
        }
        assert!(MapFolder::new("/nowhere".into(), RobotConfig::default()).names().is_empty());
    }
}
