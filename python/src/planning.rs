//! Plans on an occupancy grid.

use crate::arrays::{from_list, from_rows};
use crate::errors::value_error;
use crate::grid::OccupancyGrid;
use crate::numbers::{footprint, pose2, twist};
use crate::robot_config::robot_config;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use trundle::core::{Path, Trajectory, Twist2, Vector2};
use trundle::planning::{Plan, PlanResult, Planner};

/// Plans a path with timing from `start` to rest at `goal`, both (3,): x m, y m, theta rad, map frame.
///
/// `footprint` is a radius in m, or the corners (N, 2) m of a convex polygon, by default that of `config`; `start_twist` (v m/s, omega
/// rad/s); `config` is a `RobotConfig`, by default a Kobuki.
///
/// Returns a dictionary with the same keys for every outcome: `found`; `outcome` ("found", "blocked", "start_in_obstacle",
/// "goal_in_obstacle", "start_outside", "goal_outside"); `message`, a sentence; `nearest` (2,) m, the reachable point nearest to an
/// unreachable goal, else None; `waypoints` (N, 2) m; `cells` (M, 2) m, the path of the search; and the trajectory: `time` (K,) s, `poses`
/// (K, 3), `twists` (K, 2), `duration` s, `length` m, `min_clearance` m.
///
/// >>> room = trundle.OccupancyGrid.from_ascii(0.25, "............\n" * 4 + "............")
/// >>> plan = trundle.plan(room, start=(0.5, 0.6, 0), goal=(2.4, 0.6, 0), footprint=0.17)
/// >>> plan["found"], plan["poses"].shape[1], round(plan["length"], 2)
/// (True, 3, 1.9)
/// >>> wall = trundle.OccupancyGrid.from_ascii(0.25, "............\n......#.....\n............")
/// >>> trundle.plan(wall, (0.5, 0.3, 0), (1.6, 0.3, 0), 0.17)["outcome"]
/// 'goal_in_obstacle'
#[pyfunction]
#[pyo3(signature = (grid, start, goal, footprint=None, *, start_twist=None, config=None))]
pub fn plan<'py>(
    py: Python<'py>,
    grid: &Bound<'py, OccupancyGrid>,
    start: &Bound<'py, PyAny>,
    goal: &Bound<'py, PyAny>,
    footprint: Option<&Bound<'py, PyAny>>,
    start_twist: Option<&Bound<'py, PyAny>>,
    config: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (start, goal) = (pose2(start, "start")?, pose2(goal, "goal")?);
    let start_twist = start_twist.map_or(Ok(Twist2::ZERO), |object| twist(object, "start_twist"))?;
    let robot = robot_config(config)?;
    let outline = match footprint {
        Some(object) => self::footprint(object)?,
        None => robot.footprint().map_err(value_error)?,
    };
    let grid = &grid.get().grid;
    let plan = py.detach(|| {
        let mut planner = Planner::new(robot.planning, &outline, robot.limits, robot.drive)?;
        Ok(planner.plan(grid, start, start_twist, goal))
    });
    plan_dict(py, &plan.map_err(|invalid: trundle::core::Invalid| value_error(invalid))?)
}

/// The plan as a dictionary, the same keys for every outcome.
fn plan_dict<'py>(py: Python<'py>, plan: &Plan) -> PyResult<Bound<'py, PyDict>> {
    if let Plan::Refused(invalid) = plan {
        return Err(value_error(invalid));
    }
    let dict = PyDict::new(py);
    let found = found(plan);
    let reached = matches!(plan, Plan::Found(result) if result.instead_of.is_none());
    dict.set_item("found", reached)?;
    dict.set_item("outcome", outcome(plan))?;
    dict.set_item("message", plan.to_string())?;
    dict.set_item("nearest", nearest(plan).map(|point| from_list(py, vec![point.x, point.y])))?;
    let points = |path: Option<&Path>| {
        let points = path.map_or(&[][..], Path::points);
        from_rows(py, points.iter().map(|p| [p.x, p.y]).collect::<Vec<[f64; 2]>>())
    };
    dict.set_item("waypoints", points(found.map(|plan| &plan.waypoints))?)?;
    dict.set_item("cells", points(found.map(|plan| &plan.raw))?)?;
    set_trajectory(&dict, found.map(|plan| &plan.trajectory))?;
    dict.set_item("length", found.map_or(0.0, |plan| plan.length))?;
    dict.set_item("min_clearance", found.map_or(f64::NAN, |plan| plan.min_clearance))?;
    Ok(dict)
}

/// Sets `time`, `poses`, `twists` and `duration`.
fn set_trajectory(dict: &Bound<'_, PyDict>, trajectory: Option<&Trajectory>) -> PyResult<()> {
    let py = dict.py();
    let points = trajectory.map_or(&[][..], Trajectory::points);
    dict.set_item("time", from_list(py, points.iter().map(|point| point.time).collect()))?;
    let poses: Vec<[f64; 3]> = points.iter().map(|p| [p.pose.x, p.pose.y, p.pose.theta]).collect();
    dict.set_item("poses", from_rows(py, poses)?)?;
    let twists: Vec<[f64; 2]> = points.iter().map(|p| [p.twist.v, p.twist.omega]).collect();
    dict.set_item("twists", from_rows(py, twists)?)?;
    dict.set_item("duration", trajectory.map_or(0.0, Trajectory::duration))
}

fn found(plan: &Plan) -> Option<&PlanResult> {
    match plan {
        Plan::Found(result) => Some(result),
        _ => None,
    }
}

fn outcome(plan: &Plan) -> &'static str {
    match plan {
        Plan::Found(result) => result.instead_of.as_ref().map_or("found", outcome),
        Plan::Blocked { .. } => "blocked",
        Plan::StartInObstacle { .. } => "start_in_obstacle",
        Plan::GoalInObstacle { .. } => "goal_in_obstacle",
        Plan::StartOutside => "start_outside",
        Plan::GoalOutside => "goal_outside",
        Plan::Refused(_) => "refused",
    }
}

/// The reachable point nearest to an unreachable goal.
fn nearest(plan: &Plan) -> Option<Vector2> {
    match plan {
        Plan::Blocked { nearest } => Some(*nearest),
        Plan::Found(result) => result.instead_of.as_ref().and_then(nearest_of),
        _ => None,
    }
}

fn nearest_of(plan: &Plan) -> Option<Vector2> {
    if let Plan::Blocked { nearest } = plan { Some(*nearest) } else { None }
}
