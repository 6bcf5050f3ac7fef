use crate::console;
use std::path::Path;
use trundle::app::AppError;
use trundle::core::{Pose2, Pose3, Stamp, Vector3};
use trundle::io::{CameraModel, LaserLog, LaserLogScan, LaserLogSkip, TumSequence, read_trajectory};
use trundle::mapping::DepthScanner;
use trundle::runtime::RobotConfig;

/// Between two scans at least, s: 5 Hz.
const PERIOD: f64 = 0.19;
/// Between poses that are farther apart in time nothing is known, s.
const LONGEST_GAP: f64 = 1.0;

/// The scans of a TUM RGB-D folder at 5 Hz.
///
/// The motion is `tracked`, a TUM trajectory of the camera, or `odometry.txt`, both with the camera mounted as on the default
/// robot; else `groundtruth.txt`, whose frame must be level with the floor at z = 0, and each image is cut under the tilt and
/// height that its pose says.
pub fn read(dir: &Path, tracked: Option<&Path>, quiet: bool) -> Result<LaserLog, AppError> {
    let (mut scanner, model) = scanner(dir)?;
    let camera = model.camera;
    let sequence = TumSequence::open(dir, model.depth_scale, TumSequence::MAX_DIFFERENCE)?
        .with_size(camera.width(), camera.height());
    let tracked = tracked.map(base_poses).transpose()?;
    let poses = match &tracked {
        Some(poses) => Poses::Base(poses),
        None => Poses::of(dir, &sequence)?,
    };
    let (mut log, mut last) = (LaserLog::default(), None);
    log.max_range = Some(RobotConfig::default().scan.max_range);
    let bar = console::bar(quiet, sequence.len());
    for i in 0..sequence.len() {
        bar.inc(1);
        let stamp = sequence.stamp(i);
        if last.is_some_and(|last| stamp - last < PERIOD) {
            continue;
        }
        match scan(&sequence, i, &poses, &mut scanner) {
            Ok(scan) => {
                log.odometry.push((stamp, scan.odom_from_base));
                log.scans.push(scan);
                last = Some(stamp);
            }
            Err(problem) => log.skipped.push(LaserLogSkip { line: i + 1, problem }),
        }
    }
    bar.finish_and_clear();
    match log.skipped.first() {
        Some(first) if log.scans.is_empty() => {
            Err(AppError::Input(format!("{}: no frame can be used; {}", dir.display(), first.problem)))
        }
        _ => Ok(log),
    }
}

/// The scanner of the folder's camera, mounted as on the default robot.
pub fn scanner(dir: &Path) -> Result<(DepthScanner, CameraModel), AppError> {
    let own = dir.join("camera.toml");
    let model = if own.exists() { CameraModel::read(&own)? } else { CameraModel::named("freiburg1")? };
    let robot = RobotConfig::default();
    Ok((DepthScanner::new(model.camera, robot.mount.base_from_camera(), robot.scan)?, model))
}

fn scan(
    sequence: &TumSequence,
    i: usize,
    poses: &Poses<'_>,
    scanner: &mut DepthScanner,
) -> Result<LaserLogScan, String> {
    let stamp = sequence.stamp(i);
    let (odom_from_base, base_from_camera) = poses
        .at(stamp)
        .ok_or_else(|| format!("frame {i}: no pose about {stamp} s, or one that looks up or down"))?;
    if let Some(mount) = base_from_camera {
        scanner.remount(mount).map_err(|invalid| format!("frame {i}: {invalid}"))?;
    }
    let image = sequence.load(i).map_err(|error| error.to_string())?;
    Ok(LaserLogScan { odom_from_base, scan: scanner.scan(&image) })
}

/// Where the base was.
enum Poses<'a> {
    /// odom_from_base.
    Base(&'a [(Stamp, Pose2)]),
    /// level_from_camera.
    Camera(&'a [(Stamp, Pose3)]),
}

impl<'a> Poses<'a> {
    fn of(dir: &Path, sequence: &'a TumSequence) -> Result<Self, AppError> {
        match (sequence.odometry(), sequence.ground_truth()) {
            (Some(odometry), _) => Ok(Self::Base(odometry)),
            (None, Some(camera)) => Ok(Self::Camera(camera)),
            (None, None) => Err(AppError::Input(format!(
                "{}: neither odometry.txt nor groundtruth.txt, expected poses for a map",
                dir.display()
            ))),
        }
    }

    /// The base at a time, and where the camera sits on it when that changes.
    fn at(&self, stamp: Stamp) -> Option<(Pose2, Option<Pose3>)> {
        match self {
            Self::Base(poses) => {
                let (a, b, part) = about(poses, stamp)?;
                Some((a.interpolate(&b, part), None))
            }
            Self::Camera(poses) => {
                let (a, b, part) = about(poses, stamp)?;
                let camera = a.interpolate(&b, part);
                let base = base_below(&camera)?;
                Some((base, Some(Pose3::from_pose2(base).inverse() * camera)))
            }
        }
    }
}

/// Farther off no camera gets, m.
const FARTHEST: f64 = 1e6;

/// The base's way from a TUM trajectory of the camera, whatever its frame: about the first pose, seen from above.
fn base_poses(file: &Path) -> Result<Vec<(Stamp, Pose2)>, AppError> {
    let camera = read_trajectory(file)?;
    let Some((_, first)) = camera.first() else {
        return Err(AppError::Input(format!("{}: no pose, expected those of the camera", file.display())));
    };
    let is_far = |pose: &Pose3| pose.translation.norm() > FARTHEST;
    if let Some((stamp, pose)) = camera.iter().find(|(_, pose)| is_far(pose)) {
        let (file, off) = (file.display(), pose.translation.norm());
        let problem = format!("{file}: the pose at {stamp} s is {off} m off, expected at most {FARTHEST} m");
        return Err(AppError::Input(problem));
    }
    let base_from_camera = RobotConfig::default().mount.base_from_camera();
    let (first_from_frame, camera_from_base) = (first.inverse(), base_from_camera.inverse());
    let base = |pose: &Pose3| (base_from_camera * first_from_frame * *pose * camera_from_base).to_pose2();
    Ok(camera.iter().map(|(stamp, pose)| (*stamp, base(pose))).collect())
}

/// The poses before and after a time, and how far between them it lies.
fn about<T: Copy>(poses: &[(Stamp, T)], stamp: Stamp) -> Option<(T, T, f64)> {
    let after = poses.partition_point(|(at, _)| *at <= stamp);
    let (t0, a) = *poses.get(after.checked_sub(1)?)?;
    match poses.get(after) {
        Some((t1, b)) if *t1 - t0 <= LONGEST_GAP => Some((a, *b, (stamp - t0) / (*t1 - t0))),
        _ => (stamp - t0 < 0.1).then_some((a, a, 0.0)),
    }
}

/// A base under the camera, heading where it looks; none when that is within 20 degrees of straight up or down.
fn base_below(level_from_camera: &Pose3) -> Option<Pose2> {
    let axis = level_from_camera.rotate(Vector3::z());
    let at = level_from_camera.translation;
    (axis.x.hypot(axis.y) > 20_f64.to_radians().sin()).then(|| Pose2::new(at.x, at.y, axis.y.atan2(axis.x)))
}
