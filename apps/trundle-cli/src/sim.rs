//! `trundle sim`: drives through a simulated scene and records the robot's sensors.

mod args;
#[cfg(feature = "ros2")]
mod ros2;
#[cfg(unix)]
mod serve;

use args::DriverArgs;
pub use args::SimArgs;

use crate::console;
use crate::logging;
use crate::outcome::Outcome;
use crate::output_args::write_files;
use std::path::Path;
use trundle::app::AppError;
use trundle::core::OccupancyGrid;
use trundle::experiments::sim_drive::{
    DriveRecording, KeyDriver, LiveDrive, SimDrive, SimDriver, StillDriver, chosen_driver, drive_rows,
    drive_simulator, drive_summary, drive_verdict, recording_announcement, recording_hint, true_map,
};
use trundle::experiments::simulated::{list_scenes, load_simulator};
use trundle::io::{OutputFolder, map_files};
use trundle::live::RunFacts;
use trundle::sim::{HeightBand, Simulator};

/// `trundle sim`.
pub fn run(args: &SimArgs) -> Result<Outcome, AppError> {
    let Some(name) = args.scene.as_deref().filter(|_| !args.list) else {
        console::print_table(&list_scenes()?);
        return Ok(Outcome::Reached);
    };
    #[cfg(unix)]
    if let Some(port) = &args.wires.kobuki {
        return serve::serve(args, name, port);
    }
    #[cfg(feature = "ros2")]
    if args.ros_robot.ros2 {
        return ros2::serve(args, name);
    }
    let config = args.sensors.config()?;
    let band = match args.true_map.band.as_deref() {
        Some(&[low, high]) => HeightBand::new(low, high)?,
        _ => HeightBand::new(config.kobuki.step_over, config.kobuki.height)?,
    };
    let DriverArgs { drive: script, follow, keys, duration } = &args.driver;
    let driver =
        chosen_driver((script.as_deref(), follow.as_deref()), *keys, args.is_driven_by_page(), *duration)?;
    let folder = args.record.as_deref().map(logging::output_folder).transpose()?;
    let mut robot = load_simulator(name, args.place.options(), config)?;
    let grid =
        args.needs_map().then(|| true_map(robot.scene(), args.true_map.resolution, band)).transpose()?;
    if args.wants_only_map() {
        write_true_map(args, grid.as_ref())?;
        return Ok(Outcome::Reached);
    }
    let drive = drive(args, &mut robot, driver, grid.as_ref(), folder.as_ref())?;
    let place = folder.map(OutputFolder::commit).transpose()?;
    if !args.common.quiet {
        print(&drive, place.as_deref(), &robot);
    }
    Ok(if drive.is_complete { Outcome::Reached } else { Outcome::Missed })
}

fn drive(
    args: &SimArgs,
    robot: &mut Simulator,
    driver: Option<Box<dyn SimDriver>>,
    grid: Option<&OccupancyGrid>,
    folder: Option<&OutputFolder>,
) -> Result<SimDrive, AppError> {
    let (page, link) = args.page_args().start(|| Ok(facts(args, robot)), args.is_driven_by_page())?.unzip();
    let driver = match driver {
        None if args.driver.keys => {
            console::print(KeyDriver::HELP);
            Some(Box::new(KeyDriver::start()?) as Box<dyn SimDriver>)
        }
        driver => driver,
    };
    let mut driver: Box<dyn SimDriver> = match (link, grid) {
        (Some(link), Some(grid)) => Box::new(LiveDrive::start(driver, link, grid.clone())),
        _ => driver.unwrap_or_else(|| Box::new(StillDriver::new(args.driver.duration))),
    };
    if folder.is_some() && !args.common.quiet {
        console::print(&recording_announcement(robot, args.driver.duration.or_else(|| driver.end_s())));
    }
    let mut recording = folder.map(|folder| DriveRecording::new(folder, robot)).transpose()?;
    // All inputs are accepted by now: exit code 2 promises that nothing was written.
    write_true_map(args, grid)?;
    let display = console::StepDisplay::new(args.common.quiet);
    let drive = drive_simulator(robot, driver.as_mut(), args.driver.duration, recording.as_mut(), &display)?;
    drop(driver); // a driver at the keys gives the terminal back
    drop(page);
    if let (Some(recording), Some(grid)) = (recording, grid) {
        let scene = robot.scene();
        recording.finish(grid, scene.start, &drive_summary(&drive, &scene.name, args.place.seed))?;
    }
    Ok(drive)
}

/// Writes the files of `--map`, if given.
fn write_true_map(args: &SimArgs, grid: Option<&OccupancyGrid>) -> Result<(), AppError> {
    let (Some(file), Some(grid)) = (&args.true_map.map, grid) else { return Ok(()) };
    write_files(map_files(file, grid, args.true_map.map_image)?)
}

fn facts(args: &SimArgs, robot: &Simulator) -> RunFacts {
    let (name, radius_m) = (&robot.scene().name, robot.config().kobuki.footprint_radius);
    RunFacts::of_drive(name, radius_m, args.record.is_some())
}

/// Prints the numbers, and what to do with the recording.
fn print(drive: &SimDrive, place: Option<&Path>, robot: &Simulator) {
    console::print(&format!("{}: {}", robot.scene().name, drive_verdict(drive)));
    console::print_table(&drive_rows(drive));
    if let Some(place) = place {
        console::print(&recording_hint(robot, place));
    }
}
