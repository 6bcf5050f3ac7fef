//! The same images give the same bytes: for any number of threads, on a busy computer, in repeated runs.

use crate::freiburg;
use crate::room::{Clean, camera};
use nalgebra::Vector6;
use std::sync::atomic::{AtomicBool, Ordering};
use trundle_core::{PinholeCamera, Pose3, RgbdImage, Stamp};
use trundle_slam::{RgbdSlam, SlamConfig};

/// The trajectory and the map after all images, with the features found by a number of threads.
fn run(
    threads: usize,
    camera: PinholeCamera,
    images: &[RgbdImage],
    priors: Option<&[Pose3]>,
) -> (Vec<(Stamp, Pose3)>, Vec<u8>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut slam = RgbdSlam::new(camera, SlamConfig::default()).unwrap();
        for (i, image) in images.iter().enumerate() {
            slam.step(image, priors.map(|priors| priors[i].into()));
        }
        assert!(slam.keyframes().count() > 1, "nothing was mapped");
        (slam.trajectory(), slam.save())
    })
}

fn assert_always_the_same(camera: PinholeCamera, images: &[RgbdImage], priors: Option<&[Pose3]>) {
    let first = run(1, camera, images, priors);
    assert!(first == run(2, camera, images, priors), "two threads give another result than one");
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| {
                while !is_over.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        let busy = run(2, camera, images, priors);
        is_over.store(true, Ordering::Relaxed);
        assert!(first == busy, "a busy computer gives another result");
    });
}

#[test]
fn a_hand_held_sequence_gives_the_same_bytes() {
    let Some(images) = freiburg::frames(45) else { return };
    assert_always_the_same(freiburg::camera(), &images, None);
}

#[test]
fn a_robot_in_a_room_gives_the_same_bytes() {
    let pose = |i: usize| {
        Pose3::exp(Vector6::new(0.0, 0.0, i as f64 * 0.01, 0.0, 0.0, 0.0))
            * Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, 0.012 * i as f64, 0.0))
    };
    let images: Vec<RgbdImage> = (0..60).map(|i| Clean::at(pose(i)).shot(i)).collect();
    let priors: Vec<Pose3> = (0..60_usize).map(|i| pose(i.saturating_sub(1)).inverse() * pose(i)).collect();
    assert_always_the_same(camera(), &images, Some(&priors));
}
