//! `trundle run --check`: rates, delays, signs and tilt before the first drive.

use super::args::RunArgs;
use crate::console;
use crate::outcome::Outcome;
use trundle::app::AppError;
use trundle::app::calibrate::require_robot_file;
use trundle::app::hardware::{CheckRequest, HardwareReport, OpenCamera, check_hardware};

/// Duration of a check if the user gives none \[s\]. Source: ours; time for a push by hand.
const CHECK_S: f64 = 15.0;

/// Checks base and camera, prints the results, and writes the measured part of the robot file if requested.
pub fn check(args: &RunArgs) -> Result<Outcome, AppError> {
    let robot = args.options.robot.robot()?;
    args.write.as_deref().map_or(Ok(()), require_robot_file)?;
    let camera = OpenCamera::open_with(&args.camera, args.gyro, &robot.mount)?;
    let output = camera.intrinsics(args.intrinsics, &robot.camera)?;
    let seconds = args.options.time_limit.unwrap_or(CHECK_S);
    if !args.options.common.quiet {
        console::print(&format!(
            "Listening for {seconds} s; the base does not drive. Leave the robot at rest for 3 s, then push it straight ahead by 0.5 m."
        ));
    }
    let report = check_hardware(CheckRequest { base: &args.base, camera, output, robot: &robot, seconds })?;
    if !args.options.common.quiet {
        print(&report);
    }
    if let Some(file) = args.write.as_deref() {
        report.values.write(file)?;
        console::print(&format!("Wrote {} values to {}", report.values.values.len(), file.display()));
    }
    let problems = report.problems.iter().map(|problem| format!("problem: {problem}")).collect::<Vec<_>>();
    Ok(Outcome::unless((!problems.is_empty()).then(|| problems.join("\n"))))
}

fn print(report: &HardwareReport) {
    console::print_table(&report.rows);
    console::print_table(&report.values.rows());
    report.closing_lines().iter().for_each(|line| console::print(line));
}
