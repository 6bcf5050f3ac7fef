//! Reader and writer of odometry text files beside a TUM sequence.

use crate::IoError;
use crate::files::{content_lines, read_text, stamped_numbers};
use std::fmt::Write;
use std::path::Path;
use trundle_core::{Pose2, Stamp};

/// Farther off no robot gets, m, and rad.
const MAX_COORDINATE_M: f64 = 1e6;

/// Odometry beside a TUM sequence: lines of `timestamp x y theta` (s, m, m, rad), the pose `odom_from_base`, `#` for
/// comments. Stamps rise.
///
/// # Errors
/// With the line, when a field is missing, too many or not a finite number, when time stands still or goes back, or when a pose
/// is farther off than any robot gets.
pub fn read_odometry(path: &Path) -> Result<Vec<(Stamp, Pose2)>, IoError> {
    parse_odometry(path, &read_text(path)?)
}

fn parse_odometry(path: &Path, text: &str) -> Result<Vec<(Stamp, Pose2)>, IoError> {
    let mut poses: Vec<(Stamp, Pose2)> = Vec::new();
    for line in content_lines(text) {
        let (stamp, [x, y, theta]) = stamped_numbers(path, line, ["x", "y", "theta"])?;
        if let Some((before, _)) = poses.last().filter(|(before, _)| stamp <= *before) {
            let problem = format!("timestamp is {stamp} s, expected more than the {before} s before");
            return Err(IoError::line(path, line.0, problem));
        }
        let all = [("x", x, "m"), ("y", y, "m"), ("theta", theta, "rad")];
        if let Some((name, value, unit)) =
            all.into_iter().find(|(_, value, _)| value.abs() > MAX_COORDINATE_M)
        {
            let problem = format!("{name} is {value} {unit}, expected at most {MAX_COORDINATE_M} {unit}");
            return Err(IoError::line(path, line.0, problem));
        }
        poses.push((stamp, Pose2::new(x, y, theta)));
    }
    Ok(poses)
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
        let parse = |text: &str| parse_odometry(Path::new("odometry.txt"), text);
        assert_eq!(parse(&odometry_text(&poses)).unwrap(), poses);
        assert_eq!(parse("").unwrap(), []);
        assert_eq!(
            parse("1 0 0 0\n1 0 0 0").unwrap_err().to_string(),
            "odometry.txt, line 2: timestamp is 1.000000000 s, expected more than the 1.000000000 s before"
        );
        assert_eq!(
            parse("1 0 0 0\n2 0 -1e7 0").unwrap_err().to_string(),
            "odometry.txt, line 2: y is -10000000 m, expected at most 1000000 m"
        );
        assert!(
            parse("1 0 0").unwrap_err().to_string().contains("3 fields, expected 4: timestamp x y theta")
        );
    }
}
