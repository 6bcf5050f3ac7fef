//! Manoeuvres of turns and straight moves onto a pose in a tight place.

use crate::arrays::{array, from_list, from_rows, slice};
use crate::errors::value_error;
use crate::grid::OccupancyGrid;
use crate::numbers::{footprint, pose2, wrong_type};
use crate::robot_config::robot_config;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use trundle::app::dock::{DockingResult, DockingTask};
use trundle::core::{Footprint, Pose2, Vector2};
use trundle::docking::{DockingPlan, Motion, Obstacle, ObstacleScene, Solution};

/// Plans turns in place and straight moves from `start` to `goal`, both (3,): x m, y m, theta rad, exact for the footprint.
///
/// `obstacles` is an `OccupancyGrid`, or a list of float64 arrays (corners, 2) m: one row is a point, two a wall, more a convex polygon.
/// `footprint` is a radius in m, or the corners (N, 2) m of a convex polygon, by default that of `config`; `margin` m is the distance from
/// every obstacle; `unknown_is_free` states whether unknown cells are free; `config` is a `RobotConfig`, by default a Kobuki.
///
/// Returns a dictionary with the same keys for every outcome: `found`; `outcome` ("found", "impossible", "refused"); `message`, a sentence;
/// `kinds`, a list of "turn" and "drive"; `amounts` (N,) rad or m; `starts` and `durations` (N,) s; `poses` (N + 1, 3); `duration` s;
/// `bound` s, the lower bound of the duration of any manoeuvre with this margin; `margin` m of the result.
///
/// >>> import numpy as np
/// >>> walls = [np.array([[-2.0, y], [2.0, y]]) for y in (-0.45, 0.45)]
/// >>> box = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)]
/// >>> found = trundle.dock(walls, start=(0, -0.1, 0), goal=(0, 0.1, 0), footprint=box)
/// >>> found["found"], found["bound"] <= found["duration"] + 1e-9
/// (True, True)
#[pyfunction]
#[pyo3(signature = (obstacles, start, goal, footprint=None, *, margin=None, unknown_is_free=false, config=None))]
#[expect(clippy::too_many_arguments, reason = "options by name in Python")]
pub fn dock<'py>(
    py: Python<'py>,
    obstacles: &Bound<'py, PyAny>,
    start: &Bound<'py, PyAny>,
    goal: &Bound<'py, PyAny>,
    footprint: Option<&Bound<'py, PyAny>>,
    margin: Option<f64>,
    unknown_is_free: bool,
    config: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (start, goal) = (pose2(start, "start")?, pose2(goal, "goal")?);
    let robot = robot_config(config)?;
    let mut planner = robot.docking.planner.clone();
    planner.margin = margin.unwrap_or(planner.margin);
    let outline = match footprint {
        Some(object) => self::footprint(object)?,
        None => robot.footprint().map_err(value_error)?,
    };
    let scene = match obstacles.cast::<OccupancyGrid>() {
        Ok(grid) => {
            let (center, half) = planner.view(&outline, &start, &goal);
            ObstacleScene::from_grid(&grid.get().grid, center, half, !unknown_is_free)
        }
        Err(_) => ObstacleScene::new(&list_of(obstacles)?).map_err(value_error)?,
    };
    let refusal = off_map(obstacles, start, goal);
    let task = task(outline, (start, goal), scene, refusal);
    let result = py.detach(|| DockingResult::of(&task, planner)).map_err(value_error)?;
    docking_dict(py, &result, start)
}

/// A sentence if start or goal are off the map.
fn off_map(obstacles: &Bound<'_, PyAny>, start: Pose2, goal: Pose2) -> Option<String> {
    let grid = obstacles.cast::<OccupancyGrid>().ok()?;
    let is_off = |pose: &Pose2| grid.get().grid.geometry().cell_at(pose.position()).is_none();
    let (name, Pose2 { x, y, .. }) =
        [("start", start), ("goal", goal)].into_iter().find(|(_, pose)| is_off(pose))?;
    Some(format!("the {name} ({x:.2}, {y:.2}) m is off the map"))
}

fn task(
    footprint: Footprint,
    (start, goal): (Pose2, Pose2),
    scene: ObstacleScene,
    refusal: Option<String>,
) -> DockingTask {
    let name = "python".to_owned();
    DockingTask { name, footprint, start, goal, scene, grid: None, problem: None, refusal }
}

/// Obstacles of arrays (corners, 2): one row is a point, two are a wall, more are a convex polygon.
fn list_of(object: &Bound<'_, PyAny>) -> PyResult<Vec<Obstacle>> {
    const EXPECTED: &str =
        "an OccupancyGrid, or a list of arrays of shape (corners, 2): point, wall or convex polygon";
    let list: Vec<Bound<'_, PyAny>> =
        object.extract().map_err(|_| wrong_type(object, "obstacles", EXPECTED))?;
    list.iter().enumerate().map(|(i, item)| obstacle(item, &format!("obstacles[{i}]"))).collect()
}

fn obstacle(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Obstacle> {
    let array = array::<f64, numpy::Ix2>(object, name, "(corners, 2)")?;
    if array.shape()[1] != 2 || array.shape()[0] == 0 {
        let found = array.shape();
        return Err(value_error(format!(
            "{name} has shape {found:?}, expected (1, 2) for a point, (2, 2) for a wall, (3 or more, 2) for a polygon, m"
        )));
    }
    let corners: Vec<Vector2> =
        slice(&array, name)?.as_chunks::<2>().0.iter().map(|p| Vector2::new(p[0], p[1])).collect();
    Ok(match corners[..] {
        [point] => Obstacle::Point(point),
        [from, to] => Obstacle::Segment(from, to),
        _ => Obstacle::Polygon(corners),
    })
}

/// The result as a dictionary, the same keys for every outcome.
fn docking_dict<'py>(py: Python<'py>, result: &DockingResult, start: Pose2) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let outcome = match result {
        DockingResult::Planned(DockingPlan::Found(_)) => "found",
        DockingResult::Planned(DockingPlan::Impossible(_)) => "impossible",
        DockingResult::Refused(_) => "refused",
    };
    let message = match (result, result.found()) {
        (_, Some(found)) => trundle::app::dock::verdict(found),
        (DockingResult::Refused(why), _) => why.clone(),
        _ => result.report(0.0).1,
    };
    dict.set_item("found", outcome == "found")?;
    dict.set_item("outcome", outcome)?;
    dict.set_item("message", message)?;
    set_steps(&dict, result.found(), start)?;
    let number = |of: fn(&Solution) -> f64| result.found().map_or(f64::NAN, of);
    dict.set_item("duration", number(|found| found.manoeuvre.duration()))?;
    dict.set_item("bound", number(|found| found.bound))?;
    dict.set_item("margin", number(|found| found.margin))?;
    Ok(dict)
}

/// Sets `kinds`, `amounts`, `starts`, `durations` and `poses`.
fn set_steps(dict: &Bound<'_, PyDict>, found: Option<&Solution>, start: Pose2) -> PyResult<()> {
    let py = dict.py();
    let steps = found.map_or(&[][..], |found| found.manoeuvre.steps());
    let kinds =
        steps.iter().map(|step| if matches!(step.motion, Motion::Turn(_)) { "turn" } else { "drive" });
    dict.set_item("kinds", kinds.collect::<Vec<_>>())?;
    dict.set_item("amounts", from_list(py, steps.iter().map(|step| step.motion.amount()).collect()))?;
    dict.set_item("starts", from_list(py, steps.iter().map(|step| step.starts).collect()))?;
    dict.set_item("durations", from_list(py, steps.iter().map(|step| step.lasts).collect()))?;
    let row = |pose: Pose2| [pose.x, pose.y, pose.theta];
    let first = found.map(|_| row(start));
    let poses = first.into_iter().chain(steps.iter().map(|step| row(step.to)));
    dict.set_item("poses", from_rows(py, poses.collect::<Vec<[f64; 3]>>())?)
}
