//! Movers found in successive scans.

use crate::support::{at_home, cpu_ms, found_plan, judge, planner};
use trundle_core::{Beam, Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Scan, Stamp, Twist2, Vector2};
use trundle_planning::{MovingObstacle, MovingObstacleTracker, ObstacleTrackerConfig};

const PERSON: f64 = 0.25;
const RADIUS: f64 = 0.1755;

/// A room of 10 x 6 m with three thin legs of a table.
struct World {
    legs: Vec<(Vector2, f64)>,
    people: Vec<(Vector2, Vector2)>,
    seed: u64,
}

impl World {
    fn new(people: &[(Vector2, Vector2)]) -> Self {
        let legs = [(3.0, 4.5), (3.8, 4.5), (7.0, 1.2)].map(|(x, y)| (Vector2::new(x, y), 0.03)).to_vec();
        Self { legs, people: people.to_vec(), seed: 1 }
    }

    fn noise(&mut self, sigma: f64) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.seed =
                self.seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (self.seed >> 33) as f64 / f64::from(1_u32 << 31);
        }
        sum * sigma
    }

    /// The nearest hit along a ray, m.
    fn range(&self, from: Vector2, along: Vector2, time: f64) -> f64 {
        let walls = [(0, 0.0), (0, 10.0), (1, 0.0), (1, 6.0)]
            .into_iter()
            .map(|(axis, at): (usize, f64)| (at - from[axis]) / along[axis])
            .filter(|range| *range > 1e-6);
        let people = self.people.iter().map(|(start, v)| (start + v * time, PERSON));
        let discs = self.legs.iter().copied().chain(people).filter_map(|(at, radius)| {
            let off = at - from;
            let (near, miss) = (off.dot(&along), off.perp(&along));
            (near > 0.0 && miss.abs() < radius).then(|| near - (radius * radius - miss * miss).sqrt())
        });
        walls.chain(discs).fold(f64::INFINITY, f64::min)
    }

    /// A scan of `beams` beams over `view` rad, 3 cm off at 3 m at most now and then.
    fn scan(&mut self, pose: Pose2, time: f64, (beams, view): (usize, f64)) -> Scan {
        let origin = Vector2::new(0.1, 0.0);
        let step = view / beams as f64;
        let sensor = pose.transform(origin);
        let beam = |world: &mut Self, i: usize| {
            let angle = pose.theta - view / 2.0 + i as f64 * step;
            let range = world.range(sensor, Vector2::new(angle.cos(), angle.sin()), time);
            Beam::Hit { range: range + world.noise(0.003 * range) }
        };
        let beams = (0..beams).map(|i| beam(self, i)).collect();
        Scan::new(stamp(time), origin, -view / 2.0, step, beams).unwrap()
    }
}

fn stamp(time: f64) -> Stamp {
    Stamp::from_secs(100.0 + time).unwrap()
}

const CAMERA: (usize, f64) = (320, 1.0);
const LASER: (usize, f64) = (360, std::f64::consts::TAU);

fn tracker() -> MovingObstacleTracker {
    MovingObstacleTracker::new(ObstacleTrackerConfig::default()).unwrap()
}

/// `seconds` of scans from the robot's pose, ten per second.
fn watched(
    tracker: &mut MovingObstacleTracker,
    world: &mut World,
    pose: Pose2,
    seconds: f64,
    sensor: (usize, f64),
) -> Vec<MovingObstacle> {
    let looks = (seconds * 10.0).round() as i32;
    for k in 0..=looks {
        let time = f64::from(k) * 0.1;
        tracker.add_scan(pose, &world.scan(pose, time, sensor));
    }
    tracker.moving_obstacles(stamp(seconds))
}

fn at(x: f64, y: f64) -> Vector2 {
    Vector2::new(x, y)
}

#[test]
fn two_people_are_found_where_they_are_and_will_be() {
    for sensor in [LASER, CAMERA] {
        let things = [(at(4.0, 3.2), at(-0.1, -0.5)), (at(6.5, 4.2), at(-0.5, -0.2))];
        let mut world = World::new(&things);
        let obstacles = watched(&mut tracker(), &mut world, Pose2::new(1.0, 3.0, 0.0), 2.5, sensor);
        assert_eq!(obstacles.len(), 2, "{sensor:?} {obstacles:?}");
        for (from, v) in things {
            // The present position of the obstacle, and its forecast for two seconds later.
            for (ahead, near) in [(0.0, 0.12), (2.0, 0.4)] {
                let true_place = from + v * (2.5 + ahead);
                let off = obstacles.iter().map(|m| (m.at(ahead) - true_place).norm()).fold(9.0, f64::min);
                assert!(off < near, "{off} m off {ahead} s ahead: {obstacles:?}");
            }
        }
    }
}

#[test]
fn a_person_who_approaches_the_robot_is_detected_soon() {
    let mut world = World::new(&[(at(6.0, 3.0), at(-0.8, 0.0))]);
    let mut tracker = tracker();
    let pose = Pose2::new(1.0, 3.0, 0.0);
    let first = (0..30).find(|k| {
        let time = f64::from(*k) * 0.1;
        tracker.add_scan(pose, &world.scan(pose, time, CAMERA));
        !tracker.moving_obstacles(stamp(time)).is_empty()
    });
    // A person who was present from the beginning is first detected in cells that were observed free before.
    assert!(first.is_some_and(|k| k <= 12), "{first:?}");
}

/// The robot drives and turns, its pose wrong by up to 2 cm and a degree, past walls, legs, and things that were put down.
#[test]
fn objects_that_stand_appear_or_come_into_view_are_not_movers() {
    for sensor in [LASER, CAMERA] {
        let (mut world, mut tracker) = (World::new(&[]), tracker());
        for k in 0..600 {
            let time = f64::from(k) * 0.1;
            if k == 200 {
                world.legs.push((at(5.0, 3.0), 0.3));
            }
            let angle = time * 0.4;
            let truth = Pose2::new(5.0 + 2.5 * angle.cos(), 3.0 + 1.0 * angle.sin(), angle * 1.7);
            let scan = world.scan(truth, time, sensor);
            let believed = Pose2::new(
                truth.x + world.noise(0.007),
                truth.y + world.noise(0.007),
                truth.theta + world.noise(0.006),
            );
            tracker.add_scan(believed, &scan);
            let obstacles = tracker.moving_obstacles(stamp(time));
            assert!(obstacles.is_empty(), "{time} s: {obstacles:?}");
        }
    }
}

#[test]
fn a_track_that_stops_keeps_a_forecast_for_a_while() {
    let (mut tracker, pose) = (tracker(), Pose2::new(1.0, 3.0, 0.0));
    let walks = (at(4.0, 2.0), at(0.0, 0.7));
    assert_eq!(watched(&mut tracker, &mut World::new(&[walks]), pose, 2.0, LASER).len(), 1);
    let stop = walks.0 + walks.1 * 2.0;
    let mut stands = World::new(&[(stop, Vector2::zeros())]);
    let mut looks_on = |from: i32, to: i32| {
        (from..=to).for_each(|k| {
            let time = 2.0 + f64::from(k) * 0.1;
            tracker.add_scan(pose, &stands.scan(pose, time, LASER));
        });
        tracker.moving_obstacles(stamp(2.0 + f64::from(to) * 0.1))
    };
    for obstacles in [looks_on(1, 20), looks_on(21, 80)] {
        for ahead in [0.5, 1.0, 2.0] {
            let place = stop + walks.1 * ahead;
            let off = obstacles.iter().map(|m| (m.at(0.0) - place).norm().max((m.at(2.0) - place).norm()));
            assert!(off.fold(9.0, f64::min) < 0.25, "it may be at {place} any moment: {obstacles:?}");
        }
        let behind = stop - walks.1 * 0.5;
        assert!(obstacles.iter().all(|m| (m.at(0.0) - behind).norm() > 0.4), "but not behind: {obstacles:?}");
    }
    assert_eq!(looks_on(81, 110), [], "who stands for ten seconds stays");
}

#[test]
fn a_stopped_track_that_left_is_dropped() {
    let mut tracker = tracker();
    let mut world = World::new(&[(at(4.0, 2.0), at(0.0, 0.7))]);
    let pose = Pose2::new(1.0, 3.0, 0.0);
    watched(&mut tracker, &mut world, pose, 2.0, LASER);
    let mut stands = World::new(&[(at(4.0, 3.4), Vector2::zeros())]);
    let mut empty = World::new(&[]);
    for k in 1..=35 {
        let (time, is_there) = (2.0 + f64::from(k) * 0.1, k <= 20);
        let world = if is_there { &mut stands } else { &mut empty };
        tracker.add_scan(pose, &world.scan(pose, time, LASER));
    }
    assert_eq!(tracker.moving_obstacles(stamp(5.5)), []);
}

#[test]
fn the_forecast_of_a_track_before_a_wall_ends_there() {
    let mut tracker = tracker();
    let pose = Pose2::new(1.0, 3.0, 0.0);
    let walks = (at(4.0, 3.6), at(0.0, 0.8));
    watched(&mut tracker, &mut World::new(&[walks]), pose, 2.0, LASER);
    let mut stands = World::new(&[(walks.0 + walks.1 * 2.0, Vector2::zeros())]);
    (1..=20).for_each(|k| {
        let time = 2.0 + f64::from(k) * 0.1;
        tracker.add_scan(pose, &stands.scan(pose, time, LASER));
    });
    let obstacles = tracker.moving_obstacles(stamp(4.0));
    assert!(
        !obstacles.is_empty() && obstacles.iter().all(|m| m.at(0.0).y < 6.0),
        "the wall is at 6: {obstacles:?}"
    );
}

#[test]
fn a_track_hidden_soon_after_its_stop_is_kept() {
    let mut tracker = tracker();
    let walks = (at(4.0, 1.6), at(0.0, 0.7));
    let (ahead, away) = (Pose2::new(2.5, 3.0, 0.0), Pose2::new(2.5, 3.0, -2.0));
    watched(&mut tracker, &mut World::new(&[walks]), ahead, 2.0, CAMERA);
    let stop = walks.0 + walks.1 * 2.0;
    let mut stands = World::new(&[(stop, Vector2::zeros())]);
    for k in 1..=40 {
        let time = 2.0 + f64::from(k) * 0.1;
        let pose = if k <= 7 { ahead } else { away };
        tracker.add_scan(pose, &stands.scan(pose, time, CAMERA));
    }
    let on = stop + walks.1;
    let obstacles = tracker.moving_obstacles(stamp(6.0));
    assert!(obstacles.iter().any(|m| (m.at(0.0) - on).norm() < 0.3), "they may go on to {on}: {obstacles:?}");
}

/// A person comes from the right, stops in the path and may continue to the left: the robot passes behind. If a second person comes along
/// behind as well, the robot waits.
#[test]
fn whoever_passes_one_who_stopped_goes_behind() {
    let grid = OccupancyGrid::filled(GridGeometry::new(0.05, at(0.0, 0.0), 200, 120).unwrap(), Cell::Free);
    for side in [1.0, -1.0] {
        let ways_on = [0.45, 0.9, 1.35, 1.8].map(|on| at(5.0, 3.0 + on * side));
        let ways_on = ways_on.map(|at| MovingObstacle::new(at, Vector2::zeros(), 0.25).unwrap());
        let mut with_them = grid.clone();
        for row in 0..120 {
            for col in 0..200 {
                let cell = CellIndex { col, row };
                if (with_them.geometry().center(cell) - at(5.0, 3.0)).norm() < 0.25 {
                    with_them.set(cell, Cell::Occupied);
                }
            }
        }
        let (from, goal) = (Pose2::new(4.3, 3.0, 0.0), Pose2::new(8.0, 3.0, 0.0));
        let plan =
            planner(at_home(), RADIUS).plan_among_moving(&with_them, &ways_on, from, Twist2::ZERO, goal);
        let plan = found_plan(plan);
        let beside = plan.trajectory.points().iter().find(|p| p.pose.x >= 5.0).unwrap().pose.y - 3.0;
        assert!(beside * side < -0.3, "{beside} m to the left of who goes to {side}");
    }
}

/// A camera with a blind range of `blind` (m) observes, ten times per second, people who walk until `stop` (s).
fn dim(
    tracker: &mut MovingObstacleTracker,
    world: &mut World,
    (from, to, stop): (f64, f64, f64),
    blind: f64,
) -> Vec<MovingObstacle> {
    let pose = Pose2::new(1.0, 3.0, 0.0);
    for k in (from * 10.0).round() as i32..=(to * 10.0).round() as i32 {
        let time = f64::from(k) * 0.1;
        let seen = world.scan(pose, time.min(stop), (320, 2.4));
        let dim = |beam: &Beam| match beam {
            Beam::Hit { range } if *range < blind => Beam::Unseen,
            beam => *beam,
        };
        let beams = seen.beams().iter().map(dim).collect();
        let (first, step) = (seen.angle(0), seen.angle_increment());
        tracker.add_scan(pose, &Scan::new(stamp(time), seen.origin(), first, step, beams).unwrap());
    }
    tracker.moving_obstacles(stamp(to))
}

/// New obstacles within 2 m.
fn unconfirmed_hits(tracker: &MovingObstacleTracker, now: f64) -> Vec<Vector2> {
    tracker.unconfirmed_hits(stamp(now), at(1.0, 3.0), 2.0)
}

#[test]
fn a_track_in_the_blind_range_is_kept_until_it_is_observed_to_leave() {
    let mut tracker = tracker();
    // At 1.5 s a person stops before the camera, at 0.4 m, within the blind range.
    let mut world = World::new(&[(at(1.5, 4.2), at(0.0, -0.8))]);
    dim(&mut tracker, &mut world, (0.0, 1.5, 1.5), 0.5);
    for (from, until) in [(1.6, 2.0), (2.1, 3.5), (3.6, 9.0)] {
        let obstacles = dim(&mut tracker, &mut world, (from, until, 1.5), 0.5);
        assert!(
            obstacles.iter().any(|m| (m.at(0.0) - at(1.5, 3.0)).norm() < 0.4),
            "{until} s: {obstacles:?}"
        );
    }
    // The person has left: cells observed free are free.
    assert!(!unconfirmed_hits(&tracker, 9.0).is_empty());
    world.people.clear();
    assert!(dim(&mut tracker, &mut world, (9.1, 9.5, 1.5), 0.5).is_empty());
    assert!(unconfirmed_hits(&tracker, 9.5).is_empty());
}

#[test]
fn a_partly_hidden_track_keeps_its_largest_size() {
    // Of a person who stops next to the blind zone, only the edge remains visible.
    let (mut tracker, mut world) = (tracker(), World::new(&[(at(1.5, 4.2), at(0.0, -0.8))]));
    dim(&mut tracker, &mut world, (0.0, 1.5, 1.5), 0.5);
    for k in 16..80 {
        let now = 0.1 * f64::from(k);
        for obstacle in dim(&mut tracker, &mut world, (now, now, 1.5), 0.5) {
            assert!(obstacle.radius() >= 0.2, "{now} s: {obstacle:?}");
        }
    }
}

#[test]
fn a_track_with_one_visible_edge_counts_as_present() {
    let (mut tracker, mut world) = (tracker(), World::new(&[(at(1.82, 4.2), at(0.0, -0.8))]));
    for k in 0..75 {
        let now = 0.1 * f64::from(k);
        dim(&mut tracker, &mut world, (now, now, 1.5), 0.5);
        let they = at(1.82, 4.2 - 0.8 * now.min(1.5));
        let near = unconfirmed_hits(&tracker, now)
            .iter()
            .filter(|hit| (**hit - they).norm() < PERSON + 0.05)
            .count();
        assert!(near > 3 || now < 1.0, "{now} s: {near} hits");
    }
}

#[test]
fn a_track_that_stood_in_the_present_blind_range_is_kept() {
    let mut tracker = tracker();
    let (mut nobody, mut world) = (World::new(&[]), World::new(&[(at(1.8, 3.0), at(0.0, 0.0))]));
    dim(&mut tracker, &mut nobody, (0.0, 1.0, 0.0), 0.3);
    assert!(unconfirmed_hits(&tracker, 1.0).is_empty());
    assert!(dim(&mut tracker, &mut world, (1.1, 1.8, 0.0), 0.3).is_empty(), "nobody was seen to move");
    let is_theirs = |hit: &Vector2| ((hit - at(1.8, 3.0)).norm() - PERSON).abs() < 0.03;
    for until in [2.4, 4.0, 9.0] {
        let obstacles = dim(&mut tracker, &mut world, (until - 0.4, until, 0.0), 0.9);
        assert!(
            obstacles.iter().any(|m| (m.at(0.0) - at(1.8, 3.0)).norm() < 0.3),
            "{until} s: {obstacles:?}"
        );
        assert!(obstacles.iter().all(|m| m.at(0.0) == m.at(9.0)), "they stand");
        let hits = unconfirmed_hits(&tracker, until);
        assert!(hits.len() > 3 && hits.iter().all(is_theirs), "{until} s: {hits:?}");
        assert!(
            tracker.unconfirmed_hits(stamp(until), at(1.0, 3.0), 0.4).is_empty(),
            "they are farther away"
        );
    }
    assert!(dim(&mut tracker, &mut world, (12.0, 12.4, 0.0), 0.9).is_empty(), "nobody waits for ever");
    assert!(unconfirmed_hits(&tracker, 12.4).is_empty());
    dim(&mut tracker, &mut nobody, (12.5, 13.0, 0.0), 0.3);
    assert!(dim(&mut tracker, &mut nobody, (13.1, 13.5, 0.0), 0.3).is_empty());
}

#[test]
fn new_obstacles_are_not_kept_when_scans_end_or_the_clock_is_set_back() {
    let (mut tracker, mut nobody) = (tracker(), World::new(&[]));
    let mut world = World::new(&[(at(1.8, 3.0), at(0.0, 0.0))]);
    dim(&mut tracker, &mut nobody, (100.0, 101.0, 0.0), 0.3);
    dim(&mut tracker, &mut world, (101.1, 101.8, 0.0), 0.3);
    let count = |tracker: &MovingObstacleTracker, now: f64| unconfirmed_hits(tracker, now).len();
    assert!(count(&tracker, 101.8) > 3 && count(&tracker, 111.0) == count(&tracker, 101.8));
    assert_eq!(count(&tracker, 112.0), 0, "no scan came for 10 s");
    dim(&mut tracker, &mut nobody, (0.0, 1.0, 0.0), 0.3);
    assert_eq!(count(&tracker, 1.0), 0, "the clock was set back");
    dim(&mut tracker, &mut world, (1.1, 1.8, 0.0), 0.3);
    assert!(count(&tracker, 1.8) > 3);
    for (x, reach) in [(f64::NAN, 2.0), (f64::INFINITY, 2.0), (-1e300, 2.0), (1.0, f64::NAN), (1.0, -1.0)] {
        assert!(tracker.unconfirmed_hits(stamp(1.8), at(x, 3.0), reach).is_empty(), "{reach} m about {x}");
    }
    assert!(tracker.unconfirmed_hits(stamp(1.8), at(1.0, 3.0), f64::INFINITY).len() > 3);
}

#[test]
fn scans_from_the_past_and_wrong_numbers_change_nothing() {
    let (mut tracker, pose) = (tracker(), Pose2::new(1.0, 3.0, 0.0));
    let mut world = World::new(&[(at(4.0, 2.0), at(0.0, 0.7))]);
    let obstacles = watched(&mut tracker, &mut world, pose, 2.0, LASER);
    assert_eq!(obstacles.len(), 1);
    tracker.add_scan(pose, &world.scan(pose, 1.0, LASER));
    tracker.add_scan(Pose2 { x: f64::NAN, ..pose }, &world.scan(pose, 2.1, LASER));
    tracker.add_scan(Pose2 { y: 1e300, ..pose }, &world.scan(pose, 2.1, LASER));
    let since = Stamp::default().after(-60.0);
    let old = world.scan(pose, 2.1, LASER);
    let old =
        Scan::new(since, old.origin(), old.angle(0), old.angle_increment(), old.beams().to_vec()).unwrap();
    tracker.add_scan(Pose2 { x: f64::NAN, ..pose }, &old);
    assert_eq!(tracker.moving_obstacles(stamp(2.0)), obstacles);
    let wrong: [fn(&mut ObstacleTrackerConfig); 3] =
        [|c| c.memory = f64::NAN, |c| c.sightings = 1, |c| c.reach = 1e9];
    for set in wrong {
        let mut config = ObstacleTrackerConfig::default();
        set(&mut config);
        assert!(MovingObstacleTracker::new(config).is_err());
    }
}

/// The map of the area, with the cells drawn for people.
fn map(drawn: &[(Vector2, f64)]) -> OccupancyGrid {
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), 200, 120).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    for linear in 0..geometry.len() {
        let CellIndex { col, row } = geometry.cell(linear);
        let centre = geometry.center(CellIndex { col, row });
        let is_wall = col == 0 || row == 0 || col == 199 || row == 119;
        if is_wall || drawn.iter().any(|(at, radius)| (centre - at).norm() < *radius) {
            grid.set(CellIndex { col, row }, Cell::Occupied);
        }
    }
    grid
}

#[test]
fn an_observed_crossing_person_is_waited_for() {
    let (pose, goal) = (Pose2::new(1.0, 3.0, 0.0), Pose2::new(6.0, 3.0, 0.0));
    let crosses = (at(2.2, 0.9), at(0.0, 0.7));
    let (mut tracker, mut world) = (tracker(), World::new(&[crosses]));
    let obstacles = watched(&mut tracker, &mut world, pose, 2.0, LASER);
    assert_eq!(obstacles.len(), 1);
    let now = crosses.0 + crosses.1 * 2.0;
    // The map contains the people at their present and their earlier positions.
    let seen = map(&[(now, PERSON), (now - at(0.0, 0.5), PERSON)]);
    let still = tracker.static_grid(&seen);
    let left = still.cells().iter().zip(map(&[]).cells()).filter(|(a, b)| a != b).count();
    assert!(left <= 12, "{left} cells of someone who has left");
    let twist = Twist2::new(0.4, 0.0);
    let mut planner = planner(at_home(), RADIUS);
    let direct = found_plan(planner.plan(&still, pose, twist, goal));
    assert!(planner.first_encounter(&direct.trajectory, 0.0, &obstacles).is_some_and(|time| time < 2.0));
    let plan = found_plan(planner.plan_among_moving(&still, &obstacles, pose, twist, goal));
    judge(&still, &plan, pose, goal, RADIUS);
    assert!(plan.is_continuous && planner.first_encounter(&plan.trajectory, 0.0, &obstacles).is_none());
    let gap = |k: i32| {
        let time = f64::from(k) * 0.01;
        (plan.trajectory.at(time).pose.position() - now - crosses.1 * time).norm() - PERSON - RADIUS
    };
    let min = (0..=200).map(gap).fold(9.0, f64::min);
    assert!(min > 0.0, "{min}");
}

#[test]
fn a_wall_beside_someone_stays() {
    let (mut tracker, pose) = (tracker(), Pose2::new(1.0, 3.0, 0.0));
    // Along the upper wall, 5 cm from it.
    let walks = (at(3.0, 5.7), at(0.8, 0.0));
    assert_eq!(watched(&mut tracker, &mut World::new(&[walks]), pose, 2.0, LASER).len(), 1);
    let still = tracker.static_grid(&map(&[]));
    let gone: Vec<_> =
        (0..still.cells().len()).filter(|i| still.cells()[*i] != map(&[]).cells()[*i]).collect();
    assert!(gone.is_empty(), "{:?}", gone.iter().map(|i| still.geometry().cell(*i)).collect::<Vec<_>>());
}

#[test]
fn a_scan_costs_little() {
    let (mut tracker, mut world) = (tracker(), World::new(&[(at(4.0, 2.0), at(0.0, 0.7))]));
    let pose = Pose2::new(1.0, 3.0, 0.0);
    let mut min = f64::INFINITY;
    for k in 0..30 {
        let scan = world.scan(pose, f64::from(k) * 0.1, (640, 1.0));
        let begin = cpu_ms();
        tracker.add_scan(pose, &scan);
        min = min.min(cpu_ms() - begin);
    }
    eprintln!("obstacles: a scan of 640 beams {min:.3} ms CPU");
    // A debug build is ten times slower.
    assert!(min < 5.0, "{min}");
}
