//! The local-planning benchmark MRPB 1.0 in trundle's simulator: every pair of start and goal, with and without people. As in the
//! benchmark, the robot has the map and its start pose.

mod course;
mod metrics;
mod report;
mod trial;

pub use trial::MrpbTrial;

use crate::laser_run::{LaserPlan, drive, hokuyo};
use crate::run_each::run_each;
use crate::simulated::simulated_body;
use crate::{ExperimentContext, ExperimentReport, RobotExperiment};
use course::Course;
use std::path::{Path, PathBuf};
use trial::{GOAL_TOLERANCE_M, GOAL_TOLERANCE_RAD};
use trundle_app::AppError;
use trundle_app::operator::OperatorLink;
use trundle_core::{DriveLimits, Invalid};
use trundle_io::{OutputFolder, write_map};
use trundle_runtime::{Mission, RangeSource, RobotConfig, Task};
use trundle_sim::{FaultSchedule, SimConfig};

/// Radius of the benchmark's robot \[m\]. Source: MRPB 1.0.
const ROBOT_RADIUS_M: f64 = 0.25;
/// Inflation of the radius by the benchmark's planners \[m\]. Source: MRPB 1.0.
const INFLATION_M: f64 = 0.01;
/// Range of the benchmark's laser \[m\]. Source: MRPB 1.0.
const LASER_RANGE_M: f64 = 30.0;
/// Maximum speed of the benchmark's robot \[m/s\]. Source: MRPB 1.0.
const MAX_SPEED_M_S: f64 = 0.55;
/// Time limit of a run \[s\]. Source: ours.
const TIME_LIMIT_S: f64 = 600.0;

/// The runs of the benchmark's courses.
pub struct MrpbRequest {
    /// The folder with start_goal.csv, actors.csv and maps.
    pub data: PathBuf,
    /// Text in the names of the selected courses; `None` for all.
    pub only: Option<String>,
    /// Number of noise seeds per course, from 1.
    pub seeds: u32,
    /// A robot in place of the benchmark's own.
    pub robot: Option<RobotConfig>,
}

impl MrpbRequest {
    /// Runs on the courses of a folder whose names contain `only`, with `seeds` seeds each and the given robot.
    #[must_use]
    pub fn new(data: PathBuf, only: Option<String>, seeds: u32, robot: Option<RobotConfig>) -> Self {
        Self { data, only, seeds, robot }
    }
}

impl RobotExperiment for MrpbRequest {
    const NAME: &'static str = "mrpb";
    type Outcome = MrpbOutcome;

    fn robot(&self) -> RobotConfig {
        self.robot.clone().unwrap_or_else(benchmark_robot)
    }

    fn run(&self, context: &ExperimentContext) -> Result<MrpbOutcome, AppError> {
        run(self, context)
    }
}

/// The runs over the benchmark's courses.
pub struct MrpbOutcome {
    /// A run for each course and seed.
    pub trials: Vec<MrpbTrial>,
}

/// Drives every requested course, with each seed.
///
/// # Errors
/// When the data cannot be read, no course has the requested name, or a run cannot be created.
pub fn run(request: &MrpbRequest, context: &ExperimentContext) -> Result<MrpbOutcome, AppError> {
    let robot = request.robot();
    let chosen =
        |course: &Course| request.only.as_ref().is_none_or(|only| course.name().contains(only.as_str()));
    let all = course::read(&request.data)?;
    let names = all.iter().map(Course::name).collect::<Vec<_>>().join(", ");
    let courses: Vec<Course> = all.into_iter().filter(chosen).collect();
    if courses.is_empty() {
        let only = request.only.as_deref().unwrap_or("");
        return Err(AppError::Input(format!("--only '{only}': no course of that name; there are {names}")));
    }
    let plans: Vec<(Course, u64)> = courses
        .into_iter()
        .flat_map(|course| (1..=u64::from(request.seeds)).map(move |seed| (course.clone(), seed)))
        .collect();
    let name_of = |(course, seed): &(Course, u64)| format!("{}, seed {seed}", course.name());
    let one = |(course, seed), watch| one(&request.data, &robot, course, seed, watch);
    Ok(MrpbOutcome { trials: run_each(plans, "runs", context, name_of, one)? })
}

impl ExperimentReport for MrpbOutcome {
    fn is_success(&self) -> bool {
        self.trials.iter().all(MrpbTrial::success)
    }

    fn table(&self) -> Vec<Vec<String>> {
        report::rows(&self.trials)
    }

    fn verdict(&self) -> String {
        report::verdict(&self.trials, self.is_success())
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (trials, success) = (&self.trials, self.is_success());
        for trial in trials {
            folder.write(&format!("{}.png", report::file_name(trial)), &report::picture(trial))?;
            write_map(folder, &report::file_name(trial), &trial.grid)?;
        }
        folder.write("mrpb.csv", report::csv(trials).as_bytes())?;
        folder.write("report.html", report::report(trials, success).to_html().as_bytes())?;
        folder.write("summary.json", report::summary(trials, success).to_json().as_bytes())?;
        Ok(())
    }
}

/// The robot of the benchmark, which is certain of an arrival within the benchmark's tolerance.
fn benchmark_robot() -> RobotConfig {
    let mut robot = robot();
    robot.mission_executor.arrival_bound = GOAL_TOLERANCE_M;
    robot.mission_executor.arrival_heading_bound_deg = GOAL_TOLERANCE_RAD.to_degrees();
    robot
}

/// The benchmark's robot as the autonomy's settings: a round two-wheeled base with a laser.
pub(crate) fn robot() -> RobotConfig {
    let mut robot = RobotConfig::default();
    robot.footprint_radius = ROBOT_RADIUS_M + INFLATION_M;
    robot.sight = RangeSource::Laser;
    robot.limits = DriveLimits { v: MAX_SPEED_M_S, ..DriveLimits::KOBUKI };
    robot.schedule.map_hz = 10.0;
    robot.schedule.check_hz = 10.0;
    robot.schedule.improve_hz = 1.0;
    // Only the ends of a long corridor determine the position along it.
    robot.mapping.max_range = LASER_RANGE_M;
    // Errors of laser scans are less correlated than those of images: each scan corrects less of the heading.
    robot.localization.min_position_sigma = 0.005;
    robot.localization.min_heading_sigma_deg = 0.1;
    robot.localization.scan_heading_sigma_deg = 0.3;
    // A tenth of the benchmark's tolerance in position and a quarter in heading leave a margin for errors of the estimate.
    robot.control.settling.position_tolerance = 0.1 * GOAL_TOLERANCE_M;
    robot.control.settling.heading_tolerance = 0.25 * GOAL_TOLERANCE_RAD;
    robot
}

/// Simulated body of the robot.
pub(crate) fn body(robot: &RobotConfig) -> Result<SimConfig, Invalid> {
    let mut config = simulated_body(robot, FaultSchedule::default())?;
    config.has_camera = false;
    config.laser = Some(hokuyo(0.0));
    config.kobuki.footprint_radius = ROBOT_RADIUS_M;
    config.validated()
}

fn one(
    data: &Path,
    robot: &RobotConfig,
    course: Course,
    seed: u64,
    watch: Option<OperatorLink>,
) -> Result<MrpbTrial, AppError> {
    let plan = LaserPlan {
        robot: robot.clone(),
        body: body(robot)?,
        scene: course.scene(data)?,
        mission: Mission::new(vec![Task::go(course.start.inverse() * course.goal)])?,
        known: course.known(data, robot.mapping.resolution)?,
        seed,
        time_limit: TIME_LIMIT_S,
    };
    Ok(MrpbTrial::of(course, seed, drive(plan, watch, |_| false)?))
}
