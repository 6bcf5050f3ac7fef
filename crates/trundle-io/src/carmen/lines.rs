//! The lines of a CARMEN log by their content, and the choice of the laser.

use super::line::{LaserLine, Line, laser_name, parse};
use super::text::TextLines;
use crate::IoError;
use crate::laser_log::{LaserLogSkip, LaserLogSources, chosen, insert_in_order};
use std::collections::BTreeMap;
use trundle_core::{Pose2, Stamp};

/// The lines of the front laser, all of them one source.
const FRONT: [&str; 2] = ["FLASER", "ROBOTLASER1"];

/// All lines of a log that are read.
#[derive(Debug, Default)]
pub(super) struct LogLines {
    pub odometry: Vec<(Stamp, Pose2)>,
    /// Distance of the front laser ahead of the base, m.
    pub offset: f64,
    /// The front laser's field of view, rad, for lines without one.
    pub field_of_view: Option<f64>,
    /// The angle between its beams, rad, likewise.
    pub resolution: Option<f64>,
    lasers: Vec<(usize, &'static str, LaserLine)>,
    /// Broken lines, each with its name where it is a laser's.
    broken: Vec<(Option<&'static str>, LaserLogSkip)>,
}

impl LogLines {
    /// Reads all lines. If a compressed file is truncated after a scan, the rest counts as a broken line.
    pub(super) fn read(mut text: TextLines) -> Result<Self, IoError> {
        let mut lines = Self::default();
        let mut last = 0;
        loop {
            match text.next_content() {
                Ok(Some((number, line))) => {
                    last = number;
                    lines.take(number, line);
                }
                Ok(None) => return Ok(lines),
                Err(IoError::Malformed { problem, .. }) if !lines.lasers.is_empty() => {
                    lines.broken.push((None, LaserLogSkip { line: last + 1, problem }));
                    return Ok(lines);
                }
                Err(error) => return Err(error),
            }
        }
    }

    fn take(&mut self, number: usize, line: &str) {
        let name = laser_name(line);
        let taken = parse(line).and_then(|line| match (line, name) {
            (Line::Odometry(stamp, pose), _) => self.take_odometry(stamp, pose),
            (Line::Laser(laser), Some(name)) => {
                self.lasers.push((number, name, laser));
                Ok(())
            }
            (line, _) => {
                self.take_parameter(&line);
                Ok(())
            }
        });
        if let Err(problem) = taken {
            self.broken.push((name, LaserLogSkip { line: number, problem }));
        }
    }

    fn take_odometry(&mut self, stamp: Stamp, pose: Pose2) -> Result<(), String> {
        insert_in_order(&mut self.odometry, (stamp, pose), |(stamp, _)| *stamp)
    }

    fn take_parameter(&mut self, line: &Line) {
        match line {
            Line::Offset(metres) => self.offset = *metres,
            Line::FieldOfView(angle) => self.field_of_view = Some(*angle),
            Line::Resolution(angle) => self.resolution = Some(*angle),
            _ => {}
        }
    }

    /// The name of the lines that make the log: the requested one, else the front laser's, else the most frequent one.
    pub(super) fn chosen(&self, asked: Option<&str>) -> Result<String, String> {
        const KIND: &str = "scan";
        let mut counts = BTreeMap::new();
        for (_, name, _) in &self.lasers {
            *counts.entry((*name).to_owned()).or_insert(0) += 1;
        }
        if counts.is_empty() {
            let first = self.broken.first().map(|(name, skip)| (name.unwrap_or(FRONT[0]).to_owned(), skip));
            return first.map(|(name, _)| name).ok_or_else(|| {
                format!("no {KIND} in it, expected lines of FLASER, ROBOTLASER1 or RAWLASER1")
            });
        }
        let front = FRONT.into_iter().find(|name| counts.contains_key(*name));
        match front {
            Some(front) if asked.is_none() => Ok(front.to_owned()),
            _ => chosen(&counts, asked, KIND),
        }
    }

    /// The lines of this name; for the front laser's name those of both its names.
    pub(super) fn of<'a>(&'a self, name: &str) -> impl Iterator<Item = (usize, &'a LaserLine)> {
        let is_wanted = is_one_source(name.to_owned());
        self.lasers.iter().filter(move |(_, name, _)| is_wanted(name)).map(|(line, _, laser)| (*line, laser))
    }

    /// Problems of the lines of this name, of the odometry and of parameters.
    pub(super) fn problems(&self, name: &str) -> Vec<LaserLogSkip> {
        let is_wanted = is_one_source(name.to_owned());
        let about = self.broken.iter().filter(|(name, _)| name.is_none_or(&is_wanted));
        about.map(|(_, skip)| skip.clone()).collect()
    }

    /// The names taken and left.
    pub(super) fn sources(&self, name: &str) -> LaserLogSources {
        let is_wanted = is_one_source(name.to_owned());
        let mut left = BTreeMap::new();
        for (_, other, _) in self.lasers.iter().filter(|(_, other, _)| !is_wanted(other)) {
            *left.entry((*other).to_owned()).or_insert(0) += 1;
        }
        let has_poses = self.of(name).any(|(_, laser)| laser.poses.is_some());
        let odometry = if has_poses { name.to_owned() } else { "ODOM".to_owned() };
        LaserLogSources { scans: name.to_owned(), odometry, left: left.into_iter().collect() }
    }
}

fn is_one_source(name: String) -> impl Fn(&'static str) -> bool {
    move |other| other == name || (FRONT.contains(&name.as_str()) && FRONT.contains(&other))
}
