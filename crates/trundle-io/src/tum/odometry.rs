//! Reader and writer of odometry text files of a TUM sequence.

use super::odometry_units::{OdometryRow, unit_problems};
use super::rows::{BrokenRows, Table};
use super::trajectory_form::Form;
use crate::files::{fields, read_text, read_text_lossy, table_rows};
use crate::{Expected, IoError, Warnings};
use std::fmt::Write;
use std::path::Path;
use trundle_core::{Pose2, Stamp};

/// Farther off no robot gets, m, and rad. Source: ours.
const MAX_COORDINATE_M: f64 = 1e6;
/// Time without any change of the pose from which on it is warned of \[s\]. Source: ours, longer than the pause before a drive.
const MIN_STANDSTILL_S: f64 = 10.0;

/// Odometry of a TUM sequence: lines of `timestamp x y theta` (s, m, m, rad), or of a TUM trajectory, the pose `odom_from_base`, `#` for
/// comments.
///
/// # Errors
/// With the line, when a field is missing, superfluous or not a finite number, or when a pose is implausibly distant.
pub fn read_odometry(path: &Path) -> Result<Vec<(Stamp, Pose2)>, IoError> {
    Ok(parse_odometry(path, &read_text(path)?, BrokenRows::Refused)?.0)
}

/// The odometry of a sequence, which a run can do without: rows that cannot be read are left out with a warning. The other warnings tell
/// of sorted rows, a dropped second row of a stamp, stamps in ms, us or ns, values that seem to be in another unit, and a pose that
/// never changes.
///
/// # Errors
/// When the file has rows and none can be read: with the problem of the first one.
pub(super) fn read_optional_odometry(path: &Path) -> Result<(Vec<(Stamp, Pose2)>, Warnings), IoError> {
    Expected::Trajectory.check(path)?;
    let text = read_text_lossy(path)?;
    let (poses, warnings) = parse_odometry(path, &text, BrokenRows::LeftOut)?;
    if poses.is_empty() {
        parse_odometry(path, &text, BrokenRows::Refused)?;
    }
    Ok((poses, warnings))
}

fn parse_odometry(
    path: &Path,
    text: &str,
    broken_rows: BrokenRows,
) -> Result<(Vec<(Stamp, Pose2)>, Warnings), IoError> {
    let mut warnings = Warnings::default();
    let form = match Form::of(text) {
        form @ (Form::Tum | Form::Euroc) if columns(text) > Form::Planar.names().len() + 1 => form,
        _ => Form::Planar,
    };
    let table = Table {
        path,
        text,
        names: form.names(),
        is_open: form == Form::Euroc,
        unit: form.stamp_unit(),
        broken_rows,
    };
    let mut poses = table.read(|numbers| row(form, numbers), &mut warnings)?;
    let rows = poses.len();
    poses.dedup_by_key(|(stamp, _)| *stamp);
    if poses.len() < rows {
        let problem =
            format!("{} rows repeat the timestamp of the row before and are left out", rows - poses.len());
        warnings.add(&problem, &path.display().to_string());
    }
    for problem in unit_problems(&poses).into_iter().chain(standstill(&poses)) {
        warnings.add(&problem, &path.display().to_string());
    }
    Ok((poses.into_iter().map(|(stamp, row)| (stamp, row.pose)).collect(), warnings))
}

/// A warning about a pose that never changes.
fn standstill(poses: &[(Stamp, OdometryRow)]) -> Option<String> {
    let [(start, first), .., (end, _)] = poses else { return None };
    let is_still = *end - *start >= MIN_STANDSTILL_S && poses.iter().all(|(_, row)| row.pose == first.pose);
    is_still.then(|| {
        format!(
            "the pose is the same in all {} rows, for {:.0} s: did the base stand still, or did it report no motion?",
            poses.len(),
            *end - *start
        )
    })
}

/// The number of fields of the first row.
fn columns(text: &str) -> usize {
    table_rows(text).first().map_or(0, |(_, line)| fields(line).count())
}

/// The planar pose of a row, and its heading as given.
fn row(form: Form, numbers: &[f64]) -> Result<OdometryRow, String> {
    let pose = match (form, numbers) {
        // The row has no quaternion: every bit of the file is preserved.
        (Form::Planar, &[x, y, theta]) => Pose2 { x, y, theta },
        _ => form.pose(numbers)?.to_pose2(),
    };
    let all = [("x", pose.x, "m"), ("y", pose.y, "m"), ("theta", pose.theta, "rad")];
    match all.into_iter().find(|(_, value, _)| value.abs() > MAX_COORDINATE_M) {
        Some((name, value, unit)) => {
            Err(format!("{name} is {value} {unit}, expected at most {MAX_COORDINATE_M} {unit}"))
        }
        None => Ok(OdometryRow { pose: Pose2::new(pose.x, pose.y, pose.theta), heading: pose.theta }),
    }
}

/// The text of [`read_odometry`], exact.
pub fn odometry_text(poses: &[(Stamp, Pose2)]) -> String {
    let mut text = String::from("# timestamp x y theta\n");
    for (stamp, pose) in poses {
        writeln!(text, "{stamp} {} {} {}", pose.x, pose.y, pose.theta)
            .expect("invariant: a String takes any text");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_it_writes_and_names_lines() {
        let poses: Vec<_> =
            (0..9).map(|i| (Stamp::from_nanos(i), Pose2::new(0.1 * i as f64, -0.3, 1.0 / 3.0))).collect();
        let parse = |text: &str| {
            parse_odometry(Path::new("odometry.txt"), text, BrokenRows::Refused).map(|(poses, _)| poses)
        };
        assert_eq!(parse(&odometry_text(&poses)).unwrap(), poses);
        assert_eq!(parse("").unwrap(), []);
        assert_eq!(
            parse("1 0 0 0\n2 0 -1e7 0").unwrap_err().to_string(),
            "odometry.txt, line 2: y is -10000000 m, expected at most 1000000 m"
        );
        assert!(
            parse("1 0 0").unwrap_err().to_string().contains("3 fields, expected 4: timestamp x y theta")
        );
    }

    #[test]
    fn tum_poses_and_repeated_stamps_are_read() {
        let parse =
            |text: &str| parse_odometry(Path::new("odometry.txt"), text, BrokenRows::Refused).unwrap();
        let (poses, warnings) = parse("2.0 1 2 0 0 0 0.6 0.8\n3.0 1 2 0 0 0 0 1\n");
        assert!(warnings.is_empty());
        assert!((poses[0].1.theta - 2.0 * 0.6_f64.atan2(0.8)).abs() < 1e-12, "{poses:?}");
        let (poses, warnings) = parse("2 5 0 0\n1 4 0 0\n1 3 0 0\n");
        assert_eq!(poses.iter().map(|(_, pose)| pose.x).collect::<Vec<_>>(), [4.0, 5.0]);
        assert_eq!(warnings.iter().count(), 2);
    }

    #[test]
    fn decimal_commas_are_refused_whatever_number_of_fields_they_make() {
        let error = |text: &str| {
            parse_odometry(Path::new("odometry.txt"), text, BrokenRows::Refused).unwrap_err().to_string()
        };
        for text in ["1,5 0,1 -0,2 0,3", "1 0,1 0 0", "1\t-0,1\t0\t0"] {
            assert!(error(text).contains("has a decimal comma, expected a decimal point"), "{text}");
        }
        let rows = "1, 2, 3, 4\n2,2,3,4\n3 2 3 4\n";
        assert!(parse_odometry(Path::new("odometry.txt"), rows, BrokenRows::Refused).is_ok());
    }

    #[test]
    fn a_row_that_is_not_utf8_is_left_out() {
        let path = std::env::temp_dir().join(format!("trundle-odometry-{}.txt", std::process::id()));
        std::fs::write(&path, b"1 0 0 0\n2 0.\xff 0 0\n3 1 0 0\n").unwrap();
        let (poses, warnings) = read_optional_odometry(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!(poses.len(), 2);
        let warnings: Vec<String> = warnings.iter().map(ToString::to_string).collect();
        assert!(warnings.len() == 1 && warnings[0].contains("line 2"), "{warnings:?}");
    }

    #[test]
    fn a_pose_that_never_changes_is_warned_of() {
        let warnings = |rows: i64, x: f64| {
            let poses: Vec<_> = (0..rows)
                .map(|i| {
                    (Stamp::from_nanos(i * 1_000_000_000), Pose2::new(if i == 5 { x } else { 1.0 }, 0.0, 0.0))
                })
                .collect();
            let file = parse_odometry(Path::new("odometry.txt"), &odometry_text(&poses), BrokenRows::LeftOut);
            file.unwrap().1.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        let still = warnings(11, 1.0);
        assert!(
            still.len() == 1 && still[0].starts_with("the pose is the same in all 11 rows, for 10 s"),
            "{still:?}"
        );
        assert!(warnings(10, 1.0).is_empty() && warnings(11, 1.01).is_empty());
    }
}
