//! The TUM sequence freiburg1_rpy (Sturm et al. 2012), 400 frames, where it is at hand.

use crate::umeyama::aligned_rmse;
use std::path::{Path, PathBuf};
use std::time::Instant;
use trundle_core::{
    ColorImage, DepthImage, Distortion, PinholeCamera, RgbdImage, Stamp, Vector3, gray_from_color,
};
use trundle_slam::{RgbdSlam, SlamConfig, Tracking};

const SEQUENCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/tum_fr1_rpy_400");

pub fn camera() -> PinholeCamera {
    let lens = Distortion { k1: 0.2624, k2: -0.9531, p1: -0.0054, p2: 0.0026, k3: 1.1633 };
    PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), lens).unwrap()
}

fn load(folder: &Path, line: &str) -> RgbdImage {
    let fields: Vec<&str> = line.split_whitespace().collect();
    let color = image::open(folder.join(fields[1])).unwrap().to_rgb8();
    let depth = image::open(folder.join(fields[3])).unwrap().to_luma16();
    let (width, height) = (color.width() as usize, color.height() as usize);
    let color = ColorImage::new(width, height, color.pixels().map(|p| p.0).collect()).unwrap();
    let depth = depth.into_raw().into_iter().map(|v| f32::from(v) / 5000.0).collect();
    let stamp = Stamp::from_secs(fields[0].parse().unwrap()).unwrap();
    RgbdImage::new(stamp, color, DepthImage::new(width, height, depth).unwrap()).unwrap()
}

/// (seconds, position) of the motion capture.
fn truth(folder: &Path) -> Vec<(f64, Vector3)> {
    let text = std::fs::read_to_string(folder.join("groundtruth.txt")).unwrap();
    let parse = |line: &str| {
        let v: Vec<f64> = line.split_whitespace().map(|v| v.parse().unwrap()).collect();
        (v[0], Vector3::new(v[1], v[2], v[3]))
    };
    text.lines().filter(|line| !line.starts_with('#')).map(parse).collect()
}

/// The true position at a time, between the two nearest measurements.
fn position_at(truth: &[(f64, Vector3)], time: f64) -> Option<Vector3> {
    let after = truth.partition_point(|(t, _)| *t <= time);
    let ((a, p), (b, q)) = (*truth.get(after.checked_sub(1)?)?, *truth.get(after)?);
    (b - a < 0.1).then(|| p.lerp(&q, (time - a) / (b - a)))
}

/// What is particular about the camera: its rolling shutter.
fn kinect_v1() -> SlamConfig {
    let mut config = SlamConfig::default();
    config.motion.readout = 0.026;
    config
}

/// The first frames; `None`, and a line about it, where the sequence is not at hand.
pub fn frames(most: usize) -> Option<Vec<RgbdImage>> {
    let folder = PathBuf::from(SEQUENCE);
    let Ok(list) = std::fs::read_to_string(folder.join("associations.txt")) else {
        eprintln!("SKIPPED: no {SEQUENCE}");
        return None;
    };
    let lines = list.lines().filter(|line| !line.starts_with('#')).take(most);
    Some(lines.map(|line| load(&folder, line)).collect())
}

#[test]
fn freiburg1_rpy_is_tracked_within_2_cm() {
    let folder = PathBuf::from(SEQUENCE);
    let Ok(list) = std::fs::read_to_string(folder.join("associations.txt")) else {
        eprintln!("SKIPPED: no {SEQUENCE}");
        return;
    };
    let truth = truth(&folder);
    let mut slam = RgbdSlam::new(camera(), kinect_v1()).unwrap();
    let mut extractor = trundle_vision::OrbExtractor::new(SlamConfig::default().orb).unwrap();
    let (mut located, mut total, mut features, mut slowest) = (0, 0.0, 0.0, 0.0_f64);
    let lines: Vec<&str> = list.lines().filter(|line| !line.starts_with('#')).collect();
    for (i, line) in lines.iter().enumerate() {
        let image = load(&folder, line);
        let start = Instant::now();
        let found = extractor.extract(&gray_from_color(image.color()));
        let extraction = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let report = slam.step_with_features(image.stamp(), found, image.depth(), None);
        let rest = start.elapsed().as_secs_f64();
        (features, total, slowest) = (features + extraction, total + rest, slowest.max(rest));
        located += usize::from(report.tracking.is_located());
        if std::env::var_os("TRUNDLE_VERBOSE").is_some() {
            println!(
                "{i:3} {:?}{}{} {} features {} matches {} inliers, {} keyframes {} landmarks, {:.1} ms, sigma {:.1} mm",
                report.tracking,
                if report.new_keyframe { " KEY" } else { "" },
                if report.relocalised { " RELOCALISED" } else { "" },
                report.features,
                report.matches,
                report.inliers,
                report.keyframes,
                report.landmarks,
                rest * 1e3,
                report.covariance.fixed_view::<3, 3>(0, 0).trace().sqrt() * 1e3,
            );
        }
        assert!(report.tracking != Tracking::DeadReckoning, "frame {i}: without a prior");
    }
    let pairs: Vec<(Vector3, Vector3)> = slam
        .trajectory()
        .iter()
        .filter_map(|(stamp, pose)| Some((pose.translation, position_at(&truth, stamp.as_secs())?)))
        .collect();
    let (estimate, truth): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
    let rmse = aligned_rmse(&estimate, &truth);
    let n = lines.len() as f64;
    println!(
        "{located} of {} frames located, ATE RMSE {:.2} cm over {}, {} keyframes, features {:.1} ms, rest {:.1} ms \
         a frame (slowest {:.1})",
        lines.len(),
        rmse * 100.0,
        estimate.len(),
        slam.keyframes().count(),
        features / n * 1e3,
        total / n * 1e3,
        slowest * 1e3,
    );
    assert!(located as f64 > 0.9 * n, "{located} of {n} frames located");
    assert!(rmse < 0.02, "ATE RMSE {rmse} m");
}
