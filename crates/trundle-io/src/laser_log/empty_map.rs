//! The likely cause of an empty map: the log's ranges, its odometry, or their units.

use super::LaserLog;

/// Median of the ranges of a log \[m\]. A larger median means another unit. Source: ours; the medians of the shared logs are below 10 m,
/// and no indoor laser reaches far beyond 80 m (SICK LMS200).
const MAX_MEDIAN_RANGE_M: f64 = 50.0;
/// Median of the ranges \[m\] above which the unit is not the centimetre: a room would be 10 m and more around the robot. Source: ours.
const MAX_CENTIMETRE_MEDIAN: f64 = 1000.0;
/// Median distance by odometry between two scans \[m\]. A larger median means another unit. Source: ours.
const MAX_MEDIAN_STEP_M: f64 = 3.0;

/// Problem of the unit of a log's ranges; `None` if the ranges are plausible.
#[must_use]
pub fn range_unit_hint(log: &LaserLog) -> Option<String> {
    let median = log.statistics.median_range()?;
    let unit = if median > MAX_CENTIMETRE_MEDIAN { "millimetres" } else { "centimetres or millimetres" };
    (median > MAX_MEDIAN_RANGE_M).then(|| {
        format!(
            "half of the ranges are {median:.0} m or more, expected {MAX_MEDIAN_RANGE_M} m or less: are they in {unit}?"
        )
    })
}

/// The likely cause of an empty map of a log, by its ranges.
#[must_use]
pub fn empty_map_cause(log: &LaserLog) -> String {
    if log.statistics.is_blind() {
        return no_return_cause(log);
    }
    range_unit_hint(log).unwrap_or_else(|| {
        format!("{} of {} scans hit no obstacle", log.scans_without_return(), log.statistics.scans)
    })
}

/// The likely cause if the scans of a log do not overlap with their map, by ranges and odometry.
#[must_use]
pub fn no_overlap_cause(log: &LaserLog) -> String {
    if log.statistics.is_blind() && log.statistics.scans > 0 {
        return no_return_cause(log);
    }
    range_unit_hint(log).or_else(|| odometry_unit_hint(log)).unwrap_or_else(|| {
        "are ranges and odometry of one robot, both in metres, and is the laser mounted as in the log?"
            .to_owned()
    })
}

/// Problem of the unit of a log's odometry; `None` if the steps are plausible.
fn odometry_unit_hint(log: &LaserLog) -> Option<String> {
    let median = log.statistics.median_step()?;
    (median > MAX_MEDIAN_STEP_M).then(|| {
        format!(
            "between two scans the odometry moves {median:.0} m or more at half of the steps, expected {MAX_MEDIAN_STEP_M} m or less: \
             is it in centimetres or millimetres?"
        )
    })
}

/// The likely cause if no beam of a log has a return.
#[must_use]
pub fn no_return_cause(log: &LaserLog) -> String {
    if let Some(problem) = &log.depth_problem {
        return problem.clone();
    }
    if log.bad_ranges > 0 {
        return format!(
            "no beam of any scan hit an obstacle: {} ranges are negative, zero, infinite, not a number or below the laser's minimum range",
            log.bad_ranges
        );
    }
    match log.max_range {
        Some(max) => format!(
            "no beam of any scan hit an obstacle: every range is about the laser's largest range of {max} m or beyond it, or is none: are they \
             in centimetres or millimetres?"
        ),
        None => "no beam of any scan hit an obstacle".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laser_log::LaserLogScan;
    use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};

    /// Scans whose beams all have this range, m, `step` m apart by odometry.
    fn log(range: f64, step: f64) -> LaserLog {
        let scan = |i: u32| LaserLogScan {
            odom_from_base: Pose2::new(step * f64::from(i), 0.0, 0.0),
            scan: Scan::new(
                Stamp::from_nanos(i64::from(i)),
                Vector2::zeros(),
                0.0,
                0.1,
                vec![Beam::Hit { range }; 5],
            )
            .unwrap(),
        };
        LaserLog::of_scans((0..6).map(scan))
    }

    #[test]
    fn ranges_and_odometry_in_another_unit_are_named() {
        assert_eq!(range_unit_hint(&log(4.0, 0.1)), None);
        let centimetres = range_unit_hint(&log(400.0, 0.1)).unwrap();
        assert!(centimetres.contains("half of the ranges are 400 m or more"), "{centimetres}");
        assert!(centimetres.ends_with("are they in centimetres or millimetres?"), "{centimetres}");
        assert!(range_unit_hint(&log(4000.0, 0.1)).unwrap().ends_with("are they in millimetres?"));
        assert_eq!(no_overlap_cause(&log(400.0, 0.1)), centimetres);
        assert!(no_overlap_cause(&log(4.0, 10.0)).contains("the odometry moves 10 m or more"));
        assert!(no_overlap_cause(&log(4.0, 0.1)).contains("both in metres"));
    }

    #[test]
    fn ranges_beyond_the_largest_one_may_be_in_another_unit() {
        let blind = |i: i64| LaserLogScan {
            odom_from_base: Pose2::IDENTITY,
            scan: Scan::new(Stamp::from_nanos(i), Vector2::zeros(), 0.0, 0.1, vec![Beam::Unseen; 5]).unwrap(),
        };
        let log = LaserLog { max_range: Some(8.0), ..LaserLog::of_scans((0..6).map(blind)) };
        let cause = empty_map_cause(&log);
        assert!(cause.contains("largest range of 8 m") && cause.ends_with("millimetres?"), "{cause}");
    }
}
