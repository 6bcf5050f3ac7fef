//! The folder of a docking plan.

use super::impossible::impossible_text;
use super::picture::{DockingObstacles, manoeuvre_picture, step_pictures};
use super::result::DockingResult;
use super::table::{motions, steps_csv};
use super::task::DockingTask;
use crate::AppError;
use std::path::PathBuf;
use trundle_docking::{Certificate, DockingPlan, Solution};
use trundle_io::{OutputFolder, Summary};
use trundle_viz::tiles;

/// Writes steps, pictures and summary; returns the folder. `seconds`: wall-clock time of planning.
///
/// # Errors
/// When a file cannot be written.
pub fn write_docking(
    task: &DockingTask,
    result: &DockingResult,
    seconds: f64,
    folder: OutputFolder,
) -> Result<PathBuf, AppError> {
    let obstacles = DockingObstacles { grid: task.grid.as_ref(), problem: task.problem.as_ref() };
    let found = result.found();
    let in_the_way = match result {
        DockingResult::Planned(DockingPlan::Impossible(impossible)) => impossible.by.map(|by| by.at),
        _ => None,
    };
    let ends = (task.start, task.goal);
    if let Some(found) = found.filter(|found| !found.manoeuvre.steps().is_empty()) {
        folder.write("steps.csv", steps_csv(&found.manoeuvre).as_bytes())?;
        let steps = step_pictures(obstacles, &task.footprint, ends, found);
        folder.write("steps.png", &tiles(&steps, columns(steps.len())))?;
    }
    let picture = manoeuvre_picture(obstacles, &task.footprint, ends, found, in_the_way);
    folder.write("dock.png", &picture.to_png())?;
    folder.write("summary.json", summary(task, result, seconds).to_json().as_bytes())?;
    Ok(folder.commit()?)
}

/// Pictures in a row: four; above 16 motions, about the square root of their number.
fn columns(motions: usize) -> usize {
    motions.isqrt().max(4)
}

fn summary(task: &DockingTask, result: &DockingResult, seconds: f64) -> Summary {
    let mut summary = Summary::new("dock");
    summary.set("task", &task.name).set("from", task.start).set("to", task.goal);
    match result {
        DockingResult::Refused(reason) => summary.set("success", false).set("reason", reason),
        DockingResult::Planned(DockingPlan::Found(Solution { manoeuvre, bound, margin })) => summary
            .set("success", true)
            .set("motions", motions(manoeuvre))
            .set("duration_s", manoeuvre.duration())
            .set("bound_s", *bound)
            .set("margin_m", *margin),
        DockingResult::Planned(DockingPlan::Impossible(impossible)) => {
            let proven = impossible.certificate != Certificate::None;
            let reason = impossible_text(impossible);
            summary.set("success", false).set("proven", proven).set("reason", reason)
        }
    };
    summary.set("wall_clock", serde_json::json!({ "planning_s": seconds }));
    summary
}
