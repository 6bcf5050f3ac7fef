//! The robot's footprint among the occupied cells: exact gaps, and motions without contact.
//!
//! Problem: is a motion free of contact, also between the checked poses? Idea: a footprint with a gap g may move until one of its points
//! has moved by g (conservative advancement, \[Mirtich96\]). The shortest step is [`MIN_ADVANCE_M`]: an overlap deeper than half of this
//! step is always found. Cost: O(cells near the footprint) per check.

use crate::search::escape::Escape;
use trundle_collision::CONTACT_TOLERANCE_M;
use trundle_collision::convex_polygon::{centre_of, depth_within, inscribed_disc, inset};
use trundle_collision::square::{point_to_square, polygon_to_square};
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_grid::DistanceField;

/// Shortest advance between two checks, m. An overlap below half of this may be missed. Source: ours.
const MIN_ADVANCE_M: f64 = 4e-4;

/// Largest measured overlap of a polygon with an obstacle, m, at most the distance to the axle. There is no plan out of a deeper overlap.
/// Source: ours.
pub(crate) const MAX_OVERLAP_M: f64 = 0.2;

/// The robot's footprint in the base frame.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RobotShape {
    /// Corners counter-clockwise; none for a disc.
    corners: Vec<Vector2>,
    /// Largest distance of a point of the footprint from the axle, m.
    pub(crate) radius: f64,
    /// Smallest distance of the boundary from the axle, m; 0 if the axle is outside.
    pub(crate) inner: f64,
    /// Centre and radius of the largest disc inside the footprint, base frame, m.
    pub(crate) inscribed: (Vector2, f64),
    escaping: Option<Box<EscapingFootprint>>,
}

/// A footprint that leaves its overlap at the start.
#[derive(Debug, Clone, PartialEq)]
struct EscapingFootprint {
    escape: Escape,
    /// The footprint, shrunk until it is free at the start.
    slim: RobotShape,
}

/// Overlap of a disc with obstacles, m; `None` if the disc is free.
pub(crate) fn missing_about_disc(field: &DistanceField, at: Vector2, radius: f64) -> Option<f64> {
    (!field.has_clearance(at, radius)).then(|| radius - field.clearance(at, radius))
}

impl RobotShape {
    /// The shape of a footprint; a polygon may touch obstacles.
    pub(crate) fn new(footprint: &Footprint) -> Self {
        let radius = footprint.circumscribed_radius();
        match footprint {
            Footprint::Disc { .. } => Self {
                corners: vec![],
                radius,
                inner: radius,
                inscribed: (Vector2::zeros(), radius),
                escaping: None,
            },
            Footprint::Polygon { corners } => {
                let inner = depth_within(corners, Vector2::zeros()).max(0.0);
                let whole = Self {
                    corners: corners.clone(),
                    radius,
                    inner,
                    inscribed: inscribed_disc(corners),
                    escaping: None,
                };
                whole.shrunk(CONTACT_TOLERANCE_M).unwrap_or(whole)
            }
        }
    }

    /// The shape with its boundary moved inwards by `by` m; `None` if no area remains, or a side vanishes.
    pub(crate) fn shrunk(&self, by: f64) -> Option<Self> {
        if self.is_disc() {
            let radius = self.radius - by;
            return (radius > 0.0).then(|| Self { radius, inner: radius, ..self.clone() });
        }
        inset(&self.corners, by).map(|corners| Self {
            corners,
            inner: (self.inner - by).max(0.0),
            ..self.clone()
        })
    }

    /// Depth of the overlap at a pose, m: the shape shrunk by this amount is free; at most `cap`.
    pub(crate) fn overlap(&self, field: &DistanceField, pose: Pose2, cap: f64) -> f64 {
        const ROUNDS: usize = 12;
        if self.is_disc() {
            return (self.radius - field.clearance(pose.position(), self.radius)).min(cap);
        }
        // A shape that has vanished is free everywhere.
        let fits = |by: f64| self.shrunk(by).is_none_or(|shape| shape.gap(field, pose, 1e-3) > 0.0);
        if !fits(cap) {
            return cap;
        }
        let halve = |(low, high): (f64, f64), _| {
            let half = f64::midpoint(low, high);
            if fits(half) { (low, half) } else { (half, high) }
        };
        (0..ROUNDS).fold((0.0, cap), halve).1
    }

    /// Overlap of the shape with obstacles at a goal, m; `None` if the shape is free. The one decision behind
    /// [`Plan::GoalInObstacle`](crate::Plan::GoalInObstacle).
    pub(crate) fn missing_at_goal(&self, field: &DistanceField, goal: Pose2) -> Option<f64> {
        if self.is_disc() {
            return missing_about_disc(field, goal.position(), self.radius);
        }
        let is_free = self.gap(field, goal, 1e-3) > 0.0;
        (!is_free).then(|| self.overlap(field, goal, self.inner.max(MAX_OVERLAP_M)))
    }

    /// The same shape, treated near `start` as `by` m smaller against the obstacles that it overlaps there: it may leave the overlap but
    /// not deepen it.
    pub(crate) fn escaping(&self, field: &DistanceField, start: Pose2, by: f64) -> Option<Self> {
        let slim = self.shrunk(by)?;
        let (outline, half) = (self.outline(start), field.geometry().resolution / 2.0);
        let escape = Escape::new(start.position(), by, half * 2.0);
        let escape = escape.with_clearance_from_others(field, self.radius, |centre| match outline[..] {
            [] => (point_to_square(start.position(), centre, half).norm() - self.radius).max(0.0),
            _ => polygon_to_square(&outline, centre, half, f64::INFINITY),
        });
        Some(Self { escaping: Some(Box::new(EscapingFootprint { escape, slim })), ..self.clone() })
    }

    /// Depth of the overlap that the shape leaves, m; 0 without one.
    pub(crate) fn depth(&self) -> f64 {
        self.escaping.as_ref().map_or(0.0, |escaping| escaping.escape.depth)
    }

    /// Whether a pose is still near the overlap at the start.
    pub(crate) fn is_escaping(&self, pose: Pose2) -> bool {
        self.escaping.as_ref().is_some_and(|escaping| escaping.escape.covers(pose.position()))
    }

    pub(crate) fn is_disc(&self) -> bool {
        self.corners.is_empty()
    }

    /// Required distance from obstacles, m: of the axle for a disc, of the boundary for a polygon.
    pub(crate) fn needs(&self) -> f64 {
        if self.is_disc() { self.radius } else { MIN_ADVANCE_M }
    }

    /// The polygon at a pose, map frame; empty for a disc.
    pub(crate) fn outline(&self, pose: Pose2) -> Vec<Vector2> {
        let along = pose.direction();
        let across = Vector2::new(-along.y, along.x);
        self.corners.iter().map(|c| pose.position() + along * c.x + across * c.y).collect()
    }

    /// The exact distance between the footprint at a pose and the nearest obstacle, at most `cap` m; 0 if they meet. While the shape leaves
    /// an overlap: the distance by which it may still approach.
    pub(crate) fn gap(&self, field: &DistanceField, pose: Pose2, cap: f64) -> f64 {
        match &self.escaping {
            Some(escaping) if escaping.escape.covers(pose.position()) => {
                let cap = escaping.slim.gap_to(field, pose, cap);
                escaping.escape.others().map_or(cap, |others| self.gap_to(others, pose, cap))
            }
            _ => self.gap_to(field, pose, cap),
        }
    }

    fn gap_to(&self, field: &DistanceField, pose: Pose2, cap: f64) -> f64 {
        let at = pose.position();
        if self.is_disc() {
            return (field.clearance(at, self.radius + cap) - self.radius).max(0.0);
        }
        let surely = field.distance(at) - field.overestimate(self.radius) - self.radius;
        if surely >= cap {
            return cap;
        }
        let outline = self.outline(pose);
        if field.clearance(centre_of(&outline), 1.0) <= 0.0 || (self.inner > 0.0 && field.distance(at) <= 0.0)
        {
            return 0.0;
        }
        let low = outline.iter().fold(at, |low, c| low.inf(c)) - Vector2::repeat(cap);
        let high = outline.iter().fold(at, |high, c| high.sup(c)) + Vector2::repeat(cap);
        let half = field.geometry().resolution / 2.0;
        let grown = Vector2::repeat(half);
        let mut best = outline.iter().map(|c| field.border_gap(*c)).fold(cap, f64::min);
        field.for_obstacle_rims_in(low - grown, high + grown, |centre| {
            if best > 0.0 {
                best = best.min(polygon_to_square(&outline, centre, half, best));
            }
        });
        best
    }

    /// Whether the robot can move from `from` by `step` (map frame, m) while it turns evenly by `turn` rad, without contact.
    pub(crate) fn may_move(&self, field: &DistanceField, from: Pose2, step: Vector2, turn: f64) -> bool {
        let length = step.norm() + if self.is_disc() { 0.0 } else { self.radius * turn.abs() };
        let mut done = 0.0;
        loop {
            let share = if length > 0.0 { done / length } else { 0.0 };
            let pose =
                Pose2::new(from.x + step.x * share, from.y + step.y * share, from.theta + turn * share);
            let left = length - done;
            let gap = self.gap(field, pose, left.max(MIN_ADVANCE_M));
            if gap <= 0.0 {
                return false;
            }
            if left <= 0.0 {
                return true;
            }
            done = (done + gap.max(MIN_ADVANCE_M)).min(length);
        }
    }

    /// A turn in place from one heading to another without contact, rad: the shorter turn if that is free.
    pub(crate) fn turn(&self, field: &DistanceField, from: Pose2, to: f64) -> Option<f64> {
        let short = trundle_core::difference_of_angles(to, from.theta);
        let long = short - std::f64::consts::TAU.copysign(short);
        let free = |turn: &f64| self.is_disc() || self.may_move(field, from, Vector2::zeros(), *turn);
        [short, long].into_iter().find(free)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::OccupancyGrid;
    use trundle_grid::UnknownIs;

    /// 0.6 x 0.4 m, the axle 0.15 m behind the centre.
    fn cart() -> RobotShape {
        let at = |x, y| Vector2::new(x, y);
        let corners = vec![at(0.45, 0.2), at(-0.15, 0.2), at(-0.15, -0.2), at(0.45, -0.2)];
        RobotShape::new(&Footprint::polygon(corners).unwrap())
    }

    #[test]
    fn the_largest_inscribed_disc_is_found() {
        let (at, radius) = cart().inscribed;
        assert!(
            (radius - 0.2).abs() < 1e-4 && at.y.abs() < 1e-3 && (0.04..0.26).contains(&at.x),
            "{at} {radius}"
        );
        let triangle = [(0.0, 0.0), (3.0, 0.0), (0.0, 4.0)].map(|(x, y)| Vector2::new(x, y)).to_vec();
        let (at, radius) = RobotShape::new(&Footprint::polygon(triangle).unwrap()).inscribed;
        assert!((radius - 1.0).abs() < 1e-3 && (at - Vector2::new(1.0, 1.0)).norm() < 5e-3, "{at} {radius}");
    }

    #[test]
    fn gaps_are_those_of_the_polygon() {
        let grid = OccupancyGrid::from_ascii(
            0.1,
            &format!("{}\n{}", "#".repeat(20), vec![".".repeat(20); 19].join("\n")),
        );
        let field = DistanceField::from_grid(&grid.unwrap(), UnknownIs::Free);
        let shape = cart();
        assert!((shape.inner - 0.15).abs() < 2e-4 && (shape.radius - 0.4925).abs() < 1e-3);
        for (theta, reach) in
            [(0.0_f64, 0.2), (90.0, 0.45), (180.0, 0.2), (-90.0, 0.15), (45.0, 0.65 / 2f64.sqrt())]
        {
            let gap = shape.gap(&field, Pose2::new(1.0, 1.4, theta.to_radians()), 1.0);
            assert!((gap - (0.5 - reach)).abs() < 2e-4, "{theta}: {gap}");
        }
        assert_eq!(shape.gap(&field, Pose2::new(1.0, 1.5, std::f64::consts::FRAC_PI_2), 1.0), 0.0);
        let aside = Pose2::new(1.0, 1.6, 0.0);
        assert!(shape.may_move(&field, aside, Vector2::new(0.3, 0.0), 0.0));
        assert!(!shape.may_move(&field, aside, Vector2::new(0.0, 0.11), 0.0));
        let long = shape.turn(&field, aside, 3.0).unwrap();
        assert!(
            (long - (3.0 - std::f64::consts::TAU)).abs() < 1e-12,
            "the shorter way round sweeps the wall: {long}"
        );
        let down = Pose2::new(1.0, 1.5, -1.9);
        let turn = shape.turn(&field, down, -0.2).unwrap();
        assert!((turn - 1.7).abs() < 1e-12);
    }
}
