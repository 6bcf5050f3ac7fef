//! `trundle eval relations`: a trajectory against the relations of a reference.

use super::args::RelationsArgs;
use super::named_error::named_error;
use crate::outcome::Outcome;
use crate::{console, logging};
use trundle::app::AppError;
use trundle::app::evaluation::{path_length, relation_rows, relation_summary, unrounded_trajectory};
use trundle::eval::{
    EvalError, Relation, RelationConfig, RelationSets, RelationSetsConfig, relation_error,
    relations_from_text,
};
use trundle::io::read_text;

/// `trundle eval relations`.
pub fn run(args: &RelationsArgs) -> Result<Outcome, AppError> {
    let sets = sets(args)?;
    let estimate = unrounded_trajectory(&args.estimate)?;
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
        folder.write("summary.json", relation_summary(&judged).to_json().as_bytes())?;
        folder.commit()?;
    }
    if !args.common.quiet {
        console::print_table(&relation_rows(&judged));
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
    let sets =
        RelationSets::of(&unrounded_trajectory(path)?, &RelationSetsConfig::default()).map_err(named)?;
    let all = sets.all();
    Ok(vec![("1 m", sets.near), ("10 m", sets.far), ("loops", sets.loops), ("all", all)])
}
