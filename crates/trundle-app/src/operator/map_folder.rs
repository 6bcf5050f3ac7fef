//! Maps of a folder that an operator may load.

use crate::{BoundedFile, BoundedFileError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use trundle_core::{MAX_TEXT_CELLS, MapAnnotations, OccupancyGrid};
use trundle_io::{IoError, MapDescription, parse_annotations, picture_size};
use trundle_runtime::{RobotConfig, require_loadable};

/// Maximum number of offered names. Source: ours.
const MAX_NAMES: usize = 200;
/// Largest YAML file of a map \[bytes\]. Source: ours; files of map_saver have 150.
const MAX_YAML_BYTES: u64 = 64 * 1024;
/// Largest picture of a map \[bytes\]: a PGM of 16 bits with the most cells that are recorded, and its header. Source: ours.
const MAX_PICTURE_BYTES: u64 = 2 * MAX_TEXT_CELLS as u64 + 64 * 1024;

/// Largest file of zones and places \[bytes\]. Source: ours; 1,000 zones of ten corners have 400 kB.
const MAX_ZONES_BYTES: u64 = 4 << 20;

/// A map of the folder.
#[derive(Debug, Clone, PartialEq)]
pub struct FolderMap {
    /// The cells.
    pub grid: OccupancyGrid,
    /// Zones and named places; none without a file of them.
    pub annotations: MapAnnotations,
}

/// A folder of maps for a robot: each `NAME.yaml` with its picture, and with `NAME.geojson` if the map has zones and named places.
#[derive(Debug, Clone)]
pub struct MapFolder {
    folder: PathBuf,
    robot: RobotConfig,
    /// Whether the warning of more names than [`MAX_NAMES`] was logged.
    is_cut_told: Arc<AtomicBool>,
}

impl MapFolder {
    /// The maps of `folder` for a robot of this configuration.
    ///
    /// # Errors
    /// As [`MapFolder::check`].
    pub fn open(folder: PathBuf, robot: RobotConfig) -> Result<Self, String> {
        Self::check(&folder)?;
        let maps = Self { folder, robot, is_cut_told: Arc::default() };
        // Logs the warning of too many names at the start, not at a page's first request.
        drop(maps.names());
        Ok(maps)
    }

    /// The folder that a text names.
    ///
    /// # Errors
    /// As [`MapFolder::check`].
    pub fn checked(text: &str) -> Result<PathBuf, String> {
        let folder = PathBuf::from(text);
        Self::check(&folder)?;
        Ok(folder)
    }

    /// Refuses a path that is no folder that can be read.
    ///
    /// # Errors
    /// The reason why the folder cannot be used, and what is expected.
    pub fn check(folder: &Path) -> Result<(), String> {
        let problem = match std::fs::read_dir(folder) {
            Ok(_) => return Ok(()),
            Err(error) => match error.kind() {
                ErrorKind::NotFound => "there is no such folder".to_owned(),
                ErrorKind::NotADirectory => "this is no folder".to_owned(),
                ErrorKind::PermissionDenied => "no permission to read it".to_owned(),
                _ => error.to_string(),
            },
        };
        Err(format!(
            "{}: {problem}, expected a folder of maps, each NAME.yaml with its picture",
            folder.display()
        ))
    }

    /// The names of the offered maps, sorted; empty if the folder can no longer be read. Names beyond the limit are logged once, with their
    /// number.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let mut names = self.all_names();
        if let Some(warning) = self.cut_warning(names.len()) {
            tracing::warn!("{warning}");
        }
        names.truncate(MAX_NAMES);
        names
    }

    /// The warning of more names than the limit, with their number; only the first time.
    fn cut_warning(&self, count: usize) -> Option<String> {
        let is_new = count > MAX_NAMES && !self.is_cut_told.swap(true, Ordering::Relaxed);
        let folder = self.folder.display();
        is_new
            .then(|| format!("{folder} has {count} maps: the live page offers the first {MAX_NAMES} by name"))
    }

    fn all_names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let files = entries.map(|entry| PathBuf::from(entry.file_name()));
        let yaml = files.filter(|file| file.extension().is_some_and(|extension| extension == "yaml"));
        let mut names: Vec<String> =
            yaml.filter_map(|file| Some(file.file_stem()?.to_str()?.to_owned())).collect();
        names.sort();
        names
    }

    /// The map of a name. Only regular files inside the folder are opened; a link that leads out of the folder is refused. Reading may take
    /// seconds.
    ///
    /// # Errors
    /// When no map has this name, its files are broken, too large or outside the folder, or the robot cannot accept the map. The error
    /// contains nothing of the files' content. Details are logged only, because the caller may lack the right to read the files.
    pub fn read(&self, name: &str) -> Result<FolderMap, String> {
        // Only listed names are accepted, so no path leaves the folder.
        if !self.all_names().iter().any(|known| known == name) {
            return Err(format!("There is no map '{name}' in the folder of maps."));
        }
        let files = self.read_grid(name).and_then(|grid| {
            let annotations = self.read_annotations(name)?;
            Ok(FolderMap { grid, annotations })
        });
        files.map_err(|problem| format!("Map '{name}': {problem}."))
    }

    /// A map whose zones cannot be read is refused: without its no-go zones the robot would drive there.
    fn read_annotations(&self, name: &str) -> Result<MapAnnotations, String> {
        let path = self.folder.join(format!("{name}.geojson"));
        if path.symlink_metadata().is_err_and(|error| error.kind() == ErrorKind::NotFound) {
            return Ok(MapAnnotations::default());
        }
        let text = self.read_file("its file of zones", &path, MAX_ZONES_BYTES)?;
        let text = String::from_utf8(text).map_err(|_| "its file of zones is not UTF-8 text".to_owned())?;
        parse_annotations(&path, &text).map_err(|error| broken(name, &error))
    }

    fn read_grid(&self, name: &str) -> Result<OccupancyGrid, String> {
        let path = self.folder.join(format!("{name}.yaml"));
        let yaml = self.read_file("its YAML file", &path, MAX_YAML_BYTES)?;
        let yaml = String::from_utf8(yaml).map_err(|_| "its YAML file is not UTF-8 text".to_owned())?;
        let description = MapDescription::parse(&path, yaml).map_err(|error| broken(name, &error))?;
        let picture = self.read_file("its picture", description.picture_path(), MAX_PICTURE_BYTES)?;
        // A packed picture of few bytes may claim any size.
        if let Some((width, height)) = picture_size(&picture)
            && width.saturating_mul(height) > MAX_TEXT_CELLS
        {
            return Err(format!(
                "its picture has {width} x {height} cells, expected at most {MAX_TEXT_CELLS} in all"
            ));
        }
        let grid = description.map(&picture).map_err(|error| broken(name, &error))?.grid;
        require_loadable(grid.geometry(), &self.robot).map_err(|invalid| invalid.to_string())?;
        Ok(grid)
    }

    /// The bytes of a file of the folder; `what` it is, for the refusal.
    fn read_file(&self, what: &str, path: &Path, max_bytes: u64) -> Result<Vec<u8>, String> {
        BoundedFile { path, folder: Some(&self.folder), max_bytes }.read().map_err(|problem| {
            tracing::warn!("{}: {problem}", path.display());
            match problem {
                BoundedFileError::Outside => format!("{what} is missing or outside the folder of maps"),
                problem => format!("{what} {problem}"),
            }
        })
    }
}

/// Logs what is wrong in the files of a map; the refusal without their content.
fn broken(name: &str, error: &IoError) -> String {
    tracing::warn!("the map '{name}' cannot be loaded: {error}");
    "its files are broken; the place is in the log of the program".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_io::{map_pgm, map_yaml};

    fn write(place: &Path, name: &str, resolution: f64) -> OccupancyGrid {
        let grid = OccupancyGrid::from_ascii(resolution, "#.\n..").unwrap();
        let yaml = map_yaml(&grid, &format!("{name}.pgm"));
        std::fs::write(place.join(format!("{name}.yaml")), yaml).unwrap();
        std::fs::write(place.join(format!("{name}.pgm")), map_pgm(&grid)).unwrap();
        grid
    }

    fn without_zones(grid: OccupancyGrid) -> FolderMap {
        FolderMap { grid, annotations: MapAnnotations::default() }
    }

    #[test]
    fn zones_come_with_their_map_and_a_map_with_broken_ones_is_refused() {
        let place = tempfile::tempdir().unwrap();
        write(place.path(), "home", 0.05);
        let mut annotations = MapAnnotations::default();
        let pose = trundle_core::Pose2::new(0.5, 0.25, 0.0);
        annotations.places.push(trundle_core::NamedPlace { id: 1, name: "desk".to_owned(), pose });
        let file = place.path().join("home.geojson");
        std::fs::write(&file, trundle_io::annotations_text(&annotations)).unwrap();
        assert_eq!(maps(place.path()).read("home").unwrap().annotations, annotations);
        std::fs::write(&file, "hunter2: [").unwrap();
        let refusal = maps(place.path()).read("home").unwrap_err();
        assert_eq!(refusal, "Map 'home': its files are broken; the place is in the log of the program.");
        std::fs::write(&file, [0xff]).unwrap();
        let refusal = maps(place.path()).read("home").unwrap_err();
        assert_eq!(refusal, "Map 'home': its file of zones is not UTF-8 text.");
    }

    fn maps(place: &Path) -> MapFolder {
        MapFolder::open(place.to_owned(), RobotConfig::default()).unwrap()
    }

    #[test]
    fn maps_of_the_folder_are_read_and_nothing_else() {
        let place = tempfile::tempdir().unwrap();
        let (ground, _) = (write(place.path(), "ground floor", 0.05), write(place.path(), "coarse", 0.3));
        std::fs::create_dir(place.path().join("inner")).unwrap();
        std::fs::write(place.path().join("broken.yaml"), "image: none.pgm").unwrap();
        let maps = maps(place.path());
        assert_eq!(maps.names(), ["broken", "coarse", "ground floor"]);
        assert_eq!(maps.read("ground floor").unwrap(), without_zones(ground));
        for wrong in ["../ground floor", "inner/x", "", "broken", "coarse"] {
            assert!(maps.read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_path_that_is_no_folder_is_refused() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("a.yaml");
        std::fs::write(&file, "").unwrap();
        let refusal = |path: &Path| MapFolder::open(path.to_owned(), RobotConfig::default()).unwrap_err();
        let expected = "expected a folder of maps, each NAME.yaml with its picture";
        let nowhere = refusal(Path::new("/nowhere"));
        assert_eq!(nowhere, format!("/nowhere: there is no such folder, {expected}"));
        assert_eq!(refusal(&file), format!("{}: this is no folder, {expected}", file.display()));
    }

    #[test]
    fn names_beyond_the_limit_are_logged_once_and_load_all_the_same() {
        let place = tempfile::tempdir().unwrap();
        let last = write(place.path(), "zz", 0.05);
        for i in 0..MAX_NAMES {
            std::fs::write(place.path().join(format!("{i:03}.yaml")), "").unwrap();
        }
        let maps = maps(place.path());
        assert!(maps.is_cut_told.load(Ordering::Relaxed), "at the start");
        assert_eq!(maps.clone().cut_warning(MAX_NAMES + 1), None, "once for the page and its copies");
        let names = maps.names();
        assert_eq!((names.len(), names.last().map(String::as_str)), (MAX_NAMES, Some("199")));
        assert_eq!(maps.read("zz").unwrap(), without_zones(last));
        let new = MapFolder { is_cut_told: Arc::default(), ..maps };
        assert_eq!(new.cut_warning(MAX_NAMES), None);
        let warning = new.cut_warning(MAX_NAMES + 1).unwrap();
        assert!(warning.ends_with("has 201 maps: the live page offers the first 200 by name"), "{warning}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_or_picture_outside_the_folder_is_refused_without_its_content() {
        use std::os::unix::fs::symlink;
        let (place, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        write(outside.path(), "secret", 0.05);
        std::fs::write(outside.path().join("key"), "hunter2: [\n").unwrap();
        std::fs::write(place.path().join("own.yaml"), "hunter2: [\n").unwrap();
        let inside = write(place.path(), "a", 0.05);
        symlink(outside.path().join("key"), place.path().join("key.yaml")).unwrap();
        symlink(outside.path().join("secret.yaml"), place.path().join("link.yaml")).unwrap();
        symlink(outside.path().join("secret.pgm"), place.path().join("linked.pgm")).unwrap();
        symlink("a.yaml", place.path().join("alias.yaml")).unwrap();
        let picture = |name: &str, image: &str| {
            std::fs::write(place.path().join(format!("{name}.yaml")), map_yaml(&inside, image)).unwrap();
        };
        picture("absolute", &outside.path().join("secret.pgm").display().to_string());
        picture("missing outside", &outside.path().join("none.pgm").display().to_string());
        picture("linked", "linked.pgm");
        picture("text", "own.yaml");
        let maps = maps(place.path());
        assert_eq!(maps.read("alias").unwrap().grid, inside, "a link within the folder");
        let refusal = |name: &str| maps.read(name).unwrap_err();
        let outside = "is missing or outside the folder of maps.";
        for name in ["key", "link"] {
            assert_eq!(refusal(name), format!("Map '{name}': its YAML file {outside}"));
        }
        for name in ["absolute", "missing outside", "linked"] {
            assert_eq!(refusal(name), format!("Map '{name}': its picture {outside}"));
        }
        for name in ["own", "text"] {
            let expected =
                format!("Map '{name}': its files are broken; the place is in the log of the program.");
            assert_eq!(refusal(name), expected);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_a_folder_and_what_is_too_large_are_refused_at_once() {
        let place = tempfile::tempdir().unwrap();
        let grid = write(place.path(), "a", 0.05);
        let file = |name: &str| place.path().join(name);
        let pipes = [file("pipe.yaml"), file("pipe.pgm")];
        assert!(std::process::Command::new("mkfifo").args(&pipes).status().unwrap().success());
        std::fs::create_dir(file("folder.yaml")).unwrap();
        for (name, image) in [("piped", "pipe.pgm"), ("large", "large.pgm"), ("wide", "wide.pgm")] {
            std::fs::write(file(&format!("{name}.yaml")), map_yaml(&grid, image)).unwrap();
        }
        std::fs::write(file("wide.pgm"), "P5 30000 20000 255\n").unwrap();
        // A sparse file uses no space on the disk.
        for name in ["large.pgm", "long.yaml"] {
            std::fs::File::create(file(name)).unwrap().set_len(256 << 20).unwrap();
        }
        let folder = maps(place.path());
        let (send, answers) = std::sync::mpsc::channel();
        // In a thread: the opening of a pipe blocks until a writer exists.
        std::thread::spawn(move || {
            for name in ["pipe", "piped", "folder", "large", "long", "wide"] {
                send.send((name, folder.read(name).unwrap_err())).unwrap();
            }
        });
        for expected in [
            "its YAML file is no regular file",
            "its picture is no regular file",
            "its YAML file is no regular file",
            "its picture has 268435456 bytes, expected at most 100065536",
            "its YAML file has 268435456 bytes, expected at most 65536",
            "its picture has 30000 x 20000 cells, expected at most 50000000 in all",
        ] {
            let (name, refusal) = answers.recv_timeout(std::time::Duration::from_secs(10)).unwrap();
            assert_eq!(refusal, format!("Map '{name}': {expected}."));
        }
    }
}
