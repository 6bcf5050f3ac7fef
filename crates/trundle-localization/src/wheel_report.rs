/// What became of one reading of the wheels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum WheelReport {
    /// None yet.
    #[default]
    Nothing,
    /// The first one: it only starts the odometry.
    Started,
    /// Taken in.
    Used,
    /// Taken in, but wheels and gyro disagree: at least one wheel slips. The covariance grew with it.
    Slipping {
        /// Turn rate by the wheels minus turn rate by the gyro, rad/s.
        rate: f64,
    },
    /// Not newer than the one before: ignored.
    TimeWentBack {
        /// By how much, s, 0 or more.
        by: f64,
    },
    /// Too long after the one before: the motion between is unknown and not in the pose, but in the covariance.
    Gap {
        /// How long, s.
        length: f64,
    },
    /// Implies a rim speed that the robot cannot have: ignored.
    TooFast {
        /// Speed of the faster rim, m/s.
        speed: f64,
    },
    /// The second reading in a row at counts that the robot cannot have driven to: the encoders were reset. The motion
    /// between is unknown and not in the pose, but in the covariance.
    Restarted,
}

/// How often each kind of reading was met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WheelCounts {
    /// Taken in, slipping or not.
    pub used: usize,
    /// Of those, slipping.
    pub slipping: usize,
    /// Not newer than the one before.
    pub time_went_back: usize,
    /// After a gap.
    pub gaps: usize,
    /// Too fast to be true.
    pub too_fast: usize,
    /// Encoders found reset.
    pub restarts: usize,
    /// Readings of the gyro that were not newer than the one before, or not finite.
    pub gyro_refused: usize,
}

impl WheelCounts {
    pub(crate) fn note(&mut self, report: &WheelReport) {
        match report {
            WheelReport::Nothing | WheelReport::Started => {}
            WheelReport::Used => self.used += 1,
            WheelReport::Slipping { .. } => {
                self.used += 1;
                self.slipping += 1;
            }
            WheelReport::TimeWentBack { .. } => self.time_went_back += 1,
            WheelReport::Gap { .. } => self.gaps += 1,
            WheelReport::TooFast { .. } => self.too_fast += 1,
            WheelReport::Restarted => self.restarts += 1,
        }
    }
}
