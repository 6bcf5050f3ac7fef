//! `trundle eval relations`: a trajectory against the relations of a reference.

use super::args::RelationsArgs;
use super::named_error::named_error;
use crate::outcome::Outcome;
use crate::{console, logging};
use std::path::Path;
use trundle::app::AppError;
use trundle::core::{Pose3, Stamp};
use trundle::eval::{
    EvalError, Relation, RelationConfig, RelationError, RelationSets, RelationSetsConfig, relation_error,
    relations_from_text,
};
use trundle::io::{Summary, read_odometry, read_trajectory};

/// `trundle eval relations`.
pub fn run(args: &RelationsArgs) -> Result<Outcome, AppError> {
    let sets = sets(args)?;
    let estimate = trajectory(&args.estimate)?;
    let config = RelationConfig { max_difference: args.max_difference }.validated()?;
    let wrong = |error: EvalError| named_error(&error, &args.reference, &args.estimate);
    let mut judged = Vec::new();
    for (name, relations) in sets {
        if !relations.is_empty() {
            judged.push((name, relation_error(&relations, &estimate, &config).map_err(wrong)?));
        }
    }
    if judged.is_empty() {
        let problem = format!("{}: no relation in it", args.reference.display());
        return Err(AppError::Input(problem));
    }
    if let Some(out) = &args.out {
        let folder = logging::output_folder(out)?;
        folder.write("summary.json", summary(&judged).to_json().as_bytes())?;
        folder.commit()?;
    }
    if !args.common.quiet {
        console::print_table(&rows(&judged));
    }
    Ok(Outcome::Reached)
}

/// The relations with their names, the last all of them.
fn sets(args: &RelationsArgs) -> Result<Vec<(&'static str, Vec<Relation>)>, AppError> {
    let path = &args.reference;
    if args.file {
        let text = std::fs::read_to_string(path)
            .map_err(|error| AppError::Input(format!("{}: {error}", path.display())))?;
        let relations = relations_from_text(&text)
            .map_err(|error| AppError::Input(format!("{}, {error}", path.display())))?;
        return Ok(vec![("all", relations)]);
    }
    let named = |problem| AppError::Input(format!("{}: {problem}", path.display()));
    let sets = RelationSets::of(&trajectory(path)?, &RelationSetsConfig::default()).map_err(named)?;
    let all = sets.all();
    Ok(vec![("1 m", sets.near), ("10 m", sets.far), ("loops", sets.loops), ("all", all)])
}

/// Lines of `t x y theta`, or a TUM trajectory.
fn trajectory(path: &Path) -> Result<Vec<(Stamp, Pose3)>, AppError> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
    if first.is_some_and(|line| line.split_whitespace().count() == 4) {
        let planar = read_odometry(path)?;
        return Ok(planar.into_iter().map(|(stamp, pose)| (stamp, Pose3::from_pose2(pose))).collect());
    }
    Ok(read_trajectory(path)?)
}

fn rows(judged: &[(&str, RelationError)]) -> Vec<Vec<String>> {
    let head = ["relations", "number", "missed", "mean", "std", "mean", "std"];
    let row = |(name, error): &(&str, RelationError)| {
        let (t, r) = (&error.translation, &error.rotation);
        vec![
            (*name).to_owned(),
            t.count.to_string(),
            error.missed.to_string(),
            format!("{:.3} m", t.mean),
            format!("{:.3} m", t.std),
            format!("{:.2} deg", r.mean.to_degrees()),
            format!("{:.2} deg", r.std.to_degrees()),
        ]
    };
    std::iter::once(head.map(str::to_owned).to_vec()).chain(judged.iter().map(row)).collect()
}

fn summary(judged: &[(&str, RelationError)]) -> Summary {
    let mut summary = Summary::new("eval relations");
    summary.set("success", true);
    for (name, error) in judged {
        let name = name.replace(' ', "");
        summary
            .set(&format!("{name}_translation_m"), error.translation)
            .set(&format!("{name}_rotation_rad"), error.rotation)
            .set(&format!("{name}_missed"), error.missed);
    }
    summary
}
