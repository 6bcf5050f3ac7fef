//! A robot, and a checker that shares no code with the planner: it measures trajectories against the grid's squares.

use trundle_core::{
    Cell, DifferentialDrive, DriveLimits, Footprint, OccupancyGrid, Pose2, Twist2, Vector2, wrap_angle,
};
use trundle_planning::{Plan, PlanResult, Planner, PlannerConfig};

pub const LIMITS: DriveLimits = DriveLimits::KOBUKI;
pub const HALF_BASE: f64 = 0.115;

pub fn planner(config: PlannerConfig, radius: f64) -> Planner {
    Planner::new(config, &Footprint::Disc { radius }, LIMITS, DifferentialDrive::KOBUKI).unwrap()
}

/// Never off the grid.
pub fn at_home() -> PlannerConfig {
    let mut config = PlannerConfig::default();
    config.beyond = 0.0;
    config
}

pub fn found_plan(plan: Plan) -> Box<PlanResult> {
    match plan {
        Plan::Found(result) => result,
        other => panic!("no way: {other:?}"),
    }
}

/// The distance from a point to the nearest occupied square within 1 m, by looking at every cell.
pub fn clearance(grid: &OccupancyGrid, point: Vector2) -> f64 {
    let geometry = grid.geometry();
    let reach = (1.0 / geometry.resolution) as i64 + 1;
    let at = (point - geometry.origin) / geometry.resolution;
    let (c0, r0) = (at.x.floor() as i64, at.y.floor() as i64);
    let mut best = 1.0_f64;
    for row in (r0 - reach).max(0)..(r0 + reach + 1).min(geometry.height as i64) {
        for col in (c0 - reach).max(0)..(c0 + reach + 1).min(geometry.width as i64) {
            if grid.cells()[(row * geometry.width as i64 + col) as usize] == Cell::Occupied {
                let low = geometry.origin + Vector2::new(col as f64, row as f64) * geometry.resolution;
                let high = low + Vector2::repeat(geometry.resolution);
                let nearest = point.sup(&low).inf(&high);
                best = best.min((point - nearest).norm());
            }
        }
    }
    best
}

/// Least distance of a trajectory's centre from obstacles, m.
pub fn min_clearance(grid: &OccupancyGrid, result: &PlanResult) -> f64 {
    let mut at = Vector2::repeat(f64::INFINITY);
    let mut min = f64::INFINITY;
    for point in result.trajectory.points() {
        let position = point.pose.position();
        if (position - at).norm() > 0.002 {
            at = position;
            min = min.min(clearance(grid, position));
        }
    }
    min
}

/// Checks the properties of every plan: ends, limits, rest, clearance, and the agreement of pose and twist.
pub fn judge(grid: &OccupancyGrid, result: &PlanResult, start: Pose2, goal: Pose2, radius: f64) {
    let points = result.trajectory.points();
    let (first, last) = (points[0], points[points.len() - 1]);
    assert!(first.pose.distance(&start) < 1e-6 && wrap_angle(first.pose.theta - start.theta).abs() < 1e-6);
    assert!(last.pose.distance(&goal) < 1.1e-3, "{last:?} {goal:?}");
    assert!(wrap_angle(last.pose.theta - goal.theta).abs() < 1e-5, "{last:?} {goal:?}");
    assert_eq!(last.twist, Twist2::ZERO);
    assert!(min_clearance(grid, result) >= radius - 2e-4, "{} m of {radius}", min_clearance(grid, result));
    for point in points {
        let Twist2 { v, omega } = point.twist;
        assert!((0.0..=LIMITS.v + 1e-9).contains(&v), "{point:?}");
        assert!(omega.abs() <= LIMITS.omega * 1.01, "{point:?}");
        assert!(v + HALF_BASE * omega.abs() <= LIMITS.wheel_speed * 1.01, "{point:?}");
    }
    for pair in points.windows(2) {
        let dt = pair[1].time - pair[0].time;
        assert!(dt <= 0.0201 + 1e-9, "{pair:?}");
        assert!(
            (pair[1].twist.v - pair[0].twist.v).abs() <= LIMITS.acceleration * dt * 1.02 + 1e-6,
            "{pair:?}"
        );
        let turn = (pair[1].twist.omega - pair[0].twist.omega).abs();
        assert!(turn <= LIMITS.angular_acceleration * dt * 1.25 + 0.02, "{turn} in {dt}: {pair:?}");
        let mean = Twist2::new(
            (pair[0].twist.v + pair[1].twist.v) / 2.0,
            (pair[0].twist.omega + pair[1].twist.omega) / 2.0,
        );
        let arrived = pair[0].pose.advance(mean, dt);
        assert!(arrived.distance(&pair[1].pose) < 5e-4, "{pair:?}");
        assert!(wrap_angle(arrived.theta - pair[1].pose.theta).abs() < 1e-2, "{pair:?}");
    }
}

/// CPU time of this thread, ms; meaningful on a busy machine too.
pub fn cpu_ms() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 * 1e3 + time.tv_nsec as f64 * 1e-6
}
