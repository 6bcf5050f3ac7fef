//! What is asked: the files and poses of the command line.

use super::args::{PlaceArg, PlanArgs};
use crate::console;
use std::collections::BTreeMap;
use std::path::Path;
use trundle::app::AppError;
use trundle::core::{Cell, Footprint, GridGeometry, OccupancyGrid, Pose2, Twist2, Vector2};
use trundle::io::{read_graph, read_keep_out_mask, read_map, read_places, read_speed_mask};
use trundle::planning::{CostMask, MultiGoalPlan, Plan, Planner, PlannerConfig, SpeedMask, WaypointGraph};
use trundle::runtime::RobotConfig;
use trundle::viz::MaskShares;

/// A place to be, and what it is called in messages.
#[derive(Debug, Clone)]
pub struct Place {
    pub pose: Pose2,
    name: Option<String>,
}

impl Place {
    fn describe(&self) -> String {
        let at = format!("({}, {}) m", self.pose.x, self.pose.y);
        self.name.as_ref().map_or(at.clone(), |name| format!("'{name}' at {at}"))
    }
}

/// A map, a planner that knows the masks, a start and goals.
pub struct Errand {
    pub grid: OccupancyGrid,
    pub footprint: Footprint,
    pub planner: Planner,
    pub start: Place,
    pub goals: Vec<Place>,
    /// For pictures: 1 is forbidden, less is dear.
    pub keep_out: Option<MaskShares>,
    /// For pictures: 1 less the share of the full speed.
    pub slow: Option<MaskShares>,
    graph: Option<WaypointGraph>,
    /// A planner that knows no keep-out mask: asked what that changes.
    unmasked: Planner,
}

/// A part of an errand that has no plan: where it leads, and why not.
#[derive(Debug)]
pub struct Refusal {
    /// The goal's number, from 0.
    pub goal: usize,
    /// Where the robot stands by then: the start, or where it stopped at the goal before.
    from: Pose2,
    pub why: Plan,
}

/// A goal that another place was taken for.
pub struct Moved {
    pub goal: usize,
    /// Where the robot stops instead.
    pub to: Pose2,
    /// How far that is from the goal, m.
    pub off: f64,
    pub why: String,
}

impl Moved {
    /// One sentence.
    pub fn note(&self) -> String {
        let Self { goal, to, off, why } = self;
        format!(
            "goal {} moved to ({:.2}, {:.2}) m, {off:.2} m from the one asked for: {why}",
            goal + 1,
            to.x,
            to.y
        )
    }
}

impl Errand {
    /// Reads and checks what the command line names.
    pub fn read(args: &PlanArgs, robot: &RobotConfig) -> Result<Self, AppError> {
        let grid = read_map(&args.map)?;
        let places = args.places.as_deref().map(read_places).transpose()?;
        let resolve = |place: &PlaceArg| resolve(place, args.places.as_deref(), places.as_ref());
        let start = resolve(&args.from)?;
        let goals = args.goal.iter().map(resolve).collect::<Result<_, _>>()?;
        let graph = args.graph.as_deref().map(graph).transpose()?;
        let footprint = robot.footprint()?;
        // A map is given: what lies beyond it is no way.
        let goal_tolerance = args.near.unwrap_or(robot.planning.goal_tolerance);
        let config = PlannerConfig { beyond: 0.0, goal_tolerance, ..robot.planning };
        let mut planner = Planner::new(config, &footprint, robot.limits, robot.drive)?;
        let keep_out = args.keepout.as_deref().map(|path| keep_out(path, &grid, &mut planner)).transpose()?;
        let full = robot.limits.v;
        let slow =
            args.speed_mask.as_deref().map(|path| slow(path, full, &grid, &mut planner)).transpose()?;
        // It is asked for the goal itself, not for a place nearby.
        let exact = PlannerConfig { goal_tolerance: 0.0, ..config };
        let unmasked = Planner::new(exact, &footprint, robot.limits, robot.drive)?;
        Ok(Self { grid, footprint, planner, start, goals, keep_out, slow, graph, unmasked })
    }

    /// The plan through all goals, or which of them has none.
    pub fn plan(&mut self) -> Result<MultiGoalPlan, Refusal> {
        let goals: Vec<Pose2> = self.goals.iter().map(|goal| goal.pose).collect();
        self.tour(&goals).map_err(|(goal, why)| {
            let before = (goal > 0).then(|| self.tour(&goals[..goal]).ok()).flatten();
            let from = before.map_or(self.start.pose, |tour| tour.trajectory.end());
            Refusal { goal, from, why }
        })
    }

    fn tour(&mut self, goals: &[Pose2]) -> Result<MultiGoalPlan, (usize, Plan)> {
        let (start, grid) = (self.start.pose, &self.grid);
        match &self.graph {
            Some(graph) => self.planner.plan_multi_goal_on_graph(grid, graph, start, Twist2::ZERO, goals),
            None => self.planner.plan_multi_goal(grid, start, Twist2::ZERO, goals),
        }
    }

    /// Of each goal that another place was taken for: how far off that is, and why.
    pub fn goals_moved(&mut self, tour: &MultiGoalPlan) -> Vec<Moved> {
        let mut found = Vec::new();
        for (goal, leg) in tour.legs.iter().enumerate() {
            let Some(instead_of) = &leg.instead_of else { continue };
            let why = match instead_of {
                Plan::Blocked { .. } => "no way leads there".to_owned(),
                refusal => refusal.to_string(),
            };
            let from = leg.trajectory.points()[0].pose;
            let why = format!("{why}{}", self.without_the_mask(instead_of, from, goal));
            let to = leg.trajectory.end();
            found.push(Moved { goal, to, off: to.distance(&self.goals[goal].pose), why });
        }
        found
    }

    /// The lanes of the way-point graph, end to end; none without one.
    pub fn lanes(&self) -> Vec<[Vector2; 2]> {
        let of = |graph: &WaypointGraph| {
            graph.lanes().iter().map(|(a, b)| [graph.nodes()[*a], graph.nodes()[*b]]).collect()
        };
        self.graph.as_ref().map(of).unwrap_or_default()
    }

    /// Where the part of an errand that has no plan begins, and where it leads.
    pub fn ends(&self, refusal: &Refusal) -> (Pose2, Pose2) {
        (refusal.from, self.goals[refusal.goal].pose)
    }

    /// The place that such a part begins at: the start or the goal before, or another place that was taken for that.
    fn before(&self, refusal: &Refusal) -> Place {
        const SAME: f64 = 0.01;
        let asked = if refusal.goal == 0 { &self.start } else { &self.goals[refusal.goal - 1] };
        let is_there = asked.pose.distance(&refusal.from) < SAME;
        let round = |value: f64| (value * 100.0).round() / 100.0;
        let Pose2 { x, y, theta } = refusal.from;
        if is_there {
            asked.clone()
        } else {
            Place { pose: Pose2::new(round(x), round(y), theta), name: None }
        }
    }

    /// One sentence: which part of the errand has no plan, and why.
    pub fn explain(&mut self, refusal: &Refusal) -> String {
        let Refusal { goal, why, .. } = refusal;
        let from = self.before(refusal);
        let mut whole = format!("from {} to {}", from.describe(), self.goals[*goal].describe());
        if self.goals.len() > 1 {
            whole = format!("goal {}, {whole}", goal + 1);
        }
        if matches!(why, Plan::Blocked { .. }) && self.graph.is_some() {
            whole = format!("{whole} along the graph");
        }
        format!("{whole}: {why}{}", self.without_the_mask(why, refusal.from, *goal))
    }

    /// What a refusal has to do with the keep-out mask; nothing where it would be the same without.
    fn without_the_mask(&mut self, why: &Plan, from: Pose2, goal: usize) -> &'static str {
        if self.keep_out.is_none() {
            return "";
        }
        let goal = self.goals[goal].pose;
        let bare = match &self.graph {
            Some(graph) => self.unmasked.plan_on_graph(&self.grid, graph, from, Twist2::ZERO, goal),
            None => self.unmasked.plan(&self.grid, from, Twist2::ZERO, goal),
        };
        let same = |of: fn(&Plan) -> bool| of(why) && of(&bare);
        match why {
            Plan::StartInObstacle { .. } if !same(|plan| matches!(plan, Plan::StartInObstacle { .. })) => {
                "; it would without the keep-out mask"
            }
            Plan::GoalInObstacle { .. } if !same(|plan| matches!(plan, Plan::GoalInObstacle { .. })) => {
                "; it would without the keep-out mask"
            }
            Plan::Blocked { .. } if matches!(bare, Plan::Found(_)) => {
                "; without the keep-out mask there is one"
            }
            _ => "",
        }
    }
}

fn resolve(
    place: &PlaceArg,
    file: Option<&Path>,
    places: Option<&BTreeMap<String, Pose2>>,
) -> Result<Place, AppError> {
    let name = match place {
        PlaceArg::Pose(pose) => return Ok(Place { pose: pose.0, name: None }),
        PlaceArg::Name(name) => name,
    };
    let (Some(file), Some(places)) = (file, places) else {
        let message = format!("'{name}' is no pose X,Y,DEG; to name a place, give its file with --places");
        return Err(AppError::Input(message));
    };
    match places.get(name) {
        Some(pose) => Ok(Place { pose: *pose, name: Some(name.clone()) }),
        None => {
            let known: Vec<&str> = places.keys().map(String::as_str).collect();
            let message = format!("{}: no place '{name}'; there are: {}", file.display(), known.join(", "));
            Err(AppError::Input(message))
        }
    }
}

/// Reads a keep-out mask into the planner; what it says, for pictures.
fn keep_out(path: &Path, grid: &OccupancyGrid, planner: &mut Planner) -> Result<MaskShares, AppError> {
    let mask = read_keep_out_mask(path)?;
    let geometry = *mask.forbidden.geometry();
    on_the_map(path, &geometry, grid.geometry())?;
    let share = |(cell, dear): (&Cell, &u8)| match cell {
        Cell::Occupied => 1.0,
        _ => f32::from(*dear) / 100.0,
    };
    let shares = mask.forbidden.cells().iter().zip(&mask.dear).map(share).collect();
    planner.set_keep_out(Some(mask.forbidden));
    if mask.dear.iter().any(|value| *value > 0) {
        planner.set_cost_mask(Some(CostMask::new(geometry, mask.dear)?));
    }
    Ok(MaskShares { geometry, shares })
}

/// Reads a speed mask into the planner; what it says, for pictures. `full`: the robot's highest speed, m/s.
fn slow(path: &Path, full: f64, grid: &OccupancyGrid, planner: &mut Planner) -> Result<MaskShares, AppError> {
    let mask = read_speed_mask(path, full)?;
    on_the_map(path, &mask.geometry, grid.geometry())?;
    if mask.out_of_range > 0 {
        let (count, all) = (mask.out_of_range, mask.limits.len());
        console::warn(&format!(
            "{}: {count} of {all} cells stand for a speed that is not above 0, or above 100 %: they set no limit, as in Nav2. \
             Black does so by default; to forbid a place, use --keepout",
            path.display()
        ));
    }
    let share = |limit: &f32| (1.0 - limit / full as f32).clamp(0.0, 1.0);
    let shares = mask.limits.iter().map(share).collect();
    planner.set_speed_mask(Some(SpeedMask::new(mask.geometry, mask.limits)?));
    Ok(MaskShares { geometry: mask.geometry, shares })
}

fn graph(path: &Path) -> Result<WaypointGraph, AppError> {
    let file = read_graph(path)?;
    WaypointGraph::one_way(file.nodes, file.lanes)
        .map_err(|error| AppError::Input(format!("{}: {error}", path.display())))
}

/// A mask that lies wholly beside the map was made for another one, or another frame.
fn on_the_map(path: &Path, mask: &GridGeometry, map: &GridGeometry) -> Result<(), AppError> {
    let span = |g: &GridGeometry, axis: usize, cells: usize| {
        (g.origin[axis], g.origin[axis] + cells as f64 * g.resolution)
    };
    let apart = |axis: usize, cells: (usize, usize)| {
        let ((a, b), (c, d)) = (span(mask, axis, cells.0), span(map, axis, cells.1));
        b <= c || d <= a
    };
    if apart(0, (mask.width, map.width)) || apart(1, (mask.height, map.height)) {
        let (x, y) = (span(mask, 0, mask.width), span(mask, 1, mask.height));
        let message = format!(
            "{}: the mask lies beside the map: x {:.2} to {:.2} m, y {:.2} to {:.2} m",
            path.display(),
            x.0,
            x.1,
            y.0,
            y.1
        );
        return Err(AppError::Input(message));
    }
    Ok(())
}
