//! Graphs of waypoints and lanes.

use trundle_core::{Invalid, Vector2};

/// Waypoints and the straight lanes between them, which the robot must follow.
#[derive(Debug, Clone, PartialEq)]
pub struct WaypointGraph {
    nodes: Vec<Vector2>,
    /// Node numbers of the ends.
    lanes: Vec<(usize, usize)>,
    /// Whether lanes are driven from the first end to the second only.
    one_way: bool,
}

impl WaypointGraph {
    /// A graph of `nodes` (map frame, m) and `lanes` between them, driven in both directions.
    ///
    /// # Errors
    /// When the graph has no node, a node is not finite, or an end of a lane is no node.
    pub fn new(nodes: Vec<Vector2>, lanes: Vec<(usize, usize)>) -> Result<Self, Invalid> {
        if nodes.is_empty() {
            return Err(Invalid::new("nodes of the waypoint graph", 0, "", "1 or more"));
        }
        if let Some(i) = nodes.iter().position(|node| !(node.x.is_finite() && node.y.is_finite())) {
            return Err(Invalid::new(
                format!("node {i} of the waypoint graph"),
                "not finite",
                "",
                "finite numbers",
            ));
        }
        match lanes.iter().position(|(a, b)| *a >= nodes.len() || *b >= nodes.len()) {
            Some(i) => {
                let value = format!("{:?}", lanes[i]);
                Err(Invalid::new(format!("lane {i} of the waypoint graph"), value, "", "numbers of nodes"))
            }
            None => Ok(Self { nodes, lanes, one_way: false }),
        }
    }

    /// A graph of one-way lanes, from their first node to their second; two opposite lanes allow both directions.
    ///
    /// # Errors
    /// As [`WaypointGraph::new`].
    pub fn one_way(nodes: Vec<Vector2>, lanes: Vec<(usize, usize)>) -> Result<Self, Invalid> {
        Ok(Self { one_way: true, ..Self::new(nodes, lanes)? })
    }

    /// The waypoints, map frame, m.
    pub fn nodes(&self) -> &[Vector2] {
        &self.nodes
    }

    /// The lanes, by the node numbers of their ends.
    pub fn lanes(&self) -> &[(usize, usize)] {
        &self.lanes
    }

    /// The nodes by rising distance from a point.
    pub(crate) fn nearest(&self, point: Vector2) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.nodes.len()).collect();
        let off = |i: &usize| (self.nodes[*i] - point).norm_squared();
        order.sort_by(|a, b| off(a).total_cmp(&off(b)));
        order
    }

    /// The shortest node sequence over `free` lanes, both ends included (Dijkstra's search without a queue: graphs are small).
    pub(crate) fn shortest_lanes(
        &self,
        from: usize,
        to: usize,
        free: impl Fn(Vector2, Vector2) -> bool,
    ) -> Option<Vec<usize>> {
        let mut cost = vec![f64::INFINITY; self.nodes.len()];
        let mut before = vec![from; self.nodes.len()];
        let mut open: Vec<usize> = (0..self.nodes.len()).collect();
        cost[from] = 0.0;
        while let Some(place) = (0..open.len()).min_by(|a, b| cost[open[*a]].total_cmp(&cost[open[*b]])) {
            let here = open.swap_remove(place);
            if here == to || cost[here].is_infinite() {
                break;
            }
            for (a, b) in &self.lanes {
                let next = if *a == here {
                    *b
                } else if *b == here && !self.one_way {
                    *a
                } else {
                    continue;
                };
                let total = cost[here] + (self.nodes[next] - self.nodes[here]).norm();
                if total < cost[next] && free(self.nodes[here], self.nodes[next]) {
                    (cost[next], before[next]) = (total, here);
                }
            }
        }
        let mut nodes = cost[to].is_finite().then(|| vec![to])?;
        while nodes[nodes.len() - 1] != from {
            nodes.push(before[nodes[nodes.len() - 1]]);
        }
        nodes.reverse();
        Some(nodes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_way_lanes_are_driven_in_one_direction() {
        let nodes = [0.0, 1.0, 2.0].map(|x| Vector2::new(x, 0.0)).to_vec();
        let graph = WaypointGraph::one_way(nodes, vec![(0, 1), (1, 2), (2, 1)]).unwrap();
        assert_eq!(graph.shortest_lanes(0, 2, |_, _| true), Some(vec![0, 1, 2]));
        assert_eq!(graph.shortest_lanes(2, 1, |_, _| true), Some(vec![2, 1]));
        assert_eq!(graph.shortest_lanes(2, 0, |_, _| true), None);
    }

    #[test]
    fn the_shortest_free_lanes_are_taken() {
        let at = |x: f64, y: f64| Vector2::new(x, y);
        let nodes = vec![at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0), at(1.0, 3.0)];
        let graph = WaypointGraph::new(nodes, vec![(0, 1), (2, 1), (0, 3), (3, 2)]).unwrap();
        assert_eq!(graph.shortest_lanes(0, 2, |_, _| true), Some(vec![0, 1, 2]));
        let blocked = |a: Vector2, b: Vector2| a.y + b.y > 0.0;
        assert_eq!(graph.shortest_lanes(0, 2, blocked), Some(vec![0, 3, 2]));
        assert_eq!(graph.shortest_lanes(0, 2, |_, _| false), None);
        assert_eq!(graph.nearest(at(1.9, 0.1))[0], 2);
        assert!(WaypointGraph::new(vec![], vec![]).is_err());
        assert!(WaypointGraph::new(vec![at(0.0, f64::NAN)], vec![]).is_err());
        assert!(WaypointGraph::new(vec![at(0.0, 0.0)], vec![(0, 1)]).is_err());
    }
}
