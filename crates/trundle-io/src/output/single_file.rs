//! A single file of results, which appears complete or not at all and replaces no other file.

use super::file_identity::is_same;
use super::inputs::InputFiles;
use super::place::free_name;
use super::scratch::Scratch;
use super::unfinished;
use super::writable::require_writable;
use super::{missing_above, parent, remove_empty};
use crate::IoError;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A single file of results, which appears complete or not at all. An existing file with other content is preserved: see [`keep_aside`].
#[derive(Debug)]
pub struct OutputFile {
    path: PathBuf,
    /// `None` for a device, which is written directly.
    scratch: Option<Scratch>,
    /// Folders above the file that did not exist before, the innermost first.
    made: Vec<PathBuf>,
}

impl OutputFile {
    /// Prepares to write `path`; no file is visible there before [`OutputFile::write`].
    ///
    /// # Errors
    /// Those of [`OutputFile::check`], and when the folder is not writable.
    pub fn create_apart_from(inputs: &InputFiles, path: &Path) -> Result<Self, IoError> {
        Self::check(inputs, path)?;
        if path.exists() && !path.is_file() {
            return Ok(Self { path: path.to_owned(), scratch: None, made: Vec::new() });
        }
        let beside = parent(path);
        let mut made = missing_above(beside);
        let scratch = fs::create_dir_all(beside).and_then(|()| Scratch::create(beside, path));
        let scratch = scratch.map_err(|error| {
            remove_empty(&mut made);
            IoError::system(path, "write")(error)
        })?;
        Ok(Self { path: path.to_owned(), scratch: Some(scratch), made })
    }

    /// Refuses a file that cannot be replaced.
    ///
    /// # Errors
    /// When `path` is no file name, a folder, one of `inputs`, or no file can be made in its folder.
    pub fn check(inputs: &InputFiles, path: &Path) -> Result<(), IoError> {
        if path.is_dir() {
            return Err(IoError::malformed(path, "this is a folder, expected the name of a file"));
        }
        if path.file_name().is_none() {
            return Err(IoError::malformed(path, "names no file to write"));
        }
        inputs.require_other_than(path)?;
        if path.exists() && !path.is_file() {
            return Ok(());
        }
        require_writable(parent(path), path)
    }

    /// Refuses files that are not all different.
    ///
    /// # Errors
    /// Names a file that is there twice.
    pub fn require_different(files: &[PathBuf]) -> Result<(), IoError> {
        let is_again = |(i, file): &(usize, &PathBuf)| files[..*i].iter().any(|other| is_same(other, file));
        match files.iter().enumerate().find(is_again) {
            Some((_, file)) => {
                Err(IoError::malformed(file, "two results have this name, expected a file for each"))
            }
            None => Ok(()),
        }
    }

    /// Writes the file; an existing one is renamed.
    ///
    /// # Errors
    /// [`IoError::Incomplete`] when it cannot be written.
    pub fn write(mut self, bytes: &[u8]) -> Result<(), IoError> {
        let written = match &self.scratch {
            None => File::options().write(true).open(&self.path).and_then(|mut file| file.write_all(bytes)),
            Some(scratch) => self.replace(&scratch.stage().join("file"), bytes),
        };
        let failed = |error| vec![IoError::system(&self.path, "write")(error)];
        written.map_err(|error| IoError::Incomplete { folder: None, problems: failed(error) })?;
        self.made.clear();
        Ok(())
    }

    fn replace(&self, staged: &Path, bytes: &[u8]) -> io::Result<()> {
        if fs::read(&self.path).is_ok_and(|old| old == bytes) {
            return Ok(());
        }
        fs::write(staged, bytes)?;
        unfinished::complete(|| {
            keep(&self.path)?;
            fs::rename(staged, &self.path)
        })
    }
}

impl Drop for OutputFile {
    fn drop(&mut self) {
        self.scratch.iter().for_each(Scratch::remove);
        remove_empty(&mut self.made);
    }
}

/// Renames a file before its replacement: to the first free name with the suffix `.1`, `.2`, ...
///
/// # Errors
/// When the file cannot be renamed.
pub fn keep_aside(path: &Path) -> Result<(), IoError> {
    keep(path).map_err(IoError::system(path, "rename"))
}

fn keep(path: &Path) -> io::Result<()> {
    if !path.is_file() {
        return Ok(());
    }
    fs::rename(path, free_name(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
        OutputFile::create_apart_from(&InputFiles::default(), path)?.write(bytes)
    }

    #[test]
    fn a_file_of_other_content_is_kept_under_the_first_free_name() {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("deep/map.yaml");
        for content in ["a", "a", "b", "c"] {
            write(&path, content.as_bytes()).unwrap();
        }
        let read = |name: &str| fs::read_to_string(path.with_file_name(name)).unwrap();
        assert_eq!([read("map.yaml"), read("map.yaml.1"), read("map.yaml.2")], ["c", "a", "b"]);
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 3);
    }

    #[test]
    fn inputs_folders_and_unwritable_places_are_refused_before_anything_is_written() {
        let scratch = tempfile::tempdir().unwrap();
        let (input, file) = (scratch.path().join("input"), scratch.path().join("file"));
        [&input, &file].iter().for_each(|path| fs::write(path, "mine").unwrap());
        let inputs = InputFiles::new([input.clone()]);
        let refusal = |path: &Path| OutputFile::create_apart_from(&inputs, path).unwrap_err().to_string();
        assert!(refusal(&input).contains("it is the input"));
        assert!(refusal(scratch.path()).contains("this is a folder"));
        assert!(refusal(&file.join("below")).contains("a file is in the way"));
        drop(OutputFile::create_apart_from(&inputs, &scratch.path().join("new/er")).unwrap());
        assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 2);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_device_is_written_and_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        let error = write(Path::new("/dev/full"), b"1").unwrap_err();
        assert!(matches!(error, IoError::Incomplete { .. }), "{error}");
        assert!(error.to_string().contains("the disk is full"), "{error}");
        assert!(fs::metadata("/dev/full").unwrap().file_type().is_char_device());
    }
}
