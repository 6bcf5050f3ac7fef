//! Visual poses that follow something that moves: a person who fills the view.

use crate::{fusion::motion_window::MotionWindow, odometry::state::OdometryState};
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Pose2, Stamp};

/// Compares the motion by images with that by wheels and gyro, and takes scans as the arbiter.
///
/// Where images and wheels contradict each other, one of them is wrong. Scans that agree with the wheels decide against the images: the
/// visual map has followed something that moves. Without such scans the images are believed, since wheels slip.
#[derive(Debug, Clone, Default)]
pub(crate) struct VisualMotionCheck {
    images: MotionWindow,
    /// Number of the visual map of the window.
    map: u32,
    scans: MotionWindow,
    /// The newest verdict of a scan on the wheels.
    verdict: Option<(Stamp, WheelVerdict)>,
    /// Since when images contradict the wheels.
    doubt: Option<Stamp>,
    /// When images last contradicted wheels that scans confirm, since the visual frame was last anchored.
    conflict: Option<Stamp>,
}

/// Verdict of scans on the motion by wheels and gyro.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum WheelVerdict {
    Confirmed,
    Refuted,
}

/// Verdict on a visual pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum VisualMotion {
    /// It moves as the robot does, or nothing says otherwise.
    Agrees,
    /// It follows something that moves, at this Mahalanobis distance from the wheels.
    Contradicts(f64),
    /// It agrees again after a contradiction: the visual frame lies elsewhere.
    FrameMoved,
}

/// Mahalanobis distance of two motions beyond which they contradict each other. Source: ours, one of 10^5 by chance.
const CONFLICT_DISTANCE: f64 = 5.0;
/// The same within which scans confirm the wheels. Source: ours.
const CONFIRMED_DISTANCE: f64 = 3.0;
/// Smallest time from the begin of a contradiction to a scan that decides it \[s\]: a scan before it shows nothing of it. Source: ours.
const MIN_VERDICT_DELAY_S: f64 = 0.1;
/// Age of the newest verdict up to which another one is expected \[s\]. Source: ours.
const MAX_VERDICT_AGE_S: f64 = 1.0;
/// Time for which images are left out while no scan has decided \[s\]. Source: ours, two scans.
const MAX_DOUBT_S: f64 = 0.5;
/// Time without a contradiction after which the visual map stands still again \[s\]. Source: the window's length.
const CALM_S: f64 = 1.5;
/// Noise of a visual position within one visual map \[m\]. Source: ours.
const POSITION_SIGMA_M: f64 = 0.012;
/// Noise of its heading \[rad\]. Source: ours, 0.3 deg.
const HEADING_SIGMA_RAD: f64 = 0.005;

impl VisualMotionCheck {
    /// A visual pose of a visual map.
    pub(crate) fn add_image(
        &mut self,
        stamp: Stamp,
        map: u32,
        pose: Pose2,
        odometry: OdometryState,
    ) -> VisualMotion {
        if map != self.map {
            self.map = map;
            self.restart();
        }
        let distance = self.images.add(stamp, pose, noise(), odometry).unwrap_or(0.0);
        if distance <= CONFLICT_DISTANCE {
            self.doubt = None;
        } else {
            let since = *self.doubt.get_or_insert(stamp);
            let decided = self.verdict.filter(|(at, _)| *at - since >= MIN_VERDICT_DELAY_S);
            match decided.map(|(_, verdict)| verdict) {
                Some(WheelVerdict::Confirmed) => self.conflict = Some(stamp),
                Some(WheelVerdict::Refuted) => self.conflict = None,
                None if self.has_scans(stamp) && stamp - since <= MAX_DOUBT_S => {
                    return VisualMotion::Contradicts(distance);
                }
                None => {}
            }
        }
        match self.conflict {
            None => VisualMotion::Agrees,
            Some(at) if stamp - at <= CALM_S => VisualMotion::Contradicts(distance),
            Some(_) => VisualMotion::FrameMoved,
        }
    }

    /// A scan match with its covariance.
    pub(crate) fn add_scan(
        &mut self,
        stamp: Stamp,
        pose: Pose2,
        covariance: &Matrix3<f64>,
        odometry: OdometryState,
    ) {
        let Some(distance) = self.scans.add(stamp, pose, covariance + noise(), odometry) else { return };
        self.verdict = match distance {
            _ if distance <= CONFIRMED_DISTANCE => Some((stamp, WheelVerdict::Confirmed)),
            _ if distance > CONFLICT_DISTANCE => Some((stamp, WheelVerdict::Refuted)),
            _ => self.verdict,
        };
    }

    /// Whether scans come that may decide.
    fn has_scans(&self, now: Stamp) -> bool {
        self.verdict.is_some_and(|(at, _)| now - at <= MAX_VERDICT_AGE_S)
    }

    /// The visual frame was anchored anew.
    pub(crate) fn restart(&mut self) {
        self.images.clear();
        (self.doubt, self.conflict) = (None, None);
    }
}

fn noise() -> Matrix3<f64> {
    let sigmas = Vector3::new(POSITION_SIGMA_M, POSITION_SIGMA_M, HEADING_SIGMA_RAD);
    Matrix3::from_diagonal(&sigmas.component_mul(&sigmas))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verdicts on images of a standing robot every 0.1 s that follow a walker of 0.4 m/s from 1 s to 2 s; scans confirm the wheels, or
    /// move along with the images.
    fn verdicts(scans_stand: bool) -> Vec<VisualMotion> {
        let mut check = VisualMotionCheck::default();
        let odometry =
            OdometryState { pose: Pose2::IDENTITY, covariance: Matrix3::from_diagonal_element(1e-6) };
        let at = |i: u32| {
            let time = 0.1 * f64::from(i);
            let (stamp, walked) = (Stamp::default().after(time), 0.4 * (time - 1.0).clamp(0.0, 1.0));
            let seen = Pose2::new(0.0, walked, 0.0);
            let scan = if scans_stand { Pose2::IDENTITY } else { seen };
            check.add_scan(stamp, scan, &Matrix3::from_diagonal_element(1e-5), odometry);
            check.add_image(stamp, 0, seen, odometry)
        };
        (0..50).map(at).collect()
    }

    #[test]
    fn images_of_a_walker_are_left_out_until_they_stand_still_again() {
        let verdicts = verdicts(true);
        let agrees = verdicts.iter().take_while(|verdict| **verdict == VisualMotion::Agrees).count();
        assert!((11..=13).contains(&agrees), "{agrees}");
        let moved = verdicts.iter().position(|verdict| *verdict == VisualMotion::FrameMoved).unwrap();
        assert!((35..=46).contains(&moved), "{moved}");
    }

    #[test]
    fn images_and_scans_against_the_wheels_mean_that_the_wheels_slip() {
        let verdicts = verdicts(false);
        let left_out = verdicts.iter().filter(|verdict| **verdict != VisualMotion::Agrees).count();
        assert!(left_out <= 2, "{left_out} images until a scan decides");
    }
}
