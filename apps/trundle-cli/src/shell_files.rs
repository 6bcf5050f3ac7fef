//! `trundle completions` and `trundle man`: command line data for shells and the manual.

use crate::console;
use crate::outcome::Outcome;
use crate::output_args::write_file;
use clap::Args;
use clap_complete::Shell;
use clap_mangen::Man;
use std::path::{Path, PathBuf};
use trundle::app::AppError;

/// `trundle completions`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples: trundle completions bash > ~/.local/share/bash-completion/completions/trundle\n          \
    trundle completions zsh > ~/.zfunc/_trundle\n          \
    trundle completions fish > ~/.config/fish/completions/trundle.fish"
)]
pub struct CompletionsArgs {
    /// The shell.
    pub shell: Shell,
}

/// `trundle man`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle man ~/.local/share/man/man1 && man trundle-slam")]
pub struct ManArgs {
    /// Folder for the pages: trundle.1, trundle-slam.1 and so on. An existing page with other content is renamed to trundle.1.1.
    pub dir: PathBuf,
}

/// `trundle completions SHELL`, of the program's command line.
pub fn print_completions(args: &CompletionsArgs, mut program: clap::Command) -> Result<Outcome, AppError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "trundle", &mut script);
    console::print(String::from_utf8_lossy(&script).trim_end());
    Ok(Outcome::Reached)
}

/// `trundle man DIR`, of the program's command line.
pub fn write_man_pages(args: &ManArgs, program: clap::Command) -> Result<Outcome, AppError> {
    let mut command = program.disable_help_subcommand(true);
    command.build();
    write_pages(&command, &args.dir).map(|()| Outcome::Reached)
}

/// The page of a command, and those of its subcommands.
fn write_pages(command: &clap::Command, dir: &Path) -> Result<(), AppError> {
    let man = Man::new(command.clone());
    let path = dir.join(man.get_filename());
    let mut page = Vec::new();
    man.render(&mut page).map_err(|error| AppError::Environment(format!("{}: {error}", path.display())))?;
    write_file(&path, &page)?;
    command.get_subcommands().try_for_each(|part| write_pages(part, dir))
}
