//! Zones: areas of the floor with a rule for the robot.

use crate::{Invalid, MAX_COORDINATE_M, Vector2, require_in};
use serde::{Deserialize, Serialize};

/// Largest number of corners of a zone. A person draws fewer; the check of crossing sides grows with the square. Source: ours.
pub const MAX_ZONE_CORNERS: usize = 200;
/// Range of a speed limit \[m/s\]. Source: ours; below it a base's wheels stick.
pub const SPEED_LIMIT_RANGE_M_S: (f64, f64) = (0.05, 10.0);
/// Longest name of a zone or place \[characters\]. Source: ours; a line of a page.
pub(crate) const MAX_NAME_CHARS: usize = 60;
/// Smallest area of a zone \[m^2\]: a square of 1 cm. Source: ours; a smaller zone is drawn by mistake.
const MIN_ZONE_AREA_M2: f64 = 1e-4;

/// An area of the floor with a rule for the robot, map frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Zone {
    /// Number of the zone, unique among zones and places of a map.
    pub id: u32,
    /// Name of the zone; may be empty.
    pub name: String,
    /// Rule of the zone.
    pub kind: ZoneKind,
    /// Corners \[m\], three or more, in either order; the last is joined to the first. No two sides cross.
    pub outline: Vec<[f64; 2]>,
}

/// The rule of a zone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ZoneKind {
    /// The robot plans no path through the zone.
    NoGo,
    /// The robot plans at most this speed in the zone \[m/s\].
    Slow(f64),
    /// No rule: it has a name alone.
    Area,
}

impl Zone {
    /// The zone, its numbers checked.
    ///
    /// # Errors
    /// When the name is too long or contains control characters, or a number is not finite or out of range. When the number of corners is
    /// too small or too large, two sides cross, or the zone has no area.
    pub fn validated(self) -> Result<Self, Invalid> {
        let label = self.label();
        require_name(&label, &self.name)?;
        if let ZoneKind::Slow(speed) = self.kind {
            let (min, max) = SPEED_LIMIT_RANGE_M_S;
            require_in(&format!("speed of {label}"), speed, "m/s", min, max)?;
        }
        let corners = self.outline.len();
        if !(3..=MAX_ZONE_CORNERS).contains(&corners) {
            let expected = format!("3 to {MAX_ZONE_CORNERS}");
            return Err(Invalid::new(format!("number of corners of {label}"), corners, "", expected));
        }
        for value in self.outline.iter().flatten() {
            let field = format!("corner of {label}");
            require_in(&field, *value, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
        }
        if let Some((i, j)) = crossing_sides(&self.corners()) {
            let value = format!("crossed by itself, at its sides {} and {}", i + 1, j + 1);
            return Err(Invalid::new(format!("outline of {label}"), value, "", "sides that do not cross"));
        }
        let area = self.area();
        if area < MIN_ZONE_AREA_M2 {
            let expected = format!("{MIN_ZONE_AREA_M2} or more");
            return Err(Invalid::new(format!("area of {label}"), area, "m^2", expected));
        }
        Ok(self)
    }

    /// Name in messages: `zone 'stairs'`, `zone 3`, or `the new zone` before a number is assigned.
    #[must_use]
    pub fn label(&self) -> String {
        match self.name.trim() {
            "" if self.id == 0 => "the new zone".to_owned(),
            "" => format!("zone {}", self.id),
            _ => format!("zone '{}'", self.name),
        }
    }

    /// Corners of the zone, map frame \[m\].
    #[must_use]
    pub fn corners(&self) -> Vec<Vector2> {
        self.outline.iter().map(|[x, y]| Vector2::new(*x, *y)).collect()
    }

    /// Lowest and highest x and y of the corners \[m\].
    #[must_use]
    pub fn bounds(&self) -> (Vector2, Vector2) {
        let none = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        self.corners().iter().fold(none, |(low, high), corner| (low.inf(corner), high.sup(corner)))
    }

    /// Area within the outline \[m^2\].
    #[must_use]
    pub fn area(&self) -> f64 {
        let corners = self.corners();
        let next = corners.iter().cycle().skip(1);
        (corners.iter().zip(next).map(|(a, b)| a.perp(b)).sum::<f64>() / 2.0).abs()
    }
}

/// Checks the name of a zone or place.
pub(crate) fn require_name(label: &str, name: &str) -> Result<(), Invalid> {
    let expected = || format!("at most {MAX_NAME_CHARS} characters, none of them a control character");
    if name.chars().count() > MAX_NAME_CHARS || name.chars().any(char::is_control) {
        let shown: String = name.chars().filter(|c| !c.is_control()).take(MAX_NAME_CHARS).collect();
        return Err(Invalid::new(format!("name of {label}"), format!("'{shown}'"), "", expected()));
    }
    Ok(())
}

/// The first two sides of an outline that touch and are not neighbours, or that fold back onto each other.
fn crossing_sides(corners: &[Vector2]) -> Option<(usize, usize)> {
    let count = corners.len();
    let side = |i: usize| (corners[i], corners[(i + 1) % count]);
    for i in 0..count {
        for j in i + 1..count {
            let is_next = j == i + 1;
            let is_last = i == 0 && j == count - 1;
            let touches = match (is_next, is_last) {
                (true, _) => folds_back(side(i), side(j)),
                (_, true) => folds_back(side(j), side(i)),
                _ => segments_touch(side(i), side(j)),
            };
            if touches {
                return Some((i, j));
            }
        }
    }
    None
}

/// Whether the second of two joined sides overlaps the first, or has length zero.
fn folds_back((a, b): (Vector2, Vector2), (_, c): (Vector2, Vector2)) -> bool {
    let (first, second) = (b - a, c - b);
    first.perp(&second) == 0.0 && first.dot(&second) <= 0.0
}

fn segments_touch((a, b): (Vector2, Vector2), (c, d): (Vector2, Vector2)) -> bool {
    let turn = |p: Vector2, q: Vector2, r: Vector2| (q - p).perp(&(r - p));
    let is_within = |p: Vector2, q: Vector2, r: Vector2| {
        turn(p, q, r) == 0.0
            && (p.x.min(q.x)..=p.x.max(q.x)).contains(&r.x)
            && (p.y.min(q.y)..=p.y.max(q.y)).contains(&r.y)
    };
    let crosses = turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
    crosses || is_within(a, b, c) || is_within(a, b, d) || is_within(c, d, a) || is_within(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zone(outline: &[[f64; 2]]) -> Zone {
        Zone { id: 3, name: "stairs".to_owned(), kind: ZoneKind::NoGo, outline: outline.to_vec() }
    }

    fn refusal(zone: Zone) -> String {
        zone.validated().unwrap_err().to_string()
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    #[test]
    fn zones_in_either_order_and_with_corners_inwards_are_taken() {
        assert!(zone(&SQUARE).validated().is_ok());
        let mut reversed = SQUARE;
        reversed.reverse();
        assert!(zone(&reversed).validated().is_ok());
        let hook =
            [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        assert!(zone(&hook).validated().is_ok());
        assert_eq!(zone(&hook).bounds(), (Vector2::new(0.0, 0.0), Vector2::new(3.0, 3.0)));
    }

    #[test]
    fn a_wrong_outline_is_refused_with_the_reason() {
        let bow = refusal(zone(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]));
        assert_eq!(
            bow,
            "outline of zone 'stairs' is crossed by itself, at its sides 1 and 3, expected sides that do not cross"
        );
        let nan = refusal(zone(&[[0.0, 0.0], [f64::NAN, 0.0], [1.0, 1.0]]));
        assert_eq!(nan, "corner of zone 'stairs' is NaN m, expected -1000000 to 1000000");
        assert!(refusal(zone(&[[0.0, 0.0], [1.0, 0.0]])).contains("is 2, expected 3 to 200"));
        assert!(refusal(zone(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])).contains("crossed"));
        let ring =
            (0..500).map(|i| (0.0126 * f64::from(i)).sin_cos()).map(|(x, y)| [x, y]).collect::<Vec<_>>();
        assert!(refusal(zone(&ring)).contains("is 500, expected 3 to 200"));
        assert!(zone(&ring[..200]).validated().is_ok());
        let spike = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.5], [0.0, 1.0]];
        assert!(refusal(zone(&spike)).contains("crossed"), "a side that folds back");
        let touching = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]];
        assert!(refusal(zone(&touching)).contains("crossed"), "a corner on another side");
        assert!(refusal(zone(&[[0.0, 0.0], [1e-3, 0.0], [0.0, 1e-3]])).contains("area"));
    }

    #[test]
    fn names_and_speeds_are_checked() {
        let named = |name: &str| Zone { name: name.to_owned(), ..zone(&SQUARE) };
        assert!(named("").validated().is_ok() && named("Küche 2").validated().is_ok());
        assert!(refusal(named("a\nb")).contains("control character"));
        assert!(refusal(named(&"x".repeat(61))).contains("at most 60"));
        let slow = |speed| Zone { kind: ZoneKind::Slow(speed), ..zone(&SQUARE) };
        assert!(slow(0.1).validated().is_ok());
        assert_eq!(refusal(slow(0.0)), "speed of zone 'stairs' is 0 m/s, expected 0.05 to 10");
        assert!(slow(f64::NAN).validated().is_err());
    }
}
