//! Errors of a trajectory against the relations of a reference: reading, rows and summary.

use crate::{AppError, read_trajectory};
use std::path::Path;
use trundle_core::{Pose3, Stamp};
use trundle_eval::RelationError;
use trundle_io::Summary;

/// Share of poses that may have the stamp of the pose before. Above it the stamps are rounded, and a stamp names several poses. Source: ours.
const MAX_REPEATED_STAMPS_SHARE: f64 = 0.1;

/// A trajectory, refused where many poses have one stamp: such a pose cannot be found by its time.
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

/// The length of a trajectory's path \[m\].
///
/// # Errors
/// As [`unrounded_trajectory`].
pub fn path_length(path: &Path) -> Result<f64, AppError> {
    let poses = unrounded_trajectory(path)?;
    Ok(poses.windows(2).map(|pair| (pair[1].1.translation - pair[0].1.translation).norm()).sum())
}

/// A row for each set of relations, header first.
#[must_use]
pub fn relation_rows(judged: &[(&str, RelationError)]) -> Vec<Vec<String>> {
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

/// The summary of all sets.
#[must_use]
pub fn relation_summary(judged: &[(&str, RelationError)]) -> Summary {
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
