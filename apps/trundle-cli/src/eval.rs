//! `trundle eval`: errors of a trajectory or a map against the truth.

mod args;

pub use args::EvalArgs;

use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::{console, logging};
use args::{EvalObject, MapsArgs, RelationsArgs, TrajectoryArgs};
use trundle::app::AppError;
use trundle::app::evaluation::{
    MapEvaluation, RelationEvaluation, RelationReference, TrajectoryEvaluation, write_evaluation,
    write_summary_folder,
};
use trundle::eval::{AbsoluteConfig, Delta, RelativeConfig};
use trundle::io::Summary;

/// `trundle eval ...`.
pub fn run(args: &EvalArgs) -> Result<Outcome, AppError> {
    match &args.which {
        EvalObject::Trajectory(args) => trajectory(args)?,
        EvalObject::Relations(args) => relations(args)?,
        EvalObject::Map(args) => map(args)?,
    }
    Ok(Outcome::Reached)
}

fn trajectory(args: &TrajectoryArgs) -> Result<(), AppError> {
    let max_difference = args.max_difference;
    let absolute = AbsoluteConfig::new(max_difference, args.align);
    let delta = Delta::of(args.delta, args.unit)?;
    let relative = RelativeConfig::new(max_difference, delta, args.all_pairs).validated()?;
    let found = TrajectoryEvaluation::of_files(&args.reference, &args.estimate, &absolute, &relative)?;
    let subtitle = format!("{} against {}.", args.estimate.display(), args.reference.display());
    let folder = args.out.as_deref().map(logging::output_folder).transpose()?;
    let place = folder.map(|folder| write_evaluation(&found, &subtitle, folder)).transpose()?;
    if !args.common.quiet {
        console::print_table(&found.rows());
        place.iter().for_each(|place| console::print_see(&place.join("report.html")));
    }
    Ok(())
}

fn relations(args: &RelationsArgs) -> Result<(), AppError> {
    let form = if args.file { RelationReference::RelationFile } else { RelationReference::Trajectory };
    let found = RelationEvaluation::of(&args.reference, form, &args.estimate, args.max_difference)?;
    numbers(args.out.as_ref(), args.common.quiet, &found.summary(), &found.rows())
}

fn map(args: &MapsArgs) -> Result<(), AppError> {
    let found = MapEvaluation::of(&args.truth, &args.map, args.at.0, args.exact, args.within)?;
    numbers(args.out.as_ref(), args.common.quiet, &found.summary(), &found.rows())
}

/// Writes a folder with only the summary, if requested, and prints the table.
fn numbers(
    out: Option<&OutputDirArg>,
    quiet: bool,
    summary: &Summary,
    rows: &[Vec<String>],
) -> Result<(), AppError> {
    out.map_or(Ok(()), |out| write_summary_folder(summary, logging::output_folder(out)?))?;
    if !quiet {
        console::print_table(rows);
    }
    Ok(())
}
