//! Where the robot may be, and what it costs to be there: the one judge that search, field and curve share.

use crate::escape::Escape;
use crate::geometry::box_gap;
use crate::masks::DearMask;
use crate::{DistanceField, RoomConfig};
use trundle_core::{Cell, OccupancyGrid, Vector2};

/// Rounding that a comparison of clearances forgives, m.
const ROUNDING: f64 = 1e-6;

/// What the room may dip between two looks along a straight line, m: step^2 / 8 radius, for the distance to a convex
/// obstacle bends by at most 1 / distance.
const DIP: f64 = 1e-4;
/// How finely prices follow the clearance.
const PRICES_A_CELL: f64 = 8.0;
/// Longest step of a look, cells.
const LOOK: f64 = 0.2;

/// The robot as a disc in a distance field.
pub(crate) struct Space<'a> {
    pub(crate) field: &'a DistanceField,
    pub(crate) room: RoomConfig,
    /// Radius of the disc that must stay free, m.
    pub(crate) radius: f64,
    grid: &'a OccupancyGrid,
    /// Around a start with less room than the radius.
    escape: Option<Escape>,
    surely: f64,
    /// Prices of a unit of way by clearance, in 1/256, falling; each is that of the least clearance it stands for.
    prices: Vec<u16>,
    /// Prices a metre of clearance.
    per_price: f64,
    unknown_price: u16,
    /// What is dear beside that.
    dear: Option<&'a DearMask>,
    /// Step of a look along a straight line, m.
    look: f64,
    /// Whole cells from the grid's origin to the field's; none where the two are the same.
    shift: Option<(i64, i64)>,
}

impl<'a> Space<'a> {
    /// The space of a disc of `radius` m. When `start` has less room than that, its room is enough around it.
    pub(crate) fn new(
        field: &'a DistanceField,
        grid: &'a OccupancyGrid,
        room: RoomConfig,
        radius: f64,
        start: Vector2,
    ) -> Self {
        let at_start = field.clearance(start, radius);
        let missing = radius - at_start;
        let resolution = field.geometry().resolution;
        let escape = (missing > ROUNDING).then(|| Escape::new(start, missing, resolution));
        let offset = (field.geometry().origin - grid.geometry().origin) / grid.geometry().resolution;
        let least = if missing > ROUNDING { at_start } else { radius };
        let look = (8.0 * least * DIP).sqrt().max(1e-3).min(LOOK * field.geometry().resolution);
        let is_same = field.geometry() == grid.geometry();
        let shift = (!is_same).then_some((offset.x.round() as i64, offset.y.round() as i64));
        let per_price = PRICES_A_CELL / field.geometry().resolution;
        let limit = (room.comfort.max(room.margin) * per_price).ceil() as usize;
        let price = |density: f64| (density * 256.0) as u16;
        Self {
            field,
            room,
            radius,
            grid,
            escape,
            surely: field.overestimate(radius),
            prices: (0..=limit).map(|i| price(room.density(i as f64 / per_price))).collect(),
            per_price,
            unknown_price: price(room.unknown_weight),
            dear: None,
            look,
            shift,
        }
    }

    /// The same, where some places are dear.
    pub(crate) fn with_dear(self, dear: Option<&'a DearMask>) -> Self {
        Self { dear, ..self }
    }

    /// The same for a robot that is this disc: leaving `start`, it keeps its radius from all that it is not too near to there.
    pub(crate) fn keeping_off_the_rest(self, start: Vector2) -> Self {
        let (radius, half) = (self.radius, self.field.geometry().resolution / 2.0);
        let gap = |centre| (box_gap(start, centre, half).norm() - radius).max(0.0);
        let escape = self.escape.map(|escape| escape.keeping_off_the_rest(self.field, radius, gap));
        Self { escape, ..self }
    }

    /// What a metre at a point costs for the mask alone.
    fn mask_density(&self, point: Vector2) -> f64 {
        self.dear.map_or(0.0, |mask| mask.share(point) * self.room.mask_weight)
    }

    /// Whether the robot may stand at a point.
    pub(crate) fn is_free(&self, point: Vector2) -> bool {
        self.keeps(point, 0.0)
    }

    /// Whether the room at a point is at most `short` m less than what must be kept there: the radius, less only around a start that
    /// has less.
    pub(crate) fn keeps(&self, point: Vector2, short: f64) -> bool {
        let escape = self.escape.as_ref().filter(|escape| escape.covers(point));
        let Some(escape) = escape else { return self.field.keeps(point, self.radius - short) };
        self.field.keeps(point, self.radius - escape.depth - short)
            && escape.others().is_none_or(|others| others.keeps(point, self.radius - short))
    }

    /// Whether the robot may stand at the centre of a cell.
    pub(crate) fn is_free_cell(&self, linear: usize) -> bool {
        let distance = self.field.at_linear(linear);
        distance >= self.radius - ROUNDING
            || (self.escape.is_some() && distance > 0.0 && self.is_free(self.center(linear)))
    }

    /// Whether the straight move between neighbouring free cells `length` m apart stays free.
    pub(crate) fn joins(&self, from: usize, to: usize, length: f64) -> bool {
        let least = self.field.at_linear(from).min(self.field.at_linear(to));
        if least * least >= self.radius * self.radius + length * length / 4.0 {
            return true;
        }
        self.sees(self.center(from), self.center(to))
    }

    /// Whether the robot may drive straight from `a` to `b`.
    pub(crate) fn sees(&self, a: Vector2, b: Vector2) -> bool {
        let length = (b - a).norm();
        let look = self.look;
        let mut at = 0.0;
        while at < length {
            let point = a + (b - a) * (at / length);
            let room = self.field.distance(point) - self.surely - self.radius;
            if room < 0.0 && !self.is_free(point) {
                return false;
            }
            at += room.max(look);
        }
        self.is_free(b)
    }

    /// The cost of a metre where the nearest obstacle is `distance` m away: 1 or more.
    fn density(&self, distance: f64, is_unknown: bool) -> f64 {
        let cost = self.room.density(distance - self.radius);
        if is_unknown { cost + self.room.unknown_weight } else { cost }
    }

    /// No cell has a higher price.
    pub(crate) fn highest_price(&self) -> u16 {
        let dear = if self.dear.is_some() { (self.room.mask_weight * 256.0) as u16 } else { 0 };
        self.prices[0] + self.unknown_price + dear
    }

    /// The cost of a unit of way around the centre of a cell, in 1/256.
    pub(crate) fn cell_price(&self, linear: usize) -> u16 {
        let price = self.price_at(self.field.at_linear(linear));
        let price = if self.unknown_price > 0 && self.is_unknown(linear) {
            price + self.unknown_price
        } else {
            price
        };
        if self.dear.is_none() {
            return price;
        }
        price + (self.mask_density(self.center(linear)) * 256.0) as u16
    }

    /// The price at a distance from obstacles, whatever is known; 0 where the robot does not fit.
    pub(crate) fn price_of_room(&self, distance: f32) -> u16 {
        if f64::from(distance) < self.radius - ROUNDING { 0 } else { self.price_at(f64::from(distance)) }
    }

    fn price_at(&self, distance: f64) -> u16 {
        let place = ((distance - self.radius) * self.per_price).max(0.0) as usize;
        self.prices[place.min(self.prices.len() - 1)]
    }

    /// Column and row of a cell.
    pub(crate) fn place(&self, linear: usize) -> (u32, u32) {
        let (at, width) = (linear as u32, self.field.geometry().width as u32);
        (at % width, at / width)
    }

    /// The cost of driving straight from `a` to `b`, sampled a cell apart.
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

    pub(crate) fn center(&self, linear: usize) -> Vector2 {
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
