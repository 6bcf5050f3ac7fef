//! Parser of one line of a CARMEN log.

use crate::laser_log::{MAX_BEAMS, check_sweep};
use crate::{excerpt::excerpt, parse_stamp};
use std::f64::consts::TAU;
use std::str::SplitAsciiWhitespace;
use trundle_core::{Pose2, Stamp};

/// A line of a kind that is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    /// `ODOM`: odom_from_base.
    Odometry(Stamp, Pose2),
    /// A sweep of a laser.
    Laser(LaserLine),
    /// `PARAM robot_frontlaser_offset`, m.
    Offset(f64),
    /// `PARAM laser_front_laser_fov`, rad.
    FieldOfView(f64),
    /// `PARAM laser_front_laser_resolution`, rad.
    Resolution(f64),
    /// Anything else.
    Other,
}

/// A laser's sweep as given in the log.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LaserLine {
    pub stamp: Stamp,
    pub ranges: Vec<f64>,
    /// The angle of the first beam and the step between beams, rad; `None` if absent from the line.
    pub angles: Option<[f64; 2]>,
    /// Maximum range of the laser, m; `None` if absent from the line.
    pub max_range: Option<f64>,
    /// `odom_from_laser` and `odom_from_base`; `None` if absent from the line.
    pub poses: Option<[Pose2; 2]>,
}

/// The names of lines with a sweep: front laser, rear laser and others.
const LASERS: [&str; 8] =
    ["FLASER", "RLASER", "ROBOTLASER1", "ROBOTLASER2", "RAWLASER1", "RAWLASER2", "RAWLASER3", "RAWLASER4"];

/// Largest resolution that is read as radians \[rad\]: 2.9 deg. A larger one is read as degrees, as CARMEN writes it. Source: ours.
const MAX_RESOLUTION_RAD: f64 = 0.05;

/// The name of the line if the line contains a sweep.
pub(super) fn laser_name(line: &str) -> Option<&'static str> {
    let name = line.split_ascii_whitespace().next()?;
    LASERS.into_iter().find(|laser| *laser == name)
}

/// Content of a line, or a sentence about its fault.
pub(super) fn parse(line: &str) -> Result<Line, String> {
    let mut fields = Fields { rest: line.split_ascii_whitespace() };
    match fields.rest.next() {
        Some("ODOM") => {
            let pose = fields.pose()?;
            fields.skip(3);
            Ok(Line::Odometry(fields.stamp()?, pose))
        }
        Some("FLASER" | "RLASER") => plain_laser(fields).map(Line::Laser),
        Some("ROBOTLASER1" | "ROBOTLASER2") => robot_laser(fields).map(Line::Laser),
        Some("PARAM") => parameter(fields),
        Some(name) if LASERS.contains(&name) => raw_laser(fields).map(Line::Laser),
        _ => Ok(Line::Other),
    }
}

/// `PARAM name value time host time`; newer logs name the front laser `laser1`.
fn parameter(mut fields: Fields<'_>) -> Result<Line, String> {
    let name = fields.rest.next();
    match name {
        Some(name @ "robot_frontlaser_offset") => Ok(Line::Offset(fields.number(name)?)),
        Some(name @ ("laser_front_laser_fov" | "laser_laser1_fov")) => {
            Ok(Line::FieldOfView(fields.angle(name, TAU + 0.01)?))
        }
        Some(name @ ("laser_front_laser_resolution" | "laser_laser1_resolution")) => {
            Ok(Line::Resolution(fields.angle(name, MAX_RESOLUTION_RAD)?))
        }
        _ => Ok(Line::Other),
    }
}

/// `FLASER n r1..rn laser_pose base_pose time host time`: from right to left.
fn plain_laser(mut fields: Fields<'_>) -> Result<LaserLine, String> {
    let ranges = fields.ranges()?;
    let poses = Some([fields.pose()?, fields.pose()?]);
    Ok(LaserLine { stamp: fields.stamp()?, ranges, angles: None, max_range: None, poses })
}

/// `ROBOTLASER1 type start fov step max accuracy mode n r1..rn m i1..im laser_pose base_pose tv rv forward side turn time host time`.
fn robot_laser(mut fields: Fields<'_>) -> Result<LaserLine, String> {
    let mut line = fields.sweep()?;
    line.poses = Some([fields.pose()?, fields.pose()?]);
    fields.skip(5);
    line.stamp = fields.stamp()?;
    Ok(line)
}

/// `RAWLASER1 type start fov step max accuracy mode n r1..rn m i1..im time host time`.
fn raw_laser(mut fields: Fields<'_>) -> Result<LaserLine, String> {
    let mut line = fields.sweep()?;
    line.stamp = fields.stamp()?;
    Ok(line)
}

struct Fields<'a> {
    rest: SplitAsciiWhitespace<'a>,
}

impl Fields<'_> {
    fn skip(&mut self, count: usize) {
        self.rest.by_ref().take(count).for_each(drop);
    }

    /// `type start fov step max accuracy mode n r1..rn m i1..im`.
    fn sweep(&mut self) -> Result<LaserLine, String> {
        self.skip(1);
        let first = self.number("start angle")?;
        self.skip(1);
        let step = self.number("angle step")?;
        let max_range = self.number("greatest range")?;
        self.skip(2);
        let ranges = self.ranges()?;
        check_sweep(["start angle", "angle step"], first, step, ranges.len())?;
        let remissions = self.count("number of remissions", 0)?;
        self.skip(remissions);
        let max_range = (max_range > 0.0).then_some(max_range);
        Ok(LaserLine { stamp: Stamp::default(), ranges, angles: Some([first, step]), max_range, poses: None })
    }

    /// A positive angle, rad; a value beyond `limit_rad` is one in degrees.
    fn angle(&mut self, name: &str, limit_rad: f64) -> Result<f64, String> {
        let value = self.number(name)?;
        if value <= 0.0 || value > 360.0 {
            return Err(format!("{name} is {value}, expected above 0 and at most 360 deg"));
        }
        Ok(if value > limit_rad { value.to_radians() } else { value })
    }

    fn number(&mut self, name: &str) -> Result<f64, String> {
        let text = self.rest.next().ok_or_else(|| format!("the line ends before its {name}"))?;
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("{name} is '{}', expected a finite number", excerpt(text)))
    }

    fn count(&mut self, name: &str, min: usize) -> Result<usize, String> {
        let text = self.rest.next().ok_or_else(|| format!("the line ends before its {name}"))?;
        let count = text.parse::<usize>().ok().filter(|count| (min..=MAX_BEAMS).contains(count));
        count.ok_or_else(|| format!("{name} is '{}', expected {min} to {MAX_BEAMS}", excerpt(text)))
    }

    /// Ranges, m. A text that is not a number is NaN: an unseen beam.
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
