//! The folder of a docking plan, and the reason where there is none.

use super::picture::{DockingObstacles, manoeuvre_picture, step_pictures};
use super::table::{motions, steps_csv};
use super::task::DockingTask;
use crate::AppError;
use std::path::PathBuf;
use trundle_docking::{Certificate, DockingPlan, Impossible, SearchLimit, Solution};
use trundle_io::{OutputFolder, Summary};
use trundle_viz::tiles;

/// Writes steps, pictures and summary; where the folder is. `seconds`: wall-clock time of planning.
///
/// # Errors
/// When a file cannot be written.
pub fn write_docking(
    task: &DockingTask,
    plan: &DockingPlan,
    seconds: f64,
    folder: OutputFolder,
) -> Result<PathBuf, AppError> {
    let obstacles = DockingObstacles { grid: task.grid.as_ref(), problem: task.problem.as_ref() };
    let (found, in_the_way) = match plan {
        DockingPlan::Found(found) => (Some(found), None),
        DockingPlan::Impossible(impossible) => (None, impossible.by.map(|by| by.at)),
    };
    let ends = (task.start, task.goal);
    if let Some(found) = found.filter(|found| !found.manoeuvre.steps().is_empty()) {
        folder.write("steps.csv", steps_csv(&found.manoeuvre).as_bytes())?;
        let steps = step_pictures(obstacles, &task.footprint, ends, found);
        folder.write("steps.png", &tiles(&steps, columns(steps.len())))?;
    }
    let picture = manoeuvre_picture(obstacles, &task.footprint, ends, found, in_the_way);
    folder.write("dock.png", &picture.to_png())?;
    folder.write("summary.json", summary(task, plan, seconds).to_json().as_bytes())?;
    Ok(folder.commit()?)
}

/// Four motions a row; of more than 16 about as many as there are rows.
fn columns(motions: usize) -> usize {
    motions.isqrt().max(4)
}

/// Why there is no manoeuvre, in one sentence.
#[must_use]
pub fn impossible_text(impossible: &Impossible) -> String {
    let by = impossible.by.as_ref().map_or_else(String::new, |by| format!(": {by} is in the way"));
    let ended = |limit: SearchLimit| {
        format!("the search ended at docking.planner.{}, more of it searches longer", limit.setting())
    };
    let proof = match (impossible.certificate, impossible.limit) {
        (Certificate::Never, None) => "proven for motions of any kind".to_owned(),
        (Certificate::Never, Some(limit)) => {
            format!("proven for motions of any kind; farther off none was found: {}", ended(limit))
        }
        (Certificate::AtResolution, _) => {
            "a complete search in steps of docking.planner.position_tolerance found no way through; a way that is narrower than such a step is \
             not ruled out".to_owned()
        }
        (Certificate::None, None) => "none was found, which is no proof".to_owned(),
        (Certificate::None, Some(limit)) => format!("none was found, which is no proof: {}", ended(limit)),
    };
    format!("No manoeuvre within {:.1} m{by} ({proof}).", impossible.within)
}

fn summary(task: &DockingTask, plan: &DockingPlan, seconds: f64) -> Summary {
    let mut summary = Summary::new("dock");
    summary.set("task", &task.name).set("from", task.start).set("to", task.goal);
    match plan {
        DockingPlan::Found(Solution { manoeuvre, bound, margin }) => summary
            .set("success", true)
            .set("motions", motions(manoeuvre))
            .set("duration_s", manoeuvre.duration())
            .set("bound_s", *bound)
            .set("margin_m", *margin),
        DockingPlan::Impossible(impossible) => {
            let proven = impossible.certificate != Certificate::None;
            let reason = impossible_text(impossible);
            summary.set("success", false).set("proven", proven).set("reason", reason)
        }
    };
    summary.set("wall_clock", serde_json::json!({ "planning_s": seconds }));
    summary
}
