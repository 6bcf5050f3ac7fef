//! Ways on the grid: by the potential chosen, or over the lanes of a way-point graph.

use crate::WayPointGraph;
use crate::potential::{PotentialField, PotentialKind, PotentialOutcome};
use crate::pull::pull_taut;
use crate::space::Space;
use crate::task::{SAME_PLACE, Task};
use crate::wave::{Wave, WaveFront};
use trundle_core::Vector2;

/// Nodes of a way-point graph that are tried as the first, and as the last.
const DOORS: usize = 3;
/// They are no more than so many times as far off as the nearest, and so many m more: else the robot would leave the lanes aside.
const DOORS_OFF: (f64, f64) = (1.5, 1.0);

/// A way on the grid.
pub(crate) struct Way {
    pub(crate) raw: Vec<Vector2>,
    pub(crate) points: Vec<Vector2>,
    pub(crate) fell_back: bool,
}

impl Way {
    pub(crate) fn new(raw: Vec<Vector2>, points: Vec<Vector2>) -> Self {
        Self { raw, points, fell_back: false }
    }

    /// Goes on with another that begins where this one ends.
    fn extend(&mut self, next: Self) {
        self.raw.extend(next.raw.into_iter().skip(1));
        self.points.extend(next.points.into_iter().skip(1));
        self.fell_back |= next.fell_back;
    }
}

impl Task<'_> {
    /// The way to the goal: over the way-point graph where there is one.
    pub(crate) fn way(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        self.watch.time(|times| &mut times.way_points, || self.way_or_lanes(wave, space, start, goal))
    }

    fn way_or_lanes(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        let Some(graph) = self.graph else { return self.leg(wave, space, start, goal) };
        let (enter, leave) = (doors(graph, start), doors(graph, goal));
        let ends = enter.iter().flat_map(|a| leave.iter().map(move |b| (*a, *b)));
        let mut failure = start;
        for (first, last) in ends {
            let Some(nodes) = graph.way(first, last, |a, b| space.sees(a, b)) else { continue };
            match self.legs(wave, space, start, nodes.iter().map(|node| graph.nodes()[*node]), goal) {
                Ok(way) => return Ok(way),
                Err(nearest) => failure = nearest,
            }
        }
        Err(failure)
    }

    /// Through nodes that see each other.
    fn legs(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        nodes: impl Iterator<Item = Vector2>,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        let mut way = Way::new(vec![start], vec![start]);
        for (i, node) in nodes.enumerate() {
            let here = way.points[way.points.len() - 1];
            if (node - here).norm() < SAME_PLACE {
                continue;
            }
            let lane = || Way::new(vec![here, node], vec![here, node]);
            way.extend(if i > 0 { lane() } else { self.leg(wave, space, here, node)? });
        }
        let here = way.points[way.points.len() - 1];
        if (goal - here).norm() > SAME_PLACE {
            way.extend(self.leg(wave, space, here, goal)?);
        }
        Ok(way)
    }

    /// Way-points by the potential chosen; the reachable point nearest to the goal when there is no way.
    fn leg(
        &self,
        wave: &mut WaveFront,
        space: &Space<'_>,
        start: Vector2,
        goal: Vector2,
    ) -> Result<Way, Vector2> {
        let potential = self.config.potential;
        let mut fell_back = false;
        if potential.kind == PotentialKind::Printed {
            let printed = PotentialField::new(self.field, goal, self.body.radius, potential);
            if let PotentialOutcome::Reached(raw) = printed.descend(space, start) {
                return Ok(Way { points: pull_taut(space, &raw), raw, fell_back });
            }
            fell_back = true;
        }
        match wave.run(space, start, goal) {
            Wave::Met(raw) => Ok(Way { points: pull_taut(space, &raw), raw, fell_back }),
            Wave::Stuck(nearest) => Err(nearest),
        }
    }
}

/// The nodes by which a place is left for the lanes, or reached from them, the nearest first.
fn doors(graph: &WayPointGraph, place: Vector2) -> Vec<usize> {
    let off = |node: &usize| (graph.nodes()[*node] - place).norm();
    let mut nodes = graph.nearest(place);
    let farthest = nodes.first().map_or(0.0, off) * DOORS_OFF.0 + DOORS_OFF.1;
    nodes.truncate(DOORS);
    nodes.retain(|node| off(node) <= farthest);
    nodes
}
