//! Odometry of wheels and gyro.

use crate::{
    calibration::{
        gyro_calibration::GyroCalibration,
        visual_yaw_segments::{VisualHeading, VisualYawSegments},
        wheel_calibration::{WheelCalibration, WheelStep},
    },
    faults::{gyro_fault::GyroFault, wheel_fault::WheelFault},
    odometry::motion_increment::MotionIncrement,
    odometry::report::{ReportLog, WheelCounts, WheelReport},
    odometry::turn_integral::TurnIntegral,
    odometry_config::OdometryConfig,
    odometry_noise::{Step, of_gap, of_step},
    planar::transported,
};
use nalgebra::Matrix3;
use trundle_core::{
    DifferentialDrive, GyroRate, Invalid, Odometry, Pose2, Pose3, Stamp, Twist2, Vector3, WheelTicks,
};

/// Pose of the base by wheels and gyro.
///
/// Problem: integrate encoder ticks to a pose. Between two readings the base drives an arc. The length of the arc is the mean of the two
/// wheels' distances. The angle of the arc comes from the gyro without its bias; without a gyro, from the difference of the distances over
/// the wheelbase. The exponential map of SE(2) integrates the arc exactly. Counters wrap at 2^16; a difference is taken in the shorter
/// direction. Wheels at rest for [`OdometryConfig::still_time`] are a robot at rest, which calibrates the gyro's bias. Gyro and camera
/// calibrate the wheels' radii while driving ([`WheelOdometry::add_visual_pose`]). Wheels with a command to roll
/// ([`WheelOdometry::set_command`]) and no counts are a fault: the covariance grows by the commanded motion. Cost: O(1).
///
/// The pose never jumps by a reading from the past, after a gap, or of an impossible speed: see [`WheelReport`].
#[derive(Debug, Clone)]
pub struct WheelOdometry {
    pub(super) drive: DifferentialDrive,
    pub(super) config: OdometryConfig,
    integral: TurnIntegral,
    gyro_calibration: GyroCalibration,
    yaw_segments: VisualYawSegments,
    gyro_fault: GyroFault,
    pub(super) wheel_fault: WheelFault,
    wheel_calibration: WheelCalibration,
    pub(super) last: LastInputs,
    resting_since: Option<Stamp>,
    /// Whether wheels and gyro measured no motion in the newest reading.
    is_still: bool,
    /// Length of the path, m.
    pub(super) path_length: f64,
    pub(super) odometry: Odometry,
    pub(super) reports: ReportLog,
    /// Motion of the newest reading; `None` if the reading was rejected.
    pub(super) increment: Option<MotionIncrement>,
}

/// The newest input of each kind.
#[derive(Debug, Clone, Default)]
pub(super) struct LastInputs {
    rate: Option<GyroRate>,
    ticks: Option<WheelTicks>,
    /// A rejected reading at impossible counts: a second one near it means that the counters were reset.
    suspect_ticks: Option<WheelTicks>,
    /// Odometry that the body computed.
    pub(super) given: Option<Odometry>,
}

/// Distances of the two wheels between two readings, m, with the time, s.
#[derive(Debug, Clone, Copy)]
struct WheelMotion {
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
            gyro_calibration: GyroCalibration::new(&config),
            yaw_segments: VisualYawSegments::default(),
            wheel_calibration: WheelCalibration::new(&config),
            drive,
            config,
            integral: TurnIntegral::default(),
            gyro_fault: GyroFault::default(),
            wheel_fault: WheelFault::default(),
            last: LastInputs::default(),
            resting_since: None,
            is_still: false,
            path_length: 0.0,
            odometry: Odometry {
                stamp: Stamp::default(),
                pose: Pose2::IDENTITY,
                twist: Twist2::ZERO,
                covariance: Matrix3::zeros(),
            },
            reports: ReportLog::default(),
            increment: None,
        })
    }

    /// Adds a reading of the gyro; any number of gyro readings may precede a reading of the wheels.
    pub fn step_gyro(&mut self, rate: &GyroRate) {
        if !self.integral.push(*rate, self.config.gyro_timeout) {
            self.reports.counts.gyro_refused += 1;
            return;
        }
        self.gyro_fault.add(rate);
        let dt = self.last.rate.map_or(0.0, |last| rate.stamp - last.stamp);
        self.gyro_calibration.predict(&self.config, dt);
        if self.is_at_rest(rate.stamp) && self.gyro_calibration.is_rest_rate(&self.config, rate.omega) {
            self.gyro_calibration.update_at_rest(&self.config, rate.omega);
        }
        self.last.rate = Some(*rate);
    }

    /// Sets the twist that the base is commanded to drive.
    pub fn set_command(&mut self, twist: Twist2) {
        self.wheel_fault.set_command(twist);
    }

    /// Whether the wheels are commanded to roll without counts: encoders are stuck, or wheels are blocked.
    pub fn wheels_are_unresponsive(&self) -> bool {
        self.wheel_fault.is_unresponsive()
    }

    /// Whether the wheels count nothing without a command to roll, and the gyro measures no turn, by the newest reading.
    pub fn is_still(&self) -> bool {
        self.is_still
    }

    /// Adds a reading of the wheels and returns the odometry after it; [`WheelOdometry::report`] gives the use of the reading. A rejected
    /// reading leaves the pose unchanged.
    pub fn step_wheels(&mut self, ticks: &WheelTicks) -> Odometry {
        self.increment = None;
        let report = match self.last.ticks {
            None => self.start(ticks),
            Some(last) if ticks.stamp <= last.stamp => {
                WheelReport::TimeWentBack { by: last.stamp - ticks.stamp }
            }
            Some(last) => self.advance(&last, ticks),
        };
        self.reports.add(report);
        self.odometry
    }

    /// The odometry after the newest reading.
    pub fn odometry(&self) -> &Odometry {
        &self.odometry
    }

    /// Motion between the last two readings of the wheels, without calibration; `None` if the newest reading was not used.
    pub fn increment(&self) -> Option<&MotionIncrement> {
        self.increment.as_ref()
    }

    /// Use of the newest reading of the wheels.
    pub fn report(&self) -> WheelReport {
        self.reports.newest
    }

    /// Number of readings of each kind.
    pub fn counts(&self) -> WheelCounts {
        self.reports.counts
    }

    /// The gyro's bias, rad/s; `None` without a measurement at rest or by the camera.
    pub fn gyro_bias(&self) -> Option<f64> {
        self.gyro_calibration.is_measured().then(|| self.gyro_calibration.bias())
    }

    /// True turn over the gyro's turn, estimated from the camera.
    pub fn gyro_scale(&self) -> f64 {
        self.gyro_calibration.scale()
    }

    /// Standard deviation of the scale of turns by the gyro, ratio.
    pub fn turn_scale_sigma(&self) -> f64 {
        self.gyro_calibration.scale_sigma()
    }

    /// Estimated radii of the left and the right wheel, m.
    pub fn wheel_radii(&self) -> [f64; 2] {
        let (left, right) = self.wheel_calibration.ratios();
        [left, right].map(|ratio| ratio * self.drive.wheel_radius)
    }

    /// Adds a visual pose: at `stamp` the base was at `visual_from_base` by the camera (fixed frame) and at `odom_from_base` by the
    /// odometry. Distances calibrate the wheels' radii, turns the gyro. Images may be late, but must come in order. A pose that is not
    /// finite breaks the visual track.
    pub fn add_visual_pose(&mut self, stamp: Stamp, odom_from_base: Pose2, visual_from_base: Pose3) {
        if !(visual_from_base.is_finite() && odom_from_base.is_finite()) {
            self.break_visual_track(stamp);
            return;
        }
        self.wheel_calibration.add_visual_position(odom_from_base, visual_from_base.translation);
        let heading = VisualHeading {
            stamp,
            by_odometry: odom_from_base.theta,
            by_camera: visual_from_base.rotation,
            path_length: self.path_length,
        };
        if let Some(turn) = self.yaw_segments.add(heading) {
            self.gyro_calibration.update_by_visual_turn(&turn);
        }
    }

    /// Ends the track of visual poses at `stamp`, before a pose in another visual frame.
    pub fn break_visual_track(&mut self, stamp: Stamp) {
        self.wheel_calibration.break_visual_track();
        self.yaw_segments.interrupt(stamp);
    }

    /// Covariance of `gap` s of motion without a reading, as a right perturbation (x m, y m, theta rad).
    pub fn unobserved_motion(&self, gap: f64) -> Matrix3<f64> {
        of_gap(&self.config, gap)
    }

    fn start(&mut self, ticks: &WheelTicks) -> WheelReport {
        self.last.ticks = Some(*ticks);
        self.odometry.stamp = ticks.stamp;
        self.resting_since = None;
        self.is_still = false;
        self.integral.turn_until(ticks.stamp, self.config.gyro_timeout);
        WheelReport::Started
    }

    fn advance(&mut self, last: &WheelTicks, ticks: &WheelTicks) -> WheelReport {
        let wheels = self.wheel_motion(last, ticks);
        if wheels.dt > self.config.max_gap {
            self.skip_to(ticks, wheels.dt);
            return WheelReport::Gap { length: wheels.dt };
        }
        let speed = wheels.left.abs().max(wheels.right.abs()) / wheels.dt;
        if speed > self.config.max_speed {
            return self.reject(ticks, wheels.dt, speed);
        }
        self.last.suspect_ticks = None;
        self.last.ticks = Some(*ticks);
        self.integrate(ticks.stamp, &wheels)
    }

    fn wheel_motion(&self, last: &WheelTicks, ticks: &WheelTicks) -> WheelMotion {
        let metres = |from: u16, to: u16, ratio: f64| {
            f64::from(to.wrapping_sub(from).cast_signed()) * self.drive.metres_per_tick() * ratio
        };
        let (left, right) = self.wheel_calibration.ratios();
        WheelMotion {
            left: metres(last.left, ticks.left, left),
            right: metres(last.right, ticks.right, right),
            dt: ticks.stamp - last.stamp,
        }
    }

    fn integrate(&mut self, stamp: Stamp, wheels: &WheelMotion) -> WheelReport {
        let half_base = self.drive.wheelbase / 2.0;
        let has_no_ticks = wheels.left == 0.0 && wheels.right == 0.0;
        let unobserved = self.wheel_fault.step(half_base, !has_no_ticks, wheels.dt);
        let rests = has_no_ticks && !self.wheel_fault.is_commanded_to_roll(half_base);
        self.resting_since = if rests { self.resting_since.or(Some(stamp)) } else { None };
        let turn_by_wheels = (wheels.right - wheels.left) / self.drive.wheelbase;
        let is_unresponsive = self.wheel_fault.is_unresponsive();
        // Wheels without counts and a gyro without changes may both be faulty and cannot verify each other.
        let is_frozen = self.gyro_fault.contradicts(turn_by_wheels / wheels.dt, self.gyro_calibration.bias())
            || is_unresponsive && self.gyro_fault.is_suspect();
        let measured_turn = self.measured_turn(stamp, wheels.dt).filter(|_| !is_frozen);
        let turn_by_gyro = measured_turn.map(|turn| self.gyro_calibration.corrected_turn(turn, wheels.dt));
        // The gyro's noise must not turn a robot at rest. A single reading without a tick is no proof of rest: slow wheels give such
        // readings.
        let may_rest = rests && (self.is_at_rest(stamp) || !self.gyro_calibration.is_measured());
        // A gyro without changes may be stuck and proves no rest.
        let is_measured = !is_unresponsive && !self.gyro_fault.is_suspect();
        let is_quiet = turn_by_gyro.is_some_and(|turn| self.is_noise(turn / wheels.dt));
        self.is_still = rests && is_measured && is_quiet;
        let is_noise = may_rest && turn_by_gyro.is_some_and(|turn| self.is_noise(turn / wheels.dt));
        let turn = if is_noise { 0.0 } else { turn_by_gyro.unwrap_or(turn_by_wheels) };
        let slip_rate = turn_by_gyro.map_or(0.0, |_| (turn_by_wheels - turn) / wheels.dt);
        let slips = slip_rate.abs() > self.config.slip_rate;
        let distance = (wheels.left + wheels.right) / 2.0;
        let slip = if slips { slip_rate.abs() * wheels.dt * self.drive.wheelbase / 2.0 } else { 0.0 };
        if slips || self.is_at_rest(stamp) || turn_by_gyro.is_none() || self.gyro_fault.is_suspect() {
            self.yaw_segments.interrupt(stamp);
        }
        let variance = |turn| self.gyro_calibration.turn_variance(&self.config, turn, wheels.dt);
        let by_gyro = turn_by_gyro.map(|turn| if is_noise { 0.0 } else { variance(turn) });
        if slips || is_unresponsive {
            self.wheel_calibration.interrupt();
        } else {
            let is_sure = !self.gyro_fault.is_suspect() && self.gyro_calibration.is_measured();
            let by_gyro = turn_by_gyro.zip(by_gyro).filter(|_| is_sure);
            let step = WheelStep { distance, by_wheels: turn_by_wheels, by_gyro };
            self.wheel_calibration.add_step(self.drive.wheelbase, step);
        }
        self.move_by(stamp, &Step { distance, turn, dt: wheels.dt, by_gyro, slip });
        let unobserved = unobserved.covariance(by_gyro.is_some());
        self.odometry.covariance += unobserved;
        let (left, right) = self.wheel_calibration.ratios();
        self.increment = Some(MotionIncrement {
            stamp,
            dt: wheels.dt,
            left: wheels.left / left,
            right: wheels.right / right,
            turn_by_gyro: measured_turn,
            slip,
            is_at_rest: is_noise,
            unobserved,
        });
        if slips { WheelReport::Slipping { rate: slip_rate } } else { WheelReport::Used }
    }

    fn move_by(&mut self, stamp: Stamp, step: &Step) {
        let motion = Pose2::exp(Vector3::new(step.distance, 0.0, step.turn));
        self.path_length += step.distance.abs();
        let odometry = &mut self.odometry;
        odometry.stamp = stamp;
        odometry.pose = odometry.pose * motion;
        odometry.twist = Twist2::new(step.distance / step.dt, step.turn / step.dt);
        odometry.covariance = transported(&odometry.covariance, &motion) + of_step(&self.config, step);
    }

    /// The gyro's turn over the last `dt` s, with bias and scale, rad; `None` if the gyro does not cover them.
    fn measured_turn(&mut self, stamp: Stamp, dt: f64) -> Option<f64> {
        let (turn, covered) = self.integral.turn_until(stamp, self.config.gyro_timeout)?;
        ((covered - dt).abs() < 1e-6).then_some(turn)
    }

    fn is_noise(&self, rate_without_bias: f64) -> bool {
        self.gyro_calibration.is_rest_rate(&self.config, rate_without_bias + self.gyro_calibration.bias())
    }

    fn is_at_rest(&self, now: Stamp) -> bool {
        self.resting_since.is_some_and(|since| now - since >= self.config.still_time)
    }

    /// Rejects a first reading at impossible counts as broken. A second one near it indicates a reset of the counters.
    fn reject(&mut self, ticks: &WheelTicks, dt: f64, speed: f64) -> WheelReport {
        self.is_still = false;
        let is_confirmed = self.last.suspect_ticks.is_some_and(|suspect| {
            let wheels = self.wheel_motion(&suspect, ticks);
            wheels.dt > 0.0 && wheels.left.abs().max(wheels.right.abs()) / wheels.dt <= self.config.max_speed
        });
        if is_confirmed {
            self.skip_to(ticks, dt);
            return WheelReport::Restarted;
        }
        self.last.suspect_ticks = Some(*ticks);
        WheelReport::TooFast { speed }
    }

    /// Continues from `ticks` after `dt` s of unknown motion.
    fn skip_to(&mut self, ticks: &WheelTicks, dt: f64) {
        self.last.ticks = Some(*ticks);
        self.last.suspect_ticks = None;
        self.resting_since = None;
        self.is_still = false;
        self.wheel_calibration.interrupt();
        self.yaw_segments.interrupt(ticks.stamp);
        self.integral.turn_until(ticks.stamp, self.config.gyro_timeout);
        self.odometry.stamp = ticks.stamp;
        self.odometry.twist = Twist2::ZERO;
        self.odometry.covariance += of_gap(&self.config, dt);
        self.increment = Some(MotionIncrement::unknown(ticks.stamp, dt, of_gap(&self.config, dt)));
    }
}
