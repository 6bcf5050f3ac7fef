//! Use of the readings of the wheels.

/// Use of one reading of the wheels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum WheelReport {
    /// No reading has arrived.
    #[default]
    Nothing,
    /// First reading: the odometry starts here.
    Started,
    /// Applied.
    Used,
    /// Applied while wheels and gyro disagree: at least one wheel slips. The covariance grows with the difference.
    Slipping {
        /// Turn rate by the wheels minus turn rate by the gyro, rad/s.
        rate: f64,
    },
    /// The reading is not newer than the last one: rejected.
    TimeWentBack {
        /// Difference of the stamps, s, 0 or more.
        by: f64,
    },
    /// Too long after the last reading: the motion in the gap is unknown, and enters the covariance instead of the pose.
    Gap {
        /// Length of the gap, s.
        length: f64,
    },
    /// Speed of a wheel above the limit: rejected.
    TooFast {
        /// Speed of the faster wheel, m/s.
        speed: f64,
    },
    /// Second consecutive reading at impossible counts: the encoders were reset. The motion in between is unknown and enters the covariance
    /// instead of the pose.
    Restarted,
}

/// Number of readings of each kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WheelCounts {
    /// Number of applied readings, with or without slip.
    pub used: usize,
    /// Number of readings applied with slip.
    pub slipping: usize,
    /// Number of readings not newer than the last one.
    pub time_went_back: usize,
    /// Number of readings after a gap.
    pub gaps: usize,
    /// Number of readings above the speed limit.
    pub too_fast: usize,
    /// Number of resets of the encoders.
    pub restarts: usize,
    /// Number of gyro readings that were not newer than the last one, or not finite.
    pub gyro_refused: usize,
}

/// The newest report, and the counts of all reports.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ReportLog {
    pub(crate) newest: WheelReport,
    pub(crate) counts: WheelCounts,
}

impl ReportLog {
    pub(crate) fn add(&mut self, report: WheelReport) {
        self.newest = report;
        self.counts.add(&report);
    }
}

impl WheelCounts {
    fn add(&mut self, report: &WheelReport) {
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
