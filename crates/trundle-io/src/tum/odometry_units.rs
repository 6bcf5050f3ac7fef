//! Signs of wrong units in odometry.

use std::f64::consts::TAU;
use trundle_core::{Hypotenuse, Pose2, Stamp};

/// Speed that no indoor robot reaches \[m/s\]. Faster positions are in another unit. Source: ours.
const MAX_SPEED_M_S: f64 = 10.0;
/// Turn rate that no indoor robot reaches \[rad/s\]. Faster headings are in another unit. Source: ours.
const MAX_TURN_RATE_RAD_S: f64 = 10.0;
/// Share of the moving steps that must be too fast. Fewer are jumps, as of a robot that was carried. Source: ours.
const MIN_FAST_SHARE: f64 = 0.05;
/// Number of steps that must be too fast. Fewer prove no unit. Source: ours.
const MIN_FAST_STEPS: usize = 3;
/// Smallest agreement of displacement and heading that counts as one, 0 to 1. Source: ours.
const MIN_AGREEMENT: f64 = 0.8;
/// Agreement of displacement and heading, 0 to 1, below which they contradict. Source: ours.
const MAX_CONTRADICTION: f64 = 0.5;

/// A row of odometry.
pub(super) struct OdometryRow {
    pub pose: Pose2,
    /// The heading as given in the file, not wrapped \[rad\].
    pub heading: f64,
}

/// Numbers that seem to be in another unit than metres and radians.
pub(super) fn unit_problems(rows: &[(Stamp, OdometryRow)]) -> Vec<String> {
    let steps: Vec<Step> = rows.windows(2).filter_map(|pair| Step::between(&pair[0], &pair[1])).collect();
    let positions = wrong_positions(&steps).or_else(|| jumps(&steps));
    [positions, wrong_headings(rows, &steps)].into_iter().flatten().collect()
}

/// Steps that are too fast, but too few for another unit.
fn jumps(steps: &[Step]) -> Option<String> {
    let is_jump = |step: &&Step| step.distance / step.duration > MAX_SPEED_M_S;
    let farthest = steps.iter().filter(is_jump).max_by(|a, b| a.distance.total_cmp(&b.distance))?;
    Some(format!(
        "{} steps are faster than {MAX_SPEED_M_S} m/s, the longest {:.1} m in {:.3} s: was the robot carried, or is a row wrong?",
        steps.iter().filter(is_jump).count(),
        farthest.distance,
        farthest.duration
    ))
}

/// Motion between two successive rows.
struct Step {
    /// Time between the rows, s, above 0.
    duration: f64,
    /// Distance of the positions, m.
    distance: f64,
    /// Direction of motion, rad.
    length: f64,
    /// Heading in the file, rad.
    heading: f64,
    /// Change of the heading, rad, at least 0; a jump by one turn counts as no change.
    turn: f64,
}

impl Step {
    fn between((t0, a): &(Stamp, OdometryRow), (t1, b): &(Stamp, OdometryRow)) -> Option<Self> {
        let (x, y) = (b.pose.x - a.pose.x, b.pose.y - a.pose.y);
        let turn = (b.heading - a.heading).abs();
        let duration = *t1 - *t0;
        let turn = turn.min((TAU - turn).abs());
        let step = Self { duration, distance: x.hypotenuse(y), length: y.atan2(x), heading: a.heading, turn };
        (duration > 0.0).then_some(step)
    }

    /// Agreement of heading and direction of motion in this step, weighted by its distance. Backward motion counts like forward motion.
    fn agreement(&self, heading: f64) -> f64 {
        self.distance * (2.0 * (self.length - heading)).cos()
    }
}

fn wrong_positions(steps: &[Step]) -> Option<String> {
    let speed = fast(steps.iter().map(|step| step.distance / step.duration), MAX_SPEED_M_S)?;
    Some(format!(
        "positions move at {speed:.0} m/s, expected metres and at most {MAX_SPEED_M_S} m/s: are x and y in millimetres?"
    ))
}

fn wrong_headings(rows: &[(Stamp, OdometryRow)], steps: &[Step]) -> Option<String> {
    let largest = rows.iter().map(|(_, row)| row.heading.abs()).fold(0.0, f64::max);
    let is_fast = || fast(steps.iter().map(|step| step.turn / step.duration), MAX_TURN_RATE_RAD_S).is_some();
    let is_degrees = largest > TAU && (follows_way_in_degrees(steps) || is_fast());
    is_degrees.then(|| {
        format!(
            "theta goes up to {largest:.0} rad and turns as degrees do, expected radians: is it in degrees?"
        )
    })
}

/// Whether the direction of motion agrees with headings in degrees, and not with headings in radians.
fn follows_way_in_degrees(steps: &[Step]) -> bool {
    let length: f64 = steps.iter().map(|step| step.distance).sum();
    let as_radians: f64 = steps.iter().map(|step| step.agreement(step.heading)).sum();
    let as_degrees: f64 = steps.iter().map(|step| step.agreement(step.heading.to_radians())).sum();
    length > 0.0 && as_degrees > MIN_AGREEMENT * length && as_radians < MAX_CONTRADICTION * length
}

/// The median of the rates above `limit`, if they are too many for jumps.
fn fast(rates: impl Iterator<Item = f64>, limit: f64) -> Option<f64> {
    let moving: Vec<f64> = rates.filter(|rate| *rate > 0.0).collect();
    let mut fast: Vec<f64> = moving.iter().copied().filter(|rate| *rate > limit).collect();
    if fast.len() < MIN_FAST_STEPS || (fast.len() as f64) < MIN_FAST_SHARE * moving.len() as f64 {
        return None;
    }
    let middle = fast.len() / 2;
    Some(*fast.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A robot that turns by half a turn every 10 s at a speed of 0.3 m/s, with positions and headings in these units.
    fn drive(metre: f64, radian: f64, turn_rate: f64) -> Vec<String> {
        let mut pose = Pose2::IDENTITY;
        let mut rows = Vec::new();
        for i in 0..1000 {
            let heading = pose.theta * radian;
            let scaled = Pose2 { x: pose.x * metre, y: pose.y * metre, theta: heading };
            rows.push((Stamp::from_nanos(i * 20_000_000), OdometryRow { pose: scaled, heading }));
            pose = pose * Pose2::new(0.006, 0.0, 0.02 * turn_rate);
        }
        unit_problems(&rows)
    }

    #[test]
    fn metres_and_radians_have_no_problem() {
        assert_eq!(drive(1.0, 1.0, 0.3), Vec::<String>::new());
        assert_eq!(drive(1.0, 1.0, 0.0), Vec::<String>::new());
        assert!(unit_problems(&[]).is_empty());
    }

    #[test]
    fn millimetres_and_degrees_are_named() {
        let millimetres = drive(1000.0, 1.0, 0.3);
        assert!(millimetres.len() == 1 && millimetres[0].contains("move at 300 m/s"), "{millimetres:?}");
        assert!(millimetres[0].ends_with("are x and y in millimetres?"));
        for turn_rate in [0.05, 0.3, 1.0] {
            let degrees = drive(1.0, 1_f64.to_degrees(), turn_rate);
            assert!(degrees.len() == 1 && degrees[0].ends_with("is it in degrees?"), "{degrees:?}");
        }
    }

    #[test]
    fn headings_beyond_one_turn_are_not_another_unit_and_a_jump_is_named() {
        let mut rows: Vec<_> = (0..1000)
            .map(|i| {
                let heading = 0.006 * i as f64;
                let place = Pose2::new(heading.sin(), -heading.cos(), heading);
                (Stamp::from_nanos(i * 20_000_000), OdometryRow { pose: place, heading: 4.0 * TAU + heading })
            })
            .collect();
        assert_eq!(unit_problems(&rows), Vec::<String>::new());
        rows[500].1.pose.x += 50.0;
        let problems = unit_problems(&rows);
        assert!(
            problems.len() == 1 && problems[0].starts_with("2 steps are faster than 10 m/s, the longest 50"),
            "{problems:?}"
        );
    }
}
