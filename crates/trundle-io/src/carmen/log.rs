//! A whole CARMEN log in memory.

use super::scans::CarmenScans;
use crate::IoError;
use crate::laser_log::{LaserLog, LaserLogOptions};
use std::path::Path;

/// A CARMEN log, plain or compressed with gzip: lines of a laser (`FLASER`, `ROBOTLASER1`, `RAWLASER1` to `RAWLASER4` and those of
/// the rear), `ODOM` and three of `PARAM`; others are ignored. [`crate::LaserLogScans`] reads the scans of a long log one at a
/// time.
///
/// The scans are those of the front laser, else the lines that are most; [`LaserLogOptions::scan_topic`] names others. A `RAWLASER` line
/// has no pose: its odometry is interpolated between `ODOM` lines. Lines up to 0.05 s out of order are sorted. A broken line, or one whose
/// time goes back farther, is skipped and named in [`LaserLog::skipped`]; so is the rest of a truncated compressed file.
///
/// # Errors
/// When the file cannot be read, an option is out of range, or no line holds a scan: then the first problem is named.
pub fn read_carmen(path: &Path, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    CarmenScans::open(path, options).and_then(whole)
}

fn whole((mut log, mut scans): (LaserLog, CarmenScans)) -> Result<LaserLog, IoError> {
    while let Some(scan) = scans.next_scan(&mut log)? {
        log.scans.push(scan);
    }
    Ok(log)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::carmen::text::TextLines;
    use crate::laser_log::LaserLogScan;
    use proptest::prelude::*;
    use trundle_core::{Beam, Pose2, Stamp};

    fn read(text: &str, options: LaserLogOptions) -> Result<LaserLog, String> {
        let path = Path::new("a.log");
        let text = || TextLines::new(path, std::io::Cursor::new(text.to_owned().into_bytes()));
        CarmenScans::new(path, text, &options).and_then(whole).map_err(|error| error.to_string())
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
    fn a_given_part_of_the_mount_overrides_that_part_alone() {
        let origin = |options: LaserLogOptions| {
            let scan = read(GOOD, options).unwrap().scans[0].scan.clone();
            (scan.origin().x, (scan.angle(0).to_degrees() * 1e6).round() / 1e6)
        };
        let turned = LaserLogOptions { laser_turn: Some(0.5_f64.to_radians()), ..Default::default() };
        assert_eq!(origin(turned), (0.3, -89.5), "the place is still the log's");
        let moved = LaserLogOptions { laser_x: Some(0.1), ..Default::default() };
        assert_eq!(origin(moved), (0.1, -90.0));
        let wrong = LaserLogOptions { laser_x: Some(1e9), ..Default::default() };
        assert_eq!(wrong.validate().unwrap_err().field, "laser_x");
    }

    #[test]
    fn robotlaser_has_its_own_angles_and_limit() {
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
    fn the_reading_where_many_end_is_not_a_return() {
        let line = |range: f64| format!("FLASER 2 3 {range} 0 0 0 0 0 0 1 h 1\n");
        let text: String = (0..30).map(|i| line(81.83 + 0.005 * f64::from(i % 3))).collect();
        let log = read(&text, LaserLogOptions::default()).unwrap();
        assert!(log.scans.iter().all(|s| s.scan.beams() == [Beam::Hit { range: 3.0 }, Beam::Unseen]));
        assert_eq!(log.max_range, Some(81.84), "the greatest reading itself");
    }

    #[test]
    fn the_largest_range_is_named_as_it_was_read() {
        let text = "FLASER 2 0.02 0.02 0 0 0 0 0 0 1 h 1\n".repeat(30);
        let log = read(&text, LaserLogOptions::default()).unwrap();
        assert_eq!(log.max_range, Some(0.02));
        let cause = crate::empty_map_cause(&log);
        assert!(cause.contains("about the laser's largest range of 0.02 m"), "{cause}");
    }

    /// The angles of the first and last beam of a log's first scan, deg.
    fn ends(text: &str) -> (f64, f64) {
        let scan = read(text, LaserLogOptions::default()).unwrap().scans[0].scan.clone();
        let angle = |i: usize| (scan.angle(i).to_degrees() * 1e6).round() / 1e6;
        (angle(0), angle(scan.beams().len() - 1))
    }

    #[test]
    fn parameters_of_the_front_laser_are_obeyed() {
        let flaser = "FLASER 5 1 2 3 4 5 0 0 0 0 0 0 1 h 1";
        assert_eq!(ends(flaser), (-90.0, 90.0));
        for parameters in [
            "PARAM laser_front_laser_fov 240 h 1",
            "PARAM laser_front_laser_fov 4.1887902047863905 h 1\nPARAM laser_front_laser_resolution 5.0",
            "PARAM laser_front_laser_resolution 60",
            "PARAM laser_laser1_fov 240",
        ] {
            assert_eq!(ends(&format!("{parameters}\n{flaser}")), (-120.0, 120.0), "{parameters}");
        }
        let own = "PARAM laser_front_laser_fov 240\nROBOTLASER1 0 -1 2 1 8 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 h 0";
        assert_eq!(ends(own).0, (-1.0_f64.to_degrees() * 1e6).round() / 1e6, "a line's own angles win");
        let wrong = read(&format!("PARAM laser_front_laser_fov -3\n{flaser}"), LaserLogOptions::default());
        assert!(wrong.unwrap().skipped[0].problem.contains("laser_front_laser_fov is -3, expected above 0"));
    }

    #[test]
    fn clockwise_scans_are_turned_round() {
        let line = |first: f64, step: f64, ranges: &str| {
            format!("ROBOTLASER1 0 {first} 0 {step} 50 0.01 0 3 {ranges} 0 0 0 0 0 0 0 0 0 0 0 0 1 h 0")
        };
        let scan = |text: String, upside_down| {
            let options = LaserLogOptions { upside_down, ..LaserLogOptions::default() };
            read(&text, options).unwrap().scans[0].scan.clone()
        };
        let (left, right) = (line(-0.5, 0.5, "1 2 3"), line(0.5, -0.5, "3 2 1"));
        for upside_down in [false, true] {
            assert_eq!(scan(left.clone(), upside_down), scan(right.clone(), upside_down));
        }
    }

    #[test]
    fn raw_lines_take_their_odometry_from_odom_lines() {
        let raw = |name: &str, time: f64| format!("{name} 0 -1 2 1 8 0.01 0 3 1 2 3 0 {time} h 0\n");
        let odom = "ODOM 1 0 0 0 0 0 10 h 0\nODOM 2 0 0 0 0 0 11 h 0\n";
        let text =
            format!("{odom}{}{}{}", raw("RAWLASER1", 10.5), raw("RAWLASER2", 10.5), raw("RAWLASER1", 99.0));
        let log = read(&text, LaserLogOptions::default()).unwrap();
        assert_eq!((log.scans.len(), log.scans[0].odom_from_base.x), (1, 1.5));
        assert_eq!((log.sources.scans.as_str(), log.sources.odometry.as_str()), ("RAWLASER1", "ODOM"));
        assert_eq!(log.sources.left, [("RAWLASER2".to_owned(), 1)]);
        assert!(log.skipped[0].problem.contains("no odometry about 99.000000000 s"));
        let rear = LaserLogOptions { scan_topic: Some("RAWLASER2".to_owned()), ..LaserLogOptions::default() };
        let rear = read(&text, rear).unwrap().scans[0].scan.clone();
        assert!((rear.angle(1).abs() - std::f64::consts::PI).abs() < 1e-9, "it looks back");
        let none = LaserLogOptions { scan_topic: Some("RAWLASER4".to_owned()), ..LaserLogOptions::default() };
        assert!(read(&text, none).unwrap_err().contains("expected one of: RAWLASER1 (2), RAWLASER2 (1)"));
        let alone = read(&raw("RAWLASER1", 1.0), LaserLogOptions::default()).unwrap_err();
        assert!(alone.contains("but no odometry in it"), "{alone}");
        let late =
            read(&format!("{odom}{}", raw("RAWLASER1", 99.0)), LaserLogOptions::default()).unwrap_err();
        assert!(
            late.contains(
                "scans from 99.000000000 s to 99.000000000 s, odometry from 10.000000000 s to 11.000000000 s"
            ),
            "{late}"
        );
        let both = read(&format!("{text}{GOOD}"), LaserLogOptions::default()).unwrap();
        assert_eq!(
            (both.sources.scans.as_str(), both.scans.len()),
            ("FLASER", 1),
            "lines with poses come first"
        );
    }

    #[test]
    fn headers_in_degrees_are_refused() {
        let line = "ROBOTLASER1 0 -180 355 5 12 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 h 0";
        assert_eq!(
            read(line, LaserLogOptions::default()).unwrap_err(),
            "a.log, line 1: start angle is -180 rad, expected radians within one turn (6.283); it seems to be in degrees"
        );
    }

    proptest! {
        #[test]
        fn any_text_does_not_panic(text in "(ODOM|FLASER|ROBOTLASER1|RAWLASER2|PARAM laser_front_laser_fov|PARAM|[0-9. naif\n-]{0,8}){0,30}") {
            let _ = read(&text, LaserLogOptions::default());
        }
    }
}
