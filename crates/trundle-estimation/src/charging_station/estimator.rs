//! The estimator of the station's pose.

use super::light_config::StationLightConfig;
use super::light_model::LightModel;
use super::particles::{Particle, Particles};
use super::random::Random;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use trundle_core::{DockInfrared, Invalid, Pose2, difference_of_angles};

/// The station's pose with its covariance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StationEstimate {
    /// `map_from_station`: origin on the floor at the middle of the front, x axis out of the front.
    pub pose: Pose2,
    /// Covariance in the station's frame (right perturbation): along its axis \[m\], across it \[m\], heading \[rad\].
    pub covariance: [[f64; 3]; 3],
}

impl StationEstimate {
    /// Standard deviation of the axis' lateral position, m, at a distance from the station's front, m.
    #[must_use]
    pub fn lateral_sigma(&self, distance: f64) -> f64 {
        let c = &self.covariance;
        (c[1][1] + 2.0 * distance * c[1][2] + distance * distance * c[2][2]).max(0.0).sqrt()
    }

    /// Standard deviation of the axis' heading, rad.
    #[must_use]
    pub fn heading_sigma(&self) -> f64 {
        self.covariance[2][2].max(0.0).sqrt()
    }

    /// Standard deviation of the distance to the station along its axis, m.
    #[must_use]
    pub fn distance_sigma(&self) -> f64 {
        self.covariance[0][0].max(0.0).sqrt()
    }

    /// Whether all numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.pose.is_finite() && self.covariance.as_flattened().iter().all(|value| value.is_finite())
    }
}

/// Number of particles. Source: ours; 0.3 ms a reading.
const PARTICLE_COUNT: usize = 1000;
/// Number of candidates of the first reading. Source: ours.
const FIRST_GUESS_COUNT: usize = 8000;
/// Smallest motion between two used readings \[m\]. Readings of one place are not independent. Source: ours.
const MIN_MOTION_M: f64 = 0.01;
/// Smallest turn between two used readings \[rad\]. Source: ours.
const MIN_TURN_RAD: f64 = 0.026;
/// Exponent of a reading's likelihood: readings of neighbouring places depend on each other. Source: ours.
const LIKELIHOOD_EXPONENT: f64 = 0.3;
/// Growth of the standard deviation with the root of the receivers' path: position \[m/sqrt(m)\] and heading \[rad/sqrt(m)\]. It covers the
/// drift and the corrections of the robot's own pose, and errors of the light model. Source: ours.
const DRIFT_M: f64 = 0.006;
const DRIFT_RAD: f64 = 0.006;
/// Mean likelihood of a reading below which it contradicts the distribution. Source: ours.
const MIN_MEAN_LIKELIHOOD: f64 = 0.003;
/// Number of consecutive contradictions after which the estimate restarts. Source: ours.
const MAX_CONTRADICTIONS: u32 = 12;
/// Standard deviation of the pose at the charging plates \[m\], along, across; and heading \[rad\]. Source: the plates' tolerances.
const CONTACT_SIGMA: [f64; 3] = [0.01, 0.006, 0.03];

/// Estimates the pose of a charging station from its light along the robot's path.
#[derive(Debug, Clone)]
pub struct StationEstimator {
    model: LightModel,
    random: Random,
    particles: Particles,
    /// Pose and reading of the last update.
    last: Option<(Pose2, DockInfrared)>,
    contradictions: u32,
}

impl StationEstimator {
    /// An estimator without a station; `seed` is the seed of the particles.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: StationLightConfig, seed: u64) -> Result<Self, Invalid> {
        let (model, random) = (LightModel::new(config.validated()?), Random::new(seed));
        Ok(Self { model, random, particles: Particles::default(), last: None, contradictions: 0 })
    }

    /// Adds the light at a pose, `map_from_base`. It is called with every pose; readings without new information are ignored.
    pub fn add_light(&mut self, pose: Pose2, light: &DockInfrared) {
        if self.particles.is_empty() {
            if light.is_any() {
                self.start(pose, light);
            }
            return;
        }
        let Some(distance) = self.motion_since_last(pose, light) else { return };
        self.last = Some((pose, *light));
        let root = distance.sqrt();
        self.particles.diffuse(Vector3::new(DRIFT_M, DRIFT_M, DRIFT_RAD) * root, &mut self.random);
        let model = &self.model;
        let mean = self.particles.weigh(|map_from_station| {
            model.likelihood(light, map_from_station.inverse() * pose).powf(LIKELIHOOD_EXPONENT)
        });
        self.note_contradiction(mean, light);
        if !self.particles.is_empty() {
            self.particles.resample_if_needed(&mut self.random);
        }
    }

    /// Adds contact with the charging plates; `map_from_station` follows from the robot's pose.
    pub fn add_contact(&mut self, map_from_station: Pose2) {
        self.around(map_from_station, CONTACT_SIGMA);
    }

    /// Restores an estimate of an earlier run.
    pub fn restore(&mut self, estimate: &StationEstimate) {
        let sigma = [0, 1, 2].map(|k: usize| estimate.covariance[k][k].max(0.0).sqrt());
        self.around(estimate.pose, sigma);
    }

    /// Drops the station.
    pub fn forget(&mut self) {
        self.particles = Particles::default();
        self.contradictions = 0;
    }

    /// The estimate. `None` before the first light.
    pub fn estimate(&self) -> Option<StationEstimate> {
        if self.particles.is_empty() {
            return None;
        }
        let (pose, covariance) = self.particles.moments();
        Some(StationEstimate { pose, covariance: covariance.into() })
    }

    /// Path of the receivers since the last used reading, m. `None` if the reading has no new information.
    fn motion_since_last(&self, pose: Pose2, light: &DockInfrared) -> Option<f64> {
        let Some((last, before)) = &self.last else { return Some(0.0) };
        let distance = last.distance(&pose);
        let turn = difference_of_angles(pose.theta, last.theta).abs();
        let moved = distance >= MIN_MOTION_M || turn >= MIN_TURN_RAD || before != light;
        moved.then(|| distance + turn * self.model.receiver_radius())
    }

    fn start(&mut self, pose: Pose2, light: &DockInfrared) {
        let guesses = (0..FIRST_GUESS_COUNT).filter_map(|_| self.model.first_guess(light, &mut self.random));
        let particle =
            |base_from_station| Particle { map_from_station: pose * base_from_station, weight: 1.0 };
        self.particles = Particles(guesses.map(particle).collect());
        let model = &self.model;
        let mean = self.particles.weigh(|station| model.likelihood(light, station.inverse() * pose));
        (self.last, self.contradictions) = (Some((pose, *light)), 0);
        if mean > 0.0 {
            self.particles.resample(PARTICLE_COUNT, &mut self.random);
        } else {
            self.forget();
        }
    }

    fn note_contradiction(&mut self, mean: f64, light: &DockInfrared) {
        let contradicts = mean.is_nan() || mean < MIN_MEAN_LIKELIHOOD.powf(LIKELIHOOD_EXPONENT);
        self.contradictions = if !contradicts { 0 } else { self.contradictions + u32::from(light.is_any()) };
        if mean <= 0.0 || mean.is_nan() || self.contradictions > MAX_CONTRADICTIONS {
            self.forget();
        }
    }

    fn around(&mut self, map_from_station: Pose2, [x, y, heading]: [f64; 3]) {
        let weight = 1.0 / PARTICLE_COUNT as f64;
        self.particles = Particles(vec![Particle { map_from_station, weight }; PARTICLE_COUNT]);
        self.particles.diffuse(Vector3::new(x, y, heading), &mut self.random);
        (self.last, self.contradictions) = (None, 0);
    }
}
