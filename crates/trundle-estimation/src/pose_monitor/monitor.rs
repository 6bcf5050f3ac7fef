//! The pose monitor: probabilities of the estimated pose, of another place, and of a pose that a search found.

use crate::pose_monitor::{
    config::PoseMonitorConfig,
    image_evidence::ImageEvidence,
    scan_comparison::ViewPoint,
    view_evidence::{ViewEvidence, WINDOW_S},
};
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Cell, Invalid, OccupancyGrid, Pose2, PoseEstimate, Scan, Stamp};

/// Whether the robot is where its pose estimate says.
///
/// Hypotheses: the estimated pose H, some other place U, and a found pose F. Their weights:
///
/// ```text
/// w(H) = exp(min over t of (v(H, t) - i(t)))   v: scans since t against the map, i: images since t, nats
/// w(U) = d                                     d = window / interval x exp(lift)
/// w(F) = d exp(i + v(F) + r) / N               r: image that recognises F, N: number of poses in the free area
/// ```
///
/// Cost: a scan is linear in its beams' lengths in cells; a found pose is that for 24 scans.
#[derive(Debug, Clone)]
pub struct PoseMonitor {
    config: PoseMonitorConfig,
    images: ImageEvidence,
    view: ViewEvidence,
    /// Whether a wheel hung since an image was last recognised.
    was_lifted: bool,
    state: State,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    /// The estimate is believed.
    Believed,
    /// Another place is more probable; `map_from_odom` of the estimate that was given up.
    Displaced { map_from_odom: Pose2 },
    /// There is no estimate.
    Unknown,
}

/// What found a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PoseSource {
    /// A search of the whole map by scans.
    Scans,
    /// An image of a known place.
    Images,
}

/// How the pose is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PoseState {
    /// Images are recognised at the estimated pose.
    Tracked,
    /// No image is recognised: wheels, gyro and scans carry the estimate.
    DeadReckoned,
    /// The evidence is for another place: the robot looks around.
    Displaced,
    /// There is no estimate: the robot looks around.
    Unknown,
}

/// How the pose is known, and how probable it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseStatus {
    /// How the pose is known.
    pub state: PoseState,
    /// Probability of the estimated pose, 0 to 1.
    pub probability: f64,
}

/// Decision of the monitor on the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PoseDecision {
    /// The estimate stays as it is.
    Keep,
    /// The robot is at another place: the estimate is given up.
    GiveUp,
    /// The robot was at the given-up pose all the time.
    Restore {
        /// The given-up pose.
        map_from_odom: Pose2,
        /// Its covariance as a right perturbation (m, m, rad).
        covariance: Matrix3<f64>,
    },
}

/// Probability of the estimate below which it is given up. Source: ours.
const GIVE_UP_PROBABILITY: f64 = 0.1;
/// Probability of the estimate above which it is believed, and scans are drawn at it. Source: ours.
const BELIEVED_PROBABILITY: f64 = 0.95;
/// Logarithm of the odds of another place when the estimate is given up \[nats\]: that of [`GIVE_UP_PROBABILITY`].
const GIVEN_UP_NATS: f64 = 2.2;
/// Log-likelihood ratio of a wheel that hung, for another place \[nats\]. Source: ours.
const LIFTED_NATS: f64 = 4.0;
/// Log-likelihood ratio of a place that an image recognises \[nats\]. Source: ours: a place in 160,000 looks like another.
const RECOGNISED_NATS: f64 = 12.0;
/// Area of a place that a search tells from its neighbours \[m^2\]. Source: ours.
const PLACE_AREA_M2: f64 = 0.25;
/// Number of headings that a search tells apart. Source: ours, 10 deg.
const HEADING_COUNT: f64 = 36.0;

impl PoseMonitor {
    /// A monitor of a robot that knows its pose.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: PoseMonitorConfig) -> Result<Self, Invalid> {
        Ok(Self {
            config: config.validated()?,
            images: ImageEvidence::default(),
            view: ViewEvidence::default(),
            was_lifted: false,
            state: State::Believed,
        })
    }

    /// An image: whether it shows enough features to be located, and was located in the visual map of the estimate.
    pub fn add_image(&mut self, stamp: Stamp, shows_enough: bool, is_located: bool) {
        self.was_lifted &= !is_located;
        self.images.add(stamp, shows_enough, is_located);
    }

    /// A wheel hangs: the robot may be set down anywhere.
    pub fn set_lifted(&mut self) {
        self.was_lifted = true;
    }

    /// A scan that is not yet part of the map, with estimate and odometry at its time.
    pub fn add_scan(
        &mut self,
        grid: &OccupancyGrid,
        estimate: &PoseEstimate,
        odom_from_base: Pose2,
        scan: &Scan,
    ) {
        let view = match self.state {
            State::Displaced { map_from_odom } => ViewPoint {
                map_from_base: map_from_odom * odom_from_base,
                position_sigma: GIVEN_UP_SIGMA_M,
                heading_sigma: GIVEN_UP_SIGMA_RAD,
            },
            State::Believed | State::Unknown => ViewPoint {
                map_from_base: estimate.pose,
                position_sigma: estimate.covariance.fixed_view::<2, 2>(0, 0).trace().max(0.0).sqrt(),
                heading_sigma: estimate.covariance[(2, 2)].max(0.0).sqrt(),
            },
        };
        self.view.add(grid, &view, odom_from_base, scan);
    }

    /// Decides on the estimate, `map_from_odom`, by all evidence.
    pub fn review(&mut self, now: Stamp, map_from_odom: Pose2) -> PoseDecision {
        let probability = self.probability(now);
        match self.state {
            State::Believed if probability < GIVE_UP_PROBABILITY => {
                self.state = State::Displaced { map_from_odom };
                self.view.forget_before(self.worst_since(now).1);
                PoseDecision::GiveUp
            }
            State::Displaced { map_from_odom } if probability > BELIEVED_PROBABILITY => {
                self.state = State::Believed;
                let sigmas = Vector3::new(GIVEN_UP_SIGMA_M, GIVEN_UP_SIGMA_M, GIVEN_UP_SIGMA_RAD);
                let covariance = Matrix3::from_diagonal(&sigmas.component_mul(&sigmas));
                PoseDecision::Restore { map_from_odom, covariance }
            }
            _ => PoseDecision::Keep,
        }
    }

    /// How the pose is known.
    pub fn status(&self, now: Stamp) -> PoseStatus {
        let state = match self.state {
            State::Unknown => PoseState::Unknown,
            State::Displaced { .. } => PoseState::Displaced,
            State::Believed if self.images.is_located(now) => PoseState::Tracked,
            State::Believed => PoseState::DeadReckoned,
        };
        PoseStatus { state, probability: self.probability(now) }
    }

    /// Probability of a found pose, `map_from_odom`, among the estimate `here` and all other places.
    pub fn probability_of(
        &self,
        grid: &OccupancyGrid,
        (map_from_odom, source): (Pose2, PoseSource),
        here: Pose2,
        now: Stamp,
    ) -> f64 {
        let displaced = self.displaced_nats(now);
        let recognised = if source == PoseSource::Images { RECOGNISED_NATS } else { 0.0 };
        let found =
            displaced + recognised + self.view.nats_at(grid, map_from_odom) - number_of_places(grid).ln();
        let here = match self.state {
            State::Unknown => f64::NEG_INFINITY,
            State::Displaced { map_from_odom } => self.view.nats_at(grid, map_from_odom),
            State::Believed => self.view.nats_at(grid, here),
        };
        1.0 / (1.0 + (here - found).exp() + (displaced - found).exp())
    }

    /// Whether a probability suffices to take a found pose over.
    pub fn is_enough(&self, probability: f64) -> bool {
        probability >= self.config.accept_probability
    }

    /// A new pose replaces the estimate.
    pub fn set_pose(&mut self) {
        self.state = State::Believed;
        self.was_lifted = false;
        self.images.restart();
        self.view.restart();
    }

    /// There is no estimate.
    pub fn forget_pose(&mut self) {
        self.state = State::Unknown;
        self.view.restart();
    }

    /// Probability of the estimate, against all other places.
    fn probability(&self, now: Stamp) -> f64 {
        let odds_of_another = match self.state {
            State::Unknown => return 0.0,
            State::Believed => self.prior_nats() - self.worst_since(now).0,
            State::Displaced { .. } => GIVEN_UP_NATS + self.images.nats(now) - self.view.nats(),
        };
        1.0 / (1.0 + odds_of_another.exp())
    }

    /// Worst evidence for the estimate since any moment, and that moment.
    fn worst_since(&self, now: Stamp) -> (f64, Stamp) {
        self.view.worst_since(now, |moment| self.images.nats_since(moment, now))
    }

    /// Logarithm of the odds of another place, without the scans.
    fn displaced_nats(&self, now: Stamp) -> f64 {
        self.prior_nats() + self.images.nats(now)
    }

    /// Logarithm of the odds of another place, without images and scans.
    fn prior_nats(&self) -> f64 {
        let prior = (WINDOW_S / self.config.displacement_interval).ln();
        let lift = if self.was_lifted { LIFTED_NATS } else { 0.0 };
        prior + lift
    }
}

impl PoseStatus {
    /// Whether scans may be drawn at the estimated pose.
    pub fn is_believed(&self) -> bool {
        let has_estimate = matches!(self.state, PoseState::Tracked | PoseState::DeadReckoned);
        has_estimate && self.probability >= BELIEVED_PROBABILITY
    }
}

/// Uncertainty of a pose that was given up \[m\]: the wheels carry it. Source: ours.
const GIVEN_UP_SIGMA_M: f64 = 0.1;
/// Uncertainty of its heading \[rad\]. Source: ours.
const GIVEN_UP_SIGMA_RAD: f64 = 0.03;

/// Number of poses that a search tells apart in the free area of a map, at least one.
fn number_of_places(grid: &OccupancyGrid) -> f64 {
    let free = grid.cells().iter().filter(|cell| **cell == Cell::Free).count() as f64;
    (free * grid.geometry().resolution.powi(2) / PLACE_AREA_M2).max(1.0) * HEADING_COUNT
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::{room, scan_of};
    use trundle_core::Twist2;

    /// A robot at `truth` that believes to be at `believed`, turns on the spot and looks around every 0.2 s.
    struct Run {
        monitor: PoseMonitor,
        grid: OccupancyGrid,
        truth: Pose2,
        believed: Pose2,
        steps: u32,
    }

    impl Run {
        fn new(truth: Pose2, believed: Pose2) -> Self {
            let monitor = PoseMonitor::new(PoseMonitorConfig::default()).unwrap();
            Self { monitor, grid: room(), truth, believed, steps: 0 }
        }

        fn now(&self) -> Stamp {
            Stamp::default().after(0.2 * f64::from(self.steps))
        }

        fn step(&mut self, turn: f64, hidden: Option<f64>, is_located: bool) -> PoseDecision {
            self.steps += 1;
            let odom = Pose2::new(0.0, 0.0, turn);
            let now = self.now();
            let scan = scan_of(&self.grid, self.truth * odom, now - Stamp::default(), hidden);
            self.monitor.add_image(now, true, is_located);
            let covariance = Matrix3::from_diagonal(&Vector3::new(4e-4, 4e-4, 1e-4));
            let pose = self.believed * odom;
            let estimate = PoseEstimate { stamp: now, pose, twist: Twist2::ZERO, covariance };
            self.monitor.add_scan(&self.grid, &estimate, odom, &scan);
            self.monitor.review(now, pose * odom.inverse())
        }
    }

    #[test]
    fn a_robot_that_was_carried_away_gives_its_pose_up_within_a_second() {
        // The third stands before a wall, which fills its view as a person would.
        let places = [(4.8, 2.0, -2.0, 5), (1.0, 2.0, 2.5, 5), (5.3, 3.3, 1.5, 25)];
        for (x, y, heading, limit) in places {
            let mut run = Run::new(Pose2::new(x, y, heading), Pose2::new(1.0, 2.0, 0.0));
            let given_up = (1..40_u32).find(|_| run.step(0.0, None, false) == PoseDecision::GiveUp);
            assert!(given_up.is_some_and(|steps| steps <= limit), "({x}, {y}): {given_up:?}");
            assert_eq!(run.monitor.status(run.now()).state, PoseState::Displaced);
        }
    }

    #[test]
    fn images_of_people_that_nobody_recognises_leave_the_pose_where_the_walls_agree() {
        let at = Pose2::new(1.0, 2.0, 0.2);
        let mut run = Run::new(at, at * Pose2::new(0.03, -0.02, 0.01));
        let verdicts: Vec<PoseDecision> =
            (0..150_u32).map(|i| run.step(0.05 * f64::from(i), Some(1.5), false)).collect();
        assert!(verdicts.iter().all(|verdict| *verdict == PoseDecision::Keep));
        assert!(run.monitor.status(run.now()).is_believed());
    }

    #[test]
    fn a_pose_that_was_given_up_is_restored_where_the_scans_agree_again() {
        let at = Pose2::new(1.0, 2.0, 0.2);
        let mut run = Run::new(Pose2::new(4.8, 2.0, -2.0), at);
        while run.step(0.0, None, false) != PoseDecision::GiveUp {}
        run.truth = at;
        let restored = (0..150_u32).find_map(|i| match run.step(0.1 * f64::from(i), None, false) {
            PoseDecision::Restore { map_from_odom, .. } => Some(map_from_odom),
            _ => None,
        });
        let off = restored.unwrap().inverse() * at;
        assert!(off.log().norm() < 1e-9);
    }

    #[test]
    fn a_look_alike_place_is_not_enough_to_leave_the_estimate_and_is_where_the_scans_contradict_it() {
        let at = Pose2::new(1.0, 2.0, 0.2);
        let mut here = Run::new(at, at);
        (0..60_u32).for_each(|i| {
            here.step(0.1 * f64::from(i), None, false);
        });
        let probability = here.monitor.probability_of(&here.grid, (at, PoseSource::Scans), at, here.now());
        assert!(probability < 0.5, "the same pose: {probability}");
        let elsewhere = Pose2::new(4.8, 2.0, -2.0);
        let mut away = Run::new(elsewhere, at);
        (0..60_u32).for_each(|i| {
            away.step(0.1 * f64::from(i), None, false);
        });
        for source in [PoseSource::Scans, PoseSource::Images] {
            let probability = away.monitor.probability_of(&away.grid, (elsewhere, source), at, away.now());
            assert!(away.monitor.is_enough(probability), "{source:?}: {probability}");
            let probability = here.monitor.probability_of(&here.grid, (elsewhere, source), at, here.now());
            assert!(probability < 1e-3, "{source:?}: {probability}");
        }
    }

    #[test]
    fn a_lift_alone_is_a_doubt_and_no_proof() {
        let at = Pose2::new(1.0, 2.0, 0.2);
        let mut run = Run::new(at, at);
        run.step(0.0, None, true);
        run.monitor.set_lifted();
        assert_eq!(run.step(0.0, None, false), PoseDecision::Keep);
        run.monitor.forget_pose();
        assert_eq!(run.monitor.status(run.now()), PoseStatus { state: PoseState::Unknown, probability: 0.0 });
        run.monitor.set_pose();
        assert!(run.monitor.status(run.now()).probability > 0.5);
    }
}
