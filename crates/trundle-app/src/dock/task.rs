//! The docking task: footprint, start, goal and the obstacles of a map, a scan or a list.

use crate::{AppError, MapExtent, read_map};
use std::path::Path;
use trundle_core::{Footprint, Invalid, OccupancyGrid, Pose2};
use trundle_docking::corridor::{Problem, Scenario, parse, write};
use trundle_docking::{DockingConfig, Obstacle, ObstacleScene};
use trundle_io::{LaserLog, LaserLogOptions, no_return_cause, range_unit_hint, read_laser_log, read_text};

/// A docking task.
pub struct DockingTask {
    /// Name of the task, for the summary.
    pub name: String,
    /// The robot's outline.
    pub footprint: Footprint,
    /// `map_from_base` at the start.
    pub start: Pose2,
    /// `map_from_base` at the goal.
    pub goal: Pose2,
    /// The obstacles, for the planner.
    pub scene: ObstacleScene,
    /// The map, if the obstacles are a map's.
    pub grid: Option<OccupancyGrid>,
    /// The list, if the obstacles are a list's.
    pub problem: Option<Problem>,
    /// The reason why the task cannot be planned; `None` if the planner decides.
    pub refusal: Option<String>,
}

impl DockingTask {
    /// A task on a map file, between two poses, refused if one is off the map. `unknown_is_free`: whether unknown cells are not obstacles.
    ///
    /// # Errors
    /// When the map cannot be read.
    pub fn on_map(
        file: &Path,
        footprint: Footprint,
        (start, goal): (Pose2, Pose2),
        config: &DockingConfig,
        unknown_is_free: bool,
    ) -> Result<Self, AppError> {
        let grid = read_map(file)?;
        let off_map = [("start", start), ("goal", goal)]
            .into_iter()
            .find(|(_, pose)| grid.geometry().cell_at(pose.position()).is_none());
        let map = MapExtent::of(grid.geometry());
        let refusal = off_map.map(|(name, Pose2 { x, y, .. })| {
            format!("the {name} ({x:.2}, {y:.2}) m is off the map, which has {map}")
        });
        let (center, half) = config.view(&footprint, &start, &goal);
        let scene = ObstacleScene::from_grid(&grid, center, half, !unknown_is_free);
        let name = file.display().to_string();
        Ok(Self { name, footprint, start, goal, scene, grid: Some(grid), problem: None, refusal })
    }

    /// A task among the obstacles of a list, with the list's footprint, start and goal.
    ///
    /// # Errors
    /// When the obstacles are invalid.
    pub fn of_problem(problem: Problem) -> Result<Self, Invalid> {
        Ok(Self {
            name: problem.name.clone(),
            footprint: problem.footprint.clone(),
            start: problem.start,
            goal: problem.goal,
            scene: problem.scene()?,
            grid: None,
            problem: Some(problem),
            refusal: None,
        })
    }

    /// The task as the text of a file of problems; the obstacles of a map become walls.
    #[must_use]
    pub fn to_text(&self) -> String {
        let walls =
            || self.scene.pieces().iter().map(|p| Obstacle::Segment(p.segment.a, p.segment.b)).collect();
        let obstacles = self.problem.as_ref().map_or_else(walls, |problem| problem.obstacles.clone());
        let (name, footprint) = (self.name.clone(), self.footprint.clone());
        write(&[Problem { name, footprint, start: self.start, goal: self.goal, obstacles }])
    }
}

/// The built-in problem of this name.
#[must_use]
pub fn built_in_problem(name: &Path) -> Option<Problem> {
    Scenario::ALL.map(Scenario::problem).into_iter().find(|problem| name == Path::new(&problem.name))
}

/// The task among the points of one scan of a CARMEN log, in the frame of the robot that made it. `number` counts from 1; `None`
/// for the last scan. A scan without a return is refused.
///
/// # Errors
/// When the log cannot be read or has no such scan.
pub(super) fn scan_task(
    file: &Path,
    number: Option<usize>,
    footprint: Footprint,
    goal: Pose2,
) -> Result<DockingTask, AppError> {
    let log = read_laser_log(file, &LaserLogOptions::default())?;
    let count = log.scans.len();
    let number = number.unwrap_or(count);
    let scan = number.checked_sub(1).and_then(|i| log.scans.get(i));
    let scan = scan.ok_or_else(|| named(file, &format!("it has no scan {number}, only 1 to {count}")))?;
    let obstacles: Vec<Obstacle> = scan.scan.hits().map(Obstacle::Point).collect();
    let refusal = scan_refusal(&log, obstacles.is_empty());
    let problem =
        Problem { name: format!("scan-{number}"), footprint, start: Pose2::default(), goal, obstacles };
    let task = DockingTask::of_problem(problem).map_err(|invalid| named(file, &invalid))?;
    Ok(DockingTask { refusal, ..task })
}

/// The reason why no task can be planned in a scan of the log: the scan has no returns, or its ranges are in another unit.
fn scan_refusal(log: &LaserLog, is_blind: bool) -> Option<String> {
    if let Some(hint) = range_unit_hint(log) {
        return Some(format!("{hint} No manoeuvre is planned"));
    }
    let cause = if log.scans_without_return() == log.scans.len() {
        format!("; {}", no_return_cause(log))
    } else {
        String::new()
    };
    is_blind.then(|| {
        format!("no beam of the scan hit an obstacle, and unseen floor is not free: no manoeuvre is planned{cause}")
    })
}

/// The problem of this name in a file of problems; `None` for the first.
///
/// # Errors
/// When the file cannot be read or has no such problem.
pub fn file_problem(file: &Path, name: Option<&str>) -> Result<Problem, AppError> {
    let text = read_text(file)?;
    let mut problems = parse(&text).map_err(|invalid| named(file, &invalid))?.into_iter();
    let chosen = match name {
        Some(name) => problems.find(|problem| problem.name == name),
        None => problems.next(),
    };
    chosen.ok_or_else(|| match name {
        Some(name) => named(file, &format!("it has no problem '{name}'")),
        None => named(file, &"it has no problem"),
    })
}

/// The problem with the name of the file.
pub(super) fn named(file: &Path, problem: &dyn std::fmt::Display) -> AppError {
    AppError::Input(format!("{}: {problem}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_is_the_same_after_writing_and_reading() {
        let task = DockingTask::of_problem(built_in_problem(Path::new("hong24-a")).unwrap()).unwrap();
        let scratch = tempfile::tempdir().unwrap();
        let file = scratch.path().join("problem.txt");
        std::fs::write(&file, task.to_text()).unwrap();
        let read = DockingTask::of_problem(file_problem(&file, Some("hong24-a")).unwrap()).unwrap();
        assert_eq!((read.start, read.goal), (task.start, task.goal));
        assert_eq!(read.scene.pieces().len(), task.scene.pieces().len());
        assert!(file_problem(&file, Some("other")).unwrap_err().to_string().contains("no problem 'other'"));
    }

    #[test]
    fn only_known_names_are_built_in() {
        assert!(built_in_problem(Path::new("hong24-d")).is_some());
        assert!(built_in_problem(Path::new("hong24-e")).is_none());
    }
}
