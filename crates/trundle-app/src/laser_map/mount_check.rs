//! The search for the mount of a laser that the odometry does not contradict: mirrored, and turned.

use super::counts::ScanCounts;
use super::mount_steps::{MountSteps, Step};
use std::f64::consts::{FRAC_PI_2, TAU};
use trundle_core::{Vector2, wrap_angle};
use trundle_io::{LaserLogScan, LaserMount};

/// Number of steps below which the mount is not evaluated. Source: ours.
const MIN_STEPS: usize = 8;
/// Largest number of points of a scan that are compared. Source: ours.
const MAX_POINTS: usize = 180;
/// Smallest distance at which a point has no match \[m\]. Source: ours.
const MAX_MATCH_DISTANCE_M: f64 = 0.3;
/// Largest distance of the ends of neighbouring beams on one surface \[m\]: beams of 5 degrees on a wall at 3 m, 60 degrees aslant. Source:
/// ours.
const MAX_SURFACE_LENGTH_M: f64 = 0.5;
/// Share of the points that are compared, the nearest ones \[1\]. Source: ours, a third of a scan may be hidden from the earlier place.
const COUNTED_SHARE: f64 = 0.7;
/// Smallest difference of the errors of two mounts that is no noise \[m\]. Source: the noise of a range of a Hokuyo UTM-30LX below 10 m.
const MIN_ERROR_GAIN_M: f64 = 0.01;
/// Difference of two turns of a laser below which they are equal \[rad\]: half a degree, since messages give whole degrees. Source: ours.
const MIN_TURN_DIFFERENCE_RAD: f64 = 0.0087;
/// Difference of the turns of a laser that are tried first \[rad\]: 15 degrees, so that one of them is within 8 degrees of the true turn.
/// Source: ours.
const COARSE_TURN_STEP_RAD: f64 = TAU / 24.0;
/// Largest ratio of the error at any angle to that at the best quarter of a turn. Above it the quarter is suggested. Source: ours.
const MAX_TURNED_SHARE: f64 = 0.85;
/// Largest ratio of the better mount's error to the given mount's error. Above it no mount is suggested. Source: ours.
const MAX_ERROR_SHARE: f64 = 0.6;

/// Share of the steps with implausible odometry \[1\] above which a warning is given for any mount. Source: ours.
const MIN_SHARE_NOT_BELIEVED: f64 = 0.3;
/// Number of scans below which that share is not evaluated. Source: ours.
const MIN_SCANS: usize = 10;

/// A sentence for a log whose laser is probably not mounted as `taken`, or whose scans contradict the odometry at many steps.
pub(super) fn mount_hint(taken: LaserMount, steps: MountSteps, counts: &ScanCounts) -> Option<String> {
    let (doubted, all) = (counts.slips + counts.jumps, counts.processed);
    let is_doubted = all >= MIN_SCANS && doubted as f64 >= MIN_SHARE_NOT_BELIEVED * all as f64;
    let contradiction = format!("the scans contradict the odometry at {doubted} of {all} steps");
    match better_mount(taken, &steps.finish()).and_then(|mount| described(mount, taken)) {
        Some(mount) if is_doubted => Some(format!("{contradiction}: {mount}")),
        Some(mount) => Some(format!("the scans fit the odometry better with another mount: {mount}")),
        None if is_doubted => Some(format!(
            "{contradiction}, and no other mount of the laser fits better; are the poses those of this robot, in m and rad?"
        )),
        None => None,
    }
}

/// Name of a mount, and the options that select the mount; `None` if it equals `taken`.
fn described(mount: LaserMount, taken: LaserMount) -> Option<String> {
    // Adding zero removes the sign of a negative zero.
    let degrees = mount.turn.to_degrees().round() + 0.0;
    let is_turned_otherwise = wrap_angle(mount.turn - taken.turn).abs() >= MIN_TURN_DIFFERENCE_RAD;
    let mut options = String::new();
    if mount.upside_down && !taken.upside_down {
        options.push_str(" --upside-down");
    }
    if is_turned_otherwise {
        options.push_str(&format!(" --laser-turn={degrees}"));
    }
    let side = match (mount.upside_down, taken.upside_down) {
        (true, false) => "upside down",
        (false, true) => "the right way up",
        _ => "",
    };
    let turn = match degrees {
        _ if !is_turned_otherwise => String::new(),
        0.0 => "straight ahead".to_owned(),
        degrees => format!("turned by {degrees} deg"),
    };
    if side.is_empty() && turn.is_empty() {
        return None;
    }
    let how =
        if side.is_empty() || turn.is_empty() { format!("{side}{turn}") } else { format!("{side}, {turn}") };
    let options =
        if options.is_empty() { "leave out --upside-down".to_owned() } else { format!("try{options}") };
    Some(format!("the laser seems to be mounted {how}: {options}"))
}

/// The mount that fits the odometry of the steps clearly better than the mount `given`; `None` if no mount does.
fn better_mount(given: LaserMount, steps: &[Step]) -> Option<LaserMount> {
    if steps.len() < MIN_STEPS {
        return None;
    }
    let taken = mean_error(steps, Reading { is_mirrored: false, turn: 0.0 })?;
    let (quarter_error, quarter) = best_reading(steps, mounts_by_quarters(given))?;
    let (turned_error, turned) = best_turn(steps)?;
    // Most lasers are mounted by quarters of a turn, and beams far apart blur the error: another angle has to fit better than these.
    let is_turned = is_better(turned_error, quarter_error, MAX_TURNED_SHARE);
    let (error, best) = if is_turned { (turned_error, turned) } else { (quarter_error, quarter) };
    is_better(error, taken, MAX_ERROR_SHARE).then(|| best.applied_to(given))
}

/// Whether an error is below a share of the other, and by more than the noise.
fn is_better(error: f64, other: f64, share: f64) -> bool {
    error < share * other && other - error > MIN_ERROR_GAIN_M
}

/// The reading with the smallest mean error, and this error, m.
fn best_reading(steps: &[Step], readings: impl IntoIterator<Item = Reading>) -> Option<(f64, Reading)> {
    let errors = readings.into_iter().filter_map(|reading| Some((mean_error(steps, reading)?, reading)));
    errors.min_by(|(a, _), (b, _)| a.total_cmp(b))
}

/// Upright and mirrored readings at each multiple of `step` \[rad\] in a turn.
fn readings_every(step: f64) -> impl Iterator<Item = Reading> {
    let turns = (0..).map(move |k| f64::from(k) * step).take_while(move |turn| *turn < TAU - step / 2.0);
    turns.flat_map(|turn| [false, true].map(|is_mirrored| Reading { is_mirrored, turn }))
}

/// The readings of a log with this mount whose mounts are turned by quarters.
fn mounts_by_quarters(mount: LaserMount) -> impl Iterator<Item = Reading> {
    readings_every(FRAC_PI_2).map(move |reading| {
        let turn = if reading.is_mirrored { reading.turn + mount.turn } else { reading.turn - mount.turn };
        Reading { turn, ..reading }
    })
}

/// The best reading at any angle: a search at coarse steps, then at half the step around the best angle, down to half a degree.
fn best_turn(steps: &[Step]) -> Option<(f64, Reading)> {
    let mut best = best_reading(steps, readings_every(COARSE_TURN_STEP_RAD))?;
    let mut step = COARSE_TURN_STEP_RAD / 2.0;
    while step > MIN_TURN_DIFFERENCE_RAD / 2.0 {
        let (error, reading) = best;
        let beside = [-step, step].map(|change| Reading { turn: reading.turn + change, ..reading });
        best = best_reading(steps, beside).filter(|(other, _)| *other < error).unwrap_or(best);
        step /= 2.0;
    }
    Some(best)
}

/// Another interpretation of a scan's angles: mirrored at the base's x axis, then rotated to the left, around the laser.
#[derive(Debug, Clone, Copy)]
struct Reading {
    is_mirrored: bool,
    /// Rotation to the left, rad.
    turn: f64,
}

impl Reading {
    /// The mount that gives this reading of scans that were read with `mount`.
    fn applied_to(self, mount: LaserMount) -> LaserMount {
        let turn = if self.is_mirrored { self.turn - mount.turn } else { self.turn + mount.turn };
        LaserMount { turn: wrap_angle(turn), upside_down: mount.upside_down != self.is_mirrored }
    }

    fn point(self, origin: Vector2, point: Vector2) -> Vector2 {
        let from_laser = point - origin;
        let side = if self.is_mirrored { -from_laser.y } else { from_laser.y };
        let (sin, cos) = self.turn.sin_cos();
        origin + Vector2::new(cos * from_laser.x - sin * side, sin * from_laser.x + cos * side)
    }
}

/// The mean distance of the points of the later scans from the surfaces of the earlier ones, m, without the farthest points: those have no
/// surface in the earlier scan. `None` without points.
fn mean_error(steps: &[Step], reading: Reading) -> Option<f64> {
    let mut errors = Vec::new();
    for step in steps {
        let first = points(&step.first, reading);
        for point in points(&step.second, reading) {
            let point = step.first_from_second.transform(point);
            let distances = first.iter().zip(first.iter().skip(1).chain(first.last()));
            let distances = distances.map(|(a, b)| squared_distance(point, *a, *b));
            errors.push(distances.fold(MAX_MATCH_DISTANCE_M.powi(2), f64::min).sqrt());
        }
    }
    errors.sort_by(f64::total_cmp);
    errors.truncate((COUNTED_SHARE * errors.len() as f64).ceil() as usize);
    (!errors.is_empty()).then(|| errors.iter().sum::<f64>() / errors.len() as f64)
}

/// The squared distance of a point from the surface between the ends `a` and `b` of neighbouring beams, m^2; from `a` alone if a gap lies
/// between them. Beams of 5 degrees end 0.3 m apart, so the ends alone would hide an error of the mount.
fn squared_distance(point: Vector2, a: Vector2, b: Vector2) -> f64 {
    let (to_point, along) = (point - a, b - a);
    let squared_length = along.norm_squared();
    if squared_length == 0.0 || squared_length > MAX_SURFACE_LENGTH_M.powi(2) {
        return to_point.norm_squared();
    }
    let share = (to_point.dot(&along) / squared_length).clamp(0.0, 1.0);
    (to_point - along * share).norm_squared()
}

fn points(scan: &LaserLogScan, reading: Reading) -> Vec<Vector2> {
    let hits: Vec<Vector2> = scan.scan.hits().collect();
    let stride = hits.len().div_ceil(MAX_POINTS).max(1);
    hits.into_iter().step_by(stride).map(|point| reading.point(scan.scan.origin(), point)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use trundle_core::{Beam, Pose2, Scan, Stamp};
    use trundle_io::LaserLog;

    /// A simulated drive along a curve in a room of 6 x 4 m with a box; the laser is mounted as `truth` and its log claims an upright laser
    /// at heading 0.
    fn drive(truth: LaserMount) -> LaserLog {
        drive_with(truth, 60, TAU / 90.0)
    }

    /// The same drive with `beams` beams, `step` apart \[rad\].
    fn drive_with(truth: LaserMount, beams: i32, step: f64) -> LaserLog {
        let scans = (0..36).map(|i| {
            let at = f64::from(i) * 0.17;
            let odom_from_base = Pose2::new(2.0 + at.sin(), 1.5 + 0.6 * (1.0 - at.cos()), at);
            let hand = if truth.upside_down { -1.0 } else { 1.0 };
            let beam = |k: i32| {
                let angle = f64::from(k) * step - 2.0;
                let heading = odom_from_base.theta + truth.turn + hand * angle;
                Beam::Hit { range: range(odom_from_base.position(), heading) }
            };
            let beams: Vec<Beam> = (0..beams).map(beam).collect();
            let stamp = Stamp::from_nanos(i64::from(i) * 100_000_000);
            let scan = Scan::new(stamp, Vector2::zeros(), -2.0, step, beams).unwrap();
            LaserLogScan { odom_from_base, scan }
        });
        LaserLog::of_scans(scans)
    }

    /// The range to the walls and to a box at a wall, m.
    fn range(from: Vector2, heading: f64) -> f64 {
        let along = Vector2::new(heading.cos(), heading.sin());
        (1..300)
            .map(|k| 0.02 * f64::from(k))
            .find(|r| {
                let p = from + along * *r;
                let is_in_box = (4.0..5.0).contains(&p.x) && p.y > 3.0;
                !(0.0..6.0).contains(&p.x) || !(0.0..4.0).contains(&p.y) || is_in_box
            })
            .unwrap_or(6.0)
    }

    fn steps(log: &LaserLog) -> MountSteps {
        let mut steps = MountSteps::default();
        log.scans.iter().for_each(|scan| steps.take(&Arc::new(scan.clone())));
        steps
    }

    fn better(log: &LaserLog) -> Option<LaserMount> {
        better_mount(log.mount, &steps(log).finish())
    }

    fn hint_for(log: &LaserLog, counts: &ScanCounts) -> Option<String> {
        mount_hint(log.mount, steps(log), counts)
    }

    #[test]
    fn a_laser_as_it_is_read_has_no_better_mount() {
        assert_eq!(better(&drive(LaserMount::default())), None);
        assert_eq!(better(&LaserLog::default()), None);
    }

    #[test]
    fn mirrored_and_turned_lasers_are_named() {
        for (quarters, upside_down) in [(-1.0, false), (2.0, false), (0.0, true), (1.0, true)] {
            let truth = LaserMount { turn: quarters * FRAC_PI_2, upside_down };
            let found = better(&drive(truth)).unwrap();
            assert_eq!(found.upside_down, upside_down, "{truth:?}: {found:?}");
            assert!(wrap_angle(found.turn - truth.turn).abs() < 1e-9, "{truth:?}: {found:?}");
        }
    }

    #[test]
    fn lasers_turned_by_any_angle_are_named() {
        let turns =
            [(45.0_f64, false), (-135.0, false), (30.0, true), (67.0, false), (10.0, false), (-10.0, true)];
        for (degrees, upside_down) in turns {
            let truth = LaserMount { turn: degrees.to_radians(), upside_down };
            let found = better(&drive(truth)).unwrap();
            assert_eq!(found.upside_down, upside_down, "{truth:?}: {found:?}");
            let error = wrap_angle(found.turn - truth.turn).abs();
            assert!(error < 2.0_f64.to_radians(), "{truth:?}: {found:?}");
        }
    }

    #[test]
    fn beams_far_apart_hide_no_turn() {
        for step_deg in [1.0_f64, 2.5, 5.0, 8.0] {
            let beams = (230.0 / step_deg) as i32;
            let log = |degrees: f64| {
                let truth = LaserMount { turn: degrees.to_radians(), upside_down: false };
                drive_with(truth, beams, step_deg.to_radians())
            };
            assert_eq!(better(&log(0.0)), None, "{step_deg}");
            for degrees in [10.0_f64, -10.0, 20.0, 30.0, -30.0, 45.0, 120.0] {
                let found = better(&log(degrees)).unwrap();
                let error = wrap_angle(found.turn - degrees.to_radians()).abs();
                assert!(
                    error < 3.0_f64.to_radians() && !found.upside_down,
                    "{step_deg}, {degrees}: {found:?}"
                );
            }
        }
    }

    #[test]
    fn a_hint_names_the_options() {
        let hint = |truth| {
            let counts = ScanCounts { processed: 60, slips: 40, ..ScanCounts::default() };
            hint_for(&drive(truth), &counts).unwrap()
        };
        let upside_down = hint(LaserMount { turn: 0.0, upside_down: true });
        assert_eq!(
            upside_down,
            "the scans contradict the odometry at 40 of 60 steps: the laser seems to be mounted upside down: try --upside-down"
        );
        let turned = hint(LaserMount { turn: FRAC_PI_2, upside_down: false });
        assert!(turned.ends_with("mounted turned by 90 deg: try --laser-turn=90"), "{turned}");
        assert!(hint(LaserMount::default()).contains("no other mount"));
        let few = ScanCounts { processed: 60, slips: 10, ..ScanCounts::default() };
        assert_eq!(hint_for(&drive(LaserMount::default()), &few), None);
        let behind = LaserMount { turn: std::f64::consts::PI, upside_down: false };
        let found = hint_for(&drive(behind), &few).unwrap();
        assert!(
            found.starts_with("the scans fit the odometry better with another mount: the laser"),
            "{found}"
        );
    }

    #[test]
    fn a_hint_names_nothing_that_is_so_already() {
        let mount = |degrees: f64, upside_down| LaserMount { turn: degrees.to_radians(), upside_down };
        assert_eq!(described(mount(0.3, false), mount(0.0, false)), None);
        assert_eq!(described(mount(90.0, true), mount(90.2, true)), None);
        let ahead = described(mount(-0.1, false), mount(90.0, false)).unwrap();
        assert!(ahead.ends_with("mounted straight ahead: try --laser-turn=0"), "{ahead}");
        let turned = described(mount(90.0, true), mount(0.0, true)).unwrap();
        assert!(turned.ends_with("mounted turned by 90 deg: try --laser-turn=90"), "{turned}");
    }

    #[test]
    fn the_mount_of_a_log_is_suggested_by_quarters_whatever_was_given() {
        for (given, upside_down) in [(0.35, false), (-0.6, true)] {
            let given = LaserMount { turn: given, upside_down };
            for reading in mounts_by_quarters(given) {
                let quarters = reading.applied_to(given).turn / FRAC_PI_2;
                assert!((quarters - quarters.round()).abs() < 1e-12, "{given:?}: {reading:?}");
            }
        }
    }

    #[test]
    fn readings_change_a_mount_that_was_given() {
        let given = LaserMount { turn: 0.5, upside_down: true };
        let mirrored = Reading { is_mirrored: true, turn: FRAC_PI_2 }.applied_to(given);
        assert_eq!(mirrored, LaserMount { turn: FRAC_PI_2 - 0.5, upside_down: false });
    }
}
