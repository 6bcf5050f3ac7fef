//! The likely cause where the scans of a log leave a map empty.

use super::LaserLog;
use trundle_core::Beam;

/// Range that no indoor laser measures, m; larger ranges are in another unit. Source: SICK LMS200, 80 m.
const MAX_LASER_RANGE_M: f64 = 100.0;

/// Why nothing is in a map of a log, judged by its ranges.
#[must_use]
pub fn empty_map_cause(log: &LaserLog) -> String {
    let mut ranges = hit_ranges(log);
    if ranges.is_empty() {
        return no_return_cause(log);
    }
    let middle = ranges.len() / 2;
    let median = *ranges.select_nth_unstable_by(middle, f64::total_cmp).1;
    if median > MAX_LASER_RANGE_M {
        return format!(
            "half of the ranges are {median:.0} m or more, expected at most {MAX_LASER_RANGE_M} m: are they in millimetres?"
        );
    }
    format!("{} of {} scans met nothing", log.scans_without_return(), log.scans.len())
}

fn no_return_cause(log: &LaserLog) -> String {
    if let Some(problem) = &log.depth_problem {
        return problem.clone();
    }
    if log.bad_ranges > 0 {
        return format!(
            "no beam of any scan met anything: {} ranges are zero, negative, no number, or below the laser's least range",
            log.bad_ranges
        );
    }
    match log.max_range {
        Some(max) => format!(
            "no beam of any scan met anything: every range is about the laser's largest range of {max} m or beyond it, or is none"
        ),
        None => "no beam of any scan met anything".to_owned(),
    }
}

fn hit_ranges(log: &LaserLog) -> Vec<f64> {
    let beams = log.scans.iter().flat_map(|scan| scan.scan.beams());
    beams.filter_map(|beam| if let Beam::Hit { range } = beam { Some(*range) } else { None }).collect()
}
