//! The whole robot: sensor events in, twists and poses out.

use crate::errors::value_error;
use crate::event_kinds::event_of;
use crate::geometry::{matrix, pose2_array, twist_array};
use crate::grid::OccupancyGrid;
use crate::numbers::{pose2, seconds};
use crate::robot_config::robot_config;
use crate::scan::Scan;
use crate::track::Track;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};
use trundle::runtime::{Mission, Robot as Whole, StepReport, Task};

/// The whole robot on any body: sensor events in, twists and poses out. The base's first pose is the map's origin.
///
/// `config` is a `RobotConfig`, by default a Kobuki with a Kinect V2.
///
/// >>> body = trundle.Simulator("demo", seed=1)
/// >>> robot = trundle.Robot()
/// >>> robot.drive_to((0.5, 0, 0))
/// >>> while body.stamp < 0.5:
/// ...     step = robot.step(body.next_event())
/// ...     if step.twist is not None:
/// ...         body.command(step.twist)
/// >>> step.state, robot.pose.shape
/// ('initializing', (3,))
#[pyclass(module = "trundle")]
pub struct Robot {
    /// The lock makes the type usable across threads; pyo3 allows one thread at a time.
    robot: Mutex<Whole>,
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (config=None))]
    fn new(config: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let config = robot_config(config)?;
        Ok(Self { robot: Mutex::new(Whole::new(config).map_err(value_error)?) })
    }

    /// Processes one sensor event by rising stamp: `Wheels`, `Gyro`, `Rgbd`, `Scan`, `Touch`, `Cliff`, `Odometry`, `BodyCondition` or
    /// `Truth`.
    ///
    /// An image takes a few milliseconds, a plan some tens. Send the twist of the result to the base.
    fn step(&mut self, py: Python<'_>, event: &Bound<'_, PyAny>) -> PyResult<Step> {
        let event = event_of(event)?;
        let robot = self.robot();
        let report = py.detach(|| robot.step(&event));
        Ok(Step { stamp_s: seconds(event.stamp()), report })
    }

    /// Gives the robot one goal pose, map frame: x m, y m, theta rad.
    fn drive_to(&mut self, goal: &Bound<'_, PyAny>) -> PyResult<()> {
        self.robot().drive_to(pose2(goal, "goal")?).map_err(value_error)
    }

    /// Makes the robot explore until its map is complete and, with `and_return`, return to its start.
    #[pyo3(signature = (and_return=false))]
    fn explore(&mut self, and_return: bool) -> PyResult<()> {
        let mut tasks = vec![Task::Explore];
        tasks.extend(and_return.then_some(Task::Return));
        self.robot().begin(&Mission::new(tasks).map_err(value_error)?);
        Ok(())
    }

    /// Cancels the mission: the robot brakes to rest.
    fn stop(&mut self) {
        self.robot().begin(&Mission::default());
    }

    /// `map_from_base`, (3,): x m, y m, theta rad.
    #[getter]
    fn pose<'py>(&mut self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.robot().estimate().pose)
    }

    /// Covariance of the pose as a right perturbation (m, m, rad), (3, 3).
    #[getter]
    fn covariance<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.robot().estimate().covariance)
    }

    /// The map: a copy.
    fn grid(&mut self) -> OccupancyGrid {
        OccupancyGrid { grid: self.robot().grid().clone() }
    }

    /// The newest scan; None before the first.
    fn scan(&mut self) -> Option<Scan> {
        self.robot().scan().map(|scan| Scan { scan: scan.clone() })
    }

    /// Way-points of the newest plan, map frame, m, (N, 2); None without a plan.
    fn waypoints<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let points = |plan: &trundle::planning::PlanResult| {
            let points = plan.waypoints.points().iter().map(|p| [p.x, p.y]);
            crate::arrays::from_rows(py, points.collect::<Vec<[f64; 2]>>())
        };
        self.robot().plan().map(points).transpose()
    }

    fn __repr__(&mut self) -> String {
        let pose = self.robot().estimate().pose;
        format!("Robot(at ({:.3}, {:.3}) m, {:.1} deg)", pose.x, pose.y, pose.theta.to_degrees())
    }
}

impl Robot {
    fn robot(&mut self) -> &mut Whole {
        self.robot.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Result of a sensor event.
///
/// >>> step = trundle.Robot().step(trundle.Wheels(0.0, 0, 0))
/// >>> step.state, step.twist.tolist(), step.is_finished
/// ('idle', [0.0, 0.0], False)
#[pyclass(frozen, module = "trundle")]
pub struct Step {
    stamp_s: f64,
    report: StepReport,
}

#[pymethods]
impl Step {
    /// Stamp of the event, s.
    #[getter]
    fn stamp(&self) -> f64 {
        self.stamp_s
    }

    /// Command for the base, (2,): v m/s, omega rad/s; None for a step without a command.
    #[getter]
    fn twist<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.report.twist.map(|twist| twist_array(py, twist))
    }

    /// `map_from_base` after the step, (3,): x m, y m, theta rad.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.report.estimate.map(|estimate| pose2_array(py, estimate.pose))
    }

    /// Covariance of the pose as a right perturbation (m, m, rad), (3, 3).
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.report.estimate.map(|estimate| matrix(py, &estimate.covariance)).transpose()
    }

    /// State of the robot: "idle", "initializing", "planning", "driving", "final approach", "maneuvering", "waiting", "recovering", "lost", "arrived", "stopped".
    #[getter]
    fn state(&self) -> &'static str {
        self.report.state.name()
    }

    /// Reason why the robot stops; None in a state without a reason.
    #[getter]
    fn reason(&self) -> Option<String> {
        self.report.state.reason().map(ToString::to_string)
    }

    /// Result of the visual tracker on an image, else None.
    #[getter]
    fn track(&self) -> Option<Track> {
        self.report.track.clone().map(|report| Track { report })
    }

    /// Whether the step made a new plan.
    #[getter]
    fn is_replanned(&self) -> bool {
        self.report.replanned
    }

    /// Whether the mission is over; `state` is then its outcome.
    #[getter]
    fn is_finished(&self) -> bool {
        self.report.finished
    }

    fn __repr__(&self) -> String {
        format!("Step(stamp={}, state='{}')", self.stamp_s, self.report.state)
    }
}
