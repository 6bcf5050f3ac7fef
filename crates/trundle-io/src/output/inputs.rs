//! The files that a command reads: no output may replace them.

use super::file_identity::{FileIdentity, is_same, resolved};
use super::tree::files_below;
use crate::IoError;
use std::collections::{BTreeSet, HashMap};
use std::path::{Component, Path, PathBuf};

/// The files and folders that a command reads, with the files that these name: no output may replace them.
#[derive(Debug, Clone, Default)]
pub struct InputFiles {
    paths: Vec<PathBuf>,
}

/// Extensions of text files that refer to other files, for example a map to its picture.
const NAMING: [&str; 5] = ["yaml", "yml", "toml", "txt", "gltf"];
/// Maximum size of a text file that is searched for names of other files \[bytes\]. Larger files are not searched. Source: ours.
const MAX_NAMING_BYTES: u64 = 1 << 20;

impl InputFiles {
    /// These inputs, and the files that they refer to.
    pub fn new(paths: impl IntoIterator<Item = PathBuf>) -> Self {
        let mut files = Self::default();
        for path in paths {
            files.paths.extend(named_by(&path));
            files.paths.push(path);
        }
        files
    }

    /// These inputs, and additional `files`.
    #[must_use]
    pub fn and(mut self, files: impl IntoIterator<Item = PathBuf>) -> Self {
        self.paths.extend(files);
        self
    }

    /// Refuses `place`, a folder whose files will be moved or replaced, if it is or contains an input.
    pub(super) fn require_apart(&self, place: &Path) -> Result<(), IoError> {
        if let Some(input) = self.paths.iter().find(|input| is_within(input, place)) {
            return Err(holds(place, input));
        }
        let Ok(theirs) = files_below(place) else { return Ok(()) };
        if theirs.is_empty() || self.paths.is_empty() {
            return Ok(());
        }
        let inputs = self.identities(place);
        let shared = theirs.iter().find_map(|path| inputs.get(&FileIdentity::of(path)?));
        shared.map_or(Ok(()), |input| Err(holds(place, input)))
    }

    /// Refuses `path`, a file that will be replaced, if it is an input or contains one.
    pub(super) fn require_other_than(&self, path: &Path) -> Result<(), IoError> {
        match self.paths.iter().find(|input| is_same(input, path)) {
            Some(input) => {
                let problem = format!(
                    "this file would be replaced, but it is the input {}; name another file",
                    input.display()
                );
                Err(IoError::malformed(path, problem))
            }
            None => Ok(()),
        }
    }

    /// Every input, and every file below an input folder, without those in `place`.
    fn identities(&self, place: &Path) -> HashMap<FileIdentity, PathBuf> {
        let place = resolved(place);
        let below = |path: &PathBuf| {
            let files = if path.is_dir() { files_below(path).unwrap_or_default() } else { Vec::new() };
            files.into_iter().filter(|file| !resolved(file).starts_with(&place)).collect::<Vec<_>>()
        };
        let all = self.paths.iter().flat_map(|path| std::iter::once(path.clone()).chain(below(path)));
        all.filter_map(|path| Some((FileIdentity::of(&path)?, path))).collect()
    }
}

/// Whether `path` is `place` or inside it, by its name or after following links.
pub(super) fn is_within(path: &Path, place: &Path) -> bool {
    let (absolute, real) = (without_parent_parts(path), resolved(path));
    absolute.ancestors().chain(real.ancestors()).any(|part| is_same(part, place))
}

/// The absolute path; each `..` is the parent of the resolved preceding path, other links are not followed.
fn without_parent_parts(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    absolute.components().fold(PathBuf::new(), |before, part| match part {
        Component::ParentDir => resolved(&before).parent().map_or(before, Path::to_owned),
        part => before.join(part),
    })
}

fn holds(place: &Path, input: &Path) -> IoError {
    let what = if is_same(place, input) { "is" } else { "holds" };
    let problem = format!(
        "the results would replace this folder, but it {what} the input {}; name another folder",
        input.display()
    );
    IoError::malformed(place, problem)
}

/// The files that an input names, and those that these name: a scene names a map, and the map its picture.
fn named_by(path: &Path) -> BTreeSet<PathBuf> {
    let (mut found, mut new) = (BTreeSet::new(), named_in(path));
    while let Some(file) = new.pop() {
        if !found.contains(&file) {
            new.extend(named_in_text(&file).into_iter().map(|file| resolved(&file)));
            found.insert(file);
        }
    }
    found
}

/// The files named in a text file, or in the text files of a folder, at any location.
fn named_in(path: &Path) -> Vec<PathBuf> {
    let texts: Vec<PathBuf> = if path.is_dir() {
        let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).filter(|path| path.is_file()).collect()
    } else {
        vec![path.to_owned()]
    };
    texts.iter().flat_map(|text| named_in_text(text)).collect()
}

fn named_in_text(path: &Path) -> Vec<PathBuf> {
    let is_naming = path.extension().is_some_and(|ending| NAMING.iter().any(|known| ending == *known));
    let is_small = std::fs::metadata(path).is_ok_and(|meta| meta.len() <= MAX_NAMING_BYTES);
    let (true, true, Some(folder)) = (is_naming, is_small, path.parent()) else { return Vec::new() };
    let text = std::fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let text = text.unwrap_or_default();
    let names = text.lines().flat_map(names_in_line).filter(|name| !name.is_empty());
    let files = names.map(|name| folder.join(name));
    files.filter(|file| file.is_file()).collect()
}

/// Possible file names in a line. They are each word, quoted or marked text (names may contain blanks), and the rest of the line from each
/// word on.
fn names_in_line(line: &str) -> impl Iterator<Item = &str> {
    let words = line.split(|c: char| c.is_whitespace() || MARKS.contains(c));
    let pieces = line.split(|c: char| MARKS.contains(c)).map(str::trim);
    let starts = line.match_indices(char::is_whitespace).map(|(at, _)| at).take(MAX_WORDS);
    let rests = starts.filter_map(|at| line.get(at..)).map(str::trim);
    words.chain(pieces).chain(rests)
}

/// Characters around the name of a file in a text.
const MARKS: &str = "\"'=,[]{}";
/// Number of words of a line at which a name with blanks may begin. A later name is not found. Source: ours.
const MAX_WORDS: usize = 12;

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn refusal(inputs: &[&Path], place: &Path) -> Option<String> {
        let inputs = InputFiles::new(inputs.iter().map(|path| (*path).to_owned()));
        inputs.require_apart(place).err().map(|error| error.to_string())
    }

    #[test]
    fn a_folder_that_is_or_holds_an_input_is_refused_by_any_name() {
        let scratch = tempfile::tempdir().unwrap();
        let (data, other) = (scratch.path().join("data"), scratch.path().join("other"));
        fs::create_dir_all(data.join("rgb")).unwrap();
        fs::create_dir(&other).unwrap();
        fs::write(data.join("rgb/1.png"), "1").unwrap();
        let dotted = other.join("../data/.");
        for (input, place) in [
            (&data, &data),
            (&data, &dotted),
            (&dotted, &data),
            (&data.join("rgb/1.png"), &data),
            (&data, &scratch.path().to_owned()),
            (&data.join("not-yet"), &data),
        ] {
            let sentence = refusal(&[input], place).unwrap();
            assert!(sentence.contains("the input") && sentence.contains("data"), "{sentence}");
        }
        assert_eq!(refusal(&[&data], &other), None);
        assert_eq!(refusal(&[&data], &data.join("slam")), None, "a new folder in an input replaces nothing");
    }

    #[test]
    fn a_file_that_a_named_file_names_is_an_input() {
        let scratch = tempfile::tempdir().unwrap();
        let [scenes, maps, pictures] = ["scenes", "maps", "pictures"].map(|name| scratch.path().join(name));
        [&scenes, &maps, &pictures].iter().for_each(|folder| fs::create_dir(folder).unwrap());
        fs::write(scenes.join("s.toml"), "[base]\nmap = \"../maps/map.yaml\"\n").unwrap();
        fs::write(maps.join("map.yaml"), "image: ../pictures/map.pgm\nsame: map.yaml\n").unwrap();
        fs::write(pictures.join("map.pgm"), "1").unwrap();
        let message = refusal(&[&scenes.join("s.toml")], &pictures).unwrap();
        assert!(message.contains("holds the input") && message.contains("map.pgm"), "{message}");
        let inputs = InputFiles::new([scenes.join("s.toml")]);
        assert!(inputs.require_other_than(&pictures.join("map.pgm")).is_err());
        assert_eq!(refusal(&[&scenes.join("s.toml")], &scratch.path().join("new")), None);
    }

    #[test]
    fn a_folder_that_a_path_leaves_again_holds_no_input() {
        let scratch = tempfile::tempdir().unwrap();
        let (a, b) = (scratch.path().join("a"), scratch.path().join("b"));
        [&a, &b].iter().for_each(|folder| fs::create_dir(folder).unwrap());
        fs::write(scratch.path().join("log"), "1").unwrap();
        fs::write(a.join("map"), "1").unwrap();
        assert_eq!(refusal(&[&a.join("../log")], &a), None);
        assert_eq!(refusal(&[&b.join("../a/../log")], &a), None);
        assert!(refusal(&[&b.join("../a/map")], &a).is_some());
    }

    #[test]
    #[cfg(unix)]
    fn links_to_and_from_an_input_are_followed() {
        let scratch = tempfile::tempdir().unwrap();
        let [data, hard, soft, alias] =
            ["data", "hard", "soft", "alias"].map(|name| scratch.path().join(name));
        [&data, &hard, &soft].iter().for_each(|folder| fs::create_dir(folder).unwrap());
        fs::write(data.join("map.pgm"), "1").unwrap();
        fs::hard_link(data.join("map.pgm"), hard.join("copy.pgm")).unwrap();
        std::os::unix::fs::symlink(data.join("map.pgm"), soft.join("link.pgm")).unwrap();
        std::os::unix::fs::symlink(&data, &alias).unwrap();
        for place in [&hard, &soft, &alias] {
            assert!(refusal(&[&data], place).is_some(), "{}", place.display());
            assert!(refusal(&[&data.join("map.pgm")], place).is_some(), "{}", place.display());
        }
        assert!(refusal(&[&soft.join("link.pgm")], &data).is_some());
    }

    #[test]
    fn a_file_that_an_input_names_is_an_input() {
        let scratch = tempfile::tempdir().unwrap();
        let (maps, pictures) = (scratch.path().join("maps"), scratch.path().join("pictures"));
        [&maps, &pictures].iter().for_each(|folder| fs::create_dir(folder).unwrap());
        fs::write(pictures.join("a.pgm"), "P5").unwrap();
        fs::write(maps.join("a.yaml"), "image: \"../pictures/a.pgm\"\nresolution: 0.05\n").unwrap();
        assert!(refusal(&[&maps.join("a.yaml")], &pictures).unwrap().contains("a.pgm"));
        assert!(refusal(&[&maps], &pictures).is_some());
        let blank = scratch.path().join("two words");
        fs::create_dir(&blank).unwrap();
        fs::write(blank.join("a b.pgm"), "P5").unwrap();
        for text in
            ["image: \"../two words/a b.pgm\"", "image: ../two words/a b.pgm", "1.5 ../two words/a b.pgm"]
        {
            fs::write(maps.join("b.yaml"), text).unwrap();
            assert!(refusal(&[&maps.join("b.yaml")], &blank).is_some(), "{text}");
        }
    }
}
