//! The planning task: a map, a start, goals, and a planner with the masks and lanes of their files.

use super::goal_refusal::GoalRefusal;
use super::masks::{SpeedMaskLimits, read_lanes, set_keep_out, set_speed_mask};
use super::plan_times::PlanTimes;
use crate::{AppError, read_map};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Instant;
use trundle_core::{Footprint, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle_planning::{MultiGoalPlan, Plan, Planner, UnknownIs, WaypointGraph};
use trundle_runtime::RobotConfig;
use trundle_viz::MaskShares;

/// The files that shape a plan.
#[derive(Debug, Clone)]
pub struct PlanFiles {
    /// The map, in map_server's form.
    pub map: PathBuf,
    /// A keep-out mask, as Nav2's.
    pub keep_out: Option<PathBuf>,
    /// A speed mask, as Nav2's.
    pub speed_mask: Option<PathBuf>,
    /// A way-point graph, GeoJSON in the format of Nav2's route server.
    pub graph: Option<PathBuf>,
}

/// A pose in the map frame, with its name if it has one.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPose {
    /// `map_from_base`.
    pub pose: Pose2,
    /// Name of the pose, for messages.
    pub name: Option<String>,
}

impl NamedPose {
    /// The place `name` of the file of places.
    ///
    /// # Errors
    /// When no file of places is given, or the file has no such place.
    pub fn of_place(
        name: &str,
        file: Option<&Path>,
        places: Option<&BTreeMap<String, Pose2>>,
    ) -> Result<Self, AppError> {
        let (Some(file), Some(places)) = (file, places) else {
            let message =
                format!("'{name}' is not a pose X,Y,DEG; to name a place, give its file with --places");
            return Err(AppError::Input(message));
        };
        match places.get(name) {
            Some(pose) => Ok(Self { pose: *pose, name: Some(name.to_owned()) }),
            None => {
                let known: Vec<&str> = places.keys().map(String::as_str).collect();
                let known = match known[..] {
                    [] => "the file has no place, expected tables [NAME] with x, y (m) and heading_deg"
                        .to_owned(),
                    _ => format!("there are: {}", known.join(", ")),
                };
                Err(AppError::Input(format!("{}: no place '{name}'; {known}", file.display())))
            }
        }
    }

    /// Name and position, for messages.
    pub(super) fn describe(&self) -> String {
        let at = format!("({}, {}) m", self.pose.x, self.pose.y);
        self.name.as_ref().map_or(at.clone(), |name| format!("'{name}' at {at}"))
    }
}

/// A map, a planner with the masks, a start and goals.
pub struct PlanRequest {
    /// The map's file, for messages.
    pub map: PathBuf,
    /// The map.
    pub grid: OccupancyGrid,
    /// The robot's outline.
    pub footprint: Footprint,
    /// Plans with all masks.
    pub planner: Planner,
    /// Pose of the robot at the start.
    pub start: NamedPose,
    /// Goals, in order.
    pub goals: Vec<NamedPose>,
    /// For pictures: 1 is forbidden, less is high-cost.
    pub keep_out: Option<MaskShares>,
    /// For pictures: 1 less the share of the full speed.
    pub slow: Option<MaskShares>,
    /// Number of cells of the speed mask that set a limit.
    pub speed_limits: Option<SpeedMaskLimits>,
    pub(super) graph: Option<WaypointGraph>,
    /// Plans without the keep-out mask, to report the effect of the mask.
    pub(super) unmasked: Planner,
    /// Plans with all masks and unknown cells as free, to report the effect of unknown space; `None` if they are free anyway.
    pub(super) unknown_free: Option<Planner>,
}

impl PlanRequest {
    /// Warning about the cells of the speed mask whose limit is out of range; `None` without such cells.
    #[must_use]
    pub fn speed_mask_warning(&self) -> Option<String> {
        let limits = self.speed_limits.filter(|limits| limits.out_of_range > 0)?;
        Some(format!(
            "{} of {} cells stand for a speed that is not above 0, or above 100 %: they set no limit, as in Nav2. \
             Black does so by default; to forbid a place, use --keepout",
            limits.out_of_range, limits.cells
        ))
    }

    /// Reads and checks the files. `goal_tolerance_m`: distance from a blocked goal that still counts; `None` for the robot's own.
    ///
    /// # Errors
    /// Names the file or the invalid value.
    pub fn read(
        files: &PlanFiles,
        (start, goals): (NamedPose, Vec<NamedPose>),
        goal_tolerance_m: Option<f64>,
        robot: &RobotConfig,
    ) -> Result<Self, AppError> {
        let grid = read_map(&files.map)?;
        let graph = files.graph.as_deref().map(|path| read_lanes(path, grid.geometry())).transpose()?;
        let footprint = robot.footprint()?;
        // No path leads beyond the edge of a given map.
        let goal_tolerance = goal_tolerance_m.unwrap_or(robot.planning.goal_tolerance);
        let mut config = robot.planning;
        config.beyond = 0.0;
        config.goal_tolerance = goal_tolerance;
        let mut planner = Planner::new(config, &footprint, robot.limits, robot.drive)?;
        let mut open = config;
        open.unknown = UnknownIs::Free;
        open.goal_tolerance = 0.0;
        let mut unknown_free = (config.unknown == UnknownIs::Obstacle)
            .then(|| Planner::new(open, &footprint, robot.limits, robot.drive))
            .transpose()?;
        let keep_out = files.keep_out.as_deref();
        let masked = std::iter::once(&mut planner).chain(&mut unknown_free);
        let keep_out = keep_out.map(|path| set_keep_out(path, &grid, masked)).transpose()?;
        let slow = files.speed_mask.as_deref();
        let slow = slow.map(|path| set_speed_mask(path, robot.limits.v, &grid, &mut planner)).transpose()?;
        let (slow, speed_limits) = slow.unzip();
        // The comparison is for the goal itself, not for a pose nearby.
        let mut exact = config;
        exact.goal_tolerance = 0.0;
        let unmasked = Planner::new(exact, &footprint, robot.limits, robot.drive)?;
        let map = files.map.clone();
        Ok(Self {
            map,
            grid,
            footprint,
            planner,
            start,
            goals,
            keep_out,
            slow,
            speed_limits,
            graph,
            unmasked,
            unknown_free,
        })
    }

    /// The plan through all goals.
    ///
    /// # Errors
    /// The first goal without a plan, and the reason.
    pub fn plan(&mut self) -> Result<MultiGoalPlan, GoalRefusal> {
        let goals: Vec<Pose2> = self.goals.iter().map(|goal| goal.pose).collect();
        self.plan_through(&goals).map_err(|(goal, why)| {
            let before = (goal > 0).then(|| self.plan_through(&goals[..goal]).ok()).flatten();
            let from = before.map_or(self.start.pose, |plan| plan.trajectory.end());
            GoalRefusal { goal, from, why }
        })
    }

    /// The plan through all goals, and the wall-clock time of planning.
    ///
    /// # Errors
    /// The plan has those of [`PlanRequest::plan`].
    pub fn timed_plan(&mut self) -> (Result<MultiGoalPlan, GoalRefusal>, PlanTimes) {
        self.planner.set_clock(Some(clock_s));
        let start = clock_s();
        let plan = self.plan();
        (plan, PlanTimes { all: clock_s() - start, stages: self.planner.stage_times() })
    }

    fn plan_through(&mut self, goals: &[Pose2]) -> Result<MultiGoalPlan, (usize, Plan)> {
        let (start, grid) = (self.start.pose, &self.grid);
        match &self.graph {
            Some(graph) => self.planner.plan_multi_goal_on_graph(grid, graph, start, Twist2::ZERO, goals),
            None => self.planner.plan_multi_goal(grid, start, Twist2::ZERO, goals),
        }
    }

    /// The lanes of the way-point graph, end to end; empty without a graph.
    #[must_use]
    pub fn lanes(&self) -> Vec<[Vector2; 2]> {
        let of = |graph: &WaypointGraph| {
            graph.lanes().iter().map(|(a, b)| [graph.nodes()[*a], graph.nodes()[*b]]).collect()
        };
        self.graph.as_ref().map(of).unwrap_or_default()
    }
}

/// Wall-clock time since the first call \[s\].
fn clock_s() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}
