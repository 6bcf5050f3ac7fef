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
use trundle::runtime::{Mission, Robot as Whole, StepReport, Task};

/// The whole robot on any body.
#[pyclass(module = "trundle")]
pub struct Robot {
    robot: Whole,
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (config=None))]
    fn new(config: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let config = robot_config(config)?;
        Ok(Self { robot: Whole::new(config).map_err(value_error)? })
    }

    /// One sensor event through the whole robot.
    fn step(&mut self, py: Python<'_>, event: &Bound<'_, PyAny>) -> PyResult<Step> {
        let event = event_of(event)?;
        let report = py.detach(|| self.robot.step(&event));
        Ok(Step { stamp_s: seconds(event.stamp()), report })
    }

    /// Gives the robot one goal pose, map frame.
    fn drive_to(&mut self, goal: &Bound<'_, PyAny>) -> PyResult<()> {
        self.robot.drive_to(pose2(goal, "goal")?).map_err(value_error)
    }

    /// Lets the robot explore until its map is complete, then return to its start if asked to.
    #[pyo3(signature = (and_return=false))]
    fn explore(&mut self, and_return: bool) -> PyResult<()> {
        let mut tasks = vec![Task::Explore];
        tasks.extend(and_return.then_some(Task::Return));
        self.robot.begin(&Mission::new(tasks).map_err(value_error)?);
        Ok(())
    }

    /// Drops what is left of the mission: the robot brakes to rest.
    fn stop(&mut self) {
        self.robot.begin(&Mission::default());
    }

    /// `map_from_base`.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.robot.estimate().pose)
    }

    /// Covariance of the pose as a right perturbation.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.robot.estimate().covariance)
    }

    /// The map.
    fn grid(&self) -> OccupancyGrid {
        OccupancyGrid { grid: self.robot.grid().clone() }
    }

    /// The newest scan; None before the first.
    fn scan(&self) -> Option<Scan> {
        self.robot.scan().map(|scan| Scan { scan: scan.clone() })
    }

    /// Way-points of the newest plan, m, map frame; None where there is none.
    fn waypoints<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let points = |plan: &trundle::planning::PlanResult| {
            let points = plan.waypoints.points().iter().map(|p| [p.x, p.y]);
            crate::arrays::from_rows(py, points.collect::<Vec<[f64; 2]>>())
        };
        self.robot.plan().map(points).transpose()
    }

    fn __repr__(&self) -> String {
        let pose = self.robot.estimate().pose;
        format!("Robot(at ({:.3}, {:.3}) m, {:.1} deg)", pose.x, pose.y, pose.theta.to_degrees())
    }
}

/// The report of a step.
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

    /// v m/s, omega rad/s for the base; None where the step commands nothing.
    #[getter]
    fn twist<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.report.twist.map(|twist| twist_array(py, twist))
    }

    /// `map_from_base` after the step: x m, y m, theta rad.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.report.estimate.map(|estimate| pose2_array(py, estimate.pose))
    }

    /// Covariance of the pose as a right perturbation.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.report.estimate.map(|estimate| matrix(py, &estimate.covariance)).transpose()
    }

    /// Name of the state, as `driving`.
    #[getter]
    fn state(&self) -> &'static str {
        self.report.state.name()
    }

    /// Why the robot does not move on; None in a state without a reason.
    #[getter]
    fn reason(&self) -> Option<String> {
        self.report.state.reason().map(ToString::to_string)
    }

    /// The visual tracker's result; None but on images.
    #[getter]
    fn track(&self) -> Option<Track> {
        self.report.track.clone().map(|report| Track { report })
    }

    #[getter]
    fn is_replanned(&self) -> bool {
        self.report.replanned
    }

    /// Whether the mission is over.
    #[getter]
    fn is_finished(&self) -> bool {
        self.report.finished
    }

    fn __repr__(&self) -> String {
        format!("Step(stamp={}, state='{}')", self.stamp_s, self.report.state)
    }
}
