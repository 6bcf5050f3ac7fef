//! The pose estimate: an extended Kalman filter over odometry, visual poses and scan matches.

use crate::{
    fusion::belief::{Belief, Measurement},
    fusion::config::LocalizerConfig,
    fusion::correction::{Correction, Prediction, ScanPose, VisualPose},
    fusion::divergence_check::{DivergenceAction, DivergenceCheck},
    fusion::measurement_buffer::{MeasurementBuffer, Moment},
    fusion::pose_uncertainty::PoseUncertainty,
    fusion::visual_frame::{VisualAnchor, VisualFrame},
    odometry::state::OdometryState,
};
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;
use trundle_core::{Invalid, Odometry, Pose2, Pose3, PoseEstimate, Stamp, Twist2};

/// The pose estimate: odometry, corrected by visual poses and scan matches.
///
/// Problem: the base's pose in the map frame, at the rate of the wheels. Odometry is smooth but drifts; the absolute sources are slower and
/// late. Method: an extended Kalman filter on SE(2) with right perturbations. The error is in the base frame, a measurement is a whole pose
/// (H = I), and odometry moves the covariance by the adjoint. Each measurement is applied at its stamp and transported forward by the later
/// odometry. Visual errors are correlated in time, therefore variances have a lower bound. Cost: one step per reading; a late correction
/// costs one step per later entry.
///
/// | symbol | here | unit |
/// |---|---|---|
/// | P | `PoseEstimate::covariance` | m^2, rad^2 |
/// | Q | growth of `Odometry::covariance` | m^2, rad^2 |
/// | R | covariance of the measurement plus the configured noise | m^2, rad^2 |
///
/// The map frame is the base's frame at the first odometry: x forward, y left, z up.
#[derive(Debug, Clone)]
pub struct Localizer {
    config: LocalizerConfig,
    /// Belief at the first odometry.
    start: Belief,
    buffer: Option<MeasurementBuffer>,
    visual: VisualFrame,
    /// Standard deviation of the scale of turns by odometry.
    turn_scale_sigma: f64,
    divergence: DivergenceCheck,
}

/// Variances of an unknown pose, m^2, m^2, rad^2: 100 m cover a building. With smaller variances the gate would reject a relocalisation.
/// Source: ours.
const UNKNOWN_POSE_VARIANCES: Vector3<f64> = Vector3::new(1e4, 1e4, 10.0);

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
        let start = Belief::new(Pose2::IDENTITY, Matrix3::zeros());
        Ok(Self {
            config,
            start,
            buffer: None,
            visual,
            turn_scale_sigma: 0.0,
            divergence: DivergenceCheck::default(),
        })
    }

    /// The localizer of a resumed run in a known map: the poses of the visual maps (by number) are known, the robot's pose is unknown.
    #[must_use]
    pub fn resumed(mut self, visual_maps: BTreeMap<u32, VisualAnchor>) -> Self {
        self.visual.set_anchors(visual_maps);
        self.start = Belief::new(self.start.pose, Matrix3::from_diagonal(&UNKNOWN_POSE_VARIANCES));
        self
    }

    /// Sets the standard deviation of the scale of turns by odometry, ratio. It counts from the next odometry on; 0 at the beginning.
    pub fn set_turn_scale_sigma(&mut self, sigma: f64) {
        self.turn_scale_sigma = if sigma.is_finite() { sigma.max(0.0) } else { 0.0 };
    }

    /// Moves the estimate with the odometry.
    pub fn predict(&mut self, odometry: &Odometry) -> Prediction {
        if !(odometry.pose.is_finite() && is_finite(&odometry.covariance) && odometry.twist.is_finite()) {
            return Prediction::NotFinite;
        }
        let Some(buffer) = &mut self.buffer else {
            self.buffer = Some(MeasurementBuffer::new(odometry, self.start, self.config.min_variances()));
            return Prediction::Started;
        };
        let later = odometry.stamp - buffer.newest_odometry().stamp;
        if later < 0.0 {
            return Prediction::TimeWentBack { by: -later };
        }
        if later == 0.0 {
            return Prediction::NothingNew;
        }
        buffer.push(odometry, self.turn_scale_sigma, self.config.history);
        Prediction::Moved
    }

    /// Corrects the estimate by a visual pose. The first one of a visual map anchors the visual frame in the map.
    pub fn correct_visual(&mut self, visual: &VisualPose) -> Correction {
        if !visual.is_finite() {
            return Correction::NotFinite;
        }
        let moment = match self.find(visual.stamp) {
            Ok(moment) => moment,
            Err(rejection) => return rejection,
        };
        let Some(measurement) = self.visual.measurement(visual, &self.config) else {
            if moment.belief.position_variance() > self.config.anchor_sigma.powi(2) {
                return Correction::PoseUnknown;
            }
            self.visual.anchor(&moment.belief, visual);
            return Correction::Anchored;
        };
        self.divergence.add(&self.config, visual.stamp, measurement.pose, moment.odometry.pose);
        let correction = self.apply(&moment, measurement);
        let Correction::Gated { distance } = correction else {
            self.visual.refine(&moment.belief, &measurement);
            self.divergence.on_accepted();
            return correction;
        };
        if visual.recognised {
            self.apply_inflated(&moment, measurement);
            self.divergence = DivergenceCheck::default();
            return Correction::Recovered { distance };
        }
        match self.divergence.on_rejected(&self.config) {
            DivergenceAction::Wait => correction,
            DivergenceAction::Reanchor => {
                self.visual.anchor(&moment.belief, visual);
                self.divergence = DivergenceCheck::default();
                Correction::Reanchored
            }
            DivergenceAction::AcceptVisual => {
                self.apply_inflated(&moment, measurement);
                Correction::Recovered { distance }
            }
        }
    }

    /// Corrects the estimate by a scan match.
    pub fn correct_scan(&mut self, scan: &ScanPose) -> Correction {
        if !scan.is_finite() {
            return Correction::NotFinite;
        }
        let measurement = Measurement {
            pose: scan.map_from_base,
            noise: self.config.scan_noise() + scan.covariance + scan.map.covariance,
            prior_inflation: Matrix3::zeros(),
            variance_floor: scan.map.total().diagonal(),
            scale_error: scan.map.scale_error,
        };
        match self.find(scan.stamp) {
            Ok(moment) => self.apply(&moment, measurement),
            Err(rejection) => rejection,
        }
    }

    /// The estimate at the stamp of the newest odometry, or of a newer measurement. Without odometry: the origin at time 0.
    pub fn estimate(&self) -> PoseEstimate {
        let Some(buffer) = &self.buffer else {
            return PoseEstimate {
                stamp: Stamp::default(),
                pose: Pose2::IDENTITY,
                twist: Twist2::ZERO,
                covariance: Matrix3::zeros(),
            };
        };
        let (stamp, belief) = buffer.newest();
        let twist = buffer.newest_odometry().twist;
        PoseEstimate { stamp, pose: belief.pose, twist, covariance: belief.covariance() }
    }

    /// Uncertainty of the pose at a stamp of the last seconds, as a right perturbation.
    ///
    /// # Errors
    /// [`Correction::TooOld`], [`Correction::TooNew`] or [`Correction::NoOdometry`].
    pub fn uncertainty_at(&self, stamp: Stamp) -> Result<PoseUncertainty, Correction> {
        self.find(stamp).map(|moment| moment.belief.uncertainty)
    }

    /// `map_from_base` at a stamp of the last seconds.
    ///
    /// # Errors
    /// [`Correction::TooOld`], [`Correction::TooNew`] or [`Correction::NoOdometry`].
    pub fn pose_at(&self, stamp: Stamp) -> Result<Pose2, Correction> {
        self.find(stamp).map(|moment| moment.belief.pose)
    }

    /// Pose and covariance of the odometry at a stamp of the last seconds, interpolated between two readings.
    ///
    /// # Errors
    /// [`Correction::TooOld`], [`Correction::TooNew`] or [`Correction::NoOdometry`].
    pub fn odometry_at(&self, stamp: Stamp) -> Result<OdometryState, Correction> {
        self.find(stamp).map(|moment| moment.odometry)
    }

    /// The pose of the base by a visual pose; `None` before the frame of its visual map is anchored.
    pub fn base_by_visual(&self, visual: &VisualPose) -> Option<Pose2> {
        self.visual.base(visual)
    }

    /// Anchors the frame of a visual map again, at the pose that agrees with the estimate.
    pub fn anchor_again(&mut self, visual: &VisualPose) -> Correction {
        if !visual.is_finite() {
            return Correction::NotFinite;
        }
        match self.find(visual.stamp) {
            Ok(moment) => {
                self.visual.anchor(&moment.belief, visual);
                self.divergence = DivergenceCheck::default();
                Correction::Reanchored
            }
            Err(rejection) => rejection,
        }
    }

    /// The current visual map's frame in the map; `None` without a visual pose.
    pub fn map_from_visual(&self) -> Option<Pose3> {
        self.visual.map_from_visual()
    }

    /// Declares the pose unknown, as after a kidnapping. Earlier measurements are discarded.
    pub fn set_pose_unknown(&mut self) {
        if let Some(buffer) = &mut self.buffer {
            let odometry = *buffer.newest_odometry();
            let (_, Belief { pose, .. }) = buffer.newest();
            let unknown = Belief::new(*pose, Matrix3::from_diagonal(&UNKNOWN_POSE_VARIANCES));
            *buffer = MeasurementBuffer::new(&odometry, unknown, self.config.min_variances());
        }
        self.divergence = DivergenceCheck::default();
    }

    /// Discards the poses of the visual maps in the map, for example after the map was replaced. The next pose of each visual map anchors
    /// it again.
    pub fn forget_visual_maps(&mut self) {
        self.visual.set_anchors(BTreeMap::new());
    }

    /// The anchor of every visual map, by its number.
    pub fn visual_maps(&self) -> BTreeMap<u32, VisualAnchor> {
        self.visual.maps()
    }

    fn find(&self, stamp: Stamp) -> Result<Moment, Correction> {
        let buffer = self.buffer.as_ref().ok_or(Correction::NoOdometry)?;
        buffer.find(stamp, self.config.max_lead)
    }

    fn apply(&mut self, moment: &Moment, measurement: Measurement) -> Correction {
        let (_, distance) = moment.belief.innovation(&measurement);
        if distance > self.config.gate || distance.is_nan() {
            return Correction::Gated { distance };
        }
        self.insert(moment, measurement);
        Correction::Applied { distance }
    }

    /// Applies a measurement far from the belief: the prior is inflated by their distance.
    fn apply_inflated(&mut self, moment: &Moment, measurement: Measurement) {
        let (innovation, _) = moment.belief.innovation(&measurement);
        // With a factor of ten, the update closes nine tenths of the distance.
        let prior_inflation = innovation * innovation.transpose() * 10.0;
        self.insert(moment, Measurement { prior_inflation, ..measurement });
    }

    fn insert(&mut self, moment: &Moment, measurement: Measurement) {
        if let Some(buffer) = &mut self.buffer {
            buffer.insert(moment, measurement);
        }
    }
}

fn is_finite(matrix: &Matrix3<f64>) -> bool {
    matrix.iter().all(|v| v.is_finite())
}
