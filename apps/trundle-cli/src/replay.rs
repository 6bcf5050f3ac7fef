use crate::run::{RunSetup, drive};
use crate::{
    Outcome, args::ReplayArgs, body::Recorded, failure::Failure, logbook::Logbook, run_output, tape::Tape,
};
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
    let run = drive(
        &setup,
        &mut Recorded::new(reader),
        Tape::here(&folder)?,
        Logbook::default(),
        args.common.quiet,
    )?;
    run_output::write(&setup, run, None, folder, args.common.quiet)
}
