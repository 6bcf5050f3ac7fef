//! What is asked: the files and poses of the command line.

use super::args::{PlaceArg, PlanArgs};
use crate::failure::Failure;
use std::collections::BTreeMap;
use std::path::Path;
use trundle::core::{Footprint, GridGeometry, OccupancyGrid, Pose2, Twist2};
use trundle::io::{read_graph, read_keep_out_mask, read_map, read_places, read_speed_mask};
use trundle::planning::{Plan, Planner, PlannerConfig, SpeedMask, Tour, WayPointGraph};
use trundle::runtime::RobotConfig;

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
    graph: Option<WayPointGraph>,
}

impl Errand {
    /// Reads and checks what the command line names.
    pub fn read(args: &PlanArgs, robot: &RobotConfig) -> Result<Self, Failure> {
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
        if let Some(path) = &args.keepout {
            let mask = read_keep_out_mask(path)?;
            on_the_map(path, mask.geometry(), grid.geometry())?;
            planner.set_keep_out(Some(mask));
        }
        if let Some(path) = &args.speed_mask {
            let (geometry, limits) = read_speed_mask(path, robot.limits.v)?;
            on_the_map(path, &geometry, grid.geometry())?;
            planner.set_speed_mask(Some(SpeedMask::new(geometry, limits)?));
        }
        Ok(Self { grid, footprint, planner, start, goals, graph })
    }

    /// The plan through all goals, or in one sentence why there is none.
    pub fn plan(&mut self, map: &Path) -> Result<Tour, Failure> {
        let goals: Vec<Pose2> = self.goals.iter().map(|goal| goal.pose).collect();
        let (start, grid) = (self.start.pose, &self.grid);
        let tour = match &self.graph {
            Some(graph) => self.planner.plan_tour_on_graph(grid, graph, start, Twist2::ZERO, &goals),
            None => self.planner.plan_tour(grid, start, Twist2::ZERO, &goals),
        };
        tour.map_err(|(i, why)| Failure::Input(format!("{}: {}: {why}", map.display(), self.leg(i, &why))))
    }

    /// Which part of the errand has no plan.
    fn leg(&self, i: usize, why: &Plan) -> String {
        let from = if i == 0 { &self.start } else { &self.goals[i - 1] };
        let whole = format!("from {} to {}", from.describe(), self.goals[i].describe());
        let whole = if self.goals.len() > 1 { format!("goal {}, {whole}", i + 1) } else { whole };
        match why {
            Plan::Blocked { .. } if self.graph.is_some() => format!("{whole} along the graph"),
            _ => whole,
        }
    }
}

fn resolve(
    place: &PlaceArg,
    file: Option<&Path>,
    places: Option<&BTreeMap<String, Pose2>>,
) -> Result<Place, Failure> {
    let name = match place {
        PlaceArg::Pose(pose) => return Ok(Place { pose: pose.0, name: None }),
        PlaceArg::Name(name) => name,
    };
    let (Some(file), Some(places)) = (file, places) else {
        let message = format!("'{name}' is no pose X,Y,DEG; to name a place, give its file with --places");
        return Err(Failure::Input(message));
    };
    match places.get(name) {
        Some(pose) => Ok(Place { pose: *pose, name: Some(name.clone()) }),
        None => {
            let known: Vec<&str> = places.keys().map(String::as_str).collect();
            let message = format!("{}: no place '{name}'; there are: {}", file.display(), known.join(", "));
            Err(Failure::Input(message))
        }
    }
}

fn graph(path: &Path) -> Result<WayPointGraph, Failure> {
    let file = read_graph(path)?;
    WayPointGraph::one_way(file.nodes, file.lanes)
        .map_err(|error| Failure::Input(format!("{}: {error}", path.display())))
}

/// A mask that lies wholly beside the map was made for another one, or another frame.
fn on_the_map(path: &Path, mask: &GridGeometry, map: &GridGeometry) -> Result<(), Failure> {
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
        return Err(Failure::Input(message));
    }
    Ok(())
}
