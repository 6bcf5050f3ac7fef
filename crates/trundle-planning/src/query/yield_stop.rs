//! A stop on the path until a moving obstacle has passed.

use crate::curve::phase::Phase;
use crate::moving_obstacles::forecast::{MovingObstacle, first_encounter_of, paused};
use crate::plan::PlanResult;
use crate::query::plan_query::PlanQuery;
use crate::timing::trajectory::trajectory_with_stop;
use trundle_core::Trajectory;

/// Number of stop positions that are tried, from the earliest possible stop to the encounter. Source: ours.
const STOP_CANDIDATES: usize = 8;

/// The plan's phases with a stop and a wait on the first curve, after which no moving obstacle crosses the curve; and the wait, s. Among the
/// candidates, the one with the earliest arrival is chosen.
pub(crate) fn with_yield_stop(
    query: &PlanQuery<'_>,
    plan: &PlanResult,
    obstacles: &[MovingObstacle],
) -> Option<(Trajectory, f64)> {
    let radius = query.shape.radius;
    let encounter = first_encounter_of(&plan.trajectory, 0.0, obstacles, radius)?;
    let Phase::Drive(curve) = plan.phases.first()? else { return None };
    let first = plan.trajectory.points()[0];
    let (v, curvature) = (first.twist.v, first.twist.omega / first.twist.v.max(1e-9));
    let soonest = v * v / (2.0 * query.drive.acceleration(curvature));
    let steps = plan.trajectory.points().windows(2).take_while(|pair| pair[1].time <= encounter);
    let until: f64 = steps.map(|pair| pair[0].pose.distance(&pair[1].pose)).sum();
    let latest = until.min(curve.length());
    let stop_at = |k: usize| soonest + (latest - soonest).max(0.0) * k as f64 / (STOP_CANDIDATES - 1) as f64;
    (0..STOP_CANDIDATES)
        .filter_map(|k| {
            let ceiling = |pose| query.ceiling(pose);
            let (trajectory, time) =
                trajectory_with_stop(first.pose, &plan.phases, v, query.drive, ceiling, stop_at(k))?;
            paused(&trajectory, time, obstacles, radius)
        })
        .min_by(|a, b| a.0.duration().total_cmp(&b.0.duration()))
}
