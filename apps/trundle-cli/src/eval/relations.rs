//! `trundle eval relations`: a trajectory against the relations of a reference.

use super::args::RelationsArgs;
use super::named_error::named_error;
use crate::outcome::Outcome;
use crate::{console, logging};
use std::path::Path;
use trundle::app::{AppError, read_trajectory};
use trundle::core::{Pose3, Stamp};
use trundle::eval::{
    EvalError, Relation, RelationConfig, RelationError, RelationSets, RelationSetsConfig, relation_error,
    relations_from_text,
};
use trundle::io::{Summary, read_text};

/// Share of poses that may have the stamp of the pose before. Above it the stamps are rounded, and a stamp names several poses. Source: ours.
const MAX_REPEATED_STAMPS_SHARE: f64 = 0.1;

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
        return Err(AppError::Input(format!("{}: {}", args.reference.display(), no_relation(args)?)));
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

/// Why a reference has no relation.
fn no_relation(args: &RelationsArgs) -> Result<String, AppError> {
    if args.file {
        return Ok("no relation in it, expected lines of: from_time to_time x y z roll pitch yaw".to_owned());
    }
    let (length, near) = (path_length(&args.reference)?, RelationSetsConfig::default().near);
    Ok(format!(
        "its path is {length:.2} m long, expected at least {near} m: relations are between poses {near} m apart"
    ))
}

/// The relations with their names, the last all of them.
fn sets(args: &RelationsArgs) -> Result<Vec<(&'static str, Vec<Relation>)>, AppError> {
    let path = &args.reference;
    if args.file {
        let text = read_text(path)?;
        let relations = relations_from_text(&text)
            .map_err(|error| AppError::Input(format!("{}, {error}", path.display())))?;
        return Ok(vec![("all", relations)]);
    }
    let named = |problem| AppError::Input(format!("{}: {problem}", path.display()));
    let sets = RelationSets::of(&trajectory(path)?, &RelationSetsConfig::default()).map_err(named)?;
    let all = sets.all();
    Ok(vec![("1 m", sets.near), ("10 m", sets.far), ("loops", sets.loops), ("all", all)])
}

/// Refuses a trajectory in which many poses have one stamp: such a pose cannot be found by its time.
pub(super) fn trajectory(path: &Path) -> Result<Vec<(Stamp, Pose3)>, AppError> {
    let poses = read_trajectory(path)?;
    let repeated = poses.windows(2).filter(|pair| pair[0].0 == pair[1].0).count();
    if repeated as f64 > MAX_REPEATED_STAMPS_SHARE * poses.len() as f64 {
        let (path, count) = (path.display(), poses.len());
        return Err(AppError::Input(format!(
            "{path}: {repeated} of {count} poses have the timestamp of the pose before (are the timestamps rounded?), expected at \
             most one in ten: poses are found by their time"
        )));
    }
    Ok(poses)
}

/// The length of a reference's path, m.
fn path_length(path: &Path) -> Result<f64, AppError> {
    let poses = trajectory(path)?;
    Ok(poses.windows(2).map(|pair| (pair[1].1.translation - pair[0].1.translation).norm()).sum())
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
