//! The data of one planning request on one distance field, and what all planners of a request share.

use crate::config::PlannerConfig;
use crate::curve::analytic_curve::Curve;
use crate::curve::phase::Phase;
use crate::curve::route::{RouteContext, route};
use crate::masks::cost_mask::CostMask;
use crate::masks::keep_out::is_unknown_ahead;
use crate::masks::speed_mask::SpeedMask;
use crate::plan::{MAX_CLEARANCE_M, Plan, PlanResult};
use crate::polygon::lattice_planner::LatticePlanner;
use crate::polygon::robot_shape::RobotShape;
use crate::query::stage_timer::StageTimer;
use crate::search::cell_points::CellPoints;
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::free_points::free_points;
use crate::search::geodesic_search::GeodesicSearch;
use crate::search::grid_path::GridPath;
use crate::search::waypoint_graph::WaypointGraph;
use crate::timing::speeds::DriveModel;
use crate::timing::trajectory::trajectory;
use trundle_core::{OccupancyGrid, Path, Pose2, Trajectory, Twist2, Vector2};
use trundle_grid::DistanceField;

/// Distance of two positions that still are the same place, m. Source: ours.
pub(crate) const SAME_PLACE_M: f64 = 1e-3;
/// Speed below which a robot counts as at rest, m/s. Source: ours.
pub(crate) const REST_SPEED_M_S: f64 = 0.01;
/// Smallest radius of a search, m; used for an axle outside the footprint, whose clearance is 0. Source: ours.
pub(crate) const MIN_SEARCH_RADIUS_M: f64 = 0.01;

/// One planning request on one distance field.
pub(crate) struct PlanQuery<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) shape: &'a RobotShape,
    pub(crate) drive: &'a DriveModel,
    pub(crate) field: &'a DistanceField,
    pub(crate) grid: &'a OccupancyGrid,
    pub(crate) speeds: Option<&'a SpeedMask>,
    pub(crate) cost_mask: Option<&'a CostMask>,
    pub(crate) graph: Option<&'a WaypointGraph>,
    pub(crate) timer: &'a StageTimer,
    /// Whether cells use other points than their centres: on the second attempt, for gaps that just fit the robot.
    pub(crate) is_fine: bool,
}

/// The searches' buffers, reused from plan to plan.
#[derive(Debug, Default)]
pub(crate) struct SearchBuffers {
    pub(crate) search: GeodesicSearch,
    pub(crate) lattice_planner: LatticePlanner,
}

impl PlanQuery<'_> {
    /// The configuration space of a disc.
    pub(crate) fn configuration_space(&self, radius: f64, start: Vector2) -> ConfigurationSpace<'_> {
        let space = self.space_of_centres(radius, start);
        let space = if self.shape.is_disc() { space.with_clearance_from_others(start) } else { space };
        if !self.is_fine {
            return space;
        }
        let points = free_points(&space);
        space.with_points(points)
    }

    /// The configuration space for the search over the headings of a polygon.
    pub(crate) fn polygon_space(&self, radius: f64, start: Vector2) -> ConfigurationSpace<'_> {
        let space = self.space_of_centres(radius, start);
        // On cells of half the side the upper right corners are the centres, corners and middles of edges of the original cells.
        if self.is_fine { space.with_points(CellPoints::UpperCorners) } else { space }
    }

    fn space_of_centres(&self, radius: f64, start: Vector2) -> ConfigurationSpace<'_> {
        ConfigurationSpace::new(self.field, self.grid, self.config.room, radius, start)
            .with_cost_mask(self.cost_mask)
    }

    pub(crate) fn context<'b>(&'b self, space: &'b ConfigurationSpace<'b>) -> RouteContext<'b> {
        let shape = (!self.shape.is_disc()).then_some(self.shape);
        RouteContext { space, shape, config: &self.config.curve }
    }

    /// Whether the footprint is free of contact.
    pub(crate) fn fits(&self, pose: Pose2) -> bool {
        self.shape.gap(self.field, pose, 1e-3) > 0.0
    }

    /// [`route`], timed.
    pub(crate) fn route(
        &self,
        context: &RouteContext<'_>,
        path: &[Vector2],
        start: Pose2,
        goal: Pose2,
        moving: Option<f64>,
    ) -> Option<Vec<Phase>> {
        self.timer.time(|times| &mut times.curve, || route(context, path, start, goal, moving))
    }

    /// The arc on which the robot comes to rest as fast as timing allows.
    pub(crate) fn brake(&self, start: Pose2, twist: Twist2) -> Curve {
        let curvature = twist.omega / twist.v;
        let deceleration = self.drive.acceleration(curvature);
        let length = twist.v * twist.v / (2.0 * deceleration);
        // A little longer than exact: the quintic is a little shorter than the arc.
        Curve::arc(start, curvature, (length * 1.001).max(2.0 * SAME_PLACE_M))
    }

    pub(crate) fn timed(
        &self,
        path: GridPath,
        phases: Vec<Phase>,
        start: Pose2,
        v: f64,
        is_continuous: bool,
    ) -> Plan {
        let timing = || trajectory(start, &phases, v, self.drive, |pose| self.ceiling(pose));
        let trajectory = self.timer.time(|times| &mut times.timing, timing);
        let min_clearance =
            self.timer.time(|times| &mut times.curve, || self.smallest_clearance(&trajectory));
        let lengths = phases.iter().map(|phase| match phase {
            Phase::Drive(curve) => curve.length(),
            Phase::Turn { .. } => 0.0,
        });
        let length = lengths.fold(0.0, |sum, length| sum + length);
        let to_path = |points| Path::new(points).expect("invariant: waypoints are finite");
        Plan::Found(Box::new(PlanResult {
            waypoints: to_path(path.points),
            raw: to_path(path.raw),
            phases,
            trajectory,
            length,
            min_clearance,
            fell_back: path.fell_back,
            is_continuous,
            instead_of: None,
            wait: 0.0,
        }))
    }

    /// The highest speed at a pose by clearance, unknown space and speed mask, m/s.
    pub(crate) fn ceiling(&self, pose: Pose2) -> f64 {
        let at = pose.position();
        let near = self.drive.near_obstacles(self.field.distance(at) - self.shape.radius);
        let is_unknown = is_unknown_ahead(self.grid, pose, self.shape.radius);
        let exploring = if is_unknown { self.drive.config.unknown_speed } else { f64::INFINITY };
        near.min(exploring).min(self.speeds.map_or(f64::INFINITY, |mask| mask.limit(at)))
    }

    /// The smallest exact clearance of the robot along the trajectory, m. Cells are measured only if the interpolated distance could reduce
    /// it.
    fn smallest_clearance(&self, trajectory: &Trajectory) -> f64 {
        if self.shape.depth() > 0.0 {
            return -self.shape.depth();
        }
        let radius = self.shape.radius;
        let surely = self.field.overestimate(radius);
        trajectory.points().iter().fold(MAX_CLEARANCE_M, |min, point| {
            let at = point.pose.position();
            if self.field.distance(at) - surely - radius > min {
                min
            } else if self.shape.is_disc() {
                self.field.clearance(at, min + radius) - radius
            } else {
                self.shape.gap(self.field, point.pose, min)
            }
        })
    }
}
