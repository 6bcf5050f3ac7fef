//! `trundle devices`: connected devices, and missing ones with their remedy.

use crate::console;
use crate::outcome::Outcome;
use clap::Args;
use trundle::app::AppError;
use trundle::app::hardware::{device_rows, guard_base, udev_rules};
use trundle::drivers::CameraSpec;

/// `trundle devices`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle devices --udev | sudo tee /etc/udev/rules.d/60-trundle.rules")]
pub struct DevicesArgs {
    /// Print the udev rules that give the devices their names and rights.
    #[arg(long)]
    pub udev: bool,
}

/// `trundle serve-camera`: the frames of a camera on standard output, for the process that started this one.
#[derive(Debug, Args)]
pub struct ServeCameraArgs {
    /// The camera.
    pub camera: CameraSpec,
}

/// `trundle devices`.
pub fn run(args: &DevicesArgs) -> Outcome {
    if args.udev {
        console::print(&udev_rules());
    } else {
        console::print_table(&device_rows());
    }
    Outcome::Reached
}

/// `trundle serve-camera`.
pub fn serve(args: &ServeCameraArgs) -> Result<Outcome, AppError> {
    let served = args.camera.serve(std::io::stdout().lock());
    served.map_err(|error| AppError::Input(format!("camera {}: {error}", args.camera)))?;
    Ok(Outcome::Reached)
}

/// `trundle guard-base`.
pub fn guard() -> Result<Outcome, AppError> {
    guard_base().map(|()| Outcome::Reached)
}
