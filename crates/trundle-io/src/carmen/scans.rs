//! The second reading of a CARMEN log: one scan at a time.

use super::line::{LaserLine, Line, laser_name, parse};
use super::mount::{mount, scan_of};
use super::parameters::Parameters;
use super::ranges::{is_range, no_return_from};
use super::survey::{LogSurvey, source_of};
use super::text::TextLines;
use crate::IoError;
use crate::laser_log::{
    LaserLog, LaserLogOptions, LaserLogScan, LaserLogSkip, LaserMount, Motion, OrderBuffer,
};
use std::path::Path;
use trundle_core::{Pose2, Stamp};

/// The scans of a CARMEN log, read one at a time. The file is read twice; the memory does not grow with the number of scans.
#[derive(Debug)]
pub(crate) struct CarmenScans {
    text: TextLines,
    is_at_end: bool,
    waiting: OrderBuffer<(usize, LaserLine)>,
    /// The scan that proved the log usable.
    first: Option<LaserLogScan>,
    laser: Laser,
    /// Number of lines that are not read yet.
    left: usize,
}

/// How lines become scans.
#[derive(Debug)]
struct Laser {
    /// The lines' source.
    source: String,
    mount: Pose2,
    is_upside_down: bool,
    parameters: Parameters,
    /// Range from which on a beam has no return, m; `None` for that of the line.
    no_return_from: Option<f64>,
    /// The odometry of lines without poses.
    motion: Motion,
}

impl CarmenScans {
    /// Opens a log. Returns the data of the log that need no scans, and the reader of its scans.
    ///
    /// # Errors
    /// As [`crate::read_carmen`].
    pub(crate) fn open(path: &Path, options: &LaserLogOptions) -> Result<(LaserLog, Self), IoError> {
        options.validate().map_err(IoError::field(path))?;
        Self::new(path, || TextLines::open(path), options)
    }

    /// Reads a log whose text `text` opens.
    pub(super) fn new(
        path: &Path,
        text: impl Fn() -> Result<TextLines, IoError>,
        options: &LaserLogOptions,
    ) -> Result<(LaserLog, Self), IoError> {
        let mut survey = LogSurvey::read(text()?)?;
        let name = survey
            .chosen(options.scan_topic.as_deref())
            .map_err(|problem| IoError::malformed(path, problem))?;
        let lines = survey.take_laser(&name);
        let mut log = LaserLog { sources: survey.sources(&name, lines.has_poses), ..LaserLog::default() };
        let mount = mount(&name, lines.mount(), &survey.parameters, options);
        log.mount = LaserMount { turn: mount.theta, upside_down: options.upside_down };
        log.max_range = options.max_range.or(lines.limit());
        let laser = Laser {
            source: source_of(&name).to_owned(),
            mount,
            is_upside_down: options.upside_down,
            parameters: survey.parameters,
            no_return_from: options.max_range.or(lines.limit().map(no_return_from)),
            motion: if lines.has_poses { Motion::default() } else { motion(&survey.odometry) },
        };
        let (times, left) = (lines.times(), lines.count);
        log.skipped = survey.problems(&name);
        log.skipped.extend(lines.into_late());
        log.odometry = survey.odometry;
        let waiting = OrderBuffer::default();
        let mut scans = Self { text: text()?, is_at_end: false, waiting, first: None, laser, left };
        scans.first = scans.next_scan(&mut log)?;
        match &scans.first {
            Some(_) => Ok((log, scans)),
            None => Err(no_scan(path, &log, times)),
        }
    }

    /// The next scan; `None` after the last one. Counts the scan, or what is skipped, in `log`, which [`CarmenScans::open`] returned.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(crate) fn next_scan(&mut self, log: &mut LaserLog) -> Result<Option<LaserLogScan>, IoError> {
        if let Some(first) = self.first.take() {
            return Ok(Some(first));
        }
        while let Some((number, line)) = self.next_line()? {
            note_bad_ranges(log, number, &line);
            match self.laser.scan(&line) {
                Ok(scan) => {
                    log.statistics.count(&scan);
                    return Ok(Some(scan));
                }
                Err(problem) => log.skipped.push(LaserLogSkip { line: number, problem }),
            }
        }
        log.skipped.sort_by_key(|skip| skip.line);
        Ok(None)
    }

    /// Number of lines of the laser that are not read yet.
    pub(crate) fn left(&self) -> usize {
        self.left
    }

    /// The laser's next line, by rising stamps.
    fn next_line(&mut self) -> Result<Option<(usize, LaserLine)>, IoError> {
        loop {
            let next = if self.is_at_end { self.waiting.pop_last() } else { self.waiting.pop() };
            match next {
                Some((_, line)) => {
                    self.left = self.left.saturating_sub(1);
                    return Ok(Some(line));
                }
                None if self.is_at_end => return Ok(None),
                None => self.read_line()?,
            }
        }
    }

    fn read_line(&mut self) -> Result<(), IoError> {
        match self.text.next_content() {
            Ok(Some((number, line))) => {
                let is_wanted = laser_name(line).is_some_and(|name| source_of(name) == self.laser.source);
                if is_wanted && let Ok(Line::Laser(laser)) = parse(line) {
                    // The survey has named a line whose time goes back.
                    let _ = self.waiting.push(laser.stamp, (number, laser));
                }
            }
            // The survey has named the end of a truncated file.
            Ok(None) | Err(IoError::Malformed { .. }) => self.is_at_end = true,
            Err(error) => return Err(error),
        }
        Ok(())
    }
}

impl Laser {
    /// The scan of a line with its odometry.
    fn scan(&self, line: &LaserLine) -> Result<LaserLogScan, String> {
        let odom_from_base = match line.poses {
            Some([_, odom_from_base]) => odom_from_base,
            None => self.motion.at(line.stamp)?,
        };
        let limit = self.no_return_from.or(line.max_range).unwrap_or(f64::INFINITY);
        let scan = scan_of(line, self.mount, &self.parameters, limit, self.is_upside_down)?;
        Ok(LaserLogScan { odom_from_base, scan })
    }
}

/// The error of a log without a usable scan.
fn no_scan(path: &Path, log: &LaserLog, times: Option<(Stamp, Stamp)>) -> IoError {
    let other_clock = times.and_then(|times| motion(&log.odometry).other_clock(times));
    match (other_clock, log.skipped.first()) {
        (Some(problem), _) => IoError::malformed(path, problem),
        (None, Some(skip)) => IoError::line(path, skip.line, skip.problem.clone()),
        (None, None) => IoError::malformed(path, "no scan in it"),
    }
}

/// Odometry for interpolation. Lines that go back in time are named by the survey.
fn motion(odometry: &[(Stamp, Pose2)]) -> Motion {
    let mut motion = Motion::default();
    for (stamp, pose) in odometry {
        let _ = motion.push(*stamp, *pose);
    }
    motion
}

fn note_bad_ranges(log: &mut LaserLog, number: usize, laser: &LaserLine) {
    let bad = laser.ranges.iter().filter(|range| !is_range(**range)).count();
    log.bad_ranges += bad;
    log.first_bad_range = log.first_bad_range.or((bad > 0).then_some(number));
}
