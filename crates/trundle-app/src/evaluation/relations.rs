//! Errors of a trajectory against the relations of a reference: reading, rows and summary.

use super::named_error::named_error;
use crate::{AppError, read_trajectory};
use std::path::Path;
use trundle_core::{Pose3, Stamp};
use trundle_eval::{
    EvalError, Relation, RelationConfig, RelationError, RelationSets, RelationSetsConfig, relation_error,
    relations_from_text,
};
use trundle_io::{Summary, read_text};

/// Share of poses that may have the stamp of the pose before. Above it the stamps are rounded, and a stamp names several poses. Source: ours.
const MAX_REPEATED_STAMPS_SHARE: f64 = 0.1;

/// Reads a trajectory; refuses one in which many poses share a stamp, because such a pose cannot be found by its time.
///
/// # Errors
/// When the file cannot be read, or its stamps are rounded.
pub fn unrounded_trajectory(path: &Path) -> Result<Vec<(Stamp, Pose3)>, AppError> {
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

/// The form of a reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RelationReference {
    /// A trajectory: the relations are its own, 1 m and 10 m apart and between places visited twice.
    Trajectory,
    /// A relation file: lines of from_time, to_time, x, y, z, roll, pitch, yaw.
    RelationFile,
}

/// The errors of a trajectory for each set of relations; the last set contains all relations.
#[derive(Debug, Clone, PartialEq)]
pub struct RelationEvaluation {
    sets: Vec<(&'static str, RelationError)>,
}

impl RelationEvaluation {
    /// Evaluates the trajectory of the file `estimate`. A pose is matched to a time at most `max_difference` \[s\] away.
    ///
    /// # Errors
    /// When a file cannot be read, the reference has no relation, or the trajectory has no pose for one.
    pub fn of(
        reference: &Path,
        form: RelationReference,
        estimate: &Path,
        max_difference: f64,
    ) -> Result<Self, AppError> {
        let relations = relation_sets(reference, form)?;
        let poses = unrounded_trajectory(estimate)?;
        let mut config = RelationConfig::default();
        config.max_difference = max_difference;
        let config = config.validated()?;
        let wrong = |error: EvalError| named_error(&error, reference, estimate);
        let mut sets = Vec::new();
        for (name, relations) in relations.into_iter().filter(|(_, relations)| !relations.is_empty()) {
            sets.push((name, relation_error(&relations, &poses, &config).map_err(wrong)?));
        }
        if sets.is_empty() {
            return Err(named(reference, &no_relation(reference, form)?));
        }
        Ok(Self { sets })
    }

    /// A row for each set of relations, header first.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        let head = ["relations", "number", "missed", "mean", "std", "mean", "std"];
        let head = head.map(str::to_owned).to_vec();
        std::iter::once(head).chain(self.sets.iter().map(|(name, error)| row(name, error))).collect()
    }

    /// The numbers for scripts.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let mut summary = Summary::new("eval relations");
        summary.set("success", true);
        for (name, error) in &self.sets {
            let name = name.replace(' ', "");
            summary
                .set(&format!("{name}_translation_m"), error.translation)
                .set(&format!("{name}_rotation_rad"), error.rotation)
                .set(&format!("{name}_missed"), error.missed);
        }
        summary
    }
}

fn row(name: &str, error: &RelationError) -> Vec<String> {
    let (t, r) = (&error.translation, &error.rotation);
    vec![
        name.to_owned(),
        t.count.to_string(),
        error.missed.to_string(),
        format!("{:.3} m", t.mean),
        format!("{:.3} m", t.std),
        format!("{:.2} deg", r.mean.to_degrees()),
        format!("{:.2} deg", r.std.to_degrees()),
    ]
}

/// The sets of relations with their names; the last set contains all relations.
fn relation_sets(
    path: &Path,
    form: RelationReference,
) -> Result<Vec<(&'static str, Vec<Relation>)>, AppError> {
    if form == RelationReference::RelationFile {
        let relations = relations_from_text(&read_text(path)?)
            .map_err(|error| AppError::Input(format!("{}, {error}", path.display())))?;
        return Ok(vec![("all", relations)]);
    }
    let sets = RelationSets::of(&unrounded_trajectory(path)?, &RelationSetsConfig::default())
        .map_err(|problem| named(path, &problem.to_string()))?;
    let all = sets.all();
    Ok(vec![("1 m", sets.near), ("10 m", sets.far), ("loops", sets.loops), ("all", all)])
}

/// The reason why a reference has no relation.
fn no_relation(path: &Path, form: RelationReference) -> Result<String, AppError> {
    if form == RelationReference::RelationFile {
        return Ok("no relation in it, expected lines of: from_time to_time x y z roll pitch yaw".to_owned());
    }
    let (length, near) = (path_length(path)?, RelationSetsConfig::default().near);
    Ok(format!(
        "its path is {length:.2} m long, expected at least {near} m: relations are between poses {near} m apart"
    ))
}

/// The length of a trajectory's path \[m\].
fn path_length(path: &Path) -> Result<f64, AppError> {
    let poses = unrounded_trajectory(path)?;
    Ok(poses.windows(2).map(|pair| (pair[1].1.translation - pair[0].1.translation).norm()).sum())
}

fn named(path: &Path, problem: &str) -> AppError {
    AppError::Input(format!("{}: {problem}", path.display()))
}
