//! `trundle replay`: a repeated run of the robot on a recording.

use crate::common_args::Common;
use crate::live::LiveArgs;
use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::{console, logging, run_output};
use clap::Args;
use std::path::PathBuf;
use trundle::app::{AppError, RunLog, RunRecorder, RunReplayer, run_on_body};

/// `trundle replay`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle replay out/demo/recording.mcap --out out/replay")]
pub struct ReplayArgs {
    /// A recording made by trundle, with images (`trundle demo --record all`).
    pub recording: PathBuf,
    /// Replay a recording that is cut, as by a power failure, up to the cut.
    #[arg(long)]
    pub recover: bool,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/replay")]
    pub out: OutputDirArg,
    /// The live page, which accepts no commands.
    #[command(flatten)]
    pub live: LiveArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle replay RECORDING`.
pub fn run(args: &ReplayArgs) -> Result<Outcome, AppError> {
    let name = args.recording.display();
    let open = if args.recover { RunReplayer::open_to_cut } else { RunReplayer::open };
    let (mut body, setup) = open(&args.recording)?;
    let folder = logging::output_folder(&args.out)?;
    let recorder = RunRecorder::to_folder(&folder)?;
    let (line, progress) = console::progress(args.common.quiet);
    let (page, front_end) = args.live.front_ends(&setup, progress, None, false)?;
    let run = run_on_body(&setup, &mut body, recorder, RunLog::default(), front_end);
    line.finish_and_clear();
    drop(page);
    let run = run.map_err(|error| error.in_context(&name))?;
    if let Err(problem) = body.read_to_end() {
        console::warn(&format!("the run was over before, but {}", problem.in_context(&name)));
    }
    if let Some(report) = body.cut_report() {
        console::warn(&format!("{name}: {report}"));
    }
    run_output::write(&setup, run, None, folder, args.common.quiet)
}
