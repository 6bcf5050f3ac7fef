use super::{DataSet, Driver, SimArgs};
use crate::console;
use indicatif::ProgressBar;
use std::time::Instant;
use trundle::app::AppError;
use trundle::core::{RobotBody, SensorEvent};
use trundle::sim::Simulator;

/// What happened on a drive.
pub struct Journey {
    /// Time of the robot, s.
    pub time: f64,
    /// Images taken.
    pub images: usize,
    /// Sweeps of the laser.
    pub scans: usize,
    /// Metres driven.
    pub distance: f64,
    /// Times that the robot touched something.
    pub contacts: u32,
    /// Way-points reached, and all of them.
    pub waypoints: Option<(usize, usize)>,
    /// Whether everything was done that was asked for.
    pub is_complete: bool,
    /// Wall-clock time, s.
    pub seconds: f64,
}

impl Journey {
    /// Lets `driver` drive `robot` until the drive or the time asked for is over.
    pub fn drive(
        args: &SimArgs,
        robot: &mut Simulator,
        driver: &mut Driver,
        mut data: Option<&mut DataSet<'_>>,
    ) -> Result<Self, AppError> {
        let begun = Instant::now();
        let bar = progress(args, robot, driver);
        let (mut images, mut scans) = (0, 0);
        let mut now = 0.0;
        while let Some(event) = robot.next_event().map_err(AppError::input)? {
            let stamp = event.stamp();
            if is_over(stamp.as_secs(), args, driver) {
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
                    if let Driver::Hand(hand) = driver {
                        hand.show(image, robot);
                    }
                    show(&bar, robot, now, begun);
                }
                SensorEvent::Scan(_) => scans += 1,
                _ => {}
            }
            if let Some(data) = data.as_deref_mut() {
                data.note(event)?;
            }
        }
        bar.finish_and_clear();
        let waypoints = driver.waypoints();
        Ok(Self {
            time: now,
            images,
            scans,
            distance: robot.path_length(),
            contacts: robot.contacts(),
            waypoints,
            is_complete: waypoints.is_none_or(|(reached, all)| reached == all),
            seconds: begun.elapsed().as_secs_f64(),
        })
    }
}

fn is_over(time: f64, args: &SimArgs, driver: &Driver) -> bool {
    end(args, driver).is_some_and(|end| end <= time)
}

/// When it is over, s, where that is known: with nobody at the wheel after the time asked for, else when the drive is, or
/// that time if it is sooner.
fn end(args: &SimArgs, driver: &Driver) -> Option<f64> {
    match (driver, args.duration) {
        (Driver::Nobody, Some(duration)) => Some(duration),
        (driver, duration) => duration.into_iter().chain(driver.end()).reduce(f64::min),
    }
}

fn progress(args: &SimArgs, robot: &Simulator, driver: &Driver) -> ProgressBar {
    match end(args, driver) {
        Some(end) => console::bar(args.common.quiet, (end * robot.config().camera_rate_hz).ceil() as usize),
        None => console::live_line(args.common.quiet),
    }
}

fn show(bar: &ProgressBar, robot: &Simulator, now: f64, begun: Instant) {
    let pose = robot.true_pose();
    bar.inc(1);
    bar.set_message(format!(
        "{now:6.1} s ({:.1}x)  at {:6.2} {:6.2} m {:6.1} deg  {:6.2} m driven",
        now / begun.elapsed().as_secs_f64().max(1e-3),
        pose.x,
        pose.y,
        pose.theta.to_degrees(),
        robot.path_length(),
    ));
}
