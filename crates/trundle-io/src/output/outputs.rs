//! The check of all outputs of a command before its work.

use super::{InputFiles, OutputFile, OutputFolder};
use crate::IoError;
use std::path::PathBuf;

/// All that a command writes.
#[derive(Debug, Clone, Default)]
pub struct CommandOutputs {
    /// Folders of results, by the user or by default.
    pub folders: Vec<PathBuf>,
    /// Those of the folders that the user named.
    pub named: Vec<PathBuf>,
    /// Files of results outside of the folders.
    pub files: Vec<PathBuf>,
    /// Files of results that may lie in a folder of results: the command writes them together with it.
    pub files_of_folder: Vec<PathBuf>,
    /// Files that the command reads, if they are there, and replaces.
    pub edited: Vec<PathBuf>,
    /// Files that the command reads and may replace by their own newer content.
    pub continued: Vec<PathBuf>,
}

impl CommandOutputs {
    /// Refuses outputs that would replace an input, another output or a foreign file, or that cannot be written at their place. Nothing is
    /// written.
    ///
    /// A default folder is not tried for writing: not every action of a command writes it.
    ///
    /// # Errors
    /// Names the output, the file or folder in the way, and the remedy.
    pub fn check(&self, inputs: &InputFiles) -> Result<(), IoError> {
        let files: Vec<PathBuf> = self.files.iter().chain(&self.files_of_folder).cloned().collect();
        files.iter().try_for_each(|file| OutputFile::check(inputs, file))?;
        OutputFile::require_different(&files)?;
        self.edited.iter().try_for_each(|file| OutputFile::check(&InputFiles::default(), file))?;
        self.named.iter().try_for_each(|folder| OutputFolder::require_writable(folder))?;
        let inputs = inputs.clone().and(self.edited.iter().chain(&self.continued).cloned());
        self.folders.iter().try_for_each(|folder| {
            OutputFolder::check(&inputs, folder)?;
            let outside = |file: &PathBuf| OutputFolder::require_outside(folder, file);
            self.files.iter().try_for_each(outside)?;
            let of_folder = &self.files_of_folder;
            of_folder.iter().try_for_each(|file| OutputFolder::require_outside_last_run(folder, file))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn refusal(outputs: &CommandOutputs) -> String {
        outputs.check(&InputFiles::default()).unwrap_err().to_string()
    }

    #[test]
    fn a_file_in_the_folder_of_results_is_refused_in_its_own_words_or_written_with_it() {
        let place = tempfile::tempdir().unwrap();
        let (out, kept) = (place.path().join("out"), place.path().join("out.1"));
        let folders = vec![out.clone()];
        let apart = CommandOutputs {
            folders: folders.clone(),
            files: vec![out.join("x.glb")],
            ..CommandOutputs::default()
        };
        let words = refusal(&apart);
        assert!(words.contains("x.glb: this file would lie in") && !words.contains("input"), "{words}");
        let within = |file| CommandOutputs {
            folders: folders.clone(),
            files_of_folder: vec![file],
            ..CommandOutputs::default()
        };
        within(out.join("x.glb")).check(&InputFiles::default()).unwrap();
        let words = refusal(&within(kept.join("x.glb")));
        assert!(words.contains("in which the last run is kept"), "{words}");
        let twice = vec![place.path().join("a.ply"), place.path().join("./a.ply")];
        assert!(
            refusal(&CommandOutputs { files_of_folder: twice, ..CommandOutputs::default() })
                .contains("two results")
        );
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0, "nothing is written");
    }

    #[test]
    fn places_that_cannot_be_written_are_refused_for_every_kind_of_output() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("file");
        fs::write(&file, "mine").unwrap();
        let below = vec![file.join("x")];
        let outputs = [
            CommandOutputs { named: below.clone(), folders: below.clone(), ..CommandOutputs::default() },
            CommandOutputs { files: below.clone(), ..CommandOutputs::default() },
            CommandOutputs { files_of_folder: below.clone(), ..CommandOutputs::default() },
            CommandOutputs { edited: below, ..CommandOutputs::default() },
        ];
        for outputs in outputs {
            let words = refusal(&outputs);
            assert!(words.contains("cannot be written: a file is in the way"), "{words}");
        }
        let folder = CommandOutputs { files: vec![place.path().to_owned()], ..CommandOutputs::default() };
        assert!(refusal(&folder).contains("this is a folder"));
    }
}
