//! A stop on the way: how a robot that moves lets something pass.

use crate::movers::{Mover, conflict, paused};
use crate::plan::PlanResult;
use crate::route::Phase;
use crate::task::Task;
use crate::timing::trajectory_with_stop;
use trundle_core::Trajectory;

/// Places to stop that are tried, from as soon as the robot can to the encounter.
const PLACES: usize = 8;

impl Task<'_> {
    /// The plan's phases with a stop on the first curve, and a wait there, after which no mover is met; and the wait, s. Of the
    /// places that are tried, the one that arrives first.
    pub(crate) fn halted(&self, plan: &PlanResult, movers: &[Mover]) -> Option<(Trajectory, f64)> {
        let radius = self.body.radius;
        let encounter = conflict(&plan.trajectory, 0.0, movers, radius)?;
        let Phase::Drive(curve) = plan.phases.first()? else { return None };
        let first = plan.trajectory.points()[0];
        let (v, curvature) = (first.twist.v, first.twist.omega / first.twist.v.max(1e-9));
        let soonest = v * v / (2.0 * self.drive.acceleration(curvature));
        let steps = plan.trajectory.points().windows(2).take_while(|pair| pair[1].time <= encounter);
        let until: f64 = steps.map(|pair| pair[0].pose.distance(&pair[1].pose)).sum();
        let latest = until.min(curve.length());
        let stop_at = |k: usize| soonest + (latest - soonest).max(0.0) * k as f64 / (PLACES - 1) as f64;
        (0..PLACES)
            .filter_map(|k| {
                let ceiling = |pose| self.ceiling(pose);
                let (trajectory, time) =
                    trajectory_with_stop(first.pose, &plan.phases, v, self.drive, ceiling, stop_at(k))?;
                paused(&trajectory, time, movers, radius)
            })
            .min_by(|a, b| a.0.duration().total_cmp(&b.0.duration()))
    }
}
