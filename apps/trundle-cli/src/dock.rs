//! `trundle dock`: a manoeuvre of turns and straight moves onto a goal pose in a tight place.

mod args;

pub use args::DockArgs;

use crate::outcome::Outcome;
use crate::{console, logging, output_args};
use std::path::Path;
use std::time::Instant;
use trundle::app::AppError;
use trundle::app::dock::{DockingRequest, DockingTask, write_docking};

/// `trundle dock MAP.yaml --from --to`, `trundle dock SCANS.log --to`, `trundle dock PROBLEM.txt`, or a built-in problem by name.
pub fn run(args: &DockArgs) -> Result<Outcome, AppError> {
    let request = args.request()?;
    let task = request.task()?;
    if let Some(file) = &args.write_problem {
        return write_problem(args, &task, file);
    }
    let folder = logging::output_folder(&args.out)?;
    let clock = Instant::now();
    let result = request.plan(&task)?;
    let seconds = clock.elapsed().as_secs_f64();
    let place = write_docking(&task, &result, seconds, folder)?;
    if !args.common.quiet && result.refusal().is_none() {
        let (rows, closing) = result.report(seconds);
        console::print_table(&rows);
        console::print(&closing);
        console::print_see(&place.join("dock.png"));
    }
    match result.refusal() {
        Some(refusal) => Ok(Outcome::unless(Some(format!("{}: {refusal}", args.place.display())))),
        None => Ok(if result.found().is_some() { Outcome::Reached } else { Outcome::Missed }),
    }
}

/// Writes the task to a file of problems.
fn write_problem(args: &DockArgs, task: &DockingTask, file: &Path) -> Result<Outcome, AppError> {
    output_args::write_file(file, task.to_text().as_bytes())?;
    if !args.common.quiet {
        console::print_see(file);
    }
    Ok(Outcome::Reached)
}

impl DockArgs {
    fn request(&self) -> Result<DockingRequest, AppError> {
        Ok(DockingRequest {
            place: self.place.clone(),
            start: self.from.map(|pose| pose.0),
            goal: self.to.map(|pose| pose.0),
            footprint: self.footprint.clone(),
            scan: self.scan.map(|number| number as usize),
            problem: self.problem.clone(),
            unknown_is_free: self.through_unknown,
            method: self.method,
            margin: self.margin,
            robot: self.robot.robot_if_given()?,
        })
    }
}
