use crate::{
    Correction, LocalizerConfig, Odometer, Prediction, VisualPose,
    belief::{Belief, Measurement},
    history::{History, Moment},
    recovery::{Recovery, Verdict},
    visual_frame::{VisualAnchor, VisualFrame},
};
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;
use trundle_core::{Invalid, Odometry, Pose2, Pose3, PoseEstimate, Stamp, Twist2};

/// The one pose estimate: odometry, corrected by visual poses and scan matches.
///
/// Problem: the base's pose in the map frame, at the wheels' rate, from a smooth drifting source and slower absolute ones
/// that come late. An extended Kalman filter on SE(2) with right perturbations: its error lives in the base frame, a pose
/// is measured as a whole (H = I), and odometry moves the covariance by the adjoint. Measurements are applied at the time
/// they were taken and carried forward through the odometry since. Visual errors are strongly correlated in time, so
/// corrections never bring a variance below a floor. Cost: one step a reading; a late correction costs the steps since.
///
/// | symbol | here | unit |
/// |---|---|---|
/// | P | `PoseEstimate::covariance` | m^2, rad^2 |
/// | Q | growth of `Odometry::covariance` | m^2, rad^2 |
/// | R | the measurement's covariance plus the configured noise | m^2, rad^2 |
///
/// The map frame is the base's frame at the first odometry: x forward, y left, z up.
#[derive(Debug, Clone)]
pub struct Localizer {
    config: LocalizerConfig,
    /// What is believed before the first odometry.
    start: Belief,
    history: Option<History>,
    visual: VisualFrame,
    recovery: Recovery,
}

/// The variances of a robot that may be anywhere in a building, m^2 and rad^2.
const ANYWHERE: Vector3<f64> = Vector3::new(1e4, 1e4, 10.0);

impl Localizer {
    /// An estimate at the map's origin, for a camera mounted at `base_from_camera`.
    ///
    /// # Errors
    /// When the configuration is out of range or the mount is not finite.
    pub fn new(config: LocalizerConfig, base_from_camera: Pose3) -> Result<Self, Invalid> {
        let config = config.validated()?;
        if !base_from_camera.is_finite() {
            return Err(Invalid::new("base_from_camera", "not finite", "", "finite numbers"));
        }
        let visual = VisualFrame::new(base_from_camera);
        let start = Belief { pose: Pose2::IDENTITY, covariance: Matrix3::zeros() };
        Ok(Self { config, start, history: None, visual, recovery: Recovery::default() })
    }

    /// The same waking up in a known map: it knows where each visual map lies in it, by its number, and not where the robot
    /// stands.
    #[must_use]
    pub fn waking(mut self, visual_maps: BTreeMap<u32, VisualAnchor>) -> Self {
        self.visual.lay(visual_maps);
        self.start.covariance = Matrix3::from_diagonal(&ANYWHERE);
        self
    }

    /// Moves the estimate with the odometry.
    pub fn predict(&mut self, odometry: &Odometry) -> Prediction {
        if !(odometry.pose.is_finite() && is_finite(&odometry.covariance) && odometry.twist.is_finite()) {
            return Prediction::NotFinite;
        }
        let Some(history) = &mut self.history else {
            self.history = Some(History::new(odometry, self.start, self.config.least_variances()));
            return Prediction::Started;
        };
        let later = odometry.stamp - history.newest_odometry().stamp;
        if later < 0.0 {
            return Prediction::TimeWentBack { by: -later };
        }
        if later == 0.0 {
            return Prediction::NothingNew;
        }
        history.push(odometry, self.config.history);
        Prediction::Moved
    }

    /// Corrects the estimate by a visual pose. The first one lays the visual frame into the map.
    pub fn correct_visual(&mut self, visual: &VisualPose) -> Correction {
        if !(visual.visual_from_camera.is_finite() && visual.covariance.iter().all(|v| v.is_finite())) {
            return Correction::NotFinite;
        }
        let moment = match self.find(visual.stamp) {
            Ok(moment) => moment,
            Err(refusal) => return refusal,
        };
        let Some(measurement) = self.visual.measurement(visual, &self.config) else {
            if moment.belief.position_variance() > self.config.anchor_sigma.powi(2) {
                return Correction::Nowhere;
            }
            self.visual.anchor(&moment.belief, visual);
            return Correction::Anchored;
        };
        self.recovery.watch(&self.config, visual.stamp, measurement.pose, moment.odometer.pose);
        let correction = self.apply(&moment, measurement);
        let Correction::Gated { distance } = correction else {
            self.visual.refine(&moment.belief, &measurement);
            self.recovery.believed();
            return correction;
        };
        if visual.recognised {
            self.believe(&moment, measurement);
            self.recovery = Recovery::default();
            return Correction::Recovered { distance };
        }
        match self.recovery.refused(&self.config) {
            Verdict::Wait => correction,
            Verdict::Reanchor => {
                self.visual.anchor(&moment.belief, visual);
                self.recovery = Recovery::default();
                Correction::Reanchored
            }
            Verdict::Believe => {
                self.believe(&moment, measurement);
                Correction::Recovered { distance }
            }
        }
    }

    /// Corrects the estimate by a scan match: `map_from_base` with its covariance as a right perturbation.
    pub fn correct_scan(
        &mut self,
        stamp: Stamp,
        map_from_base: Pose2,
        covariance: &Matrix3<f64>,
    ) -> Correction {
        if !(map_from_base.is_finite() && is_finite(covariance)) {
            return Correction::NotFinite;
        }
        let noise = self.config.scan_noise() + covariance;
        match self.find(stamp) {
            Ok(moment) => {
                let (doubt, frame) = (Matrix3::zeros(), Vector3::zeros());
                self.apply(&moment, Measurement { pose: map_from_base, noise, doubt, frame })
            }
            Err(refusal) => refusal,
        }
    }

    /// The estimate at the time of the newest odometry (or of a measurement that is newer still). Before any odometry:
    /// the origin at time 0.
    pub fn estimate(&self) -> PoseEstimate {
        let Some(history) = &self.history else {
            return PoseEstimate {
                stamp: Stamp::default(),
                pose: Pose2::IDENTITY,
                twist: Twist2::ZERO,
                covariance: Matrix3::zeros(),
            };
        };
        let (stamp, belief) = history.newest();
        let twist = history.newest_odometry().twist;
        PoseEstimate { stamp, pose: belief.pose, twist, covariance: belief.covariance }
    }

    /// `map_from_base` at a moment of the last seconds.
    ///
    /// # Errors
    /// [`Correction::TooOld`], [`Correction::TooNew`] or [`Correction::NoOdometry`].
    pub fn pose_at(&self, stamp: Stamp) -> Result<Pose2, Correction> {
        self.find(stamp).map(|moment| moment.belief.pose)
    }

    /// What the odometry said at a moment of the last seconds, between two readings on the arc between them.
    ///
    /// # Errors
    /// [`Correction::TooOld`], [`Correction::TooNew`] or [`Correction::NoOdometry`].
    pub fn odometry_at(&self, stamp: Stamp) -> Result<Odometer, Correction> {
        self.find(stamp).map(|moment| moment.odometer)
    }

    /// Where the current visual map's frame lies in the map, once there was a visual pose.
    pub fn map_from_visual(&self) -> Option<Pose3> {
        self.visual.map_from_visual()
    }

    /// Forgets where the robot is: it was carried away. What was measured before no longer counts.
    pub fn lose_place(&mut self) {
        if let Some(history) = &mut self.history {
            let odometry = *history.newest_odometry();
            let (_, Belief { pose, .. }) = history.newest();
            let nowhere = Belief { pose: *pose, covariance: Matrix3::from_diagonal(&ANYWHERE) };
            *history = History::new(&odometry, nowhere, self.config.least_variances());
        }
        self.recovery = Recovery::default();
    }

    /// Where every visual map lies in the map, by its number.
    pub fn visual_maps(&self) -> BTreeMap<u32, VisualAnchor> {
        self.visual.maps()
    }

    fn find(&self, stamp: Stamp) -> Result<Moment, Correction> {
        let history = self.history.as_ref().ok_or(Correction::NoOdometry)?;
        history.find(stamp, self.config.most_ahead)
    }

    fn apply(&mut self, moment: &Moment, measurement: Measurement) -> Correction {
        let (_, distance) = moment.belief.innovation(&measurement);
        if distance > self.config.gate || distance.is_nan() {
            return Correction::Gated { distance };
        }
        self.insert(moment, measurement);
        Correction::Applied { distance }
    }

    /// Takes in a measurement far from the belief by doubting the belief as much as the two are apart.
    fn believe(&mut self, moment: &Moment, measurement: Measurement) {
        let (innovation, _) = moment.belief.innovation(&measurement);
        // Ten times: nine tenths of the way and more are gone at once.
        let doubt = innovation * innovation.transpose() * 10.0;
        self.insert(moment, Measurement { doubt, ..measurement });
    }

    fn insert(&mut self, moment: &Moment, measurement: Measurement) {
        if let Some(history) = &mut self.history {
            history.insert(moment, measurement);
        }
    }
}

fn is_finite(matrix: &Matrix3<f64>) -> bool {
    matrix.iter().all(|v| v.is_finite())
}
