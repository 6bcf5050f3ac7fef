//! The folder of a plan, or of the reason for its absence.

use super::goal_refusal::{GoalRefusal, MovedGoal};
use super::numbers::{coefficients_csv, constraints_csv, curve_csv, no_plan_summary, summary};
use super::picture;
use super::plan_times::PlanTimes;
use super::request::PlanRequest;
use crate::AppError;
use std::path::PathBuf;
use trundle_core::{DriveLimits, Vector2};
use trundle_io::{OutputFolder, trajectory_csv, waypoints_csv};
use trundle_planning::MultiGoalPlan;

/// Writes way-points, curve, trajectory, pictures, page and summary; returns the folder.
///
/// # Errors
/// When a file cannot be written.
pub fn write_plan(
    request: &PlanRequest,
    plan: &MultiGoalPlan,
    limits: DriveLimits,
    moved: &[MovedGoal],
    times: PlanTimes,
    folder: OutputFolder,
) -> Result<PathBuf, AppError> {
    let way_points: Vec<Vector2> =
        plan.legs.iter().flat_map(|leg| leg.waypoints.points().iter().copied()).collect();
    folder.write("waypoints.csv", waypoints_csv(&way_points).as_bytes())?;
    folder.write("curve.csv", curve_csv(plan).as_bytes())?;
    folder.write("coefficients.csv", coefficients_csv(plan).as_bytes())?;
    folder.write("constraints.csv", constraints_csv(plan).as_bytes())?;
    folder.write("trajectory.csv", trajectory_csv(&plan.trajectory).as_bytes())?;
    let pictures = picture::draw(request, plan, limits, moved, times);
    folder.write("plan.png", &pictures.plan)?;
    folder.write("field.png", &pictures.field)?;
    folder.write("corridors.png", &pictures.corridors)?;
    folder.write("plan.html", pictures.page.as_bytes())?;
    folder.write("summary.json", summary(request, plan, moved, times).to_json().as_bytes())?;
    Ok(folder.commit()?)
}

/// Writes a picture of the leg without a plan, and the summary with the reason.
///
/// # Errors
/// When a file cannot be written.
pub fn write_refusal(
    request: &PlanRequest,
    refusal: &GoalRefusal,
    why: &str,
    folder: OutputFolder,
) -> Result<PathBuf, AppError> {
    folder.write("plan.png", &picture::without_plan(request, refusal))?;
    folder.write("summary.json", no_plan_summary(request, refusal, why).to_json().as_bytes())?;
    Ok(folder.commit()?)
}
