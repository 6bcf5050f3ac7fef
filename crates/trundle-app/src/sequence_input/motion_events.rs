//! Odometry and gyro of a sequence as events of a robot, the same as those of a live robot.

use crate::AppError;
use trundle_core::{DifferentialDrive, GyroRate, Odometry, Pose2, SensorEvent, Stamp, Twist2};
use trundle_estimation::{OdometryEvents, WheelOdometry};
use trundle_io::Warnings;
use trundle_runtime::RobotConfig;

/// The events of `odometry` and `gyro` by rising stamps, a gyro reading before odometry of the same stamp, and the jumps of the odometry.
/// With a gyro, the odometry becomes wheels of `drive`.
pub fn motion_events(
    odometry: &[(Stamp, Pose2)],
    gyro: &[GyroRate],
    drive: DifferentialDrive,
) -> (Vec<SensorEvent>, Warnings) {
    let (mut events, mut warnings) = (OdometryEvents::new(drive), Warnings::default());
    let moved = with_twists(odometry).map(|odometry| {
        let (event, jump) = events.add(&odometry, !gyro.is_empty());
        if let Some(jump) = jump {
            warnings.add(&format!("odometry: {jump}"), &format!("{} s", odometry.stamp));
        }
        event
    });
    let mut all: Vec<_> = gyro.iter().copied().map(SensorEvent::Gyro).chain(moved).collect();
    all.sort_by_key(SensorEvent::stamp);
    (all, warnings)
}

/// `odom_from_base` by wheels and gyro, as the robot computes it, from the first pose of `odometry` on.
///
/// # Errors
/// When the robot's settings are invalid.
pub fn fused_odometry(
    odometry: &[(Stamp, Pose2)],
    gyro: &[GyroRate],
    robot: &RobotConfig,
) -> Result<Vec<(Stamp, Pose2)>, AppError> {
    let start = odometry.first().map_or(Pose2::IDENTITY, |(_, pose)| *pose);
    let mut wheels = WheelOdometry::new(robot.drive, robot.odometry.clone())?;
    let mut fused = Vec::with_capacity(odometry.len());
    for event in motion_events(odometry, gyro, robot.drive).0 {
        match event {
            SensorEvent::Gyro(rate) => wheels.step_gyro(&rate),
            SensorEvent::Wheels(ticks) => {
                let odometry = wheels.step_wheels(&ticks);
                fused.push((ticks.stamp, start * odometry.pose));
            }
            _ => {}
        }
    }
    Ok(fused)
}

/// Odometry with the twist since the pose before. The covariance is zero: the noise is that of the robot's wheels.
fn with_twists(poses: &[(Stamp, Pose2)]) -> impl Iterator<Item = Odometry> {
    let before = std::iter::once(None).chain(poses.iter().map(Some));
    before.zip(poses).map(|(before, (stamp, pose))| {
        let twist = before.filter(|(last, _)| last < stamp).map_or(Twist2::ZERO, |(last, from)| {
            let (motion, dt) = (from.inverse() * *pose, *stamp - *last);
            Twist2::new(motion.x / dt, motion.theta / dt)
        });
        Odometry { stamp: *stamp, pose: *pose, twist, covariance: nalgebra::Matrix3::zeros() }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamp(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    /// A drive of 2 s: ahead, with a turn that only the gyro measures.
    fn drive() -> (Vec<(Stamp, Pose2)>, Vec<GyroRate>) {
        let odometry = (0..=40).map(|i| (stamp(50 * i), Pose2::new(2.0 + 0.01 * i as f64, 1.0, 0.0)));
        // A gyro that never changes counts as stuck.
        let gyro = (0..=200).map(|i| GyroRate { stamp: stamp(10 * i), omega: 0.5 + 1e-4 * (i % 7) as f64 });
        (odometry.collect(), gyro.collect())
    }

    #[test]
    fn the_gyro_gives_the_heading_from_the_first_pose_on() {
        let (odometry, gyro) = drive();
        let fused = fused_odometry(&odometry, &gyro, &RobotConfig::default()).unwrap();
        let (first, last) = (fused[0].1, fused[40].1);
        assert_eq!((fused.len(), first), (41, odometry[0].1));
        assert!((last.theta - 1.0).abs() < 0.02, "{last:?}");
        assert!((last.position() - first.position()).norm() > 0.35, "{last:?}");
    }

    #[test]
    fn events_are_in_order_and_a_jump_is_a_warning() {
        let (mut odometry, gyro) = drive();
        let drive = DifferentialDrive::KOBUKI;
        let (events, warnings) = motion_events(&odometry, &gyro, drive);
        assert!(events.is_sorted_by_key(SensorEvent::stamp) && warnings.is_empty());
        assert!(matches!(events[..2], [SensorEvent::Gyro(_), SensorEvent::Wheels(_)]));
        let plain = motion_events(&odometry, &[], drive).0;
        assert!(plain.len() == 41 && plain.iter().all(|event| matches!(event, SensorEvent::Odometry(_))));
        odometry[20..].iter_mut().for_each(|(_, pose)| pose.x += 3.0);
        let (events, warnings) = motion_events(&odometry, &[], drive);
        let text = warnings.iter().next().unwrap().to_string();
        assert!(text.starts_with("odometry: a jump of 3.01 m") && text.ends_with("1.000000000 s"), "{text}");
        let Some(SensorEvent::Odometry(last)) = events.last() else { panic!("no odometry") };
        assert!((last.pose.x - 2.39).abs() < 1e-9, "{last:?}");
    }
}
