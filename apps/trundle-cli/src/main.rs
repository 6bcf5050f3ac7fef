//! The program `trundle`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(trundle_cli::run(std::env::args_os()))
}
