//! Depth images as scans, with the base's poses beside them.

use super::log_input::{DepthLog, LogInput};
use super::neighbours::{MAX_POSE_GAP_S, neighbours};
use crate::pose_coverage::why_uncovered;
use crate::sequence_input::{PendingFrame, RecordedRun, SequenceInput};
use crate::{AppError, StepProgress, read_trajectory, stop};
use std::path::Path;
use trundle_core::{Pose2, Pose3, Stamp};
use trundle_io::{DepthStatistics, LaserLog, LaserLogScan, LaserLogSkip};
use trundle_mapping::DepthScanner;
use trundle_runtime::{RobotConfig, base_below};

/// Time between two scans \[s\]; images that come sooner make no scan. A little under 1 / 5 Hz. Source: ours.
const MIN_SCAN_PERIOD_S: f64 = 0.19;
/// Distance of a camera pose from the first \[m\]. Beyond it the file is refused. Source: ours.
const MAX_POSE_DISTANCE_M: f64 = 1e6;

/// The scans of RGB-D images at 5 Hz.
///
/// The motion is `tracked_file`, a TUM trajectory of the camera, or the input's odometry, both with the camera mounted as on the input's
/// robot. Else it is the input's ground truth, whose frame must be level with the floor at z = 0. Each image is then cut under the tilt
/// and height of its pose.
pub fn read(
    input: &SequenceInput,
    tracked_file: Option<&Path>,
    progress: &dyn StepProgress,
) -> Result<LogInput, AppError> {
    let robot = &input.robot;
    let mut scanner =
        DepthScanner::new(input.camera.model.camera, robot.mount.base_from_camera(), robot.scan.clone())?;
    let tracked = tracked_file.map(|file| base_poses(file, robot)).transpose()?;
    let poses = match &tracked {
        Some(poses) => Poses::Base(poses),
        None => Poses::of(input)?,
    };
    let (mut log, mut last) = (LaserLog::default(), None);
    let (mut images, mut is_covered): (Option<(Stamp, Stamp)>, bool) = (None, false);
    let mut depth = DepthStatistics::default();
    log.max_range = Some(robot.scan.max_range);
    log.sources = input.laser_sources();
    if tracked.is_some() {
        log.sources.odometry.clear();
    }
    progress.begin(Some(input.len()));
    for (i, frame) in input.frames()?.enumerate() {
        if stop::is_requested(|| format!("{i} of {} images", input.len())) {
            break;
        }
        progress.advance();
        let frame = frame?;
        let stamp = frame.stamp();
        images = Some((images.map_or(stamp, |(first, _)| first), stamp));
        is_covered |= poses.covers(stamp);
        if last.is_some_and(|last| stamp - last < MIN_SCAN_PERIOD_S) {
            continue;
        }
        match scan(i, &frame, &poses, (&mut scanner, &mut depth)) {
            Ok(scan) => {
                log.odometry.push((stamp, scan.odom_from_base));
                log.push(scan);
                last = Some(stamp);
            }
            Err(problem) => log.skipped.push(LaserLogSkip { line: i + 1, problem }),
        }
    }
    progress.end();
    log.depth_problem = depth.problem(input.depth_scale());
    if log.scans.is_empty() && stop::stopped().is_some() {
        return Err(AppError::Stopped);
    }
    match log.skipped.first() {
        Some(first) if log.scans.is_empty() => {
            let cause = images.filter(|_| !is_covered).map(|images| {
                let file = tracked_file.map(|file| file.display().to_string());
                let name = file.unwrap_or_else(|| poses.name(input).to_owned());
                format!("{name}: no pose for any image: {}", poses.why_uncovered(images))
            });
            let problem = cause.unwrap_or_else(|| first.problem.clone());
            Err(AppError::Input(format!("{}: no frame can be used; {problem}", input.path.display())))
        }
        _ => {
            let by_wheels = tracked.is_none() && input.odometry().is_some();
            let depth = DepthLog { scan: robot.scan.clone(), blind_range: scanner.blind_range(), by_wheels };
            Ok(LogInput::in_memory(log, Some(depth), input.cut_report().map(str::to_owned)))
        }
    }
}

fn scan(
    index: usize,
    frame: &PendingFrame<'_>,
    poses: &Poses<'_>,
    (scanner, depth): (&mut DepthScanner, &mut DepthStatistics),
) -> Result<LaserLogScan, String> {
    let stamp = frame.stamp();
    let (odom_from_base, base_from_camera) = poses
        .at(stamp)
        .ok_or_else(|| format!("frame {index}: no pose near {stamp} s, or the camera points up or down"))?;
    if let Some(mount) = base_from_camera {
        scanner.remount(mount).map_err(|invalid| format!("frame {index}: {invalid}"))?;
    }
    let image = frame.decode().map_err(|error| error.to_string())?;
    depth.count(image.depth());
    Ok(LaserLogScan { odom_from_base, scan: scanner.scan(&image) })
}

/// The scans of a recording's 2-D laser, each at the odometry of its moment.
///
/// # Errors
/// When no scan can be used.
pub fn of_laser(run: &RecordedRun, file: &Path) -> Result<LogInput, AppError> {
    let refused = |problem: &str| AppError::Input(format!("{}: {problem}", file.display()));
    let odometry =
        run.odometry().ok_or_else(|| refused("no wheels in the recording, expected odometry for a map"))?;
    let mut log = LaserLog { odometry: odometry.to_vec(), ..LaserLog::default() };
    for (i, scan) in run.scans().iter().enumerate() {
        let stamp = scan.stamp();
        match neighbours(odometry, stamp) {
            Some((a, b, part)) => {
                let odom_from_base = a.interpolate(&b, part);
                log.push(LaserLogScan { odom_from_base, scan: scan.clone() });
            }
            None => {
                let problem = format!("no odometry about {stamp} s");
                log.skipped.push(LaserLogSkip { line: i + 1, problem });
            }
        }
    }
    if log.scans.is_empty() {
        return Err(refused("no scan can be used: none has odometry about its time"));
    }
    run.warn_of_cut();
    Ok(LogInput::in_memory(log, None, run.cut_report().map(str::to_owned)))
}

/// The source of the base's poses.
enum Poses<'a> {
    /// odom_from_base.
    Base(&'a [(Stamp, Pose2)]),
    /// level_from_camera.
    Camera(&'a [(Stamp, Pose3)]),
}

impl<'a> Poses<'a> {
    fn of(input: &'a SequenceInput) -> Result<Self, AppError> {
        match (input.odometry(), input.ground_truth()) {
            (Some(odometry), _) => Ok(Self::Base(odometry)),
            (None, Some(camera)) => Ok(Self::Camera(camera)),
            (None, None) => {
                let ([odometry, truth], path) = (input.pose_sources(), input.path.display());
                let problem = format!("{path}: neither {odometry} nor {truth}, expected poses for a map");
                Err(AppError::Input(problem))
            }
        }
    }

    /// The source's name in messages.
    fn name(&self, input: &SequenceInput) -> &'static str {
        let [odometry, truth] = input.pose_sources();
        match self {
            Self::Base(_) => odometry,
            Self::Camera(_) => truth,
        }
    }

    /// Whether there is a pose at a time.
    fn covers(&self, stamp: Stamp) -> bool {
        match self {
            Self::Base(poses) => neighbours(poses, stamp).is_some(),
            Self::Camera(poses) => neighbours(poses, stamp).is_some(),
        }
    }

    /// The reason why no image has a pose.
    fn why_uncovered(&self, images: (Stamp, Stamp)) -> String {
        match self {
            Self::Base(poses) => why_uncovered(poses, images, MAX_POSE_GAP_S),
            Self::Camera(poses) => why_uncovered(poses, images, MAX_POSE_GAP_S),
        }
    }

    /// The base at a time, and the camera's mount where it changes.
    fn at(&self, stamp: Stamp) -> Option<(Pose2, Option<Pose3>)> {
        match self {
            Self::Base(poses) => {
                let (a, b, part) = neighbours(poses, stamp)?;
                Some((a.interpolate(&b, part), None))
            }
            Self::Camera(poses) => {
                let (a, b, part) = neighbours(poses, stamp)?;
                let camera = a.interpolate(&b, part);
                let base = base_below(&camera)?;
                Some((base, Some(Pose3::from_pose2(base).inverse() * camera)))
            }
        }
    }
}

/// The base's trajectory from a TUM trajectory of the camera in any frame, relative to the first pose, projected onto the floor.
fn base_poses(file: &Path, robot: &RobotConfig) -> Result<Vec<(Stamp, Pose2)>, AppError> {
    let camera = read_trajectory(file)?;
    let Some((_, first)) = camera.first() else {
        return Err(AppError::Input(format!("{}: no pose, expected those of the camera", file.display())));
    };
    let is_far = |pose: &Pose3| pose.translation.norm() > MAX_POSE_DISTANCE_M;
    if let Some((stamp, pose)) = camera.iter().find(|(_, pose)| is_far(pose)) {
        let (file, off) = (file.display(), pose.translation.norm());
        let problem =
            format!("{file}: the pose at {stamp} s is {off} m off, expected at most {MAX_POSE_DISTANCE_M} m");
        return Err(AppError::Input(problem));
    }
    let base_from_camera = robot.mount.base_from_camera();
    let (first_from_frame, camera_from_base) = (first.inverse(), base_from_camera.inverse());
    let base = |pose: &Pose3| (base_from_camera * first_from_frame * *pose * camera_from_base).to_pose2();
    Ok(camera.iter().map(|(stamp, pose)| (*stamp, base(pose))).collect())
}
