//! The first reading of a CARMEN log: its lasers, parameters and odometry, without the scans.

use super::laser_survey::LaserSurvey;
use super::line::{Line, laser_name, parse};
use super::parameters::Parameters;
use super::text::TextLines;
use crate::IoError;
use crate::laser_log::{LaserLogSkip, LaserLogSources, chosen, insert_in_order};
use std::collections::BTreeMap;
use trundle_core::{Pose2, Stamp};

/// The lines of the front laser, all of them one source.
const FRONT: [&str; 2] = ["FLASER", "ROBOTLASER1"];

/// What all lines of a log show together.
#[derive(Debug, Default)]
pub(super) struct LogSurvey {
    pub(super) odometry: Vec<(Stamp, Pose2)>,
    pub(super) parameters: Parameters,
    /// Number of usable lines by their name.
    counts: BTreeMap<String, usize>,
    /// Surveys by [`source_of`] the lines.
    lasers: BTreeMap<&'static str, LaserSurvey>,
    /// Broken lines, each with its name where it is a laser's.
    broken: Vec<(Option<&'static str>, LaserLogSkip)>,
}

impl LogSurvey {
    /// Reads all lines. If a compressed file is truncated after a scan, the rest counts as a broken line.
    pub(super) fn read(mut text: TextLines) -> Result<Self, IoError> {
        let mut survey = Self::default();
        let mut last = 0;
        loop {
            match text.next_content() {
                Ok(Some((number, line))) => {
                    last = number;
                    survey.take(number, line);
                }
                Ok(None) => break,
                Err(IoError::Malformed { problem, .. }) if !survey.lasers.is_empty() => {
                    survey.broken.push((None, LaserLogSkip { line: last + 1, problem }));
                    break;
                }
                Err(error) => return Err(error),
            }
        }
        survey.lasers.values_mut().for_each(LaserSurvey::finish);
        Ok(survey)
    }

    fn take(&mut self, number: usize, line: &str) {
        let name = laser_name(line);
        let taken = parse(line).and_then(|line| match (line, name) {
            (Line::Odometry(stamp, pose), _) => {
                insert_in_order(&mut self.odometry, (stamp, pose), |(stamp, _)| *stamp)
            }
            (Line::Laser(laser), Some(name)) => {
                *self.counts.entry(name.to_owned()).or_default() += 1;
                self.lasers.entry(source_of(name)).or_default().take(number, &laser);
                Ok(())
            }
            (line, _) => {
                self.parameters.take(&line);
                Ok(())
            }
        });
        if let Err(problem) = taken {
            self.broken.push((name, LaserLogSkip { line: number, problem }));
        }
    }

    /// The name of the lines that make the log: the requested one, else the front laser's, else the most frequent one.
    pub(super) fn chosen(&self, asked: Option<&str>) -> Result<String, String> {
        const KIND: &str = "scan";
        if self.counts.is_empty() {
            let first = self.broken.first().map(|(name, skip)| (name.unwrap_or(FRONT[0]).to_owned(), skip));
            return first.map(|(name, _)| name).ok_or_else(|| {
                format!("no {KIND} in it, expected lines of FLASER, ROBOTLASER1 or RAWLASER1")
            });
        }
        let front = FRONT.into_iter().find(|name| self.counts.contains_key(*name));
        match front {
            Some(front) if asked.is_none() => Ok(front.to_owned()),
            _ => chosen(&self.counts, asked, KIND),
        }
    }

    /// Takes out the survey of the lines of this name; for the front laser's name that of both its names.
    pub(super) fn take_laser(&mut self, name: &str) -> LaserSurvey {
        self.lasers.remove(source_of(name)).unwrap_or_default()
    }

    /// Problems of the lines of this name, of the odometry and of parameters.
    pub(super) fn problems(&self, name: &str) -> Vec<LaserLogSkip> {
        let is_wanted = |other: &str| source_of(other) == source_of(name);
        let about = self.broken.iter().filter(|(name, _)| name.is_none_or(is_wanted));
        about.map(|(_, skip)| skip.clone()).collect()
    }

    /// The names taken and left.
    pub(super) fn sources(&self, name: &str, has_poses: bool) -> LaserLogSources {
        let left = self.counts.iter().filter(|(other, _)| source_of(other) != source_of(name));
        let left = left.map(|(other, count)| (other.clone(), *count)).collect();
        let odometry = if has_poses { name.to_owned() } else { "ODOM".to_owned() };
        LaserLogSources { scans: name.to_owned(), odometry, left }
    }
}

/// The name of all lines that are one source with those of this name.
pub(super) fn source_of(name: &str) -> &str {
    if FRONT.contains(&name) { FRONT[0] } else { name }
}
