//! Obstacles around the robot, as segments and points that a hull must not overlap.

use crate::scene::blocker::Blocker;
use crate::scene::cells::Cells;
use crate::scene::clearance_query::ClearanceQuery;
use crate::scene::outline::outlines;
use crate::scene::point_index::{PointIndex, PointQuery};
use std::sync::Arc;
use trundle_collision::{RoundedHull, Segment};
use trundle_core::{Cell, CellIndex, Footprint, GridGeometry, Invalid, OccupancyGrid, Pose2, Vector2};

/// An obstacle, map frame, m.
#[derive(Debug, Clone, PartialEq)]
pub enum Obstacle {
    /// A single point, as of a scan.
    Point(Vector2),
    /// A thin wall.
    Segment(Vector2, Vector2),
    /// A convex polygon, corners in either order.
    Polygon(Vec<Vector2>),
}

/// Counted cost of the distance of a segment, in units of [`crate::ContactSpace::work`]. Source: ours.
const DISTANCE_COST: u64 = 5;

/// A segment of an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObstacleSegment {
    /// Map frame, m.
    pub segment: Segment,
    /// Number of the obstacle.
    pub obstacle: u32,
}

/// All obstacles around the robot, indexed.
#[derive(Debug, Clone, PartialEq)]
pub struct ObstacleScene {
    pieces: Vec<ObstacleSegment>,
    points: Arc<PointIndex>,
    /// Convex and counter-clockwise polygons: their inside is in collision though no side is near.
    solids: Vec<(Vec<Vector2>, u32)>,
    /// The cells of a grid: their inside is in collision too.
    cells: Option<Arc<Cells>>,
}

impl ObstacleScene {
    /// A scene of obstacles in the map frame.
    ///
    /// # Errors
    /// When a coordinate is not finite, or a polygon is not convex or has no area; the error contains the obstacle's number.
    pub fn new(obstacles: &[Obstacle]) -> Result<Self, Invalid> {
        let (mut pieces, mut points, mut solids) = (Vec::new(), Vec::new(), Vec::new());
        for (i, obstacle) in obstacles.iter().enumerate() {
            let number = i as u32;
            match obstacle {
                Obstacle::Point(p) => points.push((finite(i, *p)?, number)),
                Obstacle::Segment(a, b) => {
                    let segment = Segment { a: finite(i, *a)?, b: finite(i, *b)? };
                    pieces.push(ObstacleSegment { segment, obstacle: number });
                }
                Obstacle::Polygon(corners) => {
                    let corners = convex(i, corners)?;
                    let next = corners.iter().cycle().skip(1);
                    let sides = corners.iter().zip(next).map(|(&a, &b)| Segment { a, b });
                    pieces.extend(sides.map(|segment| ObstacleSegment { segment, obstacle: number }));
                    solids.push((corners, number));
                }
            }
        }
        Ok(Self { pieces, points: Arc::new(PointIndex::new(points)), solids, cells: None })
    }

    /// The occupied cells of a grid that overlap the box of half side `half` (m) about `center`. With `unknown_blocks`, unknown cells and
    /// the space outside the grid are included.
    pub fn from_grid(grid: &OccupancyGrid, center: Vector2, half: f64, unknown_blocks: bool) -> Self {
        let geometry = *grid.geometry();
        let kind = |cell: CellIndex| match grid.get(cell) {
            Cell::Unknown if !unknown_blocks => Cell::Free,
            kind => kind,
        };
        let cells = Cells::new(geometry, center, half, unknown_blocks, kind);
        let number = |(i, segment): (usize, Segment)| ObstacleSegment { segment, obstacle: i as u32 };
        let rim = unknown_blocks.then(|| rim_of(&geometry)).into_iter().flatten();
        let pieces = outlines(&cells).into_iter().chain(rim).enumerate().map(number).collect();
        let points = Arc::new(PointIndex::new(Vec::new()));
        Self { pieces, points, solids: Vec::new(), cells: Some(Arc::new(cells)) }
    }

    /// The scene without segments outside a box of half side `half` (m) around `center`. Points remain: queries skip them by their tree.
    pub(crate) fn around(&self, center: Vector2, half: f64) -> Self {
        let pieces = self
            .pieces
            .iter()
            .filter(|p| touches_box(&p.segment, center, Vector2::repeat(half)))
            .copied()
            .collect();
        let near = |corners: &[Vector2]| corners.iter().any(|c| (c - center).amax() <= 2.0 * half);
        let solids = self.solids.iter().filter(|(corners, _)| near(corners) || holds(corners, center));
        let (points, cells) = (Arc::clone(&self.points), self.cells.clone());
        Self { pieces, points, solids: solids.cloned().collect(), cells }
    }

    /// Calls `visit` with every segment in a box about `center`.
    pub fn visit(&self, center: Vector2, half: f64, visit: impl FnMut(&Segment, u32)) {
        self.visit_box(center, Vector2::repeat(half), visit);
    }

    /// Calls `visit` with every segment and point in a box of these half sides about `center`.
    pub fn visit_box(&self, center: Vector2, half: Vector2, mut visit: impl FnMut(&Segment, u32)) {
        self.visit_pieces(center, half, &mut visit);
        self.visit_points(center, half, |p, number| visit(&Segment::point(p), number));
    }

    pub(crate) fn visit_pieces(&self, center: Vector2, half: Vector2, mut visit: impl FnMut(&Segment, u32)) {
        for piece in self.pieces.iter().filter(|piece| touches_box(&piece.segment, center, half)) {
            visit(&piece.segment, piece.obstacle);
        }
    }

    pub(crate) fn visit_points(&self, center: Vector2, half: Vector2, visit: impl FnMut(Vector2, u32)) {
        self.points.visit(center, half, visit);
    }

    /// Runs a query over all points; returns its cost.
    pub(crate) fn run_query(&self, query: &mut impl PointQuery) -> u64 {
        self.points.run_query(query)
    }

    /// Distance of a footprint at a pose from the nearest obstacle, m, 0 for an overlap, and that obstacle; `None` without an obstacle
    /// within `reach` (m).
    pub fn clearance(&self, footprint: &Footprint, pose: &Pose2, reach: f64) -> Option<(f64, Blocker)> {
        self.clearance_of(&RoundedHull::exact(footprint), pose, reach)
    }

    pub(crate) fn clearance_of(
        &self,
        hull: &RoundedHull,
        pose: &Pose2,
        reach: f64,
    ) -> Option<(f64, Blocker)> {
        self.nearest(hull, pose, reach).0
    }

    /// The nearest obstacle as in [`ObstacleScene::clearance`], and the cost of the query.
    pub(crate) fn nearest(
        &self,
        hull: &RoundedHull,
        pose: &Pose2,
        reach: f64,
    ) -> (Option<(f64, Blocker)>, u64) {
        let (sin, cos) = pose.theta.sin_cos();
        let mut best: Option<(f64, Blocker)> = None;
        let mut work = self.pieces.len() as u64;
        let half = Vector2::repeat(hull.outer_radius() + reach);
        self.visit_pieces(pose.position(), half, |segment, number| {
            let distance = hull.distance(&segment.in_frame(pose.position(), cos, sin));
            offer(&mut best, reach, distance, || Blocker::listed(number, segment.nearest(pose.position())));
            work += DISTANCE_COST;
        });
        work += self.points.run_query(&mut ClearanceQuery::new(hull, pose, reach, &mut best));
        let corner = hull.corners_at(pose).next().expect("invariant: a hull has a corner");
        for (corners, number) in self.solids.iter().filter(|(corners, _)| holds(corners, corner)) {
            offer(&mut best, reach, 0.0, || Blocker::listed(*number, corners[0]));
        }
        if self.cells.as_ref().is_some_and(|cells| cells.hold(corner)) {
            offer(&mut best, reach, 0.0, || Blocker::listed(self.pieces.len() as u32, corner));
        }
        (best, work)
    }

    /// The obstacle for a person: of a grid, the cell rather than a segment of an outline.
    pub(crate) fn named(&self, blocker: Blocker) -> Blocker {
        self.cells.as_ref().map_or(blocker, |cells| blocker.among(cells))
    }

    /// The number of points and straight pieces.
    pub fn len(&self) -> usize {
        self.pieces.len() + self.points.all().len()
    }

    /// Whether the scene has no obstacles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The straight pieces, for drawing.
    pub fn pieces(&self) -> &[ObstacleSegment] {
        &self.pieces
    }

    /// The points, for drawing, map frame, m.
    pub fn points(&self) -> impl ExactSizeIterator<Item = Vector2> + '_ {
        self.points.all().iter().map(|(p, _)| *p)
    }
}

/// Keeps an obstacle that is nearer than `reach` and the best so far, m.
fn offer(best: &mut Option<(f64, Blocker)>, reach: f64, distance: f64, blocker: impl Fn() -> Blocker) {
    if distance < best.map_or(reach, |(min, _)| min) {
        *best = Some((distance, blocker()));
    }
}

fn finite(i: usize, p: Vector2) -> Result<Vector2, Invalid> {
    if p.x.is_finite() && p.y.is_finite() {
        return Ok(p);
    }
    Err(Invalid::new(format!("obstacle {i}"), format!("({}, {})", p.x, p.y), "m", "finite coordinates"))
}

/// The corners counter-clockwise; refuses a polygon that is not convex, by the footprint's own rule.
fn convex(i: usize, corners: &[Vector2]) -> Result<Vec<Vector2>, Invalid> {
    let named = |e: Invalid| Invalid {
        field: format!("obstacle {i}: {}", e.field.replace("footprint", "polygon")),
        ..e
    };
    match Footprint::polygon(corners.to_vec()).map_err(named)? {
        Footprint::Polygon { corners } => Ok(corners),
        Footprint::Disc { .. } => Ok(Vec::new()),
    }
}

fn holds(corners: &[Vector2], p: Vector2) -> bool {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).all(|(a, b)| (b - a).perp(&(p - a)) >= 0.0)
}

fn touches_box(segment: &Segment, center: Vector2, half: Vector2) -> bool {
    let (a, b) = (segment.a - center, segment.b - center);
    a.x.min(b.x) <= half.x && a.x.max(b.x) >= -half.x && a.y.min(b.y) <= half.y && a.y.max(b.y) >= -half.y
}

/// The four sides of a grid.
fn rim_of(geometry: &GridGeometry) -> [Segment; 4] {
    let low = geometry.origin;
    let high = low + Vector2::new(geometry.width as f64, geometry.height as f64) * geometry.resolution;
    let corners = [low, Vector2::new(high.x, low.y), high, Vector2::new(low.x, high.y)];
    std::array::from_fn(|i| Segment { a: corners[i], b: corners[(i + 1) % 4] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::blocker::BlockerKind;

    #[test]
    fn invalid_obstacles_are_refused_with_their_number() {
        let error = ObstacleScene::new(&[Obstacle::Point(Vector2::new(f64::NAN, 0.0))]).unwrap_err();
        assert_eq!(error.field, "obstacle 0");
        let corners = [(0., 0.), (2., 0.), (0.5, 0.5), (0., 2.)].map(|(x, y)| Vector2::new(x, y)).to_vec();
        let error = ObstacleScene::new(&[Obstacle::Polygon(corners)]).unwrap_err();
        assert!(error.to_string().contains("obstacle 0: polygon"), "{error}");
    }

    #[test]
    fn the_outside_of_the_map_is_unknown() {
        let grid = OccupancyGrid::from_ascii(0.1, &("..........\n".repeat(10))).unwrap();
        let clear = |unknown_blocks: bool, x: f64| {
            let scene = ObstacleScene::from_grid(&grid, Vector2::new(0.5, 0.5), 3.0, unknown_blocks);
            let robot = Footprint::Disc { radius: 0.1 };
            scene.clearance(&robot, &Pose2::new(x, 0.5, 0.0), 0.01).map(|(distance, _)| distance)
        };
        assert_eq!((clear(true, 0.5), clear(true, 0.95), clear(true, 2.5)), (None, Some(0.0), Some(0.0)));
        assert_eq!((clear(false, 0.95), clear(false, 2.5)), (None, None));
    }

    #[test]
    fn the_inside_of_a_solid_is_in_collision() {
        let corners = [(-5., -5.), (5., -5.), (5., 5.), (-5., 5.)].map(|(x, y)| Vector2::new(x, y)).to_vec();
        let scene = ObstacleScene::new(&[Obstacle::Polygon(corners)]).unwrap();
        let (distance, blocker) = scene.clearance(&Footprint::KOBUKI, &Pose2::IDENTITY, 1.0).unwrap();
        assert_eq!((distance, blocker.thing), (0.0, BlockerKind::Listed(0)));
        let grid = OccupancyGrid::from_ascii(1.0, "####\n####\n####\n####").unwrap();
        let scene = ObstacleScene::from_grid(&grid, Vector2::new(2.0, 2.0), 3.0, false);
        assert_eq!(scene.clearance(&Footprint::KOBUKI, &Pose2::new(1.5, 1.5, 0.0), 1.0).unwrap().0, 0.0);
    }
}
