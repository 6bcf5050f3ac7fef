//! The TUM sequence freiburg1_rpy (Sturm et al. 2012), 400 frames; skipped if the data set is missing.

use crate::align::aligned_rmse;
use crate::drive::Drive;
use std::path::Path;
use std::time::Instant;
use trundle_core::{Pose3, RgbdImage, Stamp, Vector3, gray_from_color};
use trundle_slam::{ReadoutEstimator, RgbdSlam, SlamConfig, Tracking};

const SEQUENCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/tum_fr1_rpy_400");

pub use crate::drive::freiburg1 as camera;

/// The sequence; `None`, with a printed note, if the data set is missing.
fn sequence() -> Option<Drive> {
    let drive = Path::new(SEQUENCE).exists().then(|| Drive::open(SEQUENCE));
    if drive.is_none() {
        eprintln!("SKIPPED: no {SEQUENCE}");
    }
    drive
}

/// The first frames; `None` if the data set is missing.
pub fn frames(max: usize) -> Option<Vec<RgbdImage>> {
    let drive = sequence()?;
    Some((0..max.min(drive.frames.len())).map(|i| drive.image(i)).collect())
}

#[test]
fn freiburg1_rpy_is_tracked_within_2_cm() {
    let Some(drive) = sequence() else { return };
    let mut slam = RgbdSlam::new(drive.camera, SlamConfig::default()).unwrap();
    let mut extractor = trundle_vision::OrbExtractor::new(SlamConfig::default().orb).unwrap();
    let (mut located, mut total, mut features, mut slowest) = (0, 0.0, 0.0, 0.0_f64);
    for i in 0..drive.frames.len() {
        let image = drive.image(i);
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
    let pair = |(stamp, pose): &(Stamp, Pose3)| {
        let i = drive.frames.binary_search_by_key(stamp, |frame| frame.stamp).ok()?;
        Some((pose.translation, drive.frames[i].truth?.translation))
    };
    let pairs: Vec<(Vector3, Vector3)> = slam.trajectory().iter().filter_map(pair).collect();
    let (estimate, truth): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
    let rmse = aligned_rmse(&estimate, &truth);
    let n = drive.frames.len() as f64;
    println!(
        "{located} of {} frames located, ATE RMSE {:.2} cm over {}, {} keyframes, features {:.1} ms, rest {:.1} ms \
         a frame (slowest {:.1})",
        drive.frames.len(),
        rmse * 100.0,
        estimate.len(),
        slam.keyframes().count(),
        features / n * 1e3,
        total / n * 1e3,
        slowest * 1e3,
    );
    assert_eq!(located, drive.frames.len(), "every frame is located by its image");
    assert!(rmse < 0.02, "ATE RMSE {rmse} m");
}

/// Error of the trajectory against the ground truth, m.
fn ate(drive: &Drive, slam: &RgbdSlam) -> f64 {
    let pair = |(stamp, pose): &(Stamp, Pose3)| {
        let i = drive.frames.binary_search_by_key(stamp, |frame| frame.stamp).ok()?;
        Some((pose.translation, drive.frames[i].truth?.translation))
    };
    let pairs: Vec<(Vector3, Vector3)> = slam.trajectory().iter().filter_map(pair).collect();
    let (estimate, truth): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
    aligned_rmse(&estimate, &truth)
}

/// Time of the first dropped image, s after the first image.
const DROPPED_FROM_S: f64 = 4.0;

#[test]
fn a_camera_in_a_hand_is_located_again_after_a_second_without_images() {
    let Some(drive) = sequence() else { return };
    let mut slam = RgbdSlam::new(drive.camera, SlamConfig::default()).unwrap();
    let start = drive.frames[0].stamp;
    let (mut located, mut images) = (0, 0);
    for i in 0..drive.frames.len() {
        let since = drive.frames[i].stamp - start;
        if (DROPPED_FROM_S..DROPPED_FROM_S + 1.0).contains(&since) {
            continue;
        }
        images += 1;
        located += usize::from(slam.step(&drive.image(i), None).tracking.is_located());
    }
    let error = ate(&drive, &slam);
    println!("{located} of {images} located, {} maps, ATE RMSE {:.2} cm", slam.maps().len(), error * 100.0);
    assert!(located + 5 >= images, "{located} of {images} located");
    assert!(error < 0.03, "ATE RMSE {error} m");
}

#[test]
fn the_readout_time_of_a_kinect_v1_is_found_by_its_images() {
    let Some(drive) = sequence() else { return };
    let mut estimator = ReadoutEstimator::new(drive.camera, SlamConfig::default()).unwrap();
    (0..200).for_each(|i| estimator.record(&drive.image(i)));
    let found = estimator.estimate().unwrap();
    println!("{found:?}");
    // 26 ms [Ringaby11].
    assert!(found.is_clear() && (found.readout_s - 0.026).abs() < 0.008, "{found:?}");
}
