//! `trundle sim`: drives through a simulated scene and records what the robot saw.

pub mod args;
mod data_set;
mod driver;
mod hand;
mod journey;
pub mod map;
mod table;

pub use args::SimArgs;

use crate::{Outcome, console};
use args::LaserArg;
use data_set::DataSet;
use driver::Driver;
use hand::Hand;
use journey::Journey;
use std::path::Path;
use trundle::app::AppError;
use trundle::experiments::simulated::{list_scenes, load_scene, read_faults};
use trundle::io::OutputFolder;
use trundle::sim::{HeightBand, SimConfig, Simulator};

/// `trundle sim`.
pub fn run(args: &SimArgs) -> Result<Outcome, AppError> {
    let Some(name) = args.scene.as_deref().filter(|_| !args.list) else {
        console::print_table(&list_scenes()?);
        return Ok(Outcome::Reached);
    };
    let config = configured(args)?;
    let band = match args.band.as_deref() {
        Some(&[low, high]) => HeightBand::new(low, high)?,
        _ => HeightBand::new(config.kobuki.step_over, config.kobuki.height)?,
    };
    let mut driver = Driver::read(args)?;
    let folder = args.record.as_deref().map(new_recording).transpose()?;
    let scene = load_scene(name, args.scene_options())?;
    let grid = args.needs_map().then(|| map::truth(&scene, args.resolution, band)).transpose()?;
    if let (Some(file), Some(grid)) = (&args.map, &grid) {
        map::write(file, grid)?;
    }
    if args.wants_only_map() {
        return Ok(Outcome::Reached);
    }
    let mut robot = Simulator::new(scene, config, args.seed)
        .map_err(|error| AppError::Input(format!("{name}: {error}")))?;
    if let (Driver::Hand(hand), Some(grid)) = (&mut driver, &grid) {
        hand.begin(grid.clone(), args.common.quiet)?;
    }
    let mut data = folder.as_ref().map(|folder| DataSet::new(folder, &robot)).transpose()?;
    let journey = Journey::drive(args, &mut robot, &mut driver, data.as_mut())?;
    drop(driver); // whoever was at the keys gives the terminal back
    if let (Some(data), Some(grid)) = (data, &grid) {
        data.finish(grid, robot.scene().start, &journey.summary(args, &robot.scene().name))?;
    }
    let place = folder.map(OutputFolder::commit).transpose()?;
    if !args.common.quiet {
        journey.print(&robot.scene().name, place.as_deref(), &robot);
    }
    Ok(if journey.is_complete { Outcome::Reached } else { Outcome::Missed })
}

/// The folder of a recording; one that holds a recording already is refused: two in one folder could not be told apart.
fn new_recording(place: &Path) -> Result<OutputFolder, AppError> {
    if place.join("rgb.txt").exists() {
        let problem = "a recording is there already (rgb.txt), choose another folder or remove it";
        return Err(AppError::Input(format!("{}: {problem}", place.display())));
    }
    Ok(OutputFolder::create(place)?)
}

/// The simulated robot that the arguments ask for.
fn configured(args: &SimArgs) -> Result<SimConfig, AppError> {
    let mut config = args.camera.robot();
    config.camera_rate_hz = args.rate.unwrap_or(config.camera_rate_hz);
    config.laser = args.laser.map(LaserArg::laser);
    if let Some(file) = &args.faults {
        config.faults = read_faults(file)?;
    }
    let config = if args.no_noise { config.without_noise() } else { config };
    Ok(config.validated()?)
}
