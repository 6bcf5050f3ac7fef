//! Paths on the grid: by the configured method, or over the lanes of a waypoint graph.

use crate::query::plan_query::{PlanQuery, SAME_PLACE_M};
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::geodesic_search::{GeodesicSearch, SearchOutcome};
use crate::search::grid_path::GridPath;
use crate::search::potential::{PotentialField, PotentialKind, PotentialOutcome};
use crate::search::string_pulling::string_pulled;
use crate::search::waypoint_graph::WaypointGraph;
use trundle_core::Vector2;

/// Number of graph nodes that are tried as entry and as exit. Source: ours.
const GRAPH_ENTRIES: usize = 3;
/// Largest ratio of an entry's distance to that of the nearest node; with a larger one the robot would not use the lanes. Source: ours.
const MAX_ENTRY_RATIO: f64 = 1.5;
/// Distance of an entry added to that ratio, m. Source: ours.
const MAX_ENTRY_EXTRA_M: f64 = 1.0;

/// The path to the goal, over the waypoint graph if one is given.
pub(crate) fn find_path(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    space: &ConfigurationSpace<'_>,
    start: Vector2,
    goal: Vector2,
) -> Result<GridPath, Vector2> {
    query.timer.time(|times| &mut times.waypoints, || path_or_lanes(query, search, space, start, goal))
}

fn path_or_lanes(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    space: &ConfigurationSpace<'_>,
    start: Vector2,
    goal: Vector2,
) -> Result<GridPath, Vector2> {
    let Some(graph) = query.graph else { return path_leg(query, search, space, start, goal) };
    let (enter, leave) = (graph_entries(graph, start), graph_entries(graph, goal));
    let ends = enter.iter().flat_map(|a| leave.iter().map(move |b| (*a, *b)));
    let mut failure = start;
    for (first, last) in ends {
        let Some(nodes) = graph.shortest_lanes(first, last, |a, b| space.connects(a, b)) else { continue };
        match along_lanes(query, search, space, start, nodes.iter().map(|node| graph.nodes()[*node]), goal) {
            Ok(path) => return Ok(path),
            Err(nearest) => failure = nearest,
        }
    }
    Err(failure)
}

/// Through nodes that are connected by free straight lines.
fn along_lanes(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    space: &ConfigurationSpace<'_>,
    start: Vector2,
    nodes: impl Iterator<Item = Vector2>,
    goal: Vector2,
) -> Result<GridPath, Vector2> {
    let mut path = GridPath::new(vec![start], vec![start]);
    for (i, node) in nodes.enumerate() {
        let here = path.points[path.points.len() - 1];
        if (node - here).norm() < SAME_PLACE_M {
            continue;
        }
        let lane = || GridPath::new(vec![here, node], vec![here, node]);
        path.extend(if i > 0 { lane() } else { path_leg(query, search, space, here, node)? });
    }
    let here = path.points[path.points.len() - 1];
    if (goal - here).norm() > SAME_PLACE_M {
        path.extend(path_leg(query, search, space, here, goal)?);
    }
    Ok(path)
}

/// Waypoints by the configured method; without a path, the reachable point nearest to the goal.
fn path_leg(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    space: &ConfigurationSpace<'_>,
    start: Vector2,
    goal: Vector2,
) -> Result<GridPath, Vector2> {
    let potential = query.config.potential;
    let mut fell_back = false;
    if potential.kind == PotentialKind::Printed {
        let printed = PotentialField::new(query.field, goal, query.shape.radius, potential);
        if let PotentialOutcome::Reached(raw) = printed.descend(space, start) {
            return Ok(GridPath { points: string_pulled(space, &raw), raw, fell_back });
        }
        fell_back = true;
    }
    match search.run(space, start, goal) {
        SearchOutcome::Found(raw) => Ok(GridPath { points: string_pulled(space, &raw), raw, fell_back }),
        SearchOutcome::Unreachable(nearest) => Err(nearest),
    }
}

/// The nodes by which a point enters or leaves the lanes, the nearest first.
fn graph_entries(graph: &WaypointGraph, place: Vector2) -> Vec<usize> {
    let off = |node: &usize| (graph.nodes()[*node] - place).norm();
    let mut nodes = graph.nearest(place);
    let farthest = nodes.first().map_or(0.0, off) * MAX_ENTRY_RATIO + MAX_ENTRY_EXTRA_M;
    nodes.truncate(GRAPH_ENTRIES);
    nodes.retain(|node| off(node) <= farthest);
    nodes
}
