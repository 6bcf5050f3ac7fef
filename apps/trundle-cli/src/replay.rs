use crate::run::{RunSetup, drive};
use crate::{
    Outcome, args::ReplayArgs, body::Recorded, console, failure::Failure, logbook::Logbook, run_output,
    tape::Tape,
};
use std::path::Path;
use trundle::io::{OutputFolder, RecordingReader};

/// `trundle replay RECORDING`.
pub fn run(args: &ReplayArgs) -> Result<Outcome, Failure> {
    let name = args.recording.display();
    let reader = RecordingReader::open(&args.recording)?;
    let config = reader.config().ok_or_else(|| {
        Failure::Input(format!(
            "{name}: no trundle.Config message comes first, so this is no recording of a trundle run"
        ))
    })?;
    let setup: RunSetup = serde_json::from_value(config.clone())
        .map_err(|error| Failure::Input(format!("{name}: the configuration cannot be used: {error}")))?;
    setup.robot.clone().validated().map_err(|error| Failure::Input(format!("{name}: {error}")))?;
    let folder = OutputFolder::create(&args.out)?;
    let mut body = Recorded::new(reader);
    let run = drive(&setup, &mut body, Tape::here(&folder)?, Logbook::default(), args.common.quiet)
        .map_err(|error| told_of(&args.recording, error))?;
    if let Err(problem) = body.read_on() {
        console::warn(&format!("the run was over before, but {}", told_of(&args.recording, problem)));
    }
    run_output::write(&setup, run, None, folder, args.common.quiet)
}

/// The same with the recording's name, where it is not there yet.
fn told_of(recording: &Path, failure: Failure) -> Failure {
    match failure {
        Failure::Input(problem) => Failure::Input(format!("{}: {problem}", recording.display())),
        other => other,
    }
}
