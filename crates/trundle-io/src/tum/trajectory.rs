//! Reader and writer of trajectories.

use super::kitti;
use super::rows::{BrokenRows, Table, sort};
use super::trajectory_form::Form;
use crate::files::{read_text, read_text_lossy};
use crate::{Expected, IoError, Warnings};
use std::fmt::Write;
use std::path::Path;
use trundle_core::{Pose2, Pose3, Stamp};

/// The problem of a file without poses.
const NO_POSE: &str = "no pose in it, expected lines of: timestamp tx ty tz qx qy qz qw";

/// A trajectory of a file, by rising stamps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrajectoryFile {
    /// Stamps and poses.
    pub poses: Vec<(Stamp, Pose3)>,
    /// Whether the file has no times: then the stamps are the numbers of its rows, in seconds.
    pub is_indexed: bool,
    /// Corrections and omissions.
    pub warnings: Warnings,
}

/// The poses of [`read_trajectory_file`].
///
/// # Errors
/// As [`read_trajectory_file`].
pub fn read_trajectory(path: &Path) -> Result<Vec<(Stamp, Pose3)>, IoError> {
    Ok(read_trajectory_file(path)?.poses)
}

/// A trajectory in one of these formats, recognised by its columns; `#` for comments, a header line of words is skipped.
///
/// TUM: `timestamp tx ty tz qx qy qz qw` (s, m, unit quaternion). EuRoC: `timestamp px py pz qw qx qy qz ...`. Planar: `timestamp x y
/// theta`. KITTI: the twelve numbers of a matrix, with times in `times.txt` in the same folder. Stamps are exact to the nanosecond and may
/// repeat, as TUM's ground truth does. Rows out of order are sorted, and stamps in ms, us or ns recognised by their magnitude, each with a
/// warning.
///
/// # Errors
/// With the line, when a field is missing, superfluous or not a finite number, or a quaternion's length differs from 1 by more than 0.02;
/// and when the file has no pose.
pub fn read_trajectory_file(path: &Path) -> Result<TrajectoryFile, IoError> {
    Expected::Trajectory.check(path)?;
    parse_trajectory(path, &read_text(path)?, BrokenRows::Refused)
}

/// Reads a trajectory that a run can do without: rows that cannot be read are left out with a warning.
pub(super) fn read_optional_trajectory(path: &Path) -> TrajectoryFile {
    let text = Expected::Trajectory.check(path).and_then(|_| read_text_lossy(path));
    let read = text.and_then(|text| parse_trajectory(path, &text, BrokenRows::LeftOut));
    read.unwrap_or_else(|error| {
        let mut file = TrajectoryFile::default();
        file.warnings.add(&format!("not used, {}", error.problem()), &error.path().display().to_string());
        file
    })
}

fn parse_trajectory(path: &Path, text: &str, broken_rows: BrokenRows) -> Result<TrajectoryFile, IoError> {
    let mut file = TrajectoryFile::default();
    let form = Form::of(text);
    if form == Form::Kitti {
        let poses = kitti::read_poses(path, text, broken_rows, &mut file.warnings)?;
        let times = kitti::times(path, poses.len())?;
        file.warnings.extend(times.warnings);
        file.is_indexed = times.is_indexed;
        file.poses = times.stamps.into_iter().zip(poses).collect();
        sort(&mut file.poses, path, &mut file.warnings);
    } else {
        let (names, unit) = (form.names(), form.stamp_unit());
        let table = Table { path, text, names, is_open: form == Form::Euroc, unit, broken_rows };
        file.poses = table.read(|numbers| form.pose(numbers), &mut file.warnings)?;
    }
    if file.poses.is_empty() && broken_rows == BrokenRows::Refused {
        return Err(IoError::malformed(path, NO_POSE));
    }
    if file.poses.is_empty() && file.warnings.is_empty() {
        file.warnings.add(&format!("not used, {NO_POSE}"), &path.display().to_string());
    }
    Ok(file)
}

/// The text of a trajectory in TUM's format: stamps with nine decimals, metres and quaternion to 1e-9. Equal poses give equal bytes.
pub fn trajectory_text(poses: &[(Stamp, Pose3)]) -> String {
    let mut text = String::from("# timestamp tx ty tz qx qy qz qw\n");
    for (stamp, pose) in poses {
        let (t, q) = (pose.translation, pose.rotation);
        writeln!(
            text,
            "{stamp} {:.9} {:.9} {:.9} {:.9} {:.9} {:.9} {:.9}",
            t.x, t.y, t.z, q.i, q.j, q.k, q.w
        )
        .expect("invariant: a String takes any text");
    }
    text
}

/// [`trajectory_text`] of poses in the plane: z is 0, the rotation around z.
pub fn trajectory_text_from_planar(poses: &[(Stamp, Pose2)]) -> String {
    let lifted: Vec<_> = poses.iter().map(|&(stamp, pose)| (stamp, Pose3::from_pose2(pose))).collect();
    trajectory_text(&lifted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    fn parse(text: &str) -> Result<TrajectoryFile, IoError> {
        parse_trajectory(Path::new("a.txt"), text, BrokenRows::Refused)
    }

    fn problem(text: &str) -> String {
        parse(text).unwrap_err().to_string()
    }

    fn lines(warnings: &Warnings) -> String {
        warnings.iter().map(|warning| format!("{warning}\n")).collect()
    }

    #[test]
    fn errors_name_file_and_line() {
        let good = "# head\n1.5 0 0 0 0 0 0 1\n";
        assert_eq!(parse(good).unwrap().poses.len(), 1);
        assert_eq!(
            problem(&format!("{good}2 0 0 0 0 0 1")),
            "a.txt, line 3: 7 fields, expected 8: timestamp tx ty tz qx qy qz qw"
        );
        assert_eq!(
            problem(&format!("{good}\n2 0 NaN 0 0 0 0 1")),
            "a.txt, line 4: ty is 'NaN', expected a finite number"
        );
        assert_eq!(
            problem("1 0 0 0 0 0 0 1.1"),
            "a.txt, line 1: length of the quaternion is 1.1, expected 1 within 0.02"
        );
        assert!(problem("x 0 0 0 0 0 0 1").contains("line 1: timestamp is 'x', expected a decimal number"));
        assert!(problem("# nothing\n").starts_with("a.txt: no pose"));
    }

    #[test]
    fn a_nearly_unit_quaternion_is_normalised() {
        let poses = parse("1 0 0 0 -0.6606 -0.5119 -0.0688 0.5449").unwrap().poses;
        assert!((poses[0].1.rotation.norm() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn one_drive_is_the_same_in_every_form() {
        let tum = parse("1.5 1 2 0 0 0 0.6 0.8\n1.7 3 4 0 0 0 0 1\n").unwrap();
        assert!(tum.warnings.is_empty());
        let theta = 2.0 * 0.6_f64.atan2(0.8);
        for text in [
            "timestamp,tx,ty,tz,qx,qy,qz,qw\n1.5,1,2,0,0,0,0.6,0.8\n1.7,3,4,0,0,0,0,1\n",
            "#timestamp, p_x [m], p_y [m], p_z [m], q_w [], q_x [], q_y [], q_z [], v_x, v_y, v_z\n\
             1500000000,1,2,0,0.8,0,0,0.6,0,0,0\n1700000000,3,4,0,1,0,0,0,0,0,0\n",
            "# timestamp x y z qw qx qy qz\n1.5 1 2 0 0.8 0 0 0.6\n1.7 3 4 0 1 0 0 0\n",
            &format!("1.5 1 2 {theta}\n1.7 3 4 0\n"),
            "1700 3 4 0 0 0 0 1\n1500 1 2 0 0 0 0.6 0.8\n",
        ] {
            let read = parse(text).unwrap().poses;
            for ((at, pose), (expected_at, expected)) in read.iter().zip(&tum.poses) {
                let ratio = at.as_secs() / expected_at.as_secs();
                assert!((ratio - 1.0).abs() < 1e-9 || (ratio - 1000.0).abs() < 1e-6, "{text}");
                assert!((expected.inverse() * *pose).log().norm() < 1e-8, "{text}");
            }
        }
    }

    #[test]
    fn rows_out_of_order_are_sorted_and_units_are_named() {
        let read = parse("1700000000200 2 0 0 0 0 0 1\n1700000000100 1 0 0 0 0 0 1\n").unwrap();
        assert_eq!(read.poses.iter().map(|(_, pose)| pose.translation.x).collect::<Vec<_>>(), [1.0, 2.0]);
        assert_eq!(read.poses[1].0.to_string(), "1700000000.200000000");
        let message = lines(&read.warnings);
        assert!(message.contains("are taken as milliseconds, expected seconds: a.txt"), "{message}");
        assert!(
            message.contains(
                "rows with an earlier timestamp than the row before: 1 of 2; the rows are sorted: a.txt"
            ),
            "{message}"
        );
    }

    #[test]
    fn nanoseconds_are_the_unit_of_euroc_and_no_warning() {
        let euroc = "#timestamp, p_x, p_y, p_z, q_w, q_x, q_y, q_z, v_x, v_y, v_z\n\
                     1403636580838555648,1,2,0,1,0,0,0,0,0,0\n1403636580843555648,1,2,0,1,0,0,0,0,0,0\n";
        let read = parse(euroc).unwrap();
        assert!(read.warnings.is_empty(), "{}", lines(&read.warnings));
        assert_eq!(read.poses[1].0.to_string(), "1403636580.843555648");
        let tum = parse("1403636580838555648 1 2 0 0 0 0 1\n").unwrap();
        assert!(lines(&tum.warnings).contains("are taken as nanoseconds, expected seconds"));
    }

    #[test]
    fn broken_rows_of_a_file_that_is_not_needed_are_counted() {
        let text = "1 0 0 0 0 0 0 1\n2 0 0 0\n3 0 0 x 0 0 0 1\n4 0 0 y 0 0 0 1\n";
        let read = parse_trajectory(Path::new("a.txt"), text, BrokenRows::LeftOut).unwrap();
        assert_eq!((read.poses.len(), read.warnings.count()), (1, 3));
        assert!(
            lines(&read.warnings).contains("row left out, 4 fields, expected 8"),
            "{}",
            lines(&read.warnings)
        );
    }

    #[test]
    fn a_file_of_names_alone_that_is_not_needed_is_warned_of() {
        let text = "# timestamp tx ty tz qx qy qz qw\n";
        let read = parse_trajectory(Path::new("a.txt"), text, BrokenRows::LeftOut).unwrap();
        assert!(lines(&read.warnings).starts_with("not used, no pose in it"), "{}", lines(&read.warnings));
    }

    #[test]
    fn kitti_rows_have_the_times_beside_them_or_their_numbers() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("00.txt");
        std::fs::write(&path, "1 0 0 5 0 1 0 0 0 0 1 0\n0 -1 0 6 1 0 0 0 0 0 1 0\n").unwrap();
        let read = read_trajectory_file(&path).unwrap();
        assert_eq!(read.poses.iter().map(|(_, pose)| pose.translation.x).collect::<Vec<_>>(), [5.0, 6.0]);
        assert!((read.poses[1].1.rotation.angle() - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        assert!(
            read.is_indexed && lines(&read.warnings).contains("number of a row"),
            "{}",
            lines(&read.warnings)
        );
        std::fs::write(dir.path().join("times.txt"), "0.0\n").unwrap();
        let short = read_trajectory_file(&path).unwrap();
        let message = lines(&short.warnings);
        assert!(
            short.is_indexed && message.lines().count() == 1 && message.contains("1 times for 2 poses"),
            "{message}"
        );
        std::fs::write(dir.path().join("times.txt"), "0.0\n0.25\n").unwrap();
        let read = read_trajectory_file(&path).unwrap();
        assert!(!read.is_indexed && read.warnings.is_empty());
        assert_eq!(read.poses[1].0.as_secs(), 0.25);
        assert!(problem("2 0 0 5 0 1 0 0 0 0 1 0\n").contains("not a rotation matrix"));
    }

    proptest! {
        #[test]
        fn a_written_text_is_read(tangents in prop::collection::vec(prop::array::uniform6(-3.0..3.0), 1..20)) {
            let poses: Vec<_> = tangents.into_iter().enumerate()
                .map(|(i, t)| (Stamp::from_nanos(i as i64 * 33_333_333), Pose3::exp(Vector6::from(t)))).collect();
            let text = trajectory_text(&poses);
            let back = parse(&text).unwrap().poses;
            for ((s, p), (t, q)) in poses.iter().zip(&back) {
                prop_assert_eq!(s, t);
                prop_assert!((p.inverse() * *q).log().norm() < 1e-8);
            }
        }

        #[test]
        fn any_text_does_not_panic(text in "[0-9 .eE#,\\-+naif\n]{0,200}") {
            let _ = parse(&text);
            let _ = parse_trajectory(Path::new("a"), &text, BrokenRows::LeftOut);
        }
    }
}
