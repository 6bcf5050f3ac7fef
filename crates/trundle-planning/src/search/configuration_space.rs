//! The configuration space: free positions of the robot, and their costs. Search, potential and curve share it.

use crate::masks::cost_mask::CostMask;
use crate::search::cell_points::CellPoints;
use crate::search::clearance_cost::ClearanceCostConfig;
use crate::search::escape::Escape;
use trundle_collision::square::point_to_square;
use trundle_core::{Cell, OccupancyGrid, Vector2};
use trundle_grid::DistanceField;

/// Difference of two clearances that counts as rounding error, m. Source: ours.
const CLEARANCE_TOLERANCE_M: f64 = 1e-6;
/// Loss of clearance between two checks along a straight line, m: step^2 / 8 radius, because the second derivative of the distance to a
/// convex obstacle is at most 1 / distance. Source: ours.
const MAX_DIP_M: f64 = 1e-4;
/// Number of cost steps per cell of clearance. Source: ours.
const COSTS_PER_CELL: f64 = 8.0;
/// Longest step between two checks, cells. Source: ours.
const MAX_CHECK_STEP_CELLS: f64 = 0.2;

/// The robot as a disc in a distance field.
pub(crate) struct ConfigurationSpace<'a> {
    pub(crate) field: &'a DistanceField,
    pub(crate) costs: ClearanceCostConfig,
    /// Radius of the disc that must be free, m.
    pub(crate) radius: f64,
    grid: &'a OccupancyGrid,
    /// Zone around a start with less clearance than the radius.
    escape: Option<Escape>,
    surely: f64,
    /// Cost per length by clearance, in 1/256, decreasing; each entry is the cost of the smallest clearance in its interval.
    prices: Vec<u16>,
    /// Number of costs per metre of clearance.
    per_price: f64,
    unknown_price: u16,
    /// Additional costs.
    cost_mask: Option<&'a CostMask>,
    /// Step between two checks along a straight line, m.
    check_step: f64,
    /// Whole cells from the grid's origin to the field's; `None` if the two are equal.
    shift: Option<(i64, i64)>,
    /// The representative point of each cell.
    points: CellPoints,
}

impl<'a> ConfigurationSpace<'a> {
    /// The configuration space of a disc of `radius` m. A start with less clearance than that is free, with an escape zone around.
    pub(crate) fn new(
        field: &'a DistanceField,
        grid: &'a OccupancyGrid,
        costs: ClearanceCostConfig,
        radius: f64,
        start: Vector2,
    ) -> Self {
        let at_start = field.clearance(start, radius);
        let missing = radius - at_start;
        let resolution = field.geometry().resolution;
        let escape = (missing > CLEARANCE_TOLERANCE_M).then(|| Escape::new(start, missing, resolution));
        let offset = (field.geometry().origin - grid.geometry().origin) / grid.geometry().resolution;
        let min = if missing > CLEARANCE_TOLERANCE_M { at_start } else { radius };
        let check_step =
            (8.0 * min * MAX_DIP_M).sqrt().max(1e-3).min(MAX_CHECK_STEP_CELLS * field.geometry().resolution);
        let is_same = field.geometry() == grid.geometry();
        let shift = (!is_same).then_some((offset.x.round() as i64, offset.y.round() as i64));
        let per_price = COSTS_PER_CELL / field.geometry().resolution;
        let limit = (costs.comfort.max(costs.margin) * per_price).ceil() as usize;
        let price = |density: f64| (density * 256.0) as u16;
        Self {
            field,
            costs,
            radius,
            grid,
            escape,
            surely: field.overestimate(radius),
            prices: (0..=limit).map(|i| price(costs.density(i as f64 / per_price))).collect(),
            per_price,
            unknown_price: price(costs.unknown_weight),
            cost_mask: None,
            check_step,
            shift,
            points: CellPoints::Centres,
        }
    }

    /// The same space with an additional cost mask.
    pub(crate) fn with_cost_mask(self, cost_mask: Option<&'a CostMask>) -> Self {
        Self { cost_mask, ..self }
    }

    /// The same space for a robot that is this disc and leaves `start`: the disc has its full radius against all obstacles that it does not
    /// overlap there.
    pub(crate) fn with_clearance_from_others(self, start: Vector2) -> Self {
        let (radius, half) = (self.radius, self.field.geometry().resolution / 2.0);
        let gap = |centre| (point_to_square(start, centre, half).norm() - radius).max(0.0);
        let escape = self.escape.map(|escape| escape.with_clearance_from_others(self.field, radius, gap));
        Self { escape, ..self }
    }

    /// The same space with other representative points than the cells' centres.
    pub(crate) fn with_points(self, points: CellPoints) -> Self {
        Self { points, ..self }
    }

    /// Cost of a metre at a point by the mask alone.
    fn mask_density(&self, point: Vector2) -> f64 {
        self.cost_mask.map_or(0.0, |mask| mask.share(point) * self.costs.mask_weight)
    }

    /// Whether the robot may be at a point.
    pub(crate) fn is_free(&self, point: Vector2) -> bool {
        self.has_clearance(point, 0.0)
    }

    /// Whether the clearance at a point is at most `short` m less than required: the radius, or less in the escape zone.
    pub(crate) fn has_clearance(&self, point: Vector2, short: f64) -> bool {
        let escape = self.escape.as_ref().filter(|escape| escape.covers(point));
        let Some(escape) = escape else { return self.field.has_clearance(point, self.radius - short) };
        self.field.has_clearance(point, self.radius - escape.depth - short)
            && escape.others().is_none_or(|others| others.has_clearance(point, self.radius - short))
    }

    /// Whether the robot may be at the representative point of a cell.
    pub(crate) fn is_free_cell(&self, linear: usize) -> bool {
        match &self.points {
            CellPoints::Centres => self.is_free_centre(linear),
            CellPoints::UpperCorners => self.is_free(self.point_of(linear)),
            CellPoints::Free(choice) => choice.is_free(linear),
        }
    }

    /// Whether the robot may be at the centre of a cell.
    pub(crate) fn is_free_centre(&self, linear: usize) -> bool {
        let distance = self.field.at_linear(linear);
        distance >= self.radius - CLEARANCE_TOLERANCE_M
            || (self.escape.is_some() && distance > 0.0 && self.is_free(self.centre(linear)))
    }

    /// Whether the straight move between neighbouring free cells `length` m apart is free.
    pub(crate) fn joins(&self, from: usize, to: usize, length: f64) -> bool {
        let min = self.field.at_linear(from).min(self.field.at_linear(to));
        if min * min >= self.radius * self.radius + length * length / 4.0 {
            return true;
        }
        self.connects(self.point_of(from), self.point_of(to))
    }

    /// Whether the robot may drive straight from `a` to `b`.
    pub(crate) fn connects(&self, a: Vector2, b: Vector2) -> bool {
        let length = (b - a).norm();
        let check_step = self.check_step;
        let mut at = 0.0;
        while at < length {
            let point = a + (b - a) * (at / length);
            let spare = self.field.distance(point) - self.surely - self.radius;
            if spare < 0.0 && !self.is_free(point) {
                return false;
            }
            at += spare.max(check_step);
        }
        self.is_free(b)
    }

    /// The cost of a metre at `distance` m from the nearest obstacle: 1 or more.
    fn density(&self, distance: f64, is_unknown: bool) -> f64 {
        let cost = self.costs.density(distance - self.radius);
        if is_unknown { cost + self.costs.unknown_weight } else { cost }
    }

    /// The highest cost of any cell.
    pub(crate) fn highest_price(&self) -> u16 {
        let cost_mask = if self.cost_mask.is_some() { (self.costs.mask_weight * 256.0) as u16 } else { 0 };
        self.prices[0] + self.unknown_price + cost_mask
    }

    /// The cost of a unit of length around the centre of a cell, in 1/256.
    pub(crate) fn cell_price(&self, linear: usize) -> u16 {
        let price = self.price_at(self.field.at_linear(linear));
        let price = if self.unknown_price > 0 && self.is_unknown(linear) {
            price + self.unknown_price
        } else {
            price
        };
        if self.cost_mask.is_none() {
            return price;
        }
        price + (self.mask_density(self.point_of(linear)) * 256.0) as u16
    }

    /// The cost in known space if no cell centre is farther than `distance` from obstacles; 0 if the robot does not fit.
    pub(crate) fn price_of_room(&self, distance: f32) -> u16 {
        let more = if matches!(self.points, CellPoints::Centres) { 0.0 } else { self.half_diagonal() };
        if f64::from(distance) + more < self.radius - CLEARANCE_TOLERANCE_M {
            0
        } else {
            self.price_at(f64::from(distance))
        }
    }

    fn price_at(&self, distance: f64) -> u16 {
        let place = ((distance - self.radius) * self.per_price).max(0.0) as usize;
        self.prices[place.min(self.prices.len() - 1)]
    }

    /// The largest distance of a cell's points from its centre, m.
    pub(crate) fn half_diagonal(&self) -> f64 {
        self.field.geometry().resolution * std::f64::consts::FRAC_1_SQRT_2
    }

    /// Column and row of a cell.
    pub(crate) fn place(&self, linear: usize) -> (u32, u32) {
        let (at, width) = (linear as u32, self.field.geometry().width as u32);
        (at % width, at / width)
    }

    /// The cost of a straight drive from `a` to `b`, sampled a cell apart.
    pub(crate) fn cost(&self, a: Vector2, b: Vector2) -> f64 {
        let length = (b - a).norm();
        let steps = (length / self.field.geometry().resolution).ceil().max(1.0);
        let sum: f64 = (0..steps as usize)
            .map(|i| {
                let point = a + (b - a) * ((i as f64 + 0.5) / steps);
                self.density(self.field.distance(point), self.grid.at(point) == Cell::Unknown)
                    + self.mask_density(point)
            })
            .sum();
        sum / steps * length
    }

    /// The representative point of a cell, map frame, m.
    pub(crate) fn point_of(&self, linear: usize) -> Vector2 {
        match &self.points {
            CellPoints::Centres => self.centre(linear),
            points => self.centre(linear) + points.offset(linear) * (self.field.geometry().resolution / 2.0),
        }
    }

    /// The centre of a cell, map frame, m.
    pub(crate) fn centre(&self, linear: usize) -> Vector2 {
        self.field.geometry().center(self.field.geometry().cell(linear))
    }

    fn is_unknown(&self, linear: usize) -> bool {
        let Some(shift) = self.shift else { return self.grid.cells()[linear] == Cell::Unknown };
        let cell = self.field.geometry().cell(linear);
        let (col, row) = (cell.col as i64 + shift.0, cell.row as i64 + shift.1);
        let geometry = self.grid.geometry();
        let inside = col >= 0 && row >= 0 && col < geometry.width as i64 && row < geometry.height as i64;
        !inside || self.grid.cells()[row as usize * geometry.width + col as usize] == Cell::Unknown
    }
}
