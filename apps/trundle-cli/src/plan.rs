//! `trundle plan`: way-points, curve and trajectory through goals on a map.

mod args;

pub use args::PlanArgs;

use crate::console;
use crate::logging;
use crate::outcome::Outcome;
use trundle::app::AppError;
use trundle::app::plan::{
    GoalRefusal, NamedPose, OffMap, PlaceArg, PlanFiles, PlanRequest, PlanTimes, curve_lines, plan_rows,
    write_plan, write_refusal,
};
use trundle::core::DriveLimits;
use trundle::io::OutputFolder;
use trundle::planning::MultiGoalPlan;

/// `trundle plan MAP.yaml --from --goal`.
pub fn run(args: &PlanArgs) -> Result<Outcome, AppError> {
    let robot = args.robot.robot()?;
    let mut request = PlanRequest::read(&args.files(), args.ends()?, args.near, &robot)?;
    if let (Some(path), Some(warning)) = (&args.speed_mask, request.speed_mask_warning()) {
        console::warn(&format!("{}: {warning}", path.display()));
    }
    let folder = logging::output_folder(&args.out)?;
    let (plan, times) = request.timed_plan();
    match plan {
        Ok(plan) => report_plan(args, &mut request, &plan, robot.limits, times, folder),
        Err(refusal) => report_refusal(args, &mut request, &refusal, folder),
    }
}

fn report_plan(
    args: &PlanArgs,
    request: &mut PlanRequest,
    plan: &MultiGoalPlan,
    limits: DriveLimits,
    times: PlanTimes,
    folder: OutputFolder,
) -> Result<Outcome, AppError> {
    let moved = request.goals_moved(plan);
    let place = write_plan(request, plan, limits, &moved, times, folder)?;
    if let Some(off) = OffMap::of(request, plan) {
        console::warn(&format!("{}: {}", args.map.display(), off.warning()));
    }
    if args.coefficients {
        curve_lines(plan).iter().for_each(|line| console::print(line));
    }
    if !args.common.quiet {
        moved.iter().for_each(|moved| console::print(&moved.note()));
    }
    console::print_result(args.common.quiet, &plan_rows(plan, times), &place.join("plan.html"));
    Ok(Outcome::Reached)
}

fn report_refusal(
    args: &PlanArgs,
    request: &mut PlanRequest,
    refusal: &GoalRefusal,
    folder: OutputFolder,
) -> Result<Outcome, AppError> {
    let why = request.explain(refusal);
    write_refusal(request, refusal, &why, folder)?;
    console::print_error(&AppError::Input(format!("{}: {why}", args.map.display())));
    Ok(Outcome::Missed)
}

impl PlanArgs {
    fn files(&self) -> PlanFiles {
        PlanFiles {
            map: self.map.clone(),
            keep_out: self.keepout.clone(),
            speed_mask: self.speed_mask.clone(),
            graph: self.graph.clone(),
        }
    }

    /// Start and goals, named places looked up in the file of places.
    fn ends(&self) -> Result<(NamedPose, Vec<NamedPose>), AppError> {
        let all = std::iter::once(&self.from).chain(&self.goal);
        let mut poses = PlaceArg::poses(all, self.places.as_deref())?;
        Ok((poses.remove(0), poses))
    }
}
