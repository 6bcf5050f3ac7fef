use super::RunsArgs;
use crate::demo::{simulated, time_limit};
use crate::logbook::{Logbook, StateChange};
use crate::run::{Run, RunSetup, drive, live};
use crate::run_table::RunNumbers;
use crate::{console, failure::Failure, tape::Tape};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};
use trundle::core::{OccupancyGrid, Pose2, Vector2};
use trundle::runtime::{Mission, RobotConfig};
use trundle::sim::{FaultSchedule, Scene, Simulator};
use trundle::viz::Table;

/// So many names of runs are said at most.
const NAMED: usize = 30;

/// A closed-loop run to be made: robot and simulator, with noise, and no truth in the loop.
pub struct TrialPlan {
    /// What it is called in tables.
    pub name: String,
    /// The seed of all noise and of the scene.
    pub seed: u64,
    /// The room, with the robot's start.
    pub scene: Scene,
    /// What the robot shall do, in its map frame.
    pub mission: Mission,
    /// The robot.
    pub robot: RobotConfig,
    /// What breaks.
    pub faults: FaultSchedule,
    /// What happens to the computer.
    pub mishap: Option<Mishap>,
}

/// What happens to the robot's computer.
#[derive(Debug, Clone, Copy)]
pub enum Mishap {
    /// Killed after so many seconds, and switched on again with what it kept last, which may be seconds old.
    Restart(f64),
    /// Its disk takes no more.
    FullDisk,
}

/// What it came to.
pub struct Trial {
    /// What it is called in tables.
    pub name: String,
    /// The seed.
    pub seed: u64,
    /// Moves the map frame into the world's.
    pub world_from_map: Pose2,
    /// The numbers.
    pub numbers: RunNumbers,
    /// The way driven in truth, world frame.
    pub driven: Vec<Vector2>,
    /// When it was at each of these points, s since the beginning.
    pub times: Vec<f64>,
    /// At every image: s since the beginning, where the robot believed to be, and where it was, map frame.
    pub beliefs: Vec<(f64, Pose2, Pose2)>,
    /// The trajectory planned last, world frame.
    pub planned: Vec<Vector2>,
    /// The map, map frame.
    pub grid: OccupancyGrid,
    /// What the robot did, one after the other.
    pub changes: Vec<StateChange>,
}

impl Trial {
    /// What the robot did, one after the other.
    pub fn story(&self) -> Table {
        let row = |change: &StateChange| {
            let Pose2 { x, y, theta } = change.pose;
            let place = format!("({x:.2} m, {y:.2} m, {:.0} deg)", theta.to_degrees());
            vec![format!("{:.1}", change.at), place, change.state.to_string()]
        };
        let title = format!("{}, seed {}", self.name, self.seed);
        let table = Table::new(&title, ["time, s", "believed place", "what it began to do"]);
        self.changes.iter().map(row).fold(table, Table::row).wide()
    }
}

/// Makes the runs, as many at once as there are threads; the results are in the order of the plans.
///
/// # Errors
/// The first plan that cannot be carried out.
pub fn all(mut plans: Vec<TrialPlan>, args: &RunsArgs) -> Result<Vec<Trial>, Failure> {
    let quiet = args.common.quiet;
    let names: BTreeSet<String> = plans.iter().map(|plan| plan.name.clone()).collect();
    if let Some(word) = &args.only {
        plans.retain(|plan| format!("{}, seed {}", plan.name, plan.seed).contains(word.as_str()));
    }
    if plans.is_empty() {
        let word = args.only.as_deref().unwrap_or_default();
        let first = names.iter().take(NAMED).cloned().collect::<Vec<_>>().join("', '");
        let more = if names.len() > NAMED { ", ..." } else { "" };
        let problem = format!("--only {word}: no run has a name that holds this; there are '{first}'{more}");
        return Err(Failure::Input(problem));
    }
    let (line, done, total) = (console::live_line(quiet), AtomicUsize::new(0), plans.len());
    let trials = plans.into_par_iter().map(|plan| {
        let trial = one(plan)?;
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        line.set_message(format!("{done} of {total} runs"));
        line.tick();
        Ok(trial)
    });
    let trials = trials.collect();
    line.finish_and_clear();
    trials
}

/// Makes one run.
///
/// # Errors
/// When the plan cannot be carried out.
pub fn one(plan: TrialPlan) -> Result<Trial, Failure> {
    let TrialPlan { name, seed, scene, mission, robot, faults, mishap } = plan;
    let world_from_map = scene.start;
    let setup = RunSetup {
        scene: scene.name.clone(),
        seed,
        map_from_world: world_from_map.inverse(),
        time_limit: time_limit(&mission),
        mission,
        robot: robot.with_seed(seed),
        real_time: false,
        woken: None,
    };
    let config = simulated(&setup.robot, faults)?;
    let mut body = Simulator::new(scene, config, seed).map_err(|error| Failure::Input(error.to_string()))?;
    let run = match mishap {
        None => live(&setup, &mut body, None),
        Some(Mishap::Restart(at)) => live(&setup, &mut body, Some(at))
            .map_err(|error| Failure::Input(format!("{name}, seed {seed}: {error}"))),
        Some(Mishap::FullDisk) => drive(&setup, &mut body, Tape::full()?, Logbook::default(), true),
    }?;
    let planned = planned(&run);
    Ok(Trial {
        name,
        seed,
        world_from_map,
        numbers: RunNumbers::of(&setup, &run),
        times: run.log.truths.iter().map(|(stamp, _)| *stamp - run.log.start.unwrap_or_default()).collect(),
        beliefs: run.log.beliefs(),
        driven: run.log.truths.iter().map(|(_, pose)| world_from_map.transform(pose.position())).collect(),
        planned: planned.into_iter().map(|point| world_from_map.transform(point)).collect(),
        grid: run.robot.grid().clone(),
        changes: run.log.changes.clone(),
    })
}

fn planned(run: &Run) -> Vec<Vector2> {
    let points = run.robot.plan().map(|plan| plan.trajectory.points());
    points.unwrap_or_default().iter().map(|point| point.pose.position()).collect()
}
