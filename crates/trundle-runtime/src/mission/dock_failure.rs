//! Reason why a robot failed to dock.

use std::fmt;

/// Reason why a robot failed to dock.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum DockFailure {
    /// No receiver detected the light of a station at any reachable place.
    NoLight,
    /// The light was detected, and lost repeatedly.
    LightLost,
    /// The axis of the station stays too uncertain.
    AxisUncertain {
        /// Standard deviation of the lateral position at the contacts \[m\].
        sigma: f64,
    },
    /// The robot drove to the estimated contacts of the station, but does not charge.
    NoCharging {
        /// Attempts made.
        attempts: u32,
    },
    /// An obstacle or a fault stops the robot during or after its last straight move.
    Held,
}

impl fmt::Display for DockFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLight => f.write_str("no light of a charging station was seen"),
            Self::LightLost => f.write_str("the light of the charging station was lost repeatedly"),
            Self::AxisUncertain { sigma } => {
                write!(f, "the axis of the charging station is uncertain: standard deviation {sigma:.3} m")
            }
            Self::NoCharging { attempts } => {
                let plural = if *attempts == 1 { "" } else { "s" };
                write!(f, "nothing charges at the charging station after {attempts} attempt{plural}")
            }
            Self::Held => f.write_str("an obstacle stops the straight move at the charging station"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_failure_has_a_text_of_its_own() {
        let failures = [
            DockFailure::NoLight,
            DockFailure::LightLost,
            DockFailure::AxisUncertain { sigma: 0.05 },
            DockFailure::NoCharging { attempts: 3 },
            DockFailure::Held,
        ];
        let texts: std::collections::BTreeSet<_> = failures.iter().map(ToString::to_string).collect();
        assert_eq!(texts.len(), failures.len());
        assert_eq!(failures[0].to_string(), "no light of a charging station was seen");
        assert!(failures[3].to_string().ends_with("after 3 attempts"));
        assert!(DockFailure::NoCharging { attempts: 1 }.to_string().ends_with("after 1 attempt"));
    }
}
