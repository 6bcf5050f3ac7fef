//! The check of a sweep's angles: radians, one turn at most.

use std::f64::consts::TAU;

/// Largest angle of the first beam \[rad\]. A larger angle means degrees. One turn with room for rounding. Source: ours.
const MAX_FIRST_ANGLE_RAD: f64 = TAU + 0.01;
/// Largest sweep of the beams, number times step \[rad\]. A larger sweep means degrees. One turn and a few steps. Source: ours.
const MAX_SWEEP_RAD: f64 = 7.0;
/// Largest number of beams of a scan. A scan with more beams is refused. Source: ours.
pub(crate) const MAX_BEAMS: usize = 100_000;

/// Refuses the angles of a sweep that are not radians within one turn; `names` are the file's names of first angle and step.
pub(crate) fn check_sweep(
    names: [&str; 2],
    first_rad: f64,
    step_rad: f64,
    beams: usize,
) -> Result<(), String> {
    if !(1..=MAX_BEAMS).contains(&beams) {
        return Err(format!("{beams} ranges, expected 1 to {MAX_BEAMS}"));
    }
    let [first_name, step_name] = names;
    let expected = "expected radians within one turn (6.283)";
    if first_rad.is_nan() || first_rad.abs() > MAX_FIRST_ANGLE_RAD {
        return Err(format!("{first_name} is {first_rad} rad, {expected}{}", degrees(first_rad)));
    }
    let sweep = step_rad.abs() * beams as f64;
    if !(step_rad != 0.0 && sweep < MAX_SWEEP_RAD) {
        let hint = degrees(sweep);
        return Err(format!("{step_name} is {step_rad} rad for {beams} ranges, {expected} and not 0{hint}"));
    }
    Ok(())
}

/// The hint that an angle is one in degrees, if it can be.
fn degrees(angle: f64) -> &'static str {
    if (TAU..=361.0).contains(&angle.abs()) { "; it seems to be in degrees" } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_in_degrees_are_refused_with_the_value() {
        let check = |first, step, beams| check_sweep(["start angle", "angle step"], first, step, beams);
        assert_eq!(check(-std::f64::consts::PI, 0.0175, 360), Ok(()));
        assert_eq!(check(std::f64::consts::PI, -0.0175, 360), Ok(()));
        assert_eq!(
            check(-180.0, 5.0, 72).unwrap_err(),
            "start angle is -180 rad, expected radians within one turn (6.283); it seems to be in degrees"
        );
        assert_eq!(
            check(0.0, 0.5, 361).unwrap_err(),
            "angle step is 0.5 rad for 361 ranges, expected radians within one turn (6.283) and not 0; it seems to be in degrees"
        );
        assert!(check(0.0, 0.0, 3).unwrap_err().contains("angle step is 0 rad for 3 ranges"));
        assert!(check(f64::NAN, 0.1, 3).unwrap_err().starts_with("start angle is NaN rad"));
        assert_eq!(check(0.0, 0.1, 0).unwrap_err(), "0 ranges, expected 1 to 100000");
    }
}
