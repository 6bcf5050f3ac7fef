//! A simulated drive with the noise that the smoother assumes: wheels, gyro, camera with correlated errors, scan matches.

use nalgebra::{Matrix3, Matrix6, Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{DifferentialDrive, Pose2, Pose3, Stamp};
use trundle_estimation::{
    MeasurementUse, MotionIncrement, OdometryConfig, PlanarMeasurement, Smoother, SmootherConfig, VisualPose,
    VisualQuality,
};

/// Time between two readings of the wheels, s.
pub const STEP_S: f64 = 0.02;

/// True calibration of the simulated robot.
#[derive(Debug, Clone, Copy)]
pub struct TrueCalibration {
    pub bias: f64,
    pub scale: f64,
    pub left: f64,
    pub right: f64,
    pub wheelbase: f64,
}

impl TrueCalibration {
    /// Calibration drawn from the smoother's prior.
    pub fn drawn(rng: &mut ChaCha8Rng, odometry: &OdometryConfig, config: &SmootherConfig) -> Self {
        Self {
            bias: odometry.gyro_bias_sigma * normal(rng),
            scale: 1.0 + odometry.gyro_scale_sigma * normal(rng),
            left: 1.0 + odometry.wheel_radius_sigma * normal(rng),
            right: 1.0 + odometry.wheel_radius_sigma * normal(rng),
            wheelbase: 1.0 + config.noise.wheelbase_sigma * normal(rng),
        }
    }
}

/// A robot that drives, with a smoother that receives its measurements.
pub struct Drive {
    pub rng: ChaCha8Rng,
    pub odometry: OdometryConfig,
    pub config: SmootherConfig,
    pub calibration: TrueCalibration,
    pub smoother: Smoother,
    pub truth: Pose2,
    pub steps: i64,
    /// Error of the visual poses in the axes of the visual map.
    pub visual_error: Vector3<f64>,
    /// Whether images are located.
    pub is_lit: bool,
    /// Number of the visual map.
    pub map: u32,
    /// Sum and number of the normalised squared innovations of visual poses.
    pub innovations: (f64, f64),
    /// Distance (m) and turn (rad) since the last image.
    since_image: (f64, f64),
    /// Position at the last image.
    at_image: Vector2<f64>,
}

impl Drive {
    pub fn new(seed: u64, config: SmootherConfig) -> Self {
        let mut odometry = OdometryConfig::default();
        odometry.wheel_radius_sigma = 0.02;
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let calibration = TrueCalibration::drawn(&mut rng, &odometry, &config);
        let smoother =
            Smoother::new(config.clone(), odometry.clone(), DifferentialDrive::KOBUKI, Pose3::identity())
                .unwrap();
        Self {
            rng,
            odometry,
            config,
            calibration,
            smoother,
            truth: Pose2::IDENTITY,
            steps: 0,
            visual_error: Vector3::zeros(),
            is_lit: true,
            map: 0,
            innovations: (0.0, 0.0),
            since_image: (0.0, 0.0),
            at_image: Vector2::zeros(),
        }
    }

    pub fn now(&self) -> Stamp {
        Stamp::from_nanos(self.steps * 20_000_000)
    }

    /// Drives with turns to both sides for a time, s; three images to ten readings of the wheels.
    pub fn go(&mut self, seconds: f64) {
        for _ in 0..(seconds / STEP_S).round() as i64 {
            let time = self.steps as f64 * STEP_S;
            let (v, omega) = if (time * 0.11).sin() > 0.8 { (0.0, 0.0) } else { (0.3, (time * 0.7).sin()) };
            let increment = self.moved(v, omega);
            assert!(self.smoother.add_motion(&increment));
            if self.is_lit && self.steps % 3 == 0 {
                let visual = self.visual();
                if let MeasurementUse::Applied(innovation) = self.smoother.add_visual(&visual) {
                    self.innovations.0 += innovation.squared;
                    self.innovations.1 += 1.0;
                }
            }
        }
    }

    /// One step of the base as measured by wheels and gyro.
    pub fn moved(&mut self, v: f64, omega: f64) -> MotionIncrement {
        let (distance, turn) = (v * STEP_S, omega * STEP_S);
        let rests = distance == 0.0 && turn == 0.0;
        let odometry = self.odometry.clone();
        let c = &mut self.calibration;
        let mut sample = |variance: f64| variance.sqrt() * normal(&mut self.rng);
        let spot = odometry.spot_noise.powi(2) * turn.abs();
        let along = sample(odometry.distance_noise.powi(2) * distance.abs() + spot);
        let across = sample(odometry.sideways_noise.powi(2) * distance.abs() + spot);
        let by_gyro = odometry.gyro_turn_noise.powi(2) * turn.abs()
            + if rests {
                (odometry.gyro_rate_noise * STEP_S).powi(2)
            } else {
                odometry.gyro_time_noise.powi(2) * STEP_S
            };
        let gyro = (turn + sample(by_gyro)) / c.scale + c.bias * STEP_S;
        c.bias += sample(odometry.gyro_bias_walk.powi(2) * STEP_S);
        let by_wheels = turn
            + sample(
                odometry.wheel_turn_noise.powi(2) * turn.abs()
                    + odometry.wheel_distance_noise.powi(2) * distance.abs(),
            );
        let half = DifferentialDrive::KOBUKI.wheelbase * c.wheelbase * by_wheels / 2.0;
        self.truth = self.truth
            * Pose2::exp(Vector3::new(distance, 0.0, turn))
            * Pose2::exp(Vector3::new(along, across, 0.0));
        let (left, right) = ((distance - half) / c.left, (distance + half) / c.right);
        self.steps += 1;
        self.since_image.0 += distance.abs();
        self.since_image.1 += turn.abs();
        MotionIncrement {
            stamp: self.now(),
            dt: STEP_S,
            left,
            right,
            turn_by_gyro: Some(gyro),
            slip: 0.0,
            is_at_rest: rests,
            unobserved: Matrix3::zeros(),
        }
    }

    /// The visual pose of the present image: correlated error and white noise.
    pub fn visual(&mut self) -> VisualPose {
        let (distance, turned) = std::mem::take(&mut self.since_image);
        let keep = (-distance / self.config.noise.correlation_distance
            - turned / self.config.noise.correlation_turn)
            .exp();
        let map_part =
            sigmas(self.config.noise.visual_map_position, self.config.noise.visual_map_heading_deg);
        let white =
            sigmas(self.config.noise.visual_white_position, self.config.noise.visual_white_heading_deg);
        let new = map_part * (1.0 - keep * keep).max(0.0).sqrt();
        let turned = {
            let (e, moved) = (self.visual_error, self.truth.position() - self.at_image);
            let off = Pose2::new(0.0, 0.0, e.z).rotate(moved) - moved;
            Vector3::new(e.x + off.x, e.y + off.y, e.z)
        };
        self.at_image = self.truth.position();
        self.visual_error =
            if self.steps <= 3 { Vector3::zeros() } else { turned * keep + self.normals(new) };
        // The first image defines the visual frame.
        let white = if self.steps <= 3 { Vector3::zeros() } else { white };
        let error = self.visual_error + self.normals(white);
        self.visual_at(self.truth, error)
    }

    /// A visual pose that is off by an error in the axes of the visual map.
    pub fn visual_at(&self, pose: Pose2, error: Vector3<f64>) -> VisualPose {
        let visual = Pose2::new(pose.x + error.x, pose.y + error.y, pose.theta + error.z);
        VisualPose {
            stamp: self.now(),
            visual_from_camera: Pose3::from_pose2(visual),
            covariance: Matrix6::zeros(),
            quality: VisualQuality::Ok,
            map: self.map,
            recognised: false,
        }
    }

    /// A scan match without correlated errors.
    pub fn scan(&mut self) -> PlanarMeasurement {
        let error = self.normals(sigmas(self.config.noise.scan_position, self.config.noise.scan_heading_deg));
        PlanarMeasurement {
            stamp: self.now(),
            pose: self.truth * Pose2::exp(error),
            covariance: Matrix3::zeros(),
        }
    }

    fn normals(&mut self, sigmas: Vector3<f64>) -> Vector3<f64> {
        sigmas.map(|sigma| sigma * normal(&mut self.rng))
    }

    /// Normalised squared error of the estimate.
    pub fn nees(&self) -> f64 {
        let estimate = self.smoother.estimate();
        let off = (estimate.pose.inverse() * self.truth).log();
        off.dot(&(estimate.covariance.try_inverse().unwrap() * off))
    }

    /// Distance of the estimate from the truth, m.
    pub fn error(&self) -> f64 {
        self.smoother.estimate().pose.distance(&self.truth)
    }
}

pub fn sigmas(position: f64, heading_deg: f64) -> Vector3<f64> {
    Vector3::new(position, position, heading_deg.to_radians())
}

pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random_range(1e-12..1.0), rng.random());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}
