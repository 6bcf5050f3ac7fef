//! The files of a run's recording.

use crate::{AppError, FreeSpace, RecordingContent, RecordingSwitch};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use trundle_io::{IoError, OutputFolder, Recorder, RecordingFolder};

/// A recording into a file.
pub type FileRecorder = Recorder<BufWriter<File>>;

/// The recording that begins with the run: a replay needs it.
const FIRST_FILE: &str = "recording.mcap";

/// The files of a recording: the first from the start of the run, and one for each time the recording is switched on later. A file ends with
/// the run, by the switch, or if the disk is full or short of space.
pub(crate) struct RecordingFile {
    /// `None` without a recording, and after its end.
    recorder: Option<FileRecorder>,
    /// Folder of further files; `None` for a device, which has none.
    folder: Option<RecordingFolder>,
    /// Number of the newest file; that of the first is 1.
    number: usize,
    space: Option<FreeSpace>,
    switch: RecordingSwitch,
    /// The first failure.
    failure: Option<IoError>,
}

impl RecordingFile {
    /// Begins the first file of a recording of `content`; without content only further files are possible.
    pub(crate) fn new(
        content: RecordingContent,
        folder: &OutputFolder,
        switch: RecordingSwitch,
    ) -> Result<Self, AppError> {
        let recorder = match content {
            RecordingContent::None => None,
            _ => Some(folder.recorder(FIRST_FILE)?),
        };
        let space = Some(FreeSpace::of(&folder.staged("")));
        let file =
            Self { recorder, folder: Some(folder.recordings()), number: 1, space, switch, failure: None };
        file.report(None);
        Ok(file)
    }

    /// A recording onto a device.
    pub(crate) fn onto(recorder: FileRecorder, switch: RecordingSwitch) -> Self {
        Self { recorder: Some(recorder), folder: None, number: 1, space: None, switch, failure: None }
    }

    /// Ends the recording if `space` is short.
    pub(crate) fn watch(&mut self, space: FreeSpace) {
        self.space = Some(space);
    }

    /// Writes a line, or drops it without a recording: a full disk does not stop a robot.
    pub(crate) fn write(&mut self, line: impl FnOnce(&mut FileRecorder) -> Result<(), IoError>) {
        let Some(recorder) = &mut self.recorder else { return };
        let shortage = self.space.as_mut().and_then(FreeSpace::shortage_at_message);
        let failure = if shortage.is_none() { line(recorder).err() } else { None };
        if let Some(why) = shortage.or_else(|| failure.as_ref().map(ToString::to_string)) {
            tracing::warn!("{why}; the recording ends here, the robot continues");
            self.close(failure);
            self.report(Some(why));
        }
    }

    /// Ends the recording by the switch.
    pub(crate) fn end(&mut self) {
        self.close(None);
        self.report(None);
    }

    /// Begins a further file. Without space or folder the recording stays off, and the state contains the reason.
    pub(crate) fn begin_part(&mut self) {
        self.close(None);
        let reason = self.next_file().err();
        if let Some(why) = &reason {
            tracing::warn!("the recording is not switched on: {why}");
        }
        self.report(reason);
    }

    fn next_file(&mut self) -> Result<(), String> {
        if let Some(shortage) = self.space.as_ref().and_then(FreeSpace::shortage) {
            return Err(shortage);
        }
        let folder = self.folder.as_ref().ok_or("a device has no further files")?;
        let number = self.number + 1;
        self.recorder = Some(folder.recorder(&file_name(number)).map_err(|error| error.to_string())?);
        self.number = number;
        Ok(())
    }

    /// Completes the present file.
    fn close(&mut self, failure: Option<IoError>) {
        let Some(recorder) = self.recorder.take() else { return };
        let finished = recorder.finish().map(drop);
        if let Some(failure) = failure.or(finished.err()) {
            self.switch.update(|state| {
                state.file = None;
                state.failed_files.push(file_name(self.number));
            });
            self.failure.get_or_insert(failure);
        }
    }

    /// Reports the free space.
    pub(crate) fn report_space(&self) {
        let free_bytes = self.space.as_ref().and_then(FreeSpace::bytes);
        self.switch.update(|state| state.free_bytes = free_bytes);
    }

    fn report(&self, reason: Option<String>) {
        let is_on = self.recorder.is_some();
        self.switch.update(|state| {
            state.is_on = is_on;
            state.reason = reason;
            if is_on {
                state.file = Some(file_name(self.number));
            }
        });
        self.report_space();
    }

    /// Completes the recording.
    ///
    /// # Errors
    /// The first failure of a file.
    pub(crate) fn finish(mut self) -> Result<(), IoError> {
        self.close(None);
        self.failure.map_or(Ok(()), Err)
    }
}

fn file_name(number: usize) -> String {
    if number == 1 { FIRST_FILE.to_owned() } else { format!("recording-{number}.mcap") }
}

/// Name of the first file in messages.
pub(crate) fn first_file() -> &'static Path {
    Path::new(FIRST_FILE)
}
