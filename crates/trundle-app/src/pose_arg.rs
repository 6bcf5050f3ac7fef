//! Poses as a person writes them.

use std::str::FromStr;
use trundle_core::{MAX_COORDINATE_M, Pose2};

/// A pose on the command line: `X,Y,DEG`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseArg(pub Pose2);

impl FromStr for PoseArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').collect();
        let [x, y, degrees] = parts[..] else {
            return Err(format!("{} numbers, expected 3: X,Y,DEG (m, m, deg)", parts.len()));
        };
        let x = coordinate("X", x, "m", MAX_COORDINATE_M)?;
        let y = coordinate("Y", y, "m", MAX_COORDINATE_M)?;
        let degrees = coordinate("DEG", degrees, "deg", 1e6)?;
        Ok(Self(Pose2::new(x, y, degrees.to_radians())))
    }
}

/// A number of a text, at most `limit` in size.
pub(crate) fn coordinate(name: &str, text: &str, unit: &str, limit: f64) -> Result<f64, String> {
    let value: f64 =
        text.trim().parse().map_err(|_| format!("{name} is '{text}', expected a number in {unit}"))?;
    if value.abs() <= limit {
        Ok(value)
    } else {
        Err(format!("{name} is {value} {unit}, expected a number between -{limit} and {limit}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_three_finite_numbers() {
        let pose: PoseArg = "1.5,-2,90".parse().unwrap();
        assert_eq!(pose.0, Pose2::new(1.5, -2.0, std::f64::consts::FRAC_PI_2));
        assert!("1,2".parse::<PoseArg>().unwrap_err().contains("expected 3"));
        assert!("NaN,2,3".parse::<PoseArg>().unwrap_err().contains("X is NaN m"));
        assert!("1,2,east".parse::<PoseArg>().unwrap_err().contains("DEG is 'east'"));
    }
}
