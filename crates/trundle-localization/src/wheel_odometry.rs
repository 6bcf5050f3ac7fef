use crate::{
    OdometryConfig, WheelCounts, WheelReport,
    camera_turns::{CameraTurns, SeenHeading},
    gyro_errors::GyroErrors,
    obedience::Obedience,
    odometry_noise::{Step, of_gap, of_step},
    planar::carried,
    stuck_gyro::StuckGyro,
    turn_integral::TurnIntegral,
    wheel_size::{Rolled, WheelSize},
};
use nalgebra::Matrix3;
use trundle_core::{
    DifferentialDrive, GyroRate, Invalid, Odometry, Pose2, Pose3, Stamp, Twist2, Vector3, WheelTicks,
};

/// Where the wheels and the gyro believe the robot is.
///
/// Problem: integrate encoder ticks to a pose. Between two readings the base drives an arc whose length is the mean of
/// the two rims' ways and whose angle is the gyro's, less its bias, or the rims' difference over the wheelbase where
/// there is no gyro. The arc is integrated exactly by the exponential map of SE(2). Counters wrap at 2^16; a difference
/// is read as the shorter way round. While the wheels rest for long enough, so does the robot, and the gyro shows its bias. While they roll,
/// gyro and camera show how large they are ([`WheelOdometry::seen`]). Wheels that are told to roll ([`WheelOdometry::tell`]) and count
/// nothing are not at rest: the pose is as uncertain as the way that they were told. Cost: O(1).
///
/// A reading from the past, after a gap, or implying an impossible speed never makes the pose jump: see [`WheelReport`].
#[derive(Debug, Clone)]
pub struct WheelOdometry {
    drive: DifferentialDrive,
    config: OdometryConfig,
    gyro: TurnIntegral,
    errors: GyroErrors,
    turns: CameraTurns,
    stuck: StuckGyro,
    obedience: Obedience,
    size: WheelSize,
    last_rate: Option<GyroRate>,
    last: Option<WheelTicks>,
    suspect: Option<WheelTicks>,
    resting_since: Option<Stamp>,
    /// The length of all steps, m.
    way: f64,
    odometry: Odometry,
    report: WheelReport,
    counts: WheelCounts,
}

/// What the wheels did between two readings.
#[derive(Debug, Clone, Copy)]
struct RimMotion {
    left: f64,
    right: f64,
    dt: f64,
}

impl WheelOdometry {
    /// Odometry that starts at the origin of the odom frame.
    ///
    /// # Errors
    /// When the drive or the configuration is out of range.
    pub fn new(drive: DifferentialDrive, config: OdometryConfig) -> Result<Self, Invalid> {
        let (drive, config) = (drive.validated()?, config.validated()?);
        Ok(Self {
            errors: GyroErrors::new(&config),
            turns: CameraTurns::default(),
            size: WheelSize::new(&config),
            drive,
            config,
            gyro: TurnIntegral::default(),
            stuck: StuckGyro::default(),
            obedience: Obedience::default(),
            last_rate: None,
            last: None,
            suspect: None,
            resting_since: None,
            way: 0.0,
            odometry: Odometry {
                stamp: Stamp::default(),
                pose: Pose2::IDENTITY,
                twist: Twist2::ZERO,
                covariance: Matrix3::zeros(),
            },
            report: WheelReport::default(),
            counts: WheelCounts::default(),
        })
    }

    /// Takes in a reading of the gyro, any number of them between two readings of the wheels.
    pub fn step_gyro(&mut self, rate: &GyroRate) {
        if !self.gyro.push(*rate, self.config.gyro_timeout) {
            self.counts.gyro_refused += 1;
            return;
        }
        self.stuck.note(rate);
        let dt = self.last_rate.map_or(0.0, |last| rate.stamp - last.stamp);
        self.errors.wander(&self.config, dt);
        if self.at_rest(rate.stamp) && self.errors.explains(&self.config, rate.omega) {
            self.errors.rest(&self.config, rate.omega);
        }
        self.last_rate = Some(*rate);
    }

    /// The base is told to do this from now on.
    pub fn tell(&mut self, twist: Twist2) {
        self.obedience.tell(twist);
    }

    /// Whether the wheels have been told to roll for a while and count nothing: encoders that are stuck, or wheels that are blocked.
    pub fn wheels_do_not_answer(&self) -> bool {
        self.obedience.is_refused()
    }

    /// Takes in a reading of the wheels and returns the odometry after it; [`WheelOdometry::report`] says what became of
    /// the reading. A reading that was not taken in leaves the pose as it was.
    pub fn step_wheels(&mut self, ticks: &WheelTicks) -> Odometry {
        self.report = match self.last {
            None => self.start(ticks),
            Some(last) if ticks.stamp <= last.stamp => {
                WheelReport::TimeWentBack { by: last.stamp - ticks.stamp }
            }
            Some(last) => self.advance(&last, ticks),
        };
        self.counts.note(&self.report);
        self.odometry
    }

    /// The odometry after the newest reading.
    pub fn odometry(&self) -> &Odometry {
        &self.odometry
    }

    /// What became of the newest reading of the wheels.
    pub fn report(&self) -> WheelReport {
        self.report
    }

    /// How often each kind of reading was met.
    pub fn counts(&self) -> WheelCounts {
        self.counts
    }

    /// The gyro's bias, rad/s, once it was measured, at rest or by the camera.
    pub fn gyro_bias(&self) -> Option<f64> {
        self.errors.is_measured().then(|| self.errors.bias())
    }

    /// True turns over the gyro's, as far as the camera has shown them.
    pub fn gyro_scale(&self) -> f64 {
        self.errors.scale()
    }

    /// Radii of the left and the right wheel as far as gyro and camera have shown them, m.
    pub fn wheel_radii(&self) -> [f64; 2] {
        let (left, right) = self.size.ratios();
        [left, right].map(|ratio| ratio * self.drive.wheel_radius)
    }

    /// At `stamp` the camera saw the base at `seen_from_base`, in a frame that rests, when the odometry had it at `odom_from_base`: the
    /// ways by both show how large the wheels are, the turns what the gyro tells wrong. `None` where the frame does not go on from
    /// the last call's. Images may come late, but in order.
    pub fn seen(&mut self, stamp: Stamp, odom_from_base: Pose2, seen_from_base: Option<Pose3>) {
        match seen_from_base.filter(|seen| seen.is_finite() && odom_from_base.is_finite()) {
            Some(seen) => {
                self.size.seen(odom_from_base, seen.translation);
                let (by_odometry, by_camera) = (odom_from_base.theta, seen.rotation);
                let heading = SeenHeading { stamp, by_odometry, by_camera, way: self.way };
                if let Some(turn) = self.turns.see(heading) {
                    self.errors.seen(&turn);
                }
            }
            None => {
                self.size.unseen();
                self.turns.interrupt(stamp);
            }
        }
    }

    /// The covariance of a motion of the base that no reading has told of for `gap` s, as a right perturbation (x m, y m, theta rad).
    pub fn untold(&self, gap: f64) -> Matrix3<f64> {
        of_gap(&self.config, gap)
    }

    fn start(&mut self, ticks: &WheelTicks) -> WheelReport {
        self.last = Some(*ticks);
        self.odometry.stamp = ticks.stamp;
        self.resting_since = None;
        self.gyro.turn_until(ticks.stamp, self.config.gyro_timeout);
        WheelReport::Started
    }

    fn advance(&mut self, last: &WheelTicks, ticks: &WheelTicks) -> WheelReport {
        let rims = self.rim_motion(last, ticks);
        if rims.dt > self.config.max_gap {
            self.jump_over(ticks, rims.dt);
            return WheelReport::Gap { length: rims.dt };
        }
        let speed = rims.left.abs().max(rims.right.abs()) / rims.dt;
        if speed > self.config.max_speed {
            return self.refuse(ticks, rims.dt, speed);
        }
        self.suspect = None;
        self.last = Some(*ticks);
        self.integrate(ticks.stamp, &rims)
    }

    fn rim_motion(&self, last: &WheelTicks, ticks: &WheelTicks) -> RimMotion {
        let metres = |from: u16, to: u16, ratio: f64| {
            f64::from(to.wrapping_sub(from).cast_signed()) * self.drive.metres_per_tick() * ratio
        };
        let (left, right) = self.size.ratios();
        RimMotion {
            left: metres(last.left, ticks.left, left),
            right: metres(last.right, ticks.right, right),
            dt: ticks.stamp - last.stamp,
        }
    }

    fn integrate(&mut self, stamp: Stamp, rims: &RimMotion) -> WheelReport {
        let half_base = self.drive.wheelbase / 2.0;
        let counts_nothing = rims.left == 0.0 && rims.right == 0.0;
        let untold = self.obedience.step(half_base, !counts_nothing, rims.dt);
        let rests = counts_nothing && !self.obedience.is_to_roll(half_base);
        self.resting_since = if rests { self.resting_since.or(Some(stamp)) } else { None };

        let turn_by_wheels = (rims.right - rims.left) / self.drive.wheelbase;
        let do_not_answer = self.obedience.is_refused();
        // Of wheels that say nothing and a gyro that says the same again and again nobody knows which is right.
        let is_stuck = self.stuck.contradicts(turn_by_wheels / rims.dt, self.errors.bias())
            || do_not_answer && self.stuck.is_suspect();
        let turn_by_gyro = self.turn_by_gyro(stamp, rims.dt).filter(|_| !is_stuck);
        // The gyro's noise does not turn a robot that rests. A single reading without a tick says nothing: one that creeps has them too.
        let may_rest = rests && (self.at_rest(stamp) || !self.errors.is_measured());
        let is_noise = may_rest && turn_by_gyro.is_some_and(|turn| self.is_noise(turn / rims.dt));
        let turn = if is_noise { 0.0 } else { turn_by_gyro.unwrap_or(turn_by_wheels) };
        let slip_rate = turn_by_gyro.map_or(0.0, |_| (turn_by_wheels - turn) / rims.dt);
        let slips = slip_rate.abs() > self.config.slip_rate;
        let way = (rims.left + rims.right) / 2.0;
        let slip = if slips { slip_rate.abs() * rims.dt * self.drive.wheelbase / 2.0 } else { 0.0 };
        if slips || self.at_rest(stamp) || turn_by_gyro.is_none() || self.stuck.is_suspect() {
            self.turns.interrupt(stamp);
        }
        let variance = |turn| self.errors.turn_variance(&self.config, turn, rims.dt);
        let by_gyro = turn_by_gyro.map(|turn| if is_noise { 0.0 } else { variance(turn) });
        if slips || do_not_answer {
            self.size.interrupt();
        } else {
            let is_sure = !self.stuck.is_suspect() && self.errors.is_measured();
            let by_gyro = turn_by_gyro.zip(by_gyro).filter(|_| is_sure);
            self.size.rolled(self.drive.wheelbase, Rolled { way, by_wheels: turn_by_wheels, by_gyro });
        }
        self.move_by(stamp, &Step { way, turn, dt: rims.dt, by_gyro, slip });
        self.odometry.covariance += untold.covariance(by_gyro.is_some());
        if slips { WheelReport::Slipping { rate: slip_rate } } else { WheelReport::Used }
    }

    fn move_by(&mut self, stamp: Stamp, step: &Step) {
        let motion = Pose2::exp(Vector3::new(step.way, 0.0, step.turn));
        self.way += step.way.abs();
        let odometry = &mut self.odometry;
        odometry.stamp = stamp;
        odometry.pose = odometry.pose * motion;
        odometry.twist = Twist2::new(step.way / step.dt, step.turn / step.dt);
        odometry.covariance = carried(&odometry.covariance, &motion) + of_step(&self.config, step);
    }

    /// The gyro's turn over the last `dt` s, less its bias, rad, if it covers them.
    fn turn_by_gyro(&mut self, stamp: Stamp, dt: f64) -> Option<f64> {
        let (turn, covered) = self.gyro.turn_until(stamp, self.config.gyro_timeout)?;
        ((covered - dt).abs() < 1e-6).then(|| self.errors.true_turn(turn, dt))
    }

    fn is_noise(&self, rate_without_bias: f64) -> bool {
        self.errors.explains(&self.config, rate_without_bias + self.errors.bias())
    }

    fn at_rest(&self, now: Stamp) -> bool {
        self.resting_since.is_some_and(|since| now - since >= self.config.still_time)
    }

    /// A first reading at impossible counts is a broken one; a second one near it, and the counters were reset.
    fn refuse(&mut self, ticks: &WheelTicks, dt: f64, speed: f64) -> WheelReport {
        let confirmed = self.suspect.is_some_and(|suspect| {
            let rims = self.rim_motion(&suspect, ticks);
            rims.dt > 0.0 && rims.left.abs().max(rims.right.abs()) / rims.dt <= self.config.max_speed
        });
        if confirmed {
            self.jump_over(ticks, dt);
            return WheelReport::Restarted;
        }
        self.suspect = Some(*ticks);
        WheelReport::TooFast { speed }
    }

    /// Goes on from `ticks` without knowing what happened in the `dt` s before.
    fn jump_over(&mut self, ticks: &WheelTicks, dt: f64) {
        self.last = Some(*ticks);
        self.suspect = None;
        self.resting_since = None;
        self.size.interrupt();
        self.turns.interrupt(ticks.stamp);
        self.gyro.turn_until(ticks.stamp, self.config.gyro_timeout);
        self.odometry.stamp = ticks.stamp;
        self.odometry.twist = Twist2::ZERO;
        self.odometry.covariance += of_gap(&self.config, dt);
    }
}
