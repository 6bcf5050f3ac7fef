//! `trundle calibrate`: camera, mount, wheels and image delay.

mod args;

pub use args::CalibrateArgs;

use crate::console;
use crate::outcome::Outcome;
use args::{BoardImageArgs, BoardSheetArgs, CalibrateCommand, DriveArgs};
use trundle::app::calibrate::{
    BoardRequest, Calibration, CalibrationInput, calibrate_board, calibrate_delay, calibrate_mount,
    calibrate_wheels, write_board,
};
use trundle::app::{AppError, StepProgress, load_robot};
use trundle::vision::board::LensModel;

type DriveCalibration = fn(&CalibrationInput, &dyn StepProgress) -> Result<Calibration, AppError>;

/// `trundle calibrate ...`.
pub fn run(args: &CalibrateArgs) -> Result<Outcome, AppError> {
    match &args.command {
        CalibrateCommand::Camera(args) => camera(args)?,
        CalibrateCommand::Board(args) => sheet(args)?,
        CalibrateCommand::Mount(args) => drive(args, calibrate_mount)?,
        CalibrateCommand::Wheels(args) => drive(args, calibrate_wheels)?,
        CalibrateCommand::Delay(args) => drive(args, calibrate_delay)?,
    }
    Ok(Outcome::Reached)
}

fn drive(args: &DriveArgs, calibrate: DriveCalibration) -> Result<(), AppError> {
    let input = CalibrationInput::open(&args.recording, args.recover)?;
    let found = calibrate(&input, &console::StepDisplay::new(args.common.quiet))?;
    print(&found, args.common.quiet);
    if let Some(file) = &args.write {
        found.write(file)?;
        print_written(file, args.common.quiet);
    }
    Ok(())
}

fn camera(args: &BoardImageArgs) -> Result<(), AppError> {
    let robot = args.write.as_deref().filter(|file| file.exists());
    let request = BoardRequest {
        images: args.images.clone(),
        board: args.board,
        lens: if args.k3 { LensModel::FiveCoefficients } else { LensModel::FourCoefficients },
        in_use: load_robot(robot, &[])?.camera,
    };
    let found = calibrate_board(&request, &console::StepDisplay::new(args.common.quiet))?;
    print(&found.calibration, args.common.quiet);
    if let Some(file) = &args.write_camera {
        found.write_camera_file(file)?;
        print_written(file, args.common.quiet);
    }
    if let Some(file) = &args.write {
        found.calibration.write(file)?;
        print_written(file, args.common.quiet);
    }
    Ok(())
}

fn sheet(args: &BoardSheetArgs) -> Result<(), AppError> {
    write_board(&args.board, &args.out)?;
    print_written(&args.out, args.common.quiet);
    Ok(())
}

fn print(found: &Calibration, quiet: bool) {
    if !quiet {
        console::print_table(&found.rows());
        found.notes.iter().for_each(|note| console::print(note));
    }
}

fn print_written(file: &std::path::Path, quiet: bool) {
    if !quiet {
        console::print(&format!("Wrote {}", file.display()));
    }
}
