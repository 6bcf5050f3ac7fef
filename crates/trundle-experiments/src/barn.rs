//! The BARN challenge in trundle's simulator: cluttered worlds crossed at up to 2 m/s on a 2-D laser.

mod jackal;
mod report;
mod worlds;

use crate::ExperimentReport;
use crate::laser_run::{LaserPlan, LaserRun, Moment, drive};
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use trundle_app::{AppError, Progress};
use trundle_core::{OccupancyGrid, Vector2};
use trundle_io::{OutputFolder, write_map};
use trundle_runtime::{DriveState, Mission, RobotConfig, Task};
use worlds::BarnWorld;

/// The challenge's time limit, s.
const TIME_LIMIT: f64 = 100.0;
/// The goal is reached within this, m.
const NEAR: f64 = 1.0;
/// The clock starts when the robot has gone so far, as the challenge's does, m.
const SET_OUT: f64 = 0.1;
/// What is asked for: the part of worlds crossed, and the mean score.
const SUCCESS: f64 = 0.97;
const SCORE: f64 = 0.45;

/// A world crossed, or not.
pub struct BarnTrial {
    world: BarnWorld,
    seed: u64,
    success: bool,
    /// From setting out to the goal or the end, s.
    time: f64,
    score: f64,
    contacts: u32,
    length: f64,
    least_clearance: f64,
    /// The estimate's greatest distance from truth, m.
    worst_estimate: f64,
    plans: usize,
    /// Control cycle: median and most, ms.
    cycle_ms: (f64, f64),
    state: DriveState,
    /// World frame.
    driven: Vec<Vector2>,
    /// Map frame.
    grid: OccupancyGrid,
}

/// What to run of the BARN worlds.
pub struct BarnRequest {
    /// The folder with worlds.csv and obstacles.csv.
    pub data: PathBuf,
    /// The worlds, from 0, first and last. None: all.
    pub worlds: Option<(usize, usize)>,
    /// Seeds of noise for each world: 1 to this.
    pub seeds: u32,
    /// A robot in place of the challenge's Jackal.
    pub robot: Option<RobotConfig>,
}

/// The runs through the BARN worlds.
pub struct BarnOutcome {
    /// A run for each world and seed.
    pub trials: Vec<BarnTrial>,
}

/// Crosses the worlds asked for, with each seed.
///
/// # Errors
/// When the data cannot be read, or a run cannot be made.
pub fn run(request: &BarnRequest, progress: &Progress) -> Result<BarnOutcome, AppError> {
    let worlds = worlds::read(&request.data)?;
    let (first, last) = request.worlds.unwrap_or((0, worlds.len().saturating_sub(1)));
    if last >= worlds.len() {
        let max = worlds.len().saturating_sub(1);
        return Err(AppError::Input(format!("--worlds up to {last}, expected at most {max}")));
    }
    let chosen = worlds.into_iter().enumerate().filter(|(i, _)| (first..=last).contains(i));
    let plans: Vec<(BarnWorld, u64)> = chosen
        .flat_map(|(_, world)| (1..=u64::from(request.seeds)).map(move |seed| (world.clone(), seed)))
        .collect();
    let robot = request.robot.clone().unwrap_or_else(jackal::robot);
    let (done, total) = (AtomicUsize::new(0), plans.len());
    let trials = plans.into_par_iter().map(|(world, seed)| {
        let trial = one(&robot, world, seed)?;
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        progress.show(&format!("{done} of {total} worlds"));
        Ok(trial)
    });
    Ok(BarnOutcome { trials: trials.collect::<Result<_, AppError>>()? })
}

impl ExperimentReport for BarnOutcome {
    fn is_success(&self) -> bool {
        report::Means::of(&self.trials).within()
    }

    fn table(&self) -> Vec<Vec<String>> {
        report::rows(&self.trials, &report::Means::of(&self.trials))
    }

    fn verdict(&self) -> String {
        report::Means::of(&self.trials).verdict()
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (trials, means) = (&self.trials, report::Means::of(&self.trials));
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

fn is_at_goal(moment: &Moment) -> bool {
    moment.pose.distance(&BarnWorld::goal()) < NEAR
}

fn one(robot: &RobotConfig, world: BarnWorld, seed: u64) -> Result<BarnTrial, AppError> {
    let robot = robot.clone();
    let plan = LaserPlan {
        body: jackal::body(&robot)?,
        robot,
        scene: world.scene()?,
        mission: Mission::new(vec![Task::Go(BarnWorld::start().inverse() * BarnWorld::goal())])?,
        known: None,
        seed,
        time_limit: TIME_LIMIT,
    };
    let run = drive(plan, |moment| is_at_goal(moment) || moment.contacts > 0)?;
    Ok(BarnTrial::of(world, seed, run))
}

impl BarnTrial {
    fn of(world: BarnWorld, seed: u64, run: LaserRun) -> Self {
        let end = *run.end();
        let set_out = run.moments.iter().find(|m| m.pose.distance(&BarnWorld::start()) > SET_OUT);
        let time = end.time - set_out.map_or(0.0, |moment| moment.time);
        let success = is_at_goal(&end) && end.contacts == 0;
        let score = if success { score(world.optimal_time, time) } else { 0.0 };
        let mut cycles = run.cycles_ms.clone();
        cycles.sort_by(f64::total_cmp);
        Self {
            success,
            time,
            score,
            contacts: end.contacts,
            length: run.path_length(),
            least_clearance: run.moments.iter().map(|m| m.clearance).fold(f64::INFINITY, f64::min),
            worst_estimate: run.worst_estimate(),
            plans: run.plans,
            cycle_ms: (cycles[cycles.len() / 2], cycles[cycles.len() - 1]),
            driven: run.moments.iter().map(|m| m.pose.position()).collect(),
            grid: run.robot.grid().clone(),
            state: run.state,
            world,
            seed,
        }
    }

    /// What became of it, in a word or two.
    fn told(&self) -> String {
        match self.success {
            true => "goal reached".to_owned(),
            false if self.contacts > 0 => "contact".to_owned(),
            false if self.time >= TIME_LIMIT - 1.0 => format!("out of time, {}", self.state),
            false => self.state.to_string(),
        }
    }
}

/// The challenge's score of a world crossed: OT / clip(AT, 2 OT, 8 OT).
fn score(optimal: f64, actual: f64) -> f64 {
    optimal / actual.clamp(2.0 * optimal, 8.0 * optimal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_score_is_the_challenges() {
        assert_eq!(score(6.0, 3.0), 0.5);
        assert_eq!(score(6.0, 24.0), 0.25);
        assert_eq!(score(6.0, 90.0), 0.125);
    }
}
