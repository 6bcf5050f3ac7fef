//! Boxes as a person writes them.

use crate::pose_arg::coordinate;
use std::str::FromStr;
use trundle_core::{MAX_COORDINATE_M, Vector2};

/// A box of the map frame on the command line: `X0,Y0,X1,Y1`, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxArg {
    /// Corner of the lowest x and y \[m\].
    pub low: Vector2,
    /// Corner of the highest x and y \[m\].
    pub high: Vector2,
}

impl FromStr for BoxArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').collect();
        let [x0, y0, x1, y1] = parts[..] else {
            return Err(format!("{} numbers, expected 4: X0,Y0,X1,Y1 (m)", parts.len()));
        };
        let number = |name: &str, text: &str| coordinate(name, text, "m", MAX_COORDINATE_M);
        let (low, high) = ([number("X0", x0)?, number("Y0", y0)?], [number("X1", x1)?, number("Y1", y1)?]);
        for (axis, low, high) in [("X", low[0], high[0]), ("Y", low[1], high[1])] {
            if low >= high {
                return Err(format!(
                    "{axis}0 is {low} m and {axis}1 is {high} m, expected {axis}0 < {axis}1"
                ));
            }
        }
        Ok(Self { low: low.into(), high: high.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_four_numbers_in_order() {
        let found: BoxArg = "-1,2,3.5,4".parse().unwrap();
        assert_eq!((found.low, found.high), (Vector2::new(-1.0, 2.0), Vector2::new(3.5, 4.0)));
        let refused = |text: &str| text.parse::<BoxArg>().unwrap_err();
        assert_eq!(refused("1,2,3"), "3 numbers, expected 4: X0,Y0,X1,Y1 (m)");
        assert_eq!(refused("1,2,1,4"), "X0 is 1 m and X1 is 1 m, expected X0 < X1");
        assert!(refused("1,2,3,high").contains("Y1 is 'high', expected a number in m"));
    }
}
