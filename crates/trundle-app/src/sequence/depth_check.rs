//! The depth scale by the size of the trajectory: a wrong scale makes the whole path larger or smaller than that of a reference.

use super::odometry_prior::OdometryPrior;
use super::trajectory::SequenceTrajectory;
use crate::sequence_input::SequenceInput;
use trundle_core::{DepthImage, Pose3, Stamp};
use trundle_eval::{AbsoluteConfig, associate};
use trundle_io::DepthStatistics;
use trundle_slam::RgbdSlam;

/// Factor between trajectory and reference \[1\]. Below it, and above its inverse, the depth scale is not suspected: presets of one camera
/// differ by 4 %. Source: ours.
const MIN_FACTOR: f64 = 1.15;
/// Factor between trajectory and reference \[1\]. Above it, and below its inverse, the reference is suspected to have another unit than the
/// metre, not the depth scale. Source: ours: the scales in use differ by a factor of 5, units of length by 100.
const MAX_FACTOR: f64 = 30.0;
/// Distance by the reference over which the two are compared \[m\]: ten times the error of a ground truth. Source: ours.
const STEP_M: f64 = 0.1;
/// Longest time of a step \[s\]. Source: ours: in it, the drift of the odometry is below a hundredth.
const MAX_STEP_S: f64 = 3.0;
/// Number of steps below which the factor is unknown. Source: ours.
const MIN_STEPS: usize = 20;
/// Ratio of the quartiles of the steps' factors \[1\]. Above it the images do not have one scale: the tracking failed. Source: ours.
const MAX_QUARTILE_RATIO: f64 = 1.5;
/// Digits of a depth scale in a message. Source: ours.
const SCALE_DIGITS: i32 = 2;

/// Whether the depth of a sequence is usable, and has its unit.
pub struct DepthCheck {
    /// The depth of all images read.
    statistics: DepthStatistics,
    /// Depth units per metre.
    scale: f64,
    /// Reason why the trajectory has another size than its reference.
    size_problem: Option<String>,
}

impl DepthCheck {
    /// The check of images with `scale` depth units per metre.
    pub fn new(scale: f64) -> Self {
        Self { statistics: DepthStatistics::default(), scale, size_problem: None }
    }

    /// Counts one image.
    pub fn count(&mut self, depth: &DepthImage) {
        self.statistics.count(depth);
    }

    /// Reason for unusable depth, and the likely cause.
    pub fn unusable(&self) -> Option<String> {
        self.statistics.problem(self.scale)
    }

    /// Reason for depth that is unusable or has a wrong unit, and the likely cause.
    pub fn problem(&self) -> Option<String> {
        self.unusable().or_else(|| self.size_problem.clone())
    }

    /// Compares the size of the trajectory by the images with that by the ground truth, or else by the odometry, if there is one.
    pub fn compare(&mut self, input: &SequenceInput, slam: &RgbdSlam) {
        let estimate = SequenceTrajectory::located(slam);
        let [odometry, truth] = input.pose_sources();
        self.size_problem = None;
        let (name, factor) = match input.ground_truth() {
            Some(reference) => (truth, size_factor(reference, &estimate)),
            None => (odometry, size_factor(&OdometryPrior::new(input).camera_poses(&estimate), &estimate)),
        };
        if let Some(factor) = factor.filter(|factor| !(1.0 / MAX_FACTOR..=MAX_FACTOR).contains(factor)) {
            let path = input.path.display();
            tracing::warn!(
                "{path}: the trajectory by the images is {factor:.1e} times as large as by {name}: is {name} in metres?"
            );
            return;
        }
        self.size_problem = factor.map(|factor| {
            let size = format!("the trajectory by the images is {factor:.2} times as large as by {name}");
            let (scale, fitting) = (self.scale, rounded(self.scale * factor));
            format!("{size} with depth_scale = {scale}; about {fitting} fits (units per metre)")
        });
    }
}

/// Size of `estimate` relative to `reference`: the median over short steps, so that a jump, a slip or a lost part has no effect. `None` if
/// it is about 1, or if the steps do not agree.
fn size_factor(reference: &[(Stamp, Pose3)], estimate: &[(Stamp, Pose3)]) -> Option<f64> {
    let stamps = |poses: &[(Stamp, Pose3)]| poses.iter().map(|(stamp, _)| *stamp).collect::<Vec<_>>();
    let max_difference = AbsoluteConfig::default().max_difference;
    let pairs = associate(&stamps(reference), &stamps(estimate), max_difference).ok()?;
    let positions = |&(r, e): &(usize, usize)| (reference[r].1.translation, estimate[e].1.translation);
    let mut factors: Vec<f64> = (0..pairs.len())
        .filter_map(|i| {
            let (from, own_from) = positions(&pairs[i]);
            let is_near =
                |pair: &&(usize, usize)| reference[pair.0].0 - reference[pairs[i].0].0 <= MAX_STEP_S;
            let mut later = pairs[i..].iter().take_while(is_near).map(positions);
            let (to, own_to) = later.find(|(to, _)| (to - from).norm() >= STEP_M)?;
            Some((own_to - own_from).norm() / (to - from).norm())
        })
        .collect();
    factors.sort_by(f64::total_cmp);
    let at = |share: f64| factors[(share * (factors.len() - 1) as f64).round() as usize];
    let agree = factors.len() >= MIN_STEPS && at(0.75) <= MAX_QUARTILE_RATIO * at(0.25);
    (agree && !(1.0 / MIN_FACTOR..=MIN_FACTOR).contains(&at(0.5))).then(|| at(0.5))
}

/// A positive number to [`SCALE_DIGITS`] digits.
fn rounded(number: f64) -> f64 {
    let unit = 10_f64.powi(number.log10().floor() as i32 + 1 - SCALE_DIGITS);
    (number / unit).round() * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector3;

    /// A loop with 3 m and 2 m across, and its copy of another size, `error` m off along x in turn.
    fn paths(size: f64, error: f64) -> [Vec<(Stamp, Pose3)>; 2] {
        let path = |size: f64, error: f64| {
            (0..100).map(move |i| {
                let angle = f64::from(i) * 0.05;
                let off = if i % 2 == 0 { error } else { -error };
                let position =
                    Vector3::new(1.5 * angle.cos() * size + off, angle.sin() * size, 0.1 * angle * size);
                (
                    Stamp::from_nanos(i64::from(i) * 100_000_000),
                    Pose3 { translation: position, ..Pose3::identity() },
                )
            })
        };
        [path(1.0, 0.0).collect(), path(size, error).collect()]
    }

    #[test]
    fn a_path_of_another_size_is_named_and_the_same_size_is_not() {
        for size in [0.2, 0.7, 1.4, 5.0] {
            let [reference, estimate] = paths(size, 0.0);
            let factor = size_factor(&reference, &estimate).unwrap();
            assert!((factor / size - 1.0).abs() < 0.05, "{size}: {factor}");
        }
        for size in [0.95, 1.0, 1.05] {
            let [reference, estimate] = paths(size, 0.02);
            assert_eq!(size_factor(&reference, &estimate), None, "{size}");
        }
    }

    #[test]
    fn a_lost_track_is_not_a_wrong_scale() {
        let [reference, estimate] = paths(1.0, 5.0);
        assert_eq!(size_factor(&reference, &estimate), None, "the shape differs");
        let [reference, mut estimate] = paths(1.0, 0.0);
        assert_eq!(size_factor(&reference[..12], &estimate[..12]), None, "too few steps");
        estimate.iter_mut().skip(50).for_each(|(_, pose)| pose.translation.x += 20.0);
        assert_eq!(size_factor(&reference, &estimate), None, "a jump of 20 m");
        assert_eq!(size_factor(&reference, &[]), None, "no poses");
    }

    #[test]
    fn scales_are_rounded_to_two_digits() {
        assert_eq!([4_963.0, 1_004.0, 0.98, 261.0].map(rounded), [5_000.0, 1_000.0, 0.98, 260.0]);
    }
}
