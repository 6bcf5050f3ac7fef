//! Reader and writer of trajectories in the TUM format.

use crate::IoError;
use crate::files::{content_lines, read_text, stamped_numbers};
use nalgebra::Quaternion;
use std::fmt::Write;
use std::path::Path;
use trundle_core::{Pose2, Pose3, Stamp};

/// How far the norm of a quaternion may be from 1: files with two decimals or more pass, and are normalised.
const NORM_TOLERANCE: f64 = 0.02;

const FIELDS: [&str; 7] = ["tx", "ty", "tz", "qx", "qy", "qz", "qw"];

/// A trajectory in TUM's form: lines of `timestamp tx ty tz qx qy qz qw` (s, m, unit quaternion), `#` for comments.
///
/// Stamps are exact to the nanosecond and may repeat, as TUM's ground truth does, but not go back.
///
/// # Errors
/// With the line, when a field is missing, too many, not a finite number, when a quaternion is not of unit length
/// within 0.02, or when time goes back; and when there is no pose at all.
pub fn read_trajectory(path: &Path) -> Result<Vec<(Stamp, Pose3)>, IoError> {
    parse_trajectory(path, &read_text(path)?)
}

fn parse_trajectory(path: &Path, text: &str) -> Result<Vec<(Stamp, Pose3)>, IoError> {
    let mut poses: Vec<(Stamp, Pose3)> = Vec::new();
    for line in content_lines(text) {
        let (stamp, values) = stamped_numbers(path, line, FIELDS)?;
        if let Some((before, _)) = poses.last().filter(|(before, _)| stamp < *before) {
            let problem = format!("timestamp goes back from {before} s to {stamp} s");
            return Err(IoError::line(path, line.0, problem));
        }
        let norm = Quaternion::new(values[6], values[3], values[4], values[5]).norm();
        if (norm - 1.0).abs() > NORM_TOLERANCE {
            let problem = format!("length of the quaternion is {norm}, expected 1 within {NORM_TOLERANCE}");
            return Err(IoError::line(path, line.0, problem));
        }
        poses.push((stamp, Pose3::from(values)));
    }
    if poses.is_empty() {
        return Err(IoError::malformed(
            path,
            "no pose in it, expected lines of: timestamp tx ty tz qx qy qz qw",
        ));
    }
    Ok(poses)
}

/// The text of a trajectory in TUM's form: stamps with all nine digits, metres and quaternion to 1e-9, always the
/// same bytes for the same poses.
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

/// [`trajectory_text`] of poses in the plane: z is 0, the rotation about z.
pub fn trajectory_text_from_planar(poses: &[(Stamp, Pose2)]) -> String {
    let lifted: Vec<_> = poses.iter().map(|&(stamp, pose)| (stamp, Pose3::from_pose2(pose))).collect();
    trajectory_text(&lifted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    fn problem(text: &str) -> String {
        parse_trajectory(Path::new("a.txt"), text).unwrap_err().to_string()
    }

    #[test]
    fn errors_name_file_and_line() {
        let good = "# head\n1.5 0 0 0 0 0 0 1\n";
        assert_eq!(parse_trajectory(Path::new("a.txt"), good).unwrap().len(), 1);
        assert_eq!(
            problem(&format!("{good}2 0 0 0 0 0 1")),
            "a.txt, line 3: 7 fields, expected 8: timestamp tx ty tz qx qy qz qw"
        );
        assert_eq!(
            problem(&format!("{good}\n2 0 NaN 0 0 0 0 1")),
            "a.txt, line 4: ty is 'NaN', expected a finite number"
        );
        assert_eq!(
            problem(&format!("{good}1.4 0 0 0 0 0 0 1")),
            "a.txt, line 3: timestamp goes back from 1.500000000 s to 1.400000000 s"
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
        let poses = parse_trajectory(Path::new("a"), "1 0 0 0 -0.6606 -0.5119 -0.0688 0.5449").unwrap();
        assert!((poses[0].1.rotation.norm() - 1.0).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn what_is_written_is_read(tangents in prop::collection::vec(prop::array::uniform6(-3.0..3.0), 1..20)) {
            let poses: Vec<_> = tangents.into_iter().enumerate()
                .map(|(i, t)| (Stamp::from_nanos(i as i64 * 33_333_333), Pose3::exp(Vector6::from(t)))).collect();
            let text = trajectory_text(&poses);
            let back = parse_trajectory(Path::new("a"), &text).unwrap();
            for ((s, p), (t, q)) in poses.iter().zip(&back) {
                prop_assert_eq!(s, t);
                prop_assert!((p.inverse() * *q).log().norm() < 1e-8);
            }
        }

        #[test]
        fn any_text_is_no_panic(text in "[0-9 .eE#,\\-+naif\n]{0,200}") {
            let _ = parse_trajectory(Path::new("a"), &text);
        }
    }
}
