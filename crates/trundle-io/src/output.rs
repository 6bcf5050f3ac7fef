//! An output folder that appears complete or not at all.

use crate::{IoError, Recorder};
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Makes the content of a file.
type Content = fn() -> Vec<u8>;

/// A folder of results that appears whole or not at all.
///
/// Files are written into a hidden temporary folder beside it (inside it, where it exists already), and moved to their
/// place by [`OutputFolder::commit`]. Dropped without commit, everything written is removed again.
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    /// Holds `STAGE`, so that the results get the user's usual permissions and not those of a temporary folder.
    scratch: TempDir,
    /// Folders above the target that did not exist before, the innermost first.
    made: Vec<PathBuf>,
    /// Files that do not survive the commit unless they are written anew.
    outdated: Vec<String>,
    /// Name and content of the file that the commit writes.
    last: Option<(&'static str, Content)>,
}

/// The folder in the temporary one that becomes the target.
const STAGE: &str = "out";

impl OutputFolder {
    /// Prepares to write the results to `target`; nothing is visible there before [`OutputFolder::commit`].
    ///
    /// # Errors
    /// When `target` is a file, or nothing can be written there.
    pub fn create(target: &Path) -> Result<Self, IoError> {
        if target.as_os_str().is_empty() {
            return Err(IoError::malformed(target, "the name of the output folder is empty"));
        }
        if target.exists() && !target.is_dir() {
            return Err(IoError::malformed(
                target,
                "this is a file, expected a folder to write the results to",
            ));
        }
        let beside = if target.is_dir() { target } else { parent(target) };
        let mut made = missing_above(beside);
        let scratch = fs::create_dir_all(beside)
            .and_then(|()| tempfile::Builder::new().prefix(".trundle-").tempdir_in(beside))
            .and_then(|scratch| fs::create_dir(scratch.path().join(STAGE)).map(|()| scratch));
        let scratch = scratch.map_err(|error| {
            remove_empty(&mut made);
            IoError::system(target, "create")(error)
        })?;
        Ok(Self { target: target.to_owned(), scratch, made, outdated: vec![], last: None })
    }

    /// The same; the commit removes files of these names of an earlier run, unless they are written anew.
    pub fn instead_of(mut self, names: &[&str]) -> Self {
        self.outdated = names.iter().map(|name| (*name).to_owned()).collect();
        self
    }

    /// The same; the commit writes the file `name`, whose content is that of the moment of the commit.
    pub fn closing_with(mut self, name: &'static str, content: Content) -> Self {
        self.last = Some((name, content));
        self
    }

    /// Where the results will be.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Where the file `name` is until the commit, for writers that need a path. Subfolders must be made by the caller.
    pub fn staged(&self, name: &str) -> PathBuf {
        self.stage().join(name)
    }

    /// Writes the file `name`, a path relative to the folder; its subfolders are made.
    ///
    /// # Errors
    /// When it cannot be written, by the name it would have had.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), IoError> {
        let path = self.staged(name);
        let made = path.parent().map_or(Ok(()), fs::create_dir_all);
        made.and_then(|()| fs::write(&path, bytes)).map_err(IoError::system(&self.target.join(name), "write"))
    }

    /// Starts a recording as the file `name`; finish it before the commit.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn recorder(&self, name: &str) -> Result<Recorder<BufWriter<File>>, IoError> {
        let target = self.target.join(name);
        let file = File::create(self.staged(name)).map_err(IoError::system(&target, "create"))?;
        Recorder::new(BufWriter::with_capacity(1 << 20, file), &target)
    }

    /// Moves everything to its place: the whole folder at once where there was none, else file by file, replacing
    /// those of the same name and leaving others alone. Returns the folder.
    ///
    /// # Errors
    /// When the closing file cannot be written, or a file cannot be moved.
    pub fn commit(mut self) -> Result<PathBuf, IoError> {
        if let Some((name, content)) = self.last {
            self.write(name, &content())?;
        }
        self.made.clear();
        if self.target.is_dir() {
            for name in self.outdated.iter().filter(|name| !self.staged(name).exists()) {
                remove_file(&self.target.join(name))?;
            }
            move_files(&self.stage(), &self.target)?;
        } else {
            fs::rename(self.stage(), &self.target).map_err(IoError::system(&self.target, "create"))?;
        }
        Ok(self.target.clone())
    }

    fn stage(&self) -> PathBuf {
        self.scratch.path().join(STAGE)
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(self.scratch.path());
        remove_empty(&mut self.made);
    }
}

fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// `dir` and the folders above it that do not exist, the innermost first.
fn missing_above(dir: &Path) -> Vec<PathBuf> {
    let missing = dir.ancestors().take_while(|dir| !dir.as_os_str().is_empty() && !dir.exists());
    missing.map(Path::to_owned).collect()
}

fn remove_file(path: &Path) -> Result<(), IoError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(IoError::system(path, "remove")(error))
        }
        _ => Ok(()),
    }
}

fn remove_empty(made: &mut Vec<PathBuf>) {
    for dir in made.drain(..) {
        let _ = fs::remove_dir(dir); // refuses folders with something in them, and so it should
    }
}

fn move_files(from: &Path, to: &Path) -> Result<(), IoError> {
    let entries = fs::read_dir(from).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut names: Vec<_> =
        entries.map_err(IoError::system(from, "read"))?.into_iter().map(|entry| entry.file_name()).collect();
    names.sort();
    for name in names {
        let (source, target) = (from.join(&name), to.join(&name));
        if source.is_dir() && target.is_dir() {
            move_files(&source, &target)?;
        } else {
            fs::rename(&source, &target).map_err(IoError::system(&target, "write"))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(dir: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn appears_whole_at_commit() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("deep/er/run");
        let out = OutputFolder::create(&target).unwrap();
        out.write("a.txt", b"1").unwrap();
        out.write("sub/b.txt", b"2").unwrap();
        assert!(!target.exists());
        assert_eq!(out.commit().unwrap(), target);
        assert_eq!(names(&target), ["a.txt", "sub"]);
        assert_eq!(fs::read(target.join("sub/b.txt")).unwrap(), b"2");
        assert_eq!(names(target.parent().unwrap()), ["run"]);
    }

    #[test]
    fn leaves_no_trace_without_commit() {
        let dir = tempfile::tempdir().unwrap();
        drop(OutputFolder::create(&dir.path().join("deep/er/run")).unwrap().write("a", b"1"));
        assert_eq!(names(dir.path()), Vec::<String>::new());
        let out = OutputFolder::create(dir.path()).unwrap();
        out.write("a", b"1").unwrap();
        drop(out);
        assert_eq!(names(dir.path()), Vec::<String>::new());
    }

    #[test]
    fn replaces_files_of_the_same_name_only() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("keep"), "old").unwrap();
        fs::write(dir.path().join("map"), "old").unwrap();
        fs::create_dir(dir.path().join("sub")).unwrap();
        fs::write(dir.path().join("sub/keep"), "old").unwrap();
        let out = OutputFolder::create(dir.path()).unwrap();
        out.write("map", b"new").unwrap();
        out.write("sub/map", b"new").unwrap();
        assert_eq!(fs::read(dir.path().join("map")).unwrap(), b"old");
        out.commit().unwrap();
        assert_eq!(fs::read(dir.path().join("map")).unwrap(), b"new");
        assert_eq!(names(dir.path()), ["keep", "map", "sub"]);
        assert_eq!(names(&dir.path().join("sub")), ["keep", "map"]);
    }

    #[test]
    fn what_is_outdated_goes_with_the_commit_and_not_before() {
        let dir = tempfile::tempdir().unwrap();
        ["old", "new", "mine"].iter().for_each(|name| fs::write(dir.path().join(name), "1").unwrap());
        let begin = || OutputFolder::create(dir.path()).unwrap().instead_of(&["old", "new", "never"]);
        drop(begin());
        assert_eq!(names(dir.path()), ["mine", "new", "old"]);
        let out = begin();
        out.write("new", b"2").unwrap();
        out.commit().unwrap();
        assert_eq!(names(dir.path()), ["mine", "new"]);
        assert_eq!(fs::read(dir.path().join("new")).unwrap(), b"2");
    }

    #[test]
    fn a_file_in_the_way_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("run");
        fs::write(&file, "mine").unwrap();
        let error = OutputFolder::create(&file).unwrap_err().to_string();
        assert_eq!(
            error,
            format!("{}: this is a file, expected a folder to write the results to", file.display())
        );
        let below = file.join("deeper");
        let error = OutputFolder::create(&below).unwrap_err().to_string();
        assert_eq!(error, format!("cannot create {}: a file is in the way", below.display()));
        assert_eq!(fs::read(&file).unwrap(), b"mine");
        assert!(OutputFolder::create(Path::new("")).is_err());
        let out = OutputFolder::create(dir.path()).unwrap();
        let error =
            out.write("map.pgm/x", b"1").and_then(|()| out.write("map.pgm", b"2")).unwrap_err().to_string();
        assert!(error.starts_with("cannot write ") && error.ends_with("map.pgm: it is a folder"), "{error}");
    }

    #[test]
    #[cfg(unix)]
    fn results_have_the_usual_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let plain = dir.path().join("plain");
        fs::create_dir(&plain).unwrap();
        let ours = OutputFolder::create(&dir.path().join("ours")).unwrap().commit().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
