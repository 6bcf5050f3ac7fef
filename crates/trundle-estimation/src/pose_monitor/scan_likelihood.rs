//! Likelihood of a scan in a map: the beam model of Thrun, Burgard and Fox, Probabilistic Robotics, 6.3.

use trundle_core::{Beam, Cell, OccupancyGrid, Pose2, Scan, Vector2};

/// Angle between two compared beams \[rad\]: 5 deg. Errors of nearer beams are correlated. Source: ours.
const BEAM_SPACING_RAD: f64 = 0.087;
/// Standard deviation of a range against the map \[m\]: cells, pose and noise. Source: ours.
const RANGE_SIGMA_M: f64 = 0.1;
/// Growth of that standard deviation with the range \[m/m\]: the error of the heading on oblique walls. Source: ours.
const RANGE_SIGMA_PER_M: f64 = 0.03;
/// Probability of an unmapped object in front of the wall: a person, a chair. Source: ours.
const P_IN_FRONT: f64 = 0.2;
/// Probability of a range beyond the wall of the map: a removed object, or a wrong range. Source: ours.
const P_BEYOND: f64 = 0.1;
/// Extent of the uniform distribution of ranges \[m\]. Source: a Kinect V2's range.
const MAX_RANGE_M: f64 = 8.0;
/// Distance behind a beam's end in which its wall is searched \[m\]. Source: ours, ten standard deviations at 5 m.
const BEHIND_END_M: f64 = 2.5;
/// Exponent of the likelihood: beams have common errors of pose and map. Source: ours.
const LIKELIHOOD_EXPONENT: f64 = 0.3;

/// Natural logarithm of the likelihood ratio of a scan, base at `pose`, against a scan that is equally likely at all ranges \[nats\].
/// Beams into unknown cells count 0.
pub(crate) fn scan_log_likelihood(grid: &OccupancyGrid, pose: Pose2, scan: &Scan) -> f64 {
    let origin = pose.transform(scan.origin());
    let step = (BEAM_SPACING_RAD / scan.angle_increment()).round().max(1.0) as usize;
    let beam = |i: usize| {
        let angle = pose.theta + scan.angle(i);
        let direction = Vector2::new(angle.cos(), angle.sin());
        let wall = |range: f64| wall_range(grid, origin, direction, MAX_RANGE_M.max(range + BEHIND_END_M));
        match scan.beams()[i] {
            Beam::Hit { range } => hit_ratio(wall(range), grid.at(origin + direction * range), range),
            Beam::Free { range } => free_ratio(wall(range), range),
            Beam::Unseen => 0.0,
        }
    };
    LIKELIHOOD_EXPONENT * (0..scan.beams().len()).step_by(step).map(beam).sum::<f64>()
}

/// Range of the first occupied cell along a beam, up to `reach`, m. Rays pass unknown cells.
fn wall_range(grid: &OccupancyGrid, origin: Vector2, direction: Vector2, reach: f64) -> Option<f64> {
    let step = 0.5 * grid.geometry().resolution;
    let count = (reach / step) as usize;
    (0..count).map(|i| i as f64 * step).find(|range| grid.at(origin + direction * *range) == Cell::Occupied)
}

/// Likelihood ratio of a beam with a hit at `range`, in a cell of class `end`.
fn hit_ratio(wall: Option<f64>, end: Cell, range: f64) -> f64 {
    let uniform = 1.0 / MAX_RANGE_M;
    let Some(wall) = wall else { return if end == Cell::Unknown { 0.0 } else { P_IN_FRONT.ln() } };
    if range < wall && end == Cell::Unknown {
        return 0.0;
    }
    let sigma = range_sigma(wall);
    let z = (range - wall) / sigma;
    let p_wall = (-0.5 * z * z).exp() / (sigma * std::f64::consts::TAU.sqrt());
    let p_in_front = if range < wall { 1.0 / wall.max(sigma) } else { 0.0 };
    let p = (1.0 - P_IN_FRONT - P_BEYOND) * p_wall + P_IN_FRONT * p_in_front + P_BEYOND * uniform;
    (p / uniform).ln()
}

/// Likelihood ratio of a beam without a hit up to `range`.
fn free_ratio(wall: Option<f64>, range: f64) -> f64 {
    let is_through = wall.is_some_and(|wall| range > wall + 3.0 * range_sigma(wall));
    if is_through { P_BEYOND.ln() } else { 0.0 }
}

fn range_sigma(wall: f64) -> f64 {
    RANGE_SIGMA_M + RANGE_SIGMA_PER_M * wall
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;

    const HERE: Pose2 = Pose2 { x: -0.6, y: 0.2, theta: 0.3 };

    fn half_turn(pose: Pose2) -> Pose2 {
        Pose2::new(0.0, 0.0, std::f64::consts::PI) * pose
    }

    #[test]
    fn the_right_pose_is_far_likelier_than_one_half_a_metre_off() {
        let room = Room::with_corner_box();
        let (map, scan) = (room.map(), room.scan(HERE, 0.0));
        let right = scan_log_likelihood(&map, HERE, &scan);
        for off in [Pose2::new(0.5, 0.0, 0.0), Pose2::new(0.0, 0.5, 0.0), Pose2::new(0.0, 0.0, 0.4)] {
            let wrong = scan_log_likelihood(&map, HERE * off, &scan);
            assert!(right - wrong > 3.0, "{off:?}: {right} against {wrong}");
        }
    }

    #[test]
    fn two_poses_of_a_symmetric_room_are_alike_with_people_or_without() {
        let empty = Room::default();
        let map = empty.map();
        for room in [empty.clone(), empty.with_person(Vector2::new(0.6, 0.3))] {
            let scan = room.scan(HERE, 0.0);
            let nats =
                scan_log_likelihood(&map, HERE, &scan) - scan_log_likelihood(&map, half_turn(HERE), &scan);
            assert!(nats.abs() < 1.0, "{nats}");
        }
    }

    #[test]
    fn a_person_in_view_does_not_make_another_pose_likelier() {
        let room = Room::with_corner_box();
        let scan = room.clone().with_person(Vector2::new(0.4, 0.3)).scan(HERE, 0.0);
        let at = |pose| scan_log_likelihood(&room.map(), pose, &scan);
        assert!(at(HERE) - at(HERE * Pose2::new(0.4, 0.0, 0.1)) > 3.0);
        assert!(at(HERE) - at(half_turn(HERE)) > 0.0);
    }

    #[test]
    fn a_wall_beyond_the_range_of_a_depth_camera_counts_too() {
        let geometry = trundle_core::GridGeometry::new(0.05, Vector2::new(-1.0, -1.0), 500, 40).unwrap();
        let mut map = OccupancyGrid::filled(geometry, Cell::Free);
        (0..40).for_each(|y| {
            map.set(
                geometry.cell_at(Vector2::new(12.02, -0.99 + 0.05 * f64::from(y))).unwrap(),
                Cell::Occupied,
            )
        });
        let beams = vec![Beam::Hit { range: 12.0 }; 3];
        let scan = Scan::new(trundle_core::Stamp::default(), Vector2::zeros(), -0.02, 0.02, beams).unwrap();
        let at = |x: f64| scan_log_likelihood(&map, Pose2::new(x, 0.0, 0.0), &scan);
        assert!(at(0.0) > at(2.0) + 0.3 && at(0.0) > at(60.0) + 0.3, "{} {} {}", at(0.0), at(2.0), at(60.0));
    }

    #[test]
    fn an_unknown_map_says_nothing() {
        let room = Room::with_corner_box();
        let unknown = OccupancyGrid::filled(*room.map().geometry(), Cell::Unknown);
        assert_eq!(scan_log_likelihood(&unknown, HERE, &room.scan(HERE, 0.0)), 0.0);
    }
}
