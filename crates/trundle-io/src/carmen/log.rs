//! A laser log as read: scans with odometry, options, and skipped lines.

use super::line::{LaserLine, Line, parse};
use crate::IoError;
use crate::files::{content_lines, read_text};
use std::path::Path;
use trundle_core::{Beam, Invalid, Pose2, Scan, Stamp, require_finite, require_in, require_positive};

/// What a log does not say.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LaserLogOptions {
    /// How far ahead of the base the laser sits, m; by default what the log says: the poses of a CARMEN log's lines, else its
    /// `PARAM robot_frontlaser_offset`, else 0; the transforms of a bag.
    pub laser_x: Option<f64>,
    /// How far the laser is turned to the left, rad; by default what the log says, else 0.
    pub laser_turn: Option<f64>,
    /// The laser hangs upside down: its beams run from left to right.
    pub upside_down: bool,
    /// Ranges from here on are no returns, m; by default what the line says, else the reading at which many end.
    pub max_range: Option<f64>,
}

/// A scan with the odometry of its moment.
#[derive(Debug, Clone, PartialEq)]
pub struct LaserLogScan {
    /// The pose by odometry.
    pub odom_from_base: Pose2,
    /// The scan, base frame. Beams without a return or with a bad range are unseen.
    pub scan: Scan,
}

/// A line, or a message of a bag, that could not be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LaserLogSkip {
    /// The line, or the message's number in the bag, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub problem: String,
}

/// The log of a laser with odometry.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LaserLog {
    /// The scans, by rising stamps.
    pub scans: Vec<LaserLogScan>,
    /// The poses by odometry, by rising stamps.
    pub odometry: Vec<(Stamp, Pose2)>,
    /// Lines or messages that were skipped.
    pub skipped: Vec<LaserLogSkip>,
    /// Ranges that were negative, zero, infinite or no number.
    pub bad_ranges: usize,
    /// The first line, or message, with such a range.
    pub first_bad_range: Option<usize>,
    /// Ranges from here on were taken for no returns, m.
    pub max_range: Option<f64>,
}

/// A CARMEN log: lines `FLASER`, `ROBOTLASER1`, `ODOM` and `PARAM robot_frontlaser_offset`; others are left alone.
///
/// A broken line, or one whose time goes back, is skipped and named in [`LaserLog::skipped`].
///
/// # Errors
/// When the file cannot be read, an option is out of range, or no line holds a scan: then the first problem is named.
pub fn read_carmen(path: &Path, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    validated(options).map_err(IoError::field(path))?;
    parse_carmen(path, &read_text(path)?, options)
}

pub(crate) fn validated(options: &LaserLogOptions) -> Result<(), Invalid> {
    options.laser_x.map_or(Ok(0.0), |x| require_in("laser_x", x, "m", -20.0, 20.0))?;
    options.laser_turn.map_or(Ok(0.0), |turn| require_finite("laser_turn", turn, "rad"))?;
    options.max_range.map_or(Ok(()), |range| require_positive("max_range", range, "m").map(drop))
}

fn parse_carmen(path: &Path, text: &str, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    let mut log = LaserLog::default();
    let (mut lasers, mut offset) = (Vec::new(), 0.0);
    for (number, line) in content_lines(text) {
        let taken = parse(line).and_then(|line| match line {
            Line::Odometry(stamp, pose) => log.take_odometry(stamp, pose),
            Line::Laser(laser) => {
                let bad = laser.ranges.iter().any(|range| !is_range(*range));
                take_laser(&mut lasers, laser)?;
                log.first_bad_range = log.first_bad_range.or(bad.then_some(number));
                Ok(())
            }
            Line::Offset(metres) => {
                offset = metres;
                Ok(())
            }
            Line::Other => Ok(()),
        });
        if let Err(problem) = taken {
            log.skipped.push(LaserLogSkip { line: number, problem });
        }
    }
    if lasers.is_empty() {
        return Err(match log.skipped.first() {
            Some(skip) => IoError::line(path, skip.line, skip.problem.clone()),
            None => IoError::malformed(path, "no scan in it, expected lines of FLASER or ROBOTLASER1"),
        });
    }
    log.max_range = options.max_range.or_else(|| limit(&lasers));
    let told = mount(&lasers).unwrap_or(Pose2::new(offset, 0.0, 0.0));
    let (x, theta) = (options.laser_x.unwrap_or(told.x), options.laser_turn.unwrap_or(told.theta));
    let mount = Pose2::new(x, told.y, theta);
    for laser in &lasers {
        let scan = log.scan(laser, mount, options.upside_down);
        log.scans.push(LaserLogScan { odom_from_base: laser.odom_from_base, scan });
    }
    Ok(log)
}

fn take_laser(lasers: &mut Vec<LaserLine>, laser: LaserLine) -> Result<(), String> {
    if let Some(before) = lasers.last().filter(|before| laser.stamp < before.stamp) {
        return Err(format!("time goes back from {} s to {} s", before.stamp, laser.stamp));
    }
    lasers.push(laser);
    Ok(())
}

impl LaserLog {
    fn take_odometry(&mut self, stamp: Stamp, pose: Pose2) -> Result<(), String> {
        if let Some((before, _)) = self.odometry.last().filter(|(before, _)| stamp < *before) {
            return Err(format!("time goes back from {before} s to {stamp} s"));
        }
        self.odometry.push((stamp, pose));
        Ok(())
    }

    fn scan(&mut self, laser: &LaserLine, mount: Pose2, upside_down: bool) -> Scan {
        let limit = self.max_range.or(laser.max_range).unwrap_or(f64::INFINITY);
        let mut bad = 0;
        let mut beams: Vec<Beam> = laser
            .ranges
            .iter()
            .map(|&range| {
                let good = is_range(range);
                bad += usize::from(!good);
                if good && range < limit { Beam::Hit { range } } else { Beam::Unseen }
            })
            .collect();
        self.bad_ranges += bad;
        let sweep = laser.angle_increment * (beams.len() - 1) as f64;
        let mut first = laser.angle_min;
        if upside_down {
            beams.reverse();
            first = -(first + sweep);
        }
        Scan::new(laser.stamp, mount.position(), mount.theta + first, laser.angle_increment, beams)
            .expect("invariant: angles and mount were checked, ranges are finite and positive")
    }
}

fn is_range(range: f64) -> bool {
    range > 0.0 && range.is_finite()
}

/// The reading at which many beams end, if there is one: a laser without a return says its limit, give or take.
fn limit(lasers: &[LaserLine]) -> Option<f64> {
    /// Readings so far below the greatest are the limit too, m.
    const BAND: f64 = 0.25;
    /// Least part of all beams.
    const SHARE: f64 = 0.001;
    let readings = || lasers.iter().flat_map(|l| &l.ranges).copied().filter(|r| r.is_finite());
    let greatest = readings().fold(0.0, f64::max);
    let (mut many, mut all) = (0_usize, 0_usize);
    for range in readings() {
        all += 1;
        many += usize::from(range > greatest - BAND);
    }
    (many as f64 > SHARE * all as f64 && many > 20).then_some(greatest - BAND)
}

/// Where the laser sits by the poses of the lines, when all agree on it and it is no more than 2 m away.
fn mount(lasers: &[LaserLine]) -> Option<Pose2> {
    let place = |laser: &LaserLine| laser.odom_from_base.inverse() * laser.odom_from_laser;
    let first = place(&lasers[0]);
    let agree = |laser: &LaserLine| {
        let off = first.inverse() * place(laser);
        off.position().norm() < 0.01 && off.theta.abs() < 0.01
    };
    let away = first.position().norm() > 1e-6 || first.theta.abs() > 1e-6;
    (away && first.position().norm() < 2.0 && lasers.iter().all(agree)).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str, options: LaserLogOptions) -> Result<LaserLog, String> {
        parse_carmen(Path::new("a.log"), text, &options).map_err(|error| error.to_string())
    }

    const GOOD: &str = "FLASER 4 1 2 3 4 0.5 0 0 0.2 0 0 10.5 host 0.1\n";

    #[test]
    fn a_sweep_looks_from_right_to_left() {
        let log =
            read(&format!("# x\nODOM 1 2 0.5 0 0 0 10 host 0\n{GOOD}"), LaserLogOptions::default()).unwrap();
        assert_eq!(log.odometry, [(Stamp::from_nanos(10_000_000_000), Pose2::new(1.0, 2.0, 0.5))]);
        let LaserLogScan { odom_from_base, scan } = &log.scans[0];
        assert_eq!((odom_from_base.x, scan.origin().x), (0.2, 0.3), "the laser is 0.3 m ahead");
        assert!((scan.angle(0) + 90_f64.to_radians()).abs() < 1e-12);
        assert!((scan.angle(3) - 45_f64.to_radians()).abs() < 1e-12);
        assert_eq!(scan.beams()[3], Beam::Hit { range: 4.0 });
        let down = read(GOOD, LaserLogOptions { upside_down: true, ..Default::default() }).unwrap();
        assert_eq!(down.scans[0].scan.beams()[0], Beam::Hit { range: 4.0 });
        assert!((down.scans[0].scan.angle(0) + 45_f64.to_radians()).abs() < 1e-12);
    }

    #[test]
    fn what_is_given_of_the_mount_overrides_that_alone() {
        let origin = |options: LaserLogOptions| {
            let scan = read(GOOD, options).unwrap().scans[0].scan.clone();
            (scan.origin().x, (scan.angle(0).to_degrees() * 1e6).round() / 1e6)
        };
        let turned = LaserLogOptions { laser_turn: Some(0.5_f64.to_radians()), ..Default::default() };
        assert_eq!(origin(turned), (0.3, -89.5), "the place is still the log's");
        let moved = LaserLogOptions { laser_x: Some(0.1), ..Default::default() };
        assert_eq!(origin(moved), (0.1, -90.0));
        let wrong = LaserLogOptions { laser_x: Some(1e9), ..Default::default() };
        assert_eq!(validated(&wrong).unwrap_err().field, "laser_x");
    }

    #[test]
    fn robotlaser_says_its_own_angles_and_limit() {
        let line = "ROBOTLASER1 0 -1 2 1 8 0.01 0 3 1 2 8 1 77 0.1 0 0 0 0 0 0 0 0 0 0 12.25 host 0";
        let log = read(line, LaserLogOptions::default()).unwrap();
        let scan = &log.scans[0].scan;
        assert_eq!(
            (scan.angle_min(), scan.angle_increment(), scan.stamp().nanos),
            (-1.0, 1.0, 12_250_000_000)
        );
        assert_eq!(scan.beams(), [Beam::Hit { range: 1.0 }, Beam::Hit { range: 2.0 }, Beam::Unseen]);
    }

    #[test]
    fn broken_lines_are_named_and_left_out() {
        let broken = "FLASER 4 1 2\nFLASER x\nODOM 1 2\nFLASER 1 1 0 0 0 0 0 nan 11 h 0\nFLASER 1 1 0 0 0 0 0 0 9 h 0\n";
        let log = read(&format!("{GOOD}{broken}"), LaserLogOptions::default()).unwrap();
        let problems: Vec<_> = log.skipped.iter().map(|s| format!("{}: {}", s.line, s.problem)).collect();
        assert_eq!(
            problems,
            [
                "2: the line ends after 2 of 4 ranges",
                "3: number of beams is 'x', expected 1 to 100000",
                "4: the line ends before its theta",
                "5: theta is 'nan', expected a finite number",
                "6: time goes back from 10.500000000 s to 9.000000000 s",
            ]
        );
        assert_eq!(log.scans.len(), 1);
        assert_eq!(
            read("FLASER 4 1", LaserLogOptions::default()).unwrap_err(),
            "a.log, line 1: the line ends after 1 of 4 ranges"
        );
        assert!(read("SYNC x", LaserLogOptions::default()).unwrap_err().starts_with("a.log: no scan in it"));
    }

    #[test]
    fn bad_ranges_are_unseen_and_counted() {
        let bad = "FLASER 5 -1 nan inf 0 2 0 0 0 0 0 0 11 h 1";
        let log = read(&format!("{GOOD}{bad}"), LaserLogOptions::default()).unwrap();
        assert_eq!((log.bad_ranges, log.first_bad_range), (4, Some(2)));
        assert_eq!(log.scans[1].scan.beams()[4], Beam::Hit { range: 2.0 });
        assert_eq!(log.scans[1].scan.beams()[..4], [Beam::Unseen; 4]);
    }

    #[test]
    fn the_reading_where_many_end_is_no_return() {
        let line = |range: f64| format!("FLASER 2 3 {range} 0 0 0 0 0 0 1 h 1\n");
        let text: String = (0..30).map(|i| line(81.83 + 0.005 * f64::from(i % 3))).collect();
        let log = read(&text, LaserLogOptions::default()).unwrap();
        assert!(log.scans.iter().all(|s| s.scan.beams() == [Beam::Hit { range: 3.0 }, Beam::Unseen]));
    }

    proptest! {
        #[test]
        fn any_text_is_no_panic(text in "(ODOM|FLASER|ROBOTLASER1|PARAM|[0-9. naif\n-]{0,8}){0,30}") {
            let _ = read(&text, LaserLogOptions::default());
        }
    }
}
