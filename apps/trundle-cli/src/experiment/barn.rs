//! The BARN challenge in trundle's simulator: cluttered worlds crossed at up to 2 m/s on a 2-D laser.

mod jackal;
mod report;
mod worlds;

use super::laser_run::{LaserPlan, LaserRun, Moment, drive};
use super::{BarnArgs, WorldRange};
use crate::{Outcome, console, failure::Failure, robot_file};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use trundle::core::{OccupancyGrid, Vector2};
use trundle::io::{OutputFolder, write_map};
use trundle::runtime::{DriveState, Mission, RobotConfig, Task};
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
struct Trial {
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

/// The worlds that were asked for.
pub fn run(args: &BarnArgs) -> Result<Outcome, Failure> {
    let worlds = worlds::read(&args.data)?;
    let range = args.worlds.unwrap_or(WorldRange { first: 0, last: worlds.len().saturating_sub(1) });
    if range.last >= worlds.len() {
        let (last, most) = (range.last, worlds.len().saturating_sub(1));
        return Err(Failure::Input(format!("--worlds up to {last}, expected at most {most}")));
    }
    let chosen = worlds.into_iter().enumerate().filter(|(i, _)| (range.first..=range.last).contains(i));
    let plans: Vec<(BarnWorld, u64)> = chosen
        .flat_map(|(_, world)| (1..=u64::from(args.seeds)).map(move |seed| (world.clone(), seed)))
        .collect();
    let robot =
        args.config.as_deref().map_or_else(|| Ok(jackal::robot()), |file| robot_file::load(Some(file)))?;
    let trials = all(&robot, plans, args.common.quiet)?;
    finish(args, &trials)
}

fn all(robot: &RobotConfig, plans: Vec<(BarnWorld, u64)>, quiet: bool) -> Result<Vec<Trial>, Failure> {
    let (line, done, total) = (console::live_line(quiet), AtomicUsize::new(0), plans.len());
    let trials = plans.into_par_iter().map(|(world, seed)| {
        let trial = one(robot, world, seed)?;
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        line.set_message(format!("{done} of {total} worlds"));
        line.tick();
        Ok(trial)
    });
    let trials = trials.collect();
    line.finish_and_clear();
    trials
}

fn is_at_goal(moment: &Moment) -> bool {
    moment.pose.distance(&BarnWorld::goal()) < NEAR
}

fn one(robot: &RobotConfig, world: BarnWorld, seed: u64) -> Result<Trial, Failure> {
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
    Ok(Trial::of(world, seed, run))
}

impl Trial {
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

fn finish(args: &BarnArgs, trials: &[Trial]) -> Result<Outcome, Failure> {
    let means = report::Means::of(trials);
    let folder = OutputFolder::create(&args.out)?;
    for (name, png) in report::pictures(trials) {
        folder.write(&name, &png)?;
    }
    for trial in trials.iter().filter(|trial| !trial.success) {
        write_map(&folder, &format!("world-{}-seed-{}", trial.world.id, trial.seed), &trial.grid)?;
    }
    folder.write("barn.csv", report::csv(trials).as_bytes())?;
    folder.write("report.html", report::report(trials, &means).to_html().as_bytes())?;
    folder.write("summary.json", report::summary(trials, &means).to_json().as_bytes())?;
    let place = folder.commit()?;
    if !args.common.quiet {
        console::table(&report::rows(trials, &means));
        console::say(&format!("\n{}\nSee {}", means.told(), place.join("report.html").display()));
    }
    Ok(if means.within() { Outcome::Reached } else { Outcome::Missed })
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
