//! Drives of a laser robot on a given map: long narrow halls, mazes, and rooms that changed since they were mapped. The robot has the map
//! and its start pose, as in [`crate::mrpb`].

mod places;
mod report;
mod trial;

pub use trial::KnownMapTrial;

use crate::laser_run::{LaserPlan, drive};
use crate::map_scene::{map_from, scene_of_map};
use crate::mrpb::{body, robot};
use crate::run_each::run_each;
use crate::{ExperimentContext, ExperimentReport, RobotExperiment};
use places::{Course, Place};
use trundle_app::AppError;
use trundle_app::operator::OperatorLink;
use trundle_io::OutputFolder;
use trundle_runtime::{Mission, RobotConfig, Task};

/// Time limit of a run \[s\]. Source: ours; the longest hall takes 2 minutes.
const TIME_LIMIT_S: f64 = 600.0;

/// The runs on given maps.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct KnownMapRequest {
    /// Number of seeds of each kind of place, from 1; a seed gives place and noise.
    pub seeds: u32,
    /// Text in the names of the selected runs; `None` for all.
    pub only: Option<String>,
    /// A robot in place of that of [`crate::mrpb`].
    pub robot: Option<RobotConfig>,
}

impl KnownMapRequest {
    /// Runs of the places with `seeds` seeds whose names contain `only`, with the given robot.
    #[must_use]
    pub fn new(seeds: u32, only: Option<String>, robot: Option<RobotConfig>) -> Self {
        Self { seeds, only, robot }
    }
}

impl RobotExperiment for KnownMapRequest {
    const NAME: &'static str = "known-map";
    type Outcome = KnownMapOutcome;

    fn robot(&self) -> RobotConfig {
        self.robot.clone().unwrap_or_else(robot)
    }

    fn run(&self, context: &ExperimentContext) -> Result<KnownMapOutcome, AppError> {
        run(self, context)
    }
}

/// The runs on given maps.
pub struct KnownMapOutcome {
    /// A run for each seed and kind of place.
    pub trials: Vec<KnownMapTrial>,
}

/// Drives through every place.
///
/// # Errors
/// When no run has the requested name, or a run cannot be created.
pub fn run(request: &KnownMapRequest, context: &ExperimentContext) -> Result<KnownMapOutcome, AppError> {
    let robot = request.robot();
    let all =
        (1..=u64::from(request.seeds)).flat_map(|seed| Place::ALL.map(|place| Course::new(place, seed)));
    let only = request.only.as_deref().unwrap_or("");
    let courses: Vec<Course> = all.filter(|course| course.name().contains(only)).collect();
    if courses.is_empty() {
        let names = Place::ALL.map(Place::name).join(", ");
        return Err(AppError::Input(format!(
            "--only '{only}': no run of that name; there are {names}, each with 'seed N'"
        )));
    }
    let one = |course: Course, watch| one(&robot, &course, watch);
    Ok(KnownMapOutcome { trials: run_each(courses, "runs", context, Course::name, one)? })
}

fn one(robot: &RobotConfig, course: &Course, watch: Option<OperatorLink>) -> Result<KnownMapTrial, AppError> {
    let (start, goal) = (course.start, course.goal);
    let plan = LaserPlan {
        robot: robot.clone(),
        body: body(robot)?,
        scene: scene_of_map(&course.name(), Some(&course.world()?), start, goal)?,
        mission: Mission::new(vec![Task::go(start.inverse() * goal)])?,
        known: Some(map_from(start, &course.map()?, robot.mapping.resolution)?),
        seed: course.seed,
        time_limit: TIME_LIMIT_S,
    };
    Ok(KnownMapTrial::of(course, &drive(plan, watch, |_| false)?))
}

impl ExperimentReport for KnownMapOutcome {
    fn is_success(&self) -> bool {
        self.trials.iter().all(KnownMapTrial::is_right)
    }

    fn table(&self) -> Vec<Vec<String>> {
        report::rows(&self.trials)
    }

    fn verdict(&self) -> String {
        report::verdict(&self.trials, self.is_success())
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (trials, success) = (&self.trials, self.is_success());
        for trial in trials.iter().filter(|trial| !trial.is_right()) {
            folder.write(&format!("{}.png", trial.file_name()), &report::picture(trial))?;
        }
        folder.write("known-map.csv", report::csv(trials).as_bytes())?;
        folder.write("report.html", report::report(trials, success).to_html().as_bytes())?;
        folder.write("summary.json", report::summary(trials, success).to_json().as_bytes())?;
        Ok(())
    }
}
