//! The BARN challenge in trundle's simulator: cluttered worlds crossed at up to 2 m/s with a 2-D laser.

mod jackal;
mod report;
mod trial;
mod worlds;

pub use trial::BarnTrial;

use crate::laser_run::{LaserPlan, drive};
use crate::run_each::run_each;
use crate::{ExperimentContext, ExperimentReport, IndexRange, RobotExperiment};
use std::path::PathBuf;
use trial::{TIME_LIMIT_S, is_at_goal};
use trundle_app::AppError;
use trundle_app::operator::OperatorLink;
use trundle_io::{OutputFolder, write_map};
use trundle_runtime::{Mission, RobotConfig, Task};
use worlds::BarnWorld;

/// The runs of the BARN worlds.
pub struct BarnRequest {
    /// The folder with worlds.csv and obstacles.csv.
    pub data: PathBuf,
    /// The first and the last world, from 0. `None` for all.
    pub worlds: Option<IndexRange>,
    /// Number of noise seeds per world, from 1.
    pub seeds: u32,
    /// A robot in place of the challenge's Jackal.
    pub robot: Option<RobotConfig>,
}

impl BarnRequest {
    /// Runs in the `worlds` of a folder with `seeds` seeds each, with the given robot.
    #[must_use]
    pub fn new(data: PathBuf, worlds: Option<IndexRange>, seeds: u32, robot: Option<RobotConfig>) -> Self {
        Self { data, worlds, seeds, robot }
    }
}

impl RobotExperiment for BarnRequest {
    const NAME: &'static str = "barn";
    type Outcome = BarnOutcome;

    fn robot(&self) -> RobotConfig {
        self.robot.clone().unwrap_or_else(jackal::robot)
    }

    fn run(&self, context: &ExperimentContext) -> Result<BarnOutcome, AppError> {
        run(self, context)
    }
}

/// The runs through the BARN worlds.
pub struct BarnOutcome {
    /// A run for each world and seed.
    pub trials: Vec<BarnTrial>,
}

/// Crosses the requested worlds, with each seed.
///
/// # Errors
/// When the data cannot be read, or a run cannot be created.
pub fn run(request: &BarnRequest, context: &ExperimentContext) -> Result<BarnOutcome, AppError> {
    let worlds = worlds::read(&request.data)?;
    let max = (worlds.len() as u64).saturating_sub(1);
    let IndexRange { first, last } = request.worlds.unwrap_or(IndexRange { first: 0, last: max });
    if last > max {
        return Err(AppError::Input(format!("--worlds up to {last}, expected at most {max}")));
    }
    let chosen = (0_u64..).zip(worlds).filter(|(i, _)| (first..=last).contains(i));
    let plans: Vec<(BarnWorld, u64)> = chosen
        .flat_map(|(_, world)| (1..=u64::from(request.seeds)).map(move |seed| (world.clone(), seed)))
        .collect();
    let robot = request.robot();
    let name_of = |(world, seed): &(BarnWorld, u64)| format!("world {}, seed {seed}", world.id);
    let one = |(world, seed), watch| one(&robot, world, seed, watch);
    let trials = run_each(plans, "worlds", context, name_of, one)?;
    Ok(BarnOutcome { trials })
}

impl ExperimentReport for BarnOutcome {
    fn is_success(&self) -> bool {
        report::BarnMeans::of(&self.trials).within()
    }

    fn table(&self) -> Vec<Vec<String>> {
        report::rows(&self.trials, &report::BarnMeans::of(&self.trials))
    }

    fn verdict(&self) -> String {
        report::BarnMeans::of(&self.trials).verdict()
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (trials, means) = (&self.trials, report::BarnMeans::of(&self.trials));
        for (name, png) in report::pictures(trials) {
            folder.write(&name, &png)?;
        }
        for trial in trials.iter().filter(|trial| !trial.success) {
            write_map(folder, &format!("world-{}-seed-{}", trial.world.id, trial.seed), &trial.grid)?;
        }
        folder.write("barn.csv", report::csv(trials).as_bytes())?;
        folder.write("report.html", report::report(trials, &means).to_html().as_bytes())?;
        folder.write("summary.json", report::summary(trials, &means).to_json().as_bytes())?;
        Ok(())
    }
}

fn one(
    robot: &RobotConfig,
    world: BarnWorld,
    seed: u64,
    watch: Option<OperatorLink>,
) -> Result<BarnTrial, AppError> {
    let robot = robot.clone();
    let plan = LaserPlan {
        body: jackal::body(&robot)?,
        robot,
        scene: world.scene()?,
        mission: Mission::new(vec![Task::go(BarnWorld::start().inverse() * BarnWorld::goal())])?,
        known: None,
        seed,
        time_limit: TIME_LIMIT_S,
    };
    let run = drive(plan, watch, |moment| is_at_goal(moment) || moment.contacts > 0)?;
    Ok(BarnTrial::of(world, seed, run))
}
