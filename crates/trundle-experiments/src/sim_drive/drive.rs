//! The loop of a drive: events in, twists out.

use super::driver::SimDriver;
use super::recording::DriveRecording;
use std::time::Instant;
use trundle_app::{AppError, StepProgress, stop};
use trundle_core::{RobotBody, SensorEvent};
use trundle_sim::Simulator;

/// The result of a drive.
#[derive(Debug, Clone, PartialEq)]
pub struct SimDrive {
    /// Simulated time, s.
    pub time: f64,
    /// Number of images.
    pub images: usize,
    /// Number of laser sweeps.
    pub scans: usize,
    /// Distance driven, m.
    pub distance: f64,
    /// Number of contacts.
    pub contacts: u32,
    /// Number of reached way-points, and of all way-points.
    pub waypoints: Option<(usize, usize)>,
    /// Whether the drive reached its end, and every way-point was reached.
    pub is_complete: bool,
    /// Whether the user interrupted the drive.
    pub is_interrupted: bool,
    /// Wall-clock time, s.
    pub seconds: f64,
}

/// Drives `robot` until the driver or the `duration` (s) ends; every event is recorded in `recording`.
///
/// # Errors
/// When the simulator, the driver or the recording fails.
pub fn drive_simulator(
    robot: &mut Simulator,
    driver: &mut dyn SimDriver,
    duration: Option<f64>,
    mut recording: Option<&mut DriveRecording<'_>>,
    progress: &dyn StepProgress,
) -> Result<SimDrive, AppError> {
    let started = Instant::now();
    let images_until = |end: f64| (end * robot.config().camera_rate_hz).ceil() as usize;
    progress.begin(end_s(duration, driver).map(images_until));
    let (mut images, mut scans) = (0, 0);
    let mut now = 0.0;
    let mut is_interrupted = false;
    while let Some(event) = robot.next_event().map_err(AppError::input)? {
        let stamp = event.stamp();
        is_interrupted = stop::is_requested(|| format!("{now:.1} s of the robot's time"));
        if is_interrupted {
            break;
        }
        if end_s(duration, driver).is_some_and(|end| end <= stamp.as_secs()) {
            break;
        }
        now = stamp.as_secs().max(now);
        match &event {
            SensorEvent::Wheels(_) => {
                let twist = driver.twist(stamp, robot.true_pose())?;
                robot.command(twist).map_err(AppError::input)?;
            }
            SensorEvent::Rgbd(image) => {
                images += 1;
                driver.show(image, robot);
                show(progress, robot, now, started);
            }
            SensorEvent::Scan(scan) => {
                scans += 1;
                driver.show_scan(scan, robot);
            }
            _ => {}
        }
        if let Some(recording) = recording.as_deref_mut() {
            recording.on_event(event)?;
            if recording.is_refused() {
                break;
            }
        }
    }
    if is_interrupted && images == 0 {
        return Err(AppError::Stopped);
    }
    progress.end();
    let waypoints = driver.waypoints();
    Ok(SimDrive {
        time: now,
        images,
        scans,
        distance: robot.path_length(),
        contacts: robot.contacts(),
        waypoints,
        is_complete: !is_interrupted && waypoints.is_none_or(|(reached, all)| reached == all),
        is_interrupted,
        seconds: started.elapsed().as_secs_f64(),
    })
}

/// Known end of the drive, s: the earlier of the driver's end and the duration.
fn end_s(duration: Option<f64>, driver: &dyn SimDriver) -> Option<f64> {
    duration.into_iter().chain(driver.end_s()).reduce(f64::min)
}

fn show(progress: &dyn StepProgress, robot: &Simulator, now: f64, started: Instant) {
    let pose = robot.true_pose();
    progress.advance();
    progress.message(&format!(
        "{now:6.1} s ({:.1}x)  at {:6.2} {:6.2} m {:6.1} deg  {:6.2} m driven",
        now / started.elapsed().as_secs_f64().max(1e-3),
        pose.x,
        pose.y,
        pose.theta.to_degrees(),
        robot.path_length(),
    ));
}

#[cfg(test)]
mod tests {
    use super::super::driver::StillDriver;
    use super::*;
    use trundle_sim::{Scene, SimConfig};

    #[test]
    fn a_drive_ends_at_the_sooner_of_duration_and_driver() {
        assert_eq!(end_s(Some(1.0), &StillDriver::new(Some(3.0))), Some(1.0));
        assert_eq!(end_s(None, &StillDriver::new(Some(3.0))), Some(3.0));
    }

    #[test]
    fn a_standing_robot_takes_images_and_touches_nothing() {
        let scene = Scene::by_name("room", 1).unwrap();
        let mut robot = Simulator::new(scene, SimConfig::default(), 1).unwrap();
        let drive = drive_simulator(&mut robot, &mut StillDriver::new(Some(0.3)), None, None, &()).unwrap();
        assert!(drive.images > 0 && drive.is_complete && drive.contacts == 0, "{drive:?}");
        assert!(drive.time < 0.3 && drive.distance < 1e-6, "{drive:?}");
    }
}
