//! The request for a manoeuvre: obstacles, poses, outline and settings.

use super::result::DockingResult;
use super::task::{DockingTask, built_in_problem, file_problem, named, scan_task};
use crate::AppError;
use std::path::PathBuf;
use trundle_core::{Footprint, Pose2};
use trundle_docking::{DockingConfig, Method};
use trundle_io::{Expected, FileKind};
use trundle_runtime::RobotConfig;

/// The request for a manoeuvre onto a pose.
#[derive(Debug, Clone)]
pub struct DockingRequest {
    /// A map, a laser log, a file of problems, or the name of a built-in problem.
    pub place: PathBuf,
    /// `map_from_base` at the start; `None` for the problem's.
    pub start: Option<Pose2>,
    /// `map_from_base` at the goal; `None` for the problem's.
    pub goal: Option<Pose2>,
    /// The robot's outline; `None` for the problem's or the robot's.
    pub footprint: Option<Footprint>,
    /// Number of the scan of a log, from 1; `None` for the last one.
    pub scan: Option<usize>,
    /// Name of the problem of a file; `None` for the first one.
    pub problem: Option<String>,
    /// Whether unknown cells of a map and the space outside the map are free.
    pub unknown_is_free: bool,
    /// Planning method; `None` for the robot's.
    pub method: Option<Method>,
    /// Margin to every obstacle \[m\]; `None` for the robot's.
    pub margin: Option<f64>,
    /// The robot, if one is given.
    pub robot: Option<RobotConfig>,
}

/// Source of the obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Map,
    Log,
    BuiltIn,
    File,
}

impl DockingRequest {
    /// The task.
    ///
    /// # Errors
    /// When the file cannot be read, a pose is missing, or an option belongs to another kind of file.
    pub fn task(&self) -> Result<DockingTask, AppError> {
        match self.source()? {
            Source::Map => self.on_map(),
            Source::Log => {
                let goal = self.goal.ok_or_else(|| named(&self.place, &"a scan needs --to"))?;
                let task = scan_task(&self.place, self.scan, self.robot_footprint()?, goal)?;
                Ok(self.applied_to(task))
            }
            Source::BuiltIn | Source::File => self.listed(),
        }
    }

    /// Plans the manoeuvre of the task.
    ///
    /// # Errors
    /// When a setting is outside its range or a number is not finite.
    pub fn plan(&self, task: &DockingTask) -> Result<DockingResult, AppError> {
        DockingResult::of(task, self.planner_config()).map_err(|invalid| named(&self.place, &invalid))
    }

    /// The robot's `docking.planner` if a robot is given, else the planner's own defaults; method and margin as requested.
    fn planner_config(&self) -> DockingConfig {
        let mut config =
            self.robot.as_ref().map_or_else(DockingConfig::default, |robot| robot.docking.planner.clone());
        config.method = self.method.unwrap_or(config.method);
        config.margin = self.margin.unwrap_or(config.margin);
        config
    }

    /// The kind of the file, which fits the options.
    fn source(&self) -> Result<Source, AppError> {
        let source = if !self.place.exists() && built_in_problem(&self.place).is_some() {
            Source::BuiltIn
        } else {
            match Expected::Docking.check(&self.place)? {
                FileKind::MapYaml => Source::Map,
                FileKind::CarmenLog | FileKind::Gzip => Source::Log,
                _ => Source::File,
            }
        };
        let options = [
            ("--scan", self.scan.is_some(), Source::Log),
            ("--problem", self.problem.is_some(), Source::File),
            ("--through-unknown", self.unknown_is_free, Source::Map),
        ];
        match options.into_iter().find(|&(_, is_given, place)| is_given && place != source) {
            Some((option, _, place)) => {
                let problem = format!("{option} goes with {}, this is {}", place.name(), source.name());
                Err(named(&self.place, &problem))
            }
            None => Ok(source),
        }
    }

    fn on_map(&self) -> Result<DockingTask, AppError> {
        let (Some(start), Some(goal)) = (self.start, self.goal) else {
            return Err(named(&self.place, &"a map needs --from and --to"));
        };
        let config = self.planner_config();
        DockingTask::on_map(
            &self.place,
            self.robot_footprint()?,
            (start, goal),
            &config,
            self.unknown_is_free,
        )
    }

    /// A built-in problem, else one of a file.
    fn listed(&self) -> Result<DockingTask, AppError> {
        let problem = match built_in_problem(&self.place).filter(|_| !self.place.exists()) {
            Some(problem) => problem,
            None => file_problem(&self.place, self.problem.as_deref())?,
        };
        let task = DockingTask::of_problem(problem).map_err(|invalid| named(&self.place, &invalid))?;
        Ok(self.applied_to(task))
    }

    /// The task with footprint, start and goal as requested.
    fn applied_to(&self, task: DockingTask) -> DockingTask {
        DockingTask {
            footprint: self.footprint.clone().unwrap_or(task.footprint),
            start: self.start.unwrap_or(task.start),
            goal: self.goal.unwrap_or(task.goal),
            ..task
        }
    }

    /// The outline that was requested, else the robot's.
    fn robot_footprint(&self) -> Result<Footprint, AppError> {
        match &self.footprint {
            Some(footprint) => Ok(footprint.clone()),
            None => Ok(self.robot.clone().unwrap_or_default().footprint()?),
        }
    }
}

impl Source {
    fn name(self) -> &'static str {
        match self {
            Self::Map => "a map",
            Self::Log => "a laser log",
            Self::BuiltIn => "a built-in problem",
            Self::File => "a file of problems",
        }
    }
}
