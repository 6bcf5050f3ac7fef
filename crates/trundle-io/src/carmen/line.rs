//! Parser of one line of a CARMEN log.

use crate::{excerpt::excerpt, parse_stamp};
use std::f64::consts::{FRAC_PI_2, PI};
use std::str::SplitAsciiWhitespace;
use trundle_core::{Pose2, Stamp};

/// A line that says something to us.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    /// `ODOM`: odom_from_base.
    Odometry(Stamp, Pose2),
    /// `FLASER` or `ROBOTLASER1`.
    Laser(LaserLine),
    /// `PARAM robot_frontlaser_offset`, m.
    Offset(f64),
    /// Anything else.
    Other,
}

/// A laser's sweep as the log has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LaserLine {
    pub stamp: Stamp,
    pub ranges: Vec<f64>,
    pub angle_min: f64,
    pub angle_increment: f64,
    /// The laser's own limit, m, where the line has it.
    pub max_range: Option<f64>,
    pub odom_from_laser: Pose2,
    pub odom_from_base: Pose2,
}

/// Most beams of a line.
const MOST_BEAMS: usize = 100_000;

/// What a line says; a sentence on what is wrong with it.
pub(super) fn parse(line: &str) -> Result<Line, String> {
    let mut fields = Fields { rest: line.split_ascii_whitespace() };
    match fields.rest.next() {
        Some("ODOM") => {
            let pose = fields.pose()?;
            fields.skip(3);
            Ok(Line::Odometry(fields.stamp()?, pose))
        }
        Some("FLASER") => front_laser(fields).map(Line::Laser),
        Some("ROBOTLASER1") => robot_laser(fields).map(Line::Laser),
        Some("PARAM") => match fields.rest.next() {
            Some("robot_frontlaser_offset") => Ok(Line::Offset(fields.number("robot_frontlaser_offset")?)),
            _ => Ok(Line::Other),
        },
        _ => Ok(Line::Other),
    }
}

/// `FLASER n r1..rn laser_pose base_pose time host time`: 180 degrees, from the right.
fn front_laser(mut fields: Fields<'_>) -> Result<LaserLine, String> {
    let ranges = fields.ranges()?;
    let steps = ranges.len() - ranges.len() % 2;
    Ok(LaserLine {
        angle_min: -FRAC_PI_2,
        angle_increment: PI / steps.max(1) as f64,
        max_range: None,
        odom_from_laser: fields.pose()?,
        odom_from_base: fields.pose()?,
        stamp: fields.stamp()?,
        ranges,
    })
}

/// `ROBOTLASER1 type start fov step max accuracy mode n r1..rn m i1..im laser_pose base_pose tv rv forward side turn time host time`.
fn robot_laser(mut fields: Fields<'_>) -> Result<LaserLine, String> {
    fields.skip(1);
    let angle_min = fields.number("start angle")?;
    fields.skip(1);
    let angle_increment = fields.number("angle step")?;
    if angle_increment <= 0.0 {
        return Err(format!("angle step is {angle_increment} rad, expected more than 0"));
    }
    let max_range = fields.number("greatest range")?;
    fields.skip(2);
    let ranges = fields.ranges()?;
    let remissions = fields.count("number of remissions", 0)?;
    fields.skip(remissions);
    let (odom_from_laser, odom_from_base) = (fields.pose()?, fields.pose()?);
    fields.skip(5);
    Ok(LaserLine {
        stamp: fields.stamp()?,
        ranges,
        angle_min,
        angle_increment,
        max_range: (max_range > 0.0).then_some(max_range),
        odom_from_laser,
        odom_from_base,
    })
}

struct Fields<'a> {
    rest: SplitAsciiWhitespace<'a>,
}

impl Fields<'_> {
    fn skip(&mut self, count: usize) {
        self.rest.by_ref().take(count).for_each(drop);
    }

    fn number(&mut self, name: &str) -> Result<f64, String> {
        let text = self.rest.next().ok_or_else(|| format!("the line ends before its {name}"))?;
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("{name} is '{}', expected a finite number", excerpt(text)))
    }

    fn count(&mut self, name: &str, least: usize) -> Result<usize, String> {
        let text = self.rest.next().ok_or_else(|| format!("the line ends before its {name}"))?;
        let count = text.parse::<usize>().ok().filter(|count| (least..=MOST_BEAMS).contains(count));
        count.ok_or_else(|| format!("{name} is '{}', expected {least} to {MOST_BEAMS}", excerpt(text)))
    }

    /// Ranges, m: what is no number is NaN, a beam that says nothing.
    fn ranges(&mut self) -> Result<Vec<f64>, String> {
        let count = self.count("number of beams", 1)?;
        let ranges: Vec<f64> =
            self.rest.by_ref().take(count).map(|text| text.parse().unwrap_or(f64::NAN)).collect();
        if ranges.len() < count {
            return Err(format!("the line ends after {} of {count} ranges", ranges.len()));
        }
        Ok(ranges)
    }

    fn pose(&mut self) -> Result<Pose2, String> {
        Ok(Pose2::new(self.number("x")?, self.number("y")?, self.number("theta")?))
    }

    fn stamp(&mut self) -> Result<Stamp, String> {
        let text = self.rest.next().ok_or("the line ends before its timestamp")?;
        parse_stamp(text).map_err(|invalid| invalid.to_string())
    }
}
