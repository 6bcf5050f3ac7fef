//! Recorder and replayer: a replay feeds the robot the same inputs as the run.

use crate::body::{HookedBody, StillBody, interrupted, run_into, setup};
use std::path::{Path, PathBuf};
use trundle_app::{
    EncodedBody, FinishedRun, FreeSpace, Progress, RecordingContent, RecordingState, RecordingSwitch, RunLog,
    RunRecorder, RunReplayer, run_on_body,
};
use trundle_core::Stamp;
use trundle_io::{OutputFolder, RecordingReader};
use trundle_runtime::real_time::ThreadPlacement;

/// Records a run on `body`; the run and its recording.
fn record(body: &mut dyn EncodedBody, scratch: &Path) -> (FinishedRun, PathBuf) {
    let folder = OutputFolder::create(&scratch.join("live")).unwrap();
    let run = run_into(&setup(), body, &folder).unwrap();
    (run, folder.commit().unwrap().join("recording.mcap"))
}

/// Replays a recording into the folder `again`.
fn replay(recording: &Path, scratch: &Path) -> (FinishedRun, PathBuf) {
    let (mut body, setup) = RunReplayer::open(recording).unwrap();
    let folder = OutputFolder::create(&scratch.join("again")).unwrap();
    let run = run_into(&setup, &mut body, &folder).unwrap();
    body.read_to_end().unwrap();
    (run, folder.commit().unwrap().join("recording.mcap"))
}

#[test]
fn a_replay_commands_the_same_and_records_the_same_bytes() {
    let scratch = tempfile::tempdir().unwrap();
    let body = StillBody { contacts: Some(1), ..StillBody::touched() };
    let (live, recording) = record(&mut { body }, scratch.path());
    let (again, second) = replay(&recording, scratch.path());
    assert_eq!(live.log.twists, again.log.twists);
    assert_eq!(live.log.state, again.log.state);
    assert_eq!((live.log.contacts(), again.log.contacts()), (1, 1), "contacts are marks of the recording");
    assert!(std::fs::read(recording).unwrap() == std::fs::read(second).unwrap());
}

#[test]
fn a_replay_ends_where_the_user_ended_the_run() {
    let scratch = tempfile::tempdir().unwrap();
    let mut body = interrupted(100);
    let (live, recording) = record(&mut body, scratch.path());
    let (again, _) = replay(&recording, scratch.path());
    assert_eq!(live.log.state, again.log.state);
    assert_eq!((live.log.now, live.log.twists.len()), (again.log.now, again.log.twists.len()));
}

#[test]
fn a_thread_records_the_same_lines() {
    let scratch = tempfile::tempdir().unwrap();
    let (_, inline) = record(&mut StillBody::new(50), scratch.path());
    let folder = OutputFolder::create(&scratch.path().join("threaded")).unwrap();
    let recorder = RunRecorder::threaded(RecordingContent::All, &folder, ThreadPlacement::default()).unwrap();
    let run = run_on_body(&setup(), &mut StillBody::new(50), recorder, RunLog::default(), Progress::hidden())
        .unwrap();
    assert_eq!(run.recording.lines_lost, 0);
    assert!(run.recording.queue_lengths.count() > 50, "a length for each line");
    let threaded = folder.commit().unwrap().join("recording.mcap");
    assert!(std::fs::read(inline).unwrap() == std::fs::read(threaded).unwrap());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_recording_and_not_the_run() {
    let recorder = RunRecorder::onto_full_disk().unwrap();
    let mut body = StillBody::new(50);
    let run = run_on_body(&setup(), &mut body, recorder, RunLog::default(), Progress::hidden()).unwrap();
    assert_eq!(body.commands.len(), 50);
    let error = run.recording.error.unwrap().to_string();
    assert!(error.contains("/dev/full"), "{error}");
}

#[test]
fn a_recorder_that_failed_takes_no_more_lines() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&scratch.path().join("run")).unwrap();
    let mut recorder = RunRecorder::to_folder(&folder).unwrap();
    let fail = || trundle_io::IoError::System {
        path: "recording.mcap".into(),
        action: "write",
        source: std::io::Error::other("no space left"),
    };
    recorder.write(move |_| Err(fail()));
    recorder.write(|_| panic!("a line after the failure"));
    let error = recorder.finish().unwrap_err().to_string();
    assert!(error.contains("no space left"), "{error}");
}

#[test]
fn files_that_are_not_a_recording_of_a_run_are_refused_by_name() {
    let scratch = tempfile::tempdir().unwrap();
    let refusal = |file: &Path| RunReplayer::open(file).err().unwrap().to_string();
    let missing = scratch.path().join("missing.mcap");
    assert!(refusal(&missing).contains("missing.mcap"), "{}", refusal(&missing));
    let text = scratch.path().join("text.mcap");
    std::fs::write(&text, "no recording").unwrap();
    assert!(refusal(&text).contains("text.mcap"), "{}", refusal(&text));

    let folder = OutputFolder::create(&scratch.path().join("other")).unwrap();
    let mut recorder = RunRecorder::to_folder(&folder).unwrap();
    recorder.write(|file| file.record_json("/note", "note", Stamp::default(), &1));
    recorder.finish().unwrap();
    let other = folder.commit().unwrap().join("recording.mcap");
    assert!(refusal(&other).contains("no trundle.Config message comes first"), "{}", refusal(&other));
}

#[test]
fn a_disk_short_of_space_ends_the_recording_and_not_the_run() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&scratch.path().join("run")).unwrap();
    let recorder = RunRecorder::to_folder(&folder).unwrap().watching(FreeSpace::new(|| Some(1), 2));
    let mut body = StillBody::new(50);
    let run = run_on_body(&setup(), &mut body, recorder, RunLog::default(), Progress::hidden()).unwrap();
    assert_eq!(body.commands.len(), 50);
    assert!(run.recording.error.is_none(), "the recording is complete");
    let recording = folder.commit().unwrap().join("recording.mcap");
    assert_eq!(RecordingReader::open(&recording).unwrap().count(), 0);
}

#[test]
fn a_recording_without_images_is_not_replayed_and_content_none_writes_no_file() {
    let scratch = tempfile::tempdir().unwrap();
    let mut files = Vec::new();
    for content in [RecordingContent::None, RecordingContent::Events] {
        let folder = OutputFolder::create(&scratch.path().join(format!("{content:?}"))).unwrap();
        let mut setup = setup();
        setup.recording = content;
        let recorder = RunRecorder::of_content(content, &folder).unwrap();
        run_on_body(&setup, &mut StillBody::new(50), recorder, RunLog::default(), Progress::hidden())
            .unwrap();
        files.push(folder.commit().unwrap().join("recording.mcap"));
    }
    assert!(!files[0].exists());
    let refusal = RunReplayer::open(&files[1]).err().unwrap().to_string();
    assert!(refusal.contains("holds no images") && refusal.contains("--record all"), "{refusal}");
    let events = RecordingReader::open(&files[1]).unwrap().events().map(Result::unwrap);
    assert!(events.count() >= 50);
}

#[test]
fn a_cut_recording_is_replayed_to_the_cut() {
    let scratch = tempfile::tempdir().unwrap();
    let (live, recording) = record(&mut StillBody::new(50), scratch.path());
    let bytes = std::fs::read(&recording).unwrap();
    let cut = scratch.path().join("cut.mcap");
    for part in [3, 5, 8, 9] {
        std::fs::write(&cut, &bytes[..bytes.len() * part / 10]).unwrap();
        let (mut body, setup) = RunReplayer::open_to_cut(&cut).unwrap();
        let folder = OutputFolder::create(&scratch.path().join("again")).unwrap();
        let run = run_into(&setup, &mut body, &folder).unwrap();
        assert_eq!(run.log.twists[..], live.log.twists[..run.log.twists.len()]);
        let report = body.cut_report().unwrap();
        let byte = bytes.len() * part / 10;
        assert!(report.starts_with(&format!("the recording was cut at byte {byte}; ")), "{report}");
    }
}

/// A run of 100 inputs into the folder `live`, with turns of the switch; the run, its switch and its folder.
fn switched(
    content: RecordingContent,
    turns: &[(usize, bool)],
    space: Option<FreeSpace>,
    scratch: &Path,
) -> (FinishedRun, RecordingSwitch, PathBuf) {
    let folder = OutputFolder::create(&scratch.join("live")).unwrap();
    let mut setup = setup();
    setup.recording = content;
    let recorder = RunRecorder::of_content(content, &folder).unwrap();
    let recorder = match space {
        Some(space) => recorder.watching(space),
        None => recorder,
    };
    let switch = recorder.switch().clone();
    let mut body = HookedBody::new(StillBody::new(100), |number| {
        turns.iter().filter(|(input, _)| *input == number).for_each(|(_, on)| switch.turn(*on));
        None
    });
    let run = run_on_body(&setup, &mut body, recorder, RunLog::default(), Progress::hidden()).unwrap();
    (run, switch, folder.commit().unwrap())
}

/// Number of events of a recording.
fn events(recording: &Path) -> usize {
    RecordingReader::open(recording).unwrap().events().map(Result::unwrap).count()
}

#[test]
fn each_switching_on_begins_a_file_and_the_first_is_replayed_to_its_end() {
    let scratch = tempfile::tempdir().unwrap();
    let turns = [(40, false), (60, true), (70, false), (90, true)];
    let (run, switch, folder) = switched(RecordingContent::All, &turns, None, scratch.path());
    assert!(run.recording.error.is_none());
    let state = switch.state();
    assert_eq!((state.file.as_deref(), state.reason), (Some("recording-3.mcap"), None));
    let [first, second, third] =
        ["recording.mcap", "recording-2.mcap", "recording-3.mcap"].map(|name| folder.join(name));
    assert_eq!([&first, &second, &third].map(|file| events(file)).iter().sum::<usize>(), 39 + 10 + 211);
    let (again, _) = replay(&first, scratch.path());
    assert_eq!(again.log.twists[..], run.log.twists[..again.log.twists.len()]);
    assert!(!again.log.twists.is_empty() && again.log.twists.len() < run.log.twists.len());
    let refusal = RunReplayer::open(&second).err().unwrap().to_string();
    assert!(
        refusal.contains("recording-2.mcap") && refusal.contains("after the start of its run"),
        "{refusal}"
    );
    let messages: Vec<_> = RecordingReader::open(&second).unwrap().map(Result::unwrap).collect();
    assert!(messages.len() > events(&second) + 2, "it has poses and twists too");
}

#[test]
fn a_run_without_a_recording_records_everything_once_it_is_switched_on() {
    let scratch = tempfile::tempdir().unwrap();
    let (_, switch, folder) = switched(RecordingContent::None, &[(50, true)], None, scratch.path());
    assert!(!folder.join("recording.mcap").exists());
    assert_eq!(events(&folder.join("recording-2.mcap")), 251);
    assert!(switch.state().free_bytes.is_some());
}

#[test]
fn a_recording_is_not_switched_on_with_too_little_space() {
    let scratch = tempfile::tempdir().unwrap();
    let short = FreeSpace::new(|| Some(3_000_000), 4_000_000);
    let (run, switch, folder) = switched(RecordingContent::None, &[(50, true)], Some(short), scratch.path());
    assert!(!run.log.twists.is_empty());
    let RecordingState { is_on, file, reason, free_bytes, .. } = switch.state();
    assert_eq!((is_on, file, free_bytes), (false, None, Some(3_000_000)));
    assert_eq!(reason.unwrap(), "3 MB are free on the disk, expected 4 MB or more");
    assert!(!folder.join("recording-2.mcap").exists());
}
