//! Settings of the particle filter.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};
use trundle_grid::MapperConfig;

/// The settings of [`crate::ParticleMapper`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ParticleConfig {
    /// Number of particles, 1 to 1000. More close longer loops; time and memory grow in proportion. Default 30 (\[Grisetti07\] uses 15 to
    /// 80).
    pub particles: usize,
    /// The maps. Default: a laser with a range of 80 m and no blind range.
    pub map: MapperConfig,
    /// The odometry's errors.
    pub motion: MotionConfig,
    /// Odometry without drift, such as poses of a SLAM with loop closure. Each pose counts as a measurement, and no loops are searched.
    /// After [`crate::ParticleMapper::kidnapped`] only the steps count, since the pose of that odometry in the map is unknown. Default:
    /// none, dead reckoning.
    pub pose_prior: Option<PosePriorConfig>,
    /// Distance from the last processed scan at which a scan is processed, m, 0 to 5. Default 0.3.
    pub move_gate: f64,
    /// Turn from the last processed scan at which a scan is processed, deg, 0 to 180. Default 10.
    pub turn_gate_deg: f64,
    /// Time since the last processed scan after which a scan is processed, s, 0 to 3600. Default 2: odometry may miss a motion, as when the
    /// robot is pushed.
    pub wait_gate: f64,
    /// Largest motion of the odometry between two scans, m, 0.5 to 1000. A longer step is a jump, not a motion. Default 5.
    pub jump: f64,
    /// One sigma of a range, m, 0.001 to 0.5. Default 0.02 (SICK LMS 200: 0.01 to 0.02).
    pub range_noise: f64,
    /// Growth of the range's sigma with the square of the range, m/m^2, 0 to 0.1. Default 0: a laser; 0.0015 for a Kinect.
    pub range_noise_growth: f64,
    /// Fraction of outlier beams (people, glass), 0.001 to 0.5. Default 0.05.
    pub outliers: f64,
    /// Number of beams with correlated errors, 1 to 100. The log-likelihood of a scan is divided by it. Default 4.
    pub correlation: f64,
    /// Further divisor of the log-likelihood for the weights of the particles, 1 to 100. Default 9.
    pub weight_correlation: f64,
    /// Largest number of scans kept for redrawing after a loop, 100 to 1,000,000. Beyond it every second scan of the older half is dropped
    /// with its pose. Default 20,000: 10 km of travel, 20 MB at 180 beams.
    pub max_scans: usize,
    /// Number of poses sampled around a match, 8 to 500. Default 30.
    pub samples: usize,
    /// Effective number of particles below which they are resampled, as a fraction of their number, 0 to 1. Default 0.5 \[Grisetti07\].
    pub resample_below: f64,
    /// Fraction of the steps with wrong odometry (slipping wheels, lost messages), 1e-6 to 0.5. Default 0.01.
    pub slip_rate: f64,
    /// Distance of the robot from the odometry's path in a wrong step (one sigma), m, 0.01 to 2. Default 0.3.
    pub slip_shift: f64,
    /// Heading error of a wrong step (one sigma), rad, 0.01 to 1. Default 0.5.
    pub slip_turn: f64,
    /// Fraction of the hits' information below which a direction is degenerate, 0 to 1. Default 0.01.
    pub degenerate_below: f64,
}

impl Default for ParticleConfig {
    fn default() -> Self {
        let mut map = MapperConfig::default();
        map.max_range = 80.0;
        map.blind_range = 0.0;
        Self {
            particles: 30,
            map,
            motion: MotionConfig::default(),
            pose_prior: None,
            move_gate: 0.3,
            turn_gate_deg: 10.0,
            wait_gate: 2.0,
            jump: 5.0,
            range_noise: 0.02,
            range_noise_growth: 0.0,
            outliers: 0.05,
            correlation: 4.0,
            weight_correlation: 9.0,
            max_scans: 20_000,
            samples: 30,
            resample_below: 0.5,
            slip_rate: 0.01,
            slip_shift: 0.3,
            slip_turn: 0.5,
            degenerate_below: 0.01,
        }
    }
}

impl ParticleConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("particles", self.particles as f64, "", 1.0, 1000.0)?;
        require_in("move_gate", self.move_gate, "m", 0.0, 5.0)?;
        require_in("turn_gate_deg", self.turn_gate_deg, "deg", 0.0, 180.0)?;
        require_in("wait_gate", self.wait_gate, "s", 0.0, 3600.0)?;
        require_in("jump", self.jump, "m", 0.5, 1000.0)?;
        require_in("range_noise", self.range_noise, "m", 0.001, 0.5)?;
        require_in("range_noise_growth", self.range_noise_growth, "m/m^2", 0.0, 0.1)?;
        require_in("outliers", self.outliers, "", 0.001, 0.5)?;
        require_in("correlation", self.correlation, "", 1.0, 100.0)?;
        require_in("weight_correlation", self.weight_correlation, "", 1.0, 100.0)?;
        require_in("max_scans", self.max_scans as f64, "", 100.0, 1e6)?;
        require_in("samples", self.samples as f64, "", 8.0, 500.0)?;
        require_in("resample_below", self.resample_below, "", 0.0, 1.0)?;
        require_in("slip_rate", self.slip_rate, "", 1e-6, 0.5)?;
        require_in("slip_shift", self.slip_shift, "m", 0.01, 2.0)?;
        require_in("slip_turn", self.slip_turn, "rad", 0.01, 1.0)?;
        require_in("degenerate_below", self.degenerate_below, "", 0.0, 1.0)?;
        let pose_prior = self.pose_prior.map(PosePriorConfig::validated).transpose()?;
        Ok(Self { map: self.map.validated()?, motion: self.motion.validated()?, pose_prior, ..self })
    }
}

/// One sigma of odometry without drift.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct PosePriorConfig {
    /// Sigma of the position along each axis, m, 0.001 to 1. Default 0.01: trundle's SLAM has errors of 0.2 to 1.2 cm (docs/results.md).
    pub shift: f64,
    /// Sigma of the heading, rad, 0.0001 to 1. Default 0.003.
    pub turn: f64,
}

impl Default for PosePriorConfig {
    fn default() -> Self {
        Self { shift: 0.01, turn: 0.003 }
    }
}

impl PosePriorConfig {
    fn validated(self) -> Result<Self, Invalid> {
        require_in("pose_prior.shift", self.shift, "m", 0.001, 1.0)?;
        require_in("pose_prior.turn", self.turn, "rad", 0.0001, 1.0)?;
        Ok(self)
    }
}

/// One sigma of the odometry's error over a motion, by its distance and turn (\[Thrun05\], sec. 5.4). The defaults are those of common grid
/// mappers: cheap wheels on tiles and carpets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct MotionConfig {
    /// Position error per distance, m/m, 0 to 2. Default 0.2.
    pub shift_per_metre: f64,
    /// Position error per turn, m/rad, 0 to 2. Default 0.1.
    pub shift_per_radian: f64,
    /// Heading error per distance, rad/m, 0 to 2. Default 0.1.
    pub turn_per_metre: f64,
    /// Heading error per turn, rad/rad, 0 to 2. Default 0.2.
    pub turn_per_radian: f64,
    /// Position error without motion, m, 0.0001 to 1. Default 0.02.
    pub min_shift: f64,
    /// Heading error without motion, rad, 0.0001 to 1. Default 0.01.
    pub min_turn: f64,
}

impl Default for MotionConfig {
    fn default() -> Self {
        Self {
            shift_per_metre: 0.2,
            shift_per_radian: 0.1,
            turn_per_metre: 0.1,
            turn_per_radian: 0.2,
            min_shift: 0.02,
            min_turn: 0.01,
        }
    }
}

impl MotionConfig {
    fn validated(self) -> Result<Self, Invalid> {
        require_in("shift_per_metre", self.shift_per_metre, "m/m", 0.0, 2.0)?;
        require_in("shift_per_radian", self.shift_per_radian, "m/rad", 0.0, 2.0)?;
        require_in("turn_per_metre", self.turn_per_metre, "rad/m", 0.0, 2.0)?;
        require_in("turn_per_radian", self.turn_per_radian, "rad/rad", 0.0, 2.0)?;
        require_in("min_shift", self.min_shift, "m", 0.0001, 1.0)?;
        require_in("min_turn", self.min_turn, "rad", 0.0001, 1.0)?;
        Ok(self)
    }
}
