use crate::{Invalid, Stamp, Vector2};

/// What one bearing of a scan says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beam {
    /// An obstacle at this range, m; everything nearer is free.
    Hit {
        /// Metres.
        range: f64,
    },
    /// No obstacle up to this range, m, and nothing known beyond.
    Free {
        /// Metres.
        range: f64,
    },
    /// Nothing is known along this bearing.
    Unseen,
}

/// A laser-like scan in a horizontal plane: beam i looks along `angle_min + i * angle_increment` from the sensor.
///
/// Its frame is the base frame's plane with the origin at `origin`: bearings are about `origin`, angles from x.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    stamp: Stamp,
    origin: Vector2,
    angle_min: f64,
    angle_increment: f64,
    beams: Vec<Beam>,
}

impl Scan {
    /// A scan whose beams start at `origin` (base frame, m).
    ///
    /// # Errors
    /// When an angle or the origin is not finite, the increment is not positive, or a range is not finite and >= 0.
    pub fn new(
        stamp: Stamp,
        origin: Vector2,
        angle_min: f64,
        angle_increment: f64,
        beams: Vec<Beam>,
    ) -> Result<Self, Invalid> {
        crate::require_finite("scan origin x", origin.x, "m")?;
        crate::require_finite("scan origin y", origin.y, "m")?;
        crate::require_finite("angle_min", angle_min, "rad")?;
        crate::require_positive("angle_increment", angle_increment, "rad")?;
        for (i, beam) in beams.iter().enumerate() {
            if let Beam::Hit { range } | Beam::Free { range } = beam
                && !(range.is_finite() && *range >= 0.0)
            {
                return Err(Invalid::new(
                    format!("range of beam {i}"),
                    range,
                    "m",
                    "a finite number, 0 or more",
                ));
            }
        }
        Ok(Self { stamp, origin, angle_min, angle_increment, beams })
    }

    /// When it was taken.
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    /// Where the beams start, base frame, m.
    pub fn origin(&self) -> Vector2 {
        self.origin
    }

    /// The beams, by rising angle.
    pub fn beams(&self) -> &[Beam] {
        &self.beams
    }

    /// The bearing of beam `i`, rad, base frame.
    pub fn angle(&self, i: usize) -> f64 {
        self.angle_min + i as f64 * self.angle_increment
    }

    /// The bearing of the first beam, rad, base frame.
    pub fn angle_min(&self) -> f64 {
        self.angle_min
    }

    /// The angle between neighbouring beams, rad.
    pub fn angle_increment(&self) -> f64 {
        self.angle_increment
    }

    /// The point at `range` along beam `i`, base frame, m.
    pub fn point(&self, i: usize, range: f64) -> Vector2 {
        let angle = self.angle(i);
        self.origin + Vector2::new(angle.cos(), angle.sin()) * range
    }

    /// The obstacle points, base frame, m, by rising angle.
    pub fn hits(&self) -> impl Iterator<Item = Vector2> + '_ {
        self.beams.iter().enumerate().filter_map(|(i, beam)| match beam {
            Beam::Hit { range } => Some(self.point(i, *range)),
            _ => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_are_points_and_nan_is_refused() {
        let beams = vec![Beam::Hit { range: 2.0 }, Beam::Unseen, Beam::Free { range: 3.0 }];
        let scan = Scan::new(Stamp::default(), Vector2::new(0.1, 0.0), 0.0, 0.5, beams).unwrap();
        assert_eq!(scan.hits().collect::<Vec<_>>(), vec![Vector2::new(2.1, 0.0)]);
        let beams = vec![Beam::Hit { range: f64::NAN }];
        let error = Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 0.5, beams).unwrap_err();
        assert_eq!(error.field, "range of beam 0");
    }
}
