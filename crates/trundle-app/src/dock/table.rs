//! The manoeuvre as tables.

use trundle_docking::{Manoeuvre, Motion, Solution, Step};
use trundle_io::table_csv;

/// The manoeuvre, step by step.
pub fn rows(manoeuvre: &Manoeuvre) -> Vec<Vec<String>> {
    let header = ["step", "motion", "by", "starts", "takes", "ends at"].map(str::to_owned).to_vec();
    let row = |(i, step): (usize, &Step)| {
        let to = step.to;
        vec![
            (i + 1).to_string(),
            step.motion.word().to_owned(),
            amount(step.motion),
            format!("{:.2} s", step.starts),
            format!("{:.2} s", step.lasts),
            format!("({:.3}, {:.3}) m, {:.1} deg", to.x, to.y, to.theta.to_degrees()),
        ]
    };
    std::iter::once(header).chain(manoeuvre.steps().iter().enumerate().map(row)).collect()
}

/// Length or angle of a motion, with its unit.
pub fn amount(motion: Motion) -> String {
    match motion {
        Motion::Turn(angle) => format!("{:.1} deg", angle.to_degrees().abs()),
        Motion::Drive(distance) => format!("{:.3} m", distance.abs()),
    }
}

/// Duration of the manoeuvre, and its distance from the proven minimum.
pub fn verdict(found: &Solution) -> String {
    let duration = found.manoeuvre.duration();
    let proven = if found.bound > 0.0 {
        format!(
            ", at most {:.1} % above the proven minimum for this clearance",
            (duration / found.bound - 1.0).max(0.0) * 100.0
        )
    } else {
        String::new()
    };
    format!("{duration:.2} s{proven}, {:.1} cm or more from every obstacle", found.margin.max(0.0) * 100.0)
}

/// The motions in words.
pub fn motions(manoeuvre: &Manoeuvre) -> Vec<&'static str> {
    manoeuvre.steps().iter().map(|step| step.motion.word()).collect()
}

/// The steps as CSV: turns in rad, moves in m.
pub fn steps_csv(manoeuvre: &Manoeuvre) -> String {
    let header = ["starts_s", "lasts_s", "turn_rad", "drive_m", "x_m", "y_m", "theta_rad"];
    let row = |step: &Step| {
        let (turn, drive) = match step.motion {
            Motion::Turn(angle) => (angle, 0.0),
            Motion::Drive(distance) => (0.0, distance),
        };
        [step.starts, step.lasts, turn, drive, step.to.x, step.to.y, step.to.theta]
    };
    table_csv(header, manoeuvre.steps().iter().map(row))
}
