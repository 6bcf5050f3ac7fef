use super::{Outline, World};
use trundle_core::{Footprint, Invalid, Pose2, require_finite, require_in};

/// The heights between which something is in the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightBand {
    low: f64,
    high: f64,
}

impl HeightBand {
    /// Above `low` and below `high`, m above the floor.
    ///
    /// # Errors
    /// When a bound is not finite or `high` is not above `low`.
    pub fn new(low: f64, high: f64) -> Result<Self, Invalid> {
        require_finite("low end of the height band", low, "m")?;
        require_finite("high end of the height band", high, "m")?;
        if high > low {
            Ok(Self { low, high })
        } else {
            Err(Invalid::new("high end of the height band", high, "m", format!("more than {low}")))
        }
    }
}

/// The outlines of everything in a height band: what a robot of that height can touch.
#[derive(Debug, Clone)]
pub(crate) struct Obstacles {
    outlines: Vec<Outline>,
}

impl Obstacles {
    /// Metres between a footprint standing at `pose` and the nearest of them, 0 or less in contact; infinite when
    /// there is none.
    pub(crate) fn clearance(&self, footprint: &Footprint, pose: Pose2) -> f64 {
        let robot = Outline::of_footprint(footprint, pose);
        self.outlines.iter().map(|outline| outline.clearance(&robot)).fold(f64::INFINITY, f64::min)
    }

    pub(super) fn outlines(&self) -> &[Outline] {
        &self.outlines
    }
}

impl World {
    /// Everything that reaches into a height band.
    pub(crate) fn obstacles(&self, band: HeightBand) -> Obstacles {
        let reaches = |shape: &super::Shape| {
            let bounds = shape.aabb();
            bounds.max.z > band.low && bounds.min.z < band.high
        };
        let outlines = self.solids.iter().zip(&self.outlines).filter(|(solid, _)| reaches(&solid.shape));
        Obstacles { outlines: outlines.map(|(_, outline)| outline.clone()).collect() }
    }

    /// Metres between a footprint standing at `pose` (`world_from_base`) and the nearest solid of the height band;
    /// 0 or less in contact, infinite when there is none.
    ///
    /// # Errors
    /// When the pose is not finite.
    pub fn clearance(&self, footprint: &Footprint, pose: Pose2, band: HeightBand) -> Result<f64, Invalid> {
        require_in("pose x", pose.x, "m", -1e9, 1e9)?;
        require_in("pose y", pose.y, "m", -1e9, 1e9)?;
        require_finite("pose theta", pose.theta, "rad")?;
        Ok(self.obstacles(band).clearance(footprint, pose))
    }

    /// Whether a footprint standing at `pose` (`world_from_base`) touches a solid of the height band.
    ///
    /// # Errors
    /// When the pose is not finite.
    pub fn collides(&self, footprint: &Footprint, pose: Pose2, band: HeightBand) -> Result<bool, Invalid> {
        Ok(self.clearance(footprint, pose, band)? <= 0.0)
    }
}
