//! Trajectories in the format of the KITTI odometry benchmark: a matrix per row, with times in a second file.

use super::rows::{BrokenRows, number};
use super::trajectory_form::KITTI_COLUMNS;
use crate::files::{fields, read_text, table_rows};
use crate::stamp_unit::StampUnit;
use crate::{IoError, Warnings};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::path::Path;
use trundle_core::{Pose3, Stamp, Vector3};

/// Largest deviation of a rotation matrix's columns from unit length and right angles: files with three decimals are accepted. Source:
/// ours.
const ORTHOGONALITY_TOLERANCE: f64 = 0.02;

/// The poses of a KITTI file, in the order of the rows.
pub(super) fn read_poses(
    path: &Path,
    text: &str,
    broken_rows: BrokenRows,
    warnings: &mut Warnings,
) -> Result<Vec<Pose3>, IoError> {
    let mut poses = Vec::new();
    for (line, content) in table_rows(text) {
        match pose(content) {
            Ok(pose) => poses.push(pose),
            // A row is identified by its number only: after a missing row the others have no time.
            Err(problem) if broken_rows == BrokenRows::Refused => {
                return Err(IoError::line(path, line, problem));
            }
            Err(problem) => {
                warnings.add(&format!("not used, {problem}"), &format!("{}, line {line}", path.display()));
                return Ok(Vec::new());
            }
        }
    }
    Ok(poses)
}

/// The times of a file's rows.
pub(super) struct Times {
    pub stamps: Vec<Stamp>,
    /// Whether the times are only the numbers of the rows.
    pub is_indexed: bool,
    pub warnings: Warnings,
}

/// The times of the rows: `times.txt` in the same folder, else the number of the row in seconds, with a warning.
pub(super) fn times(path: &Path, rows: usize) -> Result<Times, IoError> {
    let mut warnings = Warnings::default();
    let beside = path.with_file_name("times.txt");
    if beside.is_file() && beside != path {
        let stamps = stamps(&beside)?;
        if stamps.len() == rows {
            return Ok(Times { stamps, is_indexed: false, warnings });
        }
        let problem = format!(
            "{} times for {rows} poses, not used: the number of a row is taken as its time in seconds",
            stamps.len()
        );
        warnings.add(&problem, &beside.display().to_string());
    } else {
        let problem = "KITTI poses have no times and times.txt is not beside them: the number of a row is taken as its time in seconds";
        warnings.add(problem, &path.display().to_string());
    }
    let stamps = (0..rows).map(|row| Stamp::from_nanos(row as i64 * 1_000_000_000)).collect();
    Ok(Times { stamps, is_indexed: true, warnings })
}

/// The stamps of a file of one per line.
fn stamps(path: &Path) -> Result<Vec<Stamp>, IoError> {
    let text = read_text(path)?;
    let lines: Vec<(usize, &str)> =
        table_rows(&text).into_iter().filter_map(|(line, row)| Some((line, fields(row).next()?))).collect();
    let texts: Vec<&str> = lines.iter().map(|(_, text)| *text).collect();
    let unit = StampUnit::of(&texts);
    let parse = |(line, text): &(usize, &str)| {
        unit.parse(text).map_err(|invalid| IoError::line(path, *line, invalid.to_string()))
    };
    lines.iter().map(parse).collect()
}

fn pose(line: &str) -> Result<Pose3, String> {
    let numbers =
        fields(line).map(|field| number("matrix element", field)).collect::<Result<Vec<f64>, _>>()?;
    if numbers.len() != KITTI_COLUMNS {
        return Err(format!("{} numbers, expected the {KITTI_COLUMNS} of a KITTI pose", numbers.len()));
    }
    let row = |i: usize| &numbers[4 * i..4 * i + 4];
    let matrix = Matrix3::from_fn(|i, j| row(i)[j]);
    let off = (matrix.transpose() * matrix - Matrix3::identity()).amax();
    if off > ORTHOGONALITY_TOLERANCE || !off.is_finite() || matrix.determinant() < 0.0 {
        return Err("the first three columns are not a rotation matrix".to_owned());
    }
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&matrix));
    Ok(Pose3::new(rotation, Vector3::new(row(0)[3], row(1)[3], row(2)[3])))
}
