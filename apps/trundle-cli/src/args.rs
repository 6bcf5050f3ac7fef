use crate::dock::DockArgs;
use crate::experiment::ExperimentArgs;
use crate::sim::SimArgs;
use crate::sim::args::UpArg;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;
use std::str::FromStr;
use trundle::app::{AppError, load_robot};
use trundle::core::Pose2;
use trundle::runtime::RobotConfig;

/// Autonomy for a two-wheeled indoor robot with one RGB-D camera.
#[derive(Debug, Parser)]
#[command(name = "trundle", version, about, arg_required_else_help = true)]
pub struct Cli {
    /// Log state changes and pose corrections; twice (-vv): everything. TRUNDLE_LOG=trundle_runtime=debug filters by crate.
    #[arg(long, short, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Drive through a simulated room on camera, wheels and gyro alone.
    Demo(DemoArgs),
    /// Run the robot again on a recording: same recording, same bytes.
    Replay(ReplayArgs),
    /// Track a recorded RGB-D sequence and draw its map.
    Slam(SlamArgs),
    /// Draw the map of a laser log, a ROS 2 bag or an RGB-D folder.
    Map(crate::map::MapArgs),
    /// Judge a trajectory or a map against the truth.
    Eval(crate::eval::EvalArgs),
    /// Plan on a map: way-points, curve and trajectory.
    Plan(crate::plan::PlanArgs),
    /// Drive a simulated robot through a scene and record what it sees.
    Sim(SimArgs),
    /// Settle on a goal in a tight place: the manoeuvre of turns and straight moves.
    Dock(DockArgs),
    /// The papers' experiments, each with its table and pictures.
    Experiment(ExperimentArgs),
    /// Train, look at and exchange the words by which places are recognised.
    Vocabulary(crate::vocabulary::VocabularyArgs),
    /// Print the whole robot file with its defaults, or check one.
    Config(ConfigArgs),
}

/// What every command takes.
#[derive(Debug, Clone, Args)]
pub struct Common {
    /// Print nothing but warnings and errors: no progress, no table.
    #[arg(long, short)]
    pub quiet: bool,
    /// Threads to use; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
}

/// What every command that has a robot takes.
#[derive(Debug, Clone, Args)]
pub struct RobotArgs {
    /// Robot file (see `trundle config`).
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Set one key on top of the robot file, as `--set control.settling.speed_m_s=0.2`; may be given again.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl RobotArgs {
    /// The robot: the file's or the default one, with the keys set on top.
    ///
    /// # Errors
    /// Names the file or the key, and what is wrong with it.
    pub fn robot(&self) -> Result<RobotConfig, AppError> {
        load_robot(self.config.as_deref(), &self.set)
    }

    /// The robot where a file or a key is given, else nothing.
    ///
    /// # Errors
    /// As [`RobotArgs::robot`].
    pub fn robot_if_given(&self) -> Result<Option<RobotConfig>, AppError> {
        if self.config.is_none() && self.set.is_empty() { Ok(None) } else { self.robot().map(Some) }
    }
}

/// `trundle demo`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle demo --seed 3 --direct --out out/demo3\n\n\
    Exit code: 0 goal reached and nothing touched, 1 otherwise, 2 bad input.")]
pub struct DemoArgs {
    /// Seed of the room's furniture and textures and of all noise.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// The room: a built-in scene (`trundle sim --list`), a scene file, a .glb or .gltf, or a map (.yaml) raised to walls.
    #[arg(long, value_name = "SCENE", default_value = "demo")]
    pub scene: String,
    /// Where the robot starts in the room: m, m, deg [default: the room's own]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub start: Option<PoseArg>,
    /// The axis that points up in a .glb or .gltf.
    #[arg(long, value_enum, value_name = "AXIS", default_value_t = UpArg::Y)]
    pub up: UpArg,
    /// Goal in the map frame, which starts at the robot: m, m, deg; may be said again for the next one [default: the room's own]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub goal: Vec<PoseArg>,
    /// Drive straight to the goal: the map is drawn on the way [default: explore until the map is complete, do the goals, come back]
    #[arg(long)]
    pub direct: bool,
    /// By the clock on the wall: simulator and robot in threads of their own, camera at 30 Hz; Ctrl-C stops the robot and ends the run.
    #[arg(long)]
    pub real_time: bool,
    /// Write the robot's maps and the state of its mission to FILE, every 3 to 10 s: `--resume` goes on from there.
    #[arg(long, value_name = "FILE", alias = "memory")]
    pub checkpoint: Option<PathBuf>,
    /// Resume from the file of --checkpoint, standing here in the room (m, m, deg): the robot localizes itself in its maps and goes on
    /// with its mission. The map's frame stays that of --start.
    #[arg(long, value_name = "X,Y,DEG", alias = "wake", allow_hyphen_values = true, requires = "checkpoint", conflicts_with_all = ["goal", "direct"])]
    pub resume: Option<PoseArg>,
    /// What breaks, and when: a TOML file as for `trundle sim --faults`.
    #[arg(long, value_name = "FILE")]
    pub faults: Option<PathBuf>,
    /// Give the run up after this much of the robot's time, s [default: 600 a goal, 1800 for exploring]
    #[arg(long, value_name = "S", value_parser = positive_seconds)]
    pub time_limit: Option<f64>,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "out/demo")]
    pub out: PathBuf,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle replay`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle replay out/demo/recording.mcap --out out/replay")]
pub struct ReplayArgs {
    /// A recording made by trundle.
    pub recording: PathBuf,
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "out/replay")]
    pub out: PathBuf,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle slam`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle slam ../shared/data/tum_fr1_rpy_400 --height 1.57 --tilt 33 --roll=-37"
)]
pub struct SlamArgs {
    /// A TUM RGB-D folder: rgb.txt, depth.txt, optional groundtruth.txt and odometry.txt.
    pub dir: PathBuf,
    /// Preset freiburg1, freiburg2, freiburg3, kinect_v2, or a TOML file [default: DIR/camera.toml, else freiburg1]
    #[arg(long, value_name = "PRESET|FILE")]
    pub camera: Option<String>,
    /// Depth units a metre [default: the camera's]
    #[arg(long, value_name = "N")]
    pub depth_scale: Option<f64>,
    /// Stop after this many frames.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
    /// Height of the first camera above the floor, m, for the map.
    #[arg(long, value_name = "M", default_value_t = 1.0)]
    pub height: f64,
    /// Downward tilt of the first camera, deg, for the map.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    pub tilt: f64,
    /// Roll of the first camera to its right, deg, for the map.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    pub roll: f64,
    /// Begin with the visual map that an earlier run wrote (its visual.map): where the camera is in it is found out
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Only locate the camera in the map given: it stays as it is
    #[arg(long, requires = "map")]
    pub localise: bool,
    /// Seed of the random sampling.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "out/slam")]
    pub out: PathBuf,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

impl SlamArgs {
    /// The camera that was asked for, else that which the sequence brings along, else the benchmark's first.
    pub fn camera(&self) -> String {
        let own = self.dir.join("camera.toml");
        let brought = || own.exists().then(|| own.display().to_string());
        self.camera.clone().or_else(brought).unwrap_or_else(|| "freiburg1".to_owned())
    }
}

/// `trundle config`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle config > robot.toml && trundle demo --config robot.toml")]
pub struct ConfigArgs {
    /// Check this robot file and print it whole, its gaps filled with the defaults.
    pub file: Option<PathBuf>,
    /// Set one key on top of the file; may be given again.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Print the JSON schema of robot files instead, for editors.
    #[arg(long)]
    pub schema: bool,
    /// Write robot.toml, robot.schema.json and summary.json into this folder too.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print nothing.
    #[arg(long, short)]
    pub quiet: bool,
}

/// A pose on the command line: `X,Y,DEG`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseArg(pub Pose2);

impl FromStr for PoseArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').collect();
        let [x, y, degrees] = parts[..] else {
            return Err(format!("{} numbers, expected 3: X,Y,DEG (m, m, deg)", parts.len()));
        };
        let x = coordinate("X", x, "m", 1e6)?;
        let y = coordinate("Y", y, "m", 1e6)?;
        let degrees = coordinate("DEG", degrees, "deg", 1e6)?;
        Ok(Self(Pose2::new(x, y, degrees.to_radians())))
    }
}

/// A time span on the command line: a finite number of seconds above 0.
fn positive_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("expected a finite number of seconds above 0".to_owned()),
    }
}

fn coordinate(name: &str, text: &str, unit: &str, limit: f64) -> Result<f64, String> {
    let value: f64 =
        text.trim().parse().map_err(|_| format!("{name} is '{text}', expected a number in {unit}"))?;
    if value.abs() <= limit {
        Ok(value)
    } else {
        Err(format!("{name} is {value} {unit}, expected a number between -{limit} and {limit}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn poses_are_three_finite_numbers() {
        let pose: PoseArg = "1.5,-2,90".parse().unwrap();
        assert_eq!(pose.0, Pose2::new(1.5, -2.0, std::f64::consts::FRAC_PI_2));
        assert!("1,2".parse::<PoseArg>().unwrap_err().contains("expected 3"));
        assert!("NaN,2,3".parse::<PoseArg>().unwrap_err().contains("X is NaN m"));
        assert!("1,2,east".parse::<PoseArg>().unwrap_err().contains("DEG is 'east'"));
    }

    #[test]
    fn every_help_fits_a_screen() {
        for command in Cli::command().get_subcommands_mut() {
            let lines = command.render_help().to_string().lines().count();
            assert!(lines <= 40, "{} has {lines} lines of help", command.get_name());
        }
    }
}
