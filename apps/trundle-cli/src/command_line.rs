//! The commands of `trundle`.

use crate::calibrate::CalibrateArgs;
use crate::convert::ConvertArgs;
use crate::data::DataArgs;
use crate::demo::DemoArgs;
use crate::devices::{DevicesArgs, ServeCameraArgs};
use crate::dock::DockArgs;
use crate::doctor::DoctorArgs;
use crate::eval::EvalArgs;
use crate::experiment::ExperimentArgs;
use crate::map::MapArgs;
use crate::plan::PlanArgs;
use crate::replay::ReplayArgs;
use crate::robot_file::ConfigArgs;
#[cfg(feature = "ros2")]
use crate::ros2::Ros2Args;
use crate::run::RunArgs;
use crate::shell_files::{CompletionsArgs, ManArgs};
use crate::sim::SimArgs;
use crate::slam::SlamArgs;
use crate::vocabulary::VocabularyArgs;
use clap::{Parser, Subcommand};
use trundle::app::exit_codes::EXIT_CODES;

/// Version of the package, and the commit if it was built from a checkout.
const LONG_VERSION: &str = env!("TRUNDLE_LONG_VERSION");

/// Autonomy for a two-wheeled indoor robot with one RGB-D camera.
#[derive(Debug, Parser)]
#[command(name = "trundle", version, long_version = LONG_VERSION, about, arg_required_else_help = true, after_help = EXIT_CODES)]
pub struct Cli {
    /// Log state changes and pose corrections; twice (-vv): everything. TRUNDLE_LOG=trundle_runtime=debug filters by crate.
    #[arg(long, short, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
    /// The action.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Drive through a simulated room by camera, wheels and gyro.
    Demo(DemoArgs),
    /// Drive a real robot: base, depth camera, mission.
    Run(RunArgs),
    /// Drive a ROS 2 robot: its sensors and base by topics, goals by Nav2's actions.
    #[cfg(feature = "ros2")]
    Ros2(Ros2Args),
    /// Run the robot again on a recording: same recording, same bytes.
    Replay(ReplayArgs),
    /// Track a recorded RGB-D sequence and draw its map.
    Slam(SlamArgs),
    /// Draw the map of a laser log, a ROS 2 bag or an RGB-D folder.
    Map(MapArgs),
    /// Convert RGB-D images with their poses: ROS bag, TUM folder, recording.
    Convert(ConvertArgs),
    /// Calibrate the robot: camera, mount, wheels, image delay.
    Calibrate(CalibrateArgs),
    /// Evaluate a trajectory or a map against the truth.
    Eval(EvalArgs),
    /// Plan on a map: way-points, curve and trajectory.
    Plan(PlanArgs),
    /// Drive a simulated robot through a scene and record its sensors.
    Sim(SimArgs),
    /// Plan a manoeuvre of turns and straight moves onto a goal in a tight place.
    Dock(DockArgs),
    /// The papers' experiments, each with its table and pictures.
    Experiment(ExperimentArgs),
    /// Train, inspect and exchange the visual vocabulary by which places are recognised.
    Vocabulary(VocabularyArgs),
    /// Print the whole robot file with its defaults, or check one.
    Config(ConfigArgs),
    /// Check this computer before the first drive: clock, rights, disk, devices, limits, each with its remedy.
    Doctor(DoctorArgs),
    /// List the connected devices, and the missing ones.
    Devices(DevicesArgs),
    /// Write the frames of a camera to standard output; `run` starts it for cameras whose library may crash.
    #[command(hide = true)]
    ServeCamera(ServeCameraArgs),
    /// Stop the base at the end of standard input; for `run`.
    #[command(hide = true)]
    GuardBase,
    /// The data sets of the experiments: description, source, licence.
    Data(DataArgs),
    /// Print the completions of a shell: bash, zsh, fish, elvish, powershell.
    Completions(CompletionsArgs),
    /// Write a man page for each command.
    Man(ManArgs),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[cfg(feature = "ros2")]
    #[test]
    fn a_run_needs_a_mission_or_ros_2() {
        let parse = |given: &[&str]| {
            Cli::try_parse_from([&["trundle", "run", "--camera", "folder:/tmp"][..], given].concat())
        };
        let refusal = parse(&[]).unwrap_err().to_string();
        assert!(refusal.contains("--goal <X,Y,DEG>") && refusal.contains("--ros2"), "{refusal}");
        assert!(parse(&["--raw-images"]).is_err());
        for (given, tasks) in [("--ros2", 0), ("--ros2 --explore", 2), ("--dock", 1)] {
            let given: Vec<&str> = given.split(' ').collect();
            let Command::Run(args) = parse(&given).unwrap().command else { panic!("another command") };
            assert_eq!(args.mission.request().mission().unwrap().tasks().len(), tasks, "{given:?}");
        }
    }

    #[cfg(feature = "ros2")]
    #[test]
    fn a_battery_is_read_only_from_a_given_topic() {
        let options = trundle::ros2::Ros2Options::read("trundle", Some(0), Default::default(), &[]).unwrap();
        let battery = |given: &[&str]| {
            let Command::Ros2(args) = Cli::parse_from([&["trundle", "ros2"][..], given].concat()).command
            else {
                panic!("another command")
            };
            args.topics.settings(&options).battery
        };
        assert_eq!(battery(&[]), None);
        assert_eq!(battery(&["--battery", "battery_state"]).as_deref(), Some("battery_state"));
    }

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_help_fits_a_screen() {
        for command in Cli::command().get_subcommands_mut() {
            let lines = command.render_help().to_string().lines().count();
            assert!(lines <= 40, "{} has {lines} lines of help", command.get_name());
        }
    }
}
