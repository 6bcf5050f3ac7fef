//! Difference of two scans beam by beam, to detect motion that the odometry missed.

use crate::particle_config::ParticleConfig;
use trundle_core::{Beam, Scan};

/// Smallest fraction of differing beams that shows a motion of the robot \[1\]. A person in view changes fewer beams. Source: ours.
const MIN_CHANGED_SHARE: f64 = 0.3;
/// Smallest difference of two ranges of one beam beyond noise \[sigmas of a range\]. Source: ours, three sigmas of a difference.
const MIN_CHANGE_SIGMAS: f64 = 4.3;
/// Fewest beams with a return in both scans for a comparison. Source: ours.
const MIN_COMPARED_BEAMS: usize = 20;

/// The ranges of a scan, m; NaN without a return.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScanRanges(Vec<f32>);

impl ScanRanges {
    pub(crate) fn of(scan: &Scan) -> Self {
        Self(scan.beams().iter().map(range).collect())
    }

    /// Whether enough beams of `scan` differ to show a motion of the laser.
    pub(crate) fn differ_from(&self, config: &ParticleConfig, scan: &Scan) -> bool {
        let pairs = self.0.iter().zip(scan.beams()).map(|(before, beam)| (*before, range(beam)));
        let (mut compared, mut changed) = (0, 0);
        for (before, now) in pairs.filter(|(before, now)| before.is_finite() && now.is_finite()) {
            let sigma = config.range_noise + config.range_noise_growth * f64::from(now * now);
            compared += 1;
            changed += usize::from(f64::from((now - before).abs()) > MIN_CHANGE_SIGMAS * sigma);
        }
        compared >= MIN_COMPARED_BEAMS && changed as f64 > MIN_CHANGED_SHARE * compared as f64
    }
}

fn range(beam: &Beam) -> f32 {
    match beam {
        Beam::Hit { range } => *range as f32,
        _ => f32::NAN,
    }
}
