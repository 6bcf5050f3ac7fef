//! The kinds of faults and the schedule of their start and end.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose2, require_finite, require_in};

/// Kind of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum FaultKind {
    /// The lens is covered: images come, black and without depth.
    CameraBlack,
    /// Darkness: colour is black; the depth camera has its own light.
    LightsOut,
    /// Images have new stamps but repeat the last image before the fault (or the first one, if none came before).
    CameraFrozen,
    /// Images do not come.
    CameraDropped {
        /// Share of lost images, 0 to 1.
        probability: f64,
    },
    /// Images come late, with the stamp of when they were taken: out of the order of stamps.
    CameraLate {
        /// Seconds, 0 to 60.
        delay_s: f64,
    },
    /// Images come without depth.
    DepthGone,
    /// A wheel turns and is counted, but drives the body by only a fraction of its distance.
    WheelSlips {
        /// The wheel.
        side: WheelSide,
        /// The fraction of the wheel's distance that moves the body, 0 (spinning) to 2.
        factor: f64,
    },
    /// The encoders repeat their last counts while the wheels turn.
    EncodersStuck,
    /// The gyro repeats its last rate.
    GyroStuck,
    /// The encoders' counters jump once, at `from_s`; `to_s` has no effect.
    OdometryJumps {
        /// Ticks of the left wheel.
        left_ticks: i32,
        /// Ticks of the right wheel.
        right_ticks: i32,
    },
    /// At `from_s` the robot is moved to another pose, once no person is there. No sensor of the base measures the move, and `to_s` has no
    /// effect.
    Kidnapped {
        /// World frame, m.
        x: f64,
        /// World frame, m.
        y: f64,
        /// World frame, deg.
        heading_deg: f64,
    },
    /// The bumper is stuck in one state.
    BumperStuck {
        /// The state.
        pressed: bool,
    },
    /// Scans do not come.
    LaserGone,
}

/// A wheel of the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WheelSide {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

/// A fault and its time: `from_s <= t < to_s`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// Seconds since the start, 0 or more.
    pub from_s: f64,
    /// Seconds since the start, more than `from_s`. Default infinite: permanent.
    #[serde(default = "forever")]
    pub to_s: f64,
    /// The fault.
    pub kind: FaultKind,
}

fn forever() -> f64 {
    f64::INFINITY
}

impl Fault {
    /// Whether the fault is active `time` seconds after the start.
    pub fn holds_at(&self, time: f64) -> bool {
        time >= self.from_s && time < self.to_s
    }
}

/// All faults of a run, in any order; of two faults that set the same state, the later one in the list applies.
///
/// In TOML a list of `{ from_s, to_s, kind }`, where `kind` is a name (`"camera-black"`) or a table
/// (`{ camera-late = { delay_s = 0.3 } }`).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FaultSchedule {
    /// The faults.
    pub faults: Vec<Fault>,
}

impl FaultSchedule {
    /// Passes a valid schedule through.
    ///
    /// # Errors
    /// When a number is outside its range or not finite; the error gives the index of the fault.
    pub fn validated(self) -> Result<Self, Invalid> {
        for (i, fault) in self.faults.iter().enumerate() {
            let name = |field: &str| format!("faults[{i}].{field}");
            require_in(&name("from_s"), fault.from_s, "s", 0.0, 1e9)?;
            if fault.to_s.partial_cmp(&fault.from_s) != Some(std::cmp::Ordering::Greater) {
                let expected = format!("more than {}", fault.from_s);
                return Err(Invalid::new(name("to_s"), fault.to_s, "s", expected));
            }
            match fault.kind {
                FaultKind::CameraDropped { probability } => {
                    require_in(&name("probability"), probability, "", 0.0, 1.0)?;
                }
                FaultKind::CameraLate { delay_s } => {
                    require_in(&name("delay_s"), delay_s, "s", 0.0, 60.0)?;
                }
                FaultKind::WheelSlips { factor, .. } => {
                    require_in(&name("factor"), factor, "", 0.0, 2.0)?;
                }
                FaultKind::Kidnapped { x, y, heading_deg } => {
                    require_in(&name("x"), x, "m", -1e6, 1e6)?;
                    require_in(&name("y"), y, "m", -1e6, 1e6)?;
                    require_finite(&name("heading_deg"), heading_deg, "deg")?;
                }
                _ => {}
            }
        }
        Ok(self)
    }

    /// Whether a freeze of the camera is scheduled.
    pub(crate) fn freezes_camera(&self) -> bool {
        self.faults.iter().any(|fault| fault.kind == FaultKind::CameraFrozen)
    }

    /// Time and pose of each kidnapping, `world_from_base`, in the order of the list.
    pub fn kidnappings(&self) -> impl Iterator<Item = (f64, Pose2)> + '_ {
        self.faults.iter().filter_map(|fault| match fault.kind {
            FaultKind::Kidnapped { x, y, heading_deg } => {
                Some((fault.from_s, Pose2::new(x, y, heading_deg.to_radians())))
            }
            _ => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(from_s: f64, to_s: f64, kind: FaultKind) -> String {
        let schedule = FaultSchedule { faults: vec![Fault { from_s, to_s, kind }] };
        schedule.validated().unwrap_err().to_string()
    }

    #[test]
    fn bad_faults_are_refused_by_name() {
        assert_eq!(refused(2.0, 1.0, FaultKind::GyroStuck), "faults[0].to_s is 1 s, expected more than 2");
        assert!(refused(f64::NAN, 1.0, FaultKind::GyroStuck).contains("faults[0].from_s"));
        let slips = FaultKind::WheelSlips { side: WheelSide::Left, factor: f64::NAN };
        assert!(refused(0.0, 1.0, slips).contains("faults[0].factor"));
        let put = FaultKind::Kidnapped { x: f64::INFINITY, y: 0.0, heading_deg: 0.0 };
        assert!(refused(0.0, 1.0, put).contains("faults[0].x is inf m"));
    }
}
