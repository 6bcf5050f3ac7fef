//! The scan of a CARMEN line in the base frame: mount, angles, direction.

use super::line::LaserLine;
use super::parameters::Parameters;
use super::ranges::is_range;
use crate::laser_log::{LaserLogOptions, check_sweep};
use std::f64::consts::PI;
use trundle_core::{Beam, Pose2, Scan};

/// Mount of the laser of the lines `name`: by the options, else `by_poses` of the lines, else the name.
pub(super) fn mount(
    name: &str,
    by_poses: Option<Pose2>,
    parameters: &Parameters,
    options: &LaserLogOptions,
) -> Pose2 {
    let known = by_poses.unwrap_or_else(|| mount_by_name(name, parameters.offset));
    let (x, theta) = (options.laser_x.unwrap_or(known.x), options.laser_turn.unwrap_or(known.theta));
    Pose2::new(x, known.y, theta)
}

/// Mount by the line's name: the front laser points ahead at its offset, the rear laser points back at the base's origin, others are at the
/// base's origin.
fn mount_by_name(name: &str, front_offset: f64) -> Pose2 {
    match name {
        "RLASER" | "ROBOTLASER2" | "RAWLASER2" => Pose2::new(0.0, 0.0, PI),
        "RAWLASER3" | "RAWLASER4" => Pose2::IDENTITY,
        _ => Pose2::new(front_offset, 0.0, 0.0),
    }
}

/// The scan of a line, beams from right to left; a range of at least `limit` m, or an invalid one, has no return.
///
/// # Errors
/// When the log's parameters give more than a turn for this number of beams.
pub(super) fn scan_of(
    laser: &LaserLine,
    mount: Pose2,
    parameters: &Parameters,
    limit: f64,
    upside_down: bool,
) -> Result<Scan, String> {
    let [first, step] = angles(laser, parameters)?;
    let beam = |&range: &f64| match is_range(range) && range < limit {
        true => Beam::Hit { range },
        false => Beam::Unseen,
    };
    let mut beams: Vec<Beam> = laser.ranges.iter().map(beam).collect();
    let hand = if upside_down { -1.0 } else { 1.0 };
    let is_clockwise = hand * step < 0.0;
    let mut bearing = hand * first;
    if is_clockwise {
        beams.reverse();
        bearing = hand * (first + step * (beams.len() - 1) as f64);
    }
    Scan::new(laser.stamp, mount.position(), mount.theta + bearing, step.abs(), beams)
        .map_err(|invalid| invalid.to_string())
}

/// The angle of the first beam and the step: the line's own, else by the log's parameters, else 180 degrees.
fn angles(laser: &LaserLine, parameters: &Parameters) -> Result<[f64; 2], String> {
    if let Some(angles) = laser.angles {
        return Ok(angles);
    }
    let count = laser.ranges.len();
    let steps = (count - count % 2).max(1) as f64;
    let field_of_view = match (parameters.field_of_view, parameters.resolution) {
        (Some(field_of_view), _) => field_of_view,
        (None, Some(resolution)) => resolution * steps,
        (None, None) => PI,
    };
    let (first, step) = (-field_of_view / 2.0, field_of_view / steps);
    check_sweep(["the start angle by PARAM", "the angle step by PARAM"], first, step, count)?;
    Ok([first, step])
}
