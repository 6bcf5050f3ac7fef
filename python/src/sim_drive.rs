//! A simulator driven for a duration.

use trundle::core::{RobotBody, SensorEvent, Twist2, require_in};
use trundle::sim::{SimError, Simulator};

/// Step of the simulator's dynamics \[s\], the smallest duration of a drive. Source: the step of `trundle-sim`.
const STEP_S: f64 = 0.001;
/// Largest duration of a drive \[s\]: a longer one is a mistyped number. Source: ours.
const MAX_DURATION_S: f64 = 3600.0;

/// Drives with `twist` for `duration` s, in whole milliseconds; returns the events of that time.
///
/// # Errors
/// When the duration is not from 1 ms to an hour, or the command is not finite.
pub fn drive(simulator: &mut Simulator, twist: Twist2, duration: f64) -> Result<Vec<SensorEvent>, SimError> {
    require_in("duration", duration, "s", STEP_S, MAX_DURATION_S)?;
    simulator.command(twist)?;
    let mut events = Vec::new();
    for _ in 0..(duration / STEP_S).round() as u64 {
        events.extend(simulator.advance()?);
    }
    Ok(events)
}
