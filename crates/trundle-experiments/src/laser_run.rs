//! A run of a robot with a laser and without a camera.

use crate::cpu_clock;
use trundle_app::operator::OperatorLink;
use trundle_app::{AppError, stop};
use trundle_core::{OccupancyGrid, Pose2, RobotBody, SensorEvent, Twist2};
use trundle_runtime::{DriveState, Mission, Robot, RobotConfig};
use trundle_sim::{LaserConfig, Scene, SimConfig, Simulator};

/// A robot with a laser and without a camera, in a scene, with its own estimate.
pub struct LaserPlan {
    /// The robot.
    pub robot: RobotConfig,
    /// Simulated body of the robot.
    pub body: SimConfig,
    /// The place, with the robot's start.
    pub scene: Scene,
    /// The mission, map frame.
    pub mission: Mission,
    /// The initial map; `None` begins with an empty map.
    pub known: Option<OccupancyGrid>,
    /// Seed of all noise.
    pub seed: u64,
    /// Time limit of the run, simulated time \[s\].
    pub time_limit: f64,
}

/// State for a checker, 50 times per second.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Time since the start, s.
    pub time: f64,
    /// True pose, world frame.
    pub pose: Pose2,
    /// Distance of the estimate from the true position, m.
    pub estimate_error: f64,
    /// Standard deviation of the estimated position along its most uncertain direction, m.
    pub estimate_sigma: f64,
    /// The command.
    pub twist: Twist2,
    /// True clearance of the outline, m.
    pub clearance: f64,
    /// Number of separate contacts so far.
    pub contacts: u32,
}

/// Result of a run.
pub struct LaserRun {
    /// The moments from start to end.
    pub moments: Vec<Moment>,
    /// The robot, with its map.
    pub robot: Robot,
    /// State at the end.
    pub state: DriveState,
    /// Number of plans.
    pub plans: usize,
    /// Processor time of each control cycle (odometry, supervision, planning, control and safety), ms.
    pub cycles_ms: Vec<f64>,
}

/// A Hokuyo-like laser, as in the BARN challenge: 270 deg, 720 beams, 30 m; all beams simultaneous, as in Gazebo.
pub fn hokuyo(forward: f64) -> LaserConfig {
    let mut config = LaserConfig::default();
    config.x = forward;
    config.z = 0.25;
    config.field_of_view = 270_f64.to_radians();
    config.beams = 720;
    config.rate_hz = 40.0;
    config.range_min = 0.06;
    config.range_max = 30.0;
    config.noise = 0.01;
    config
}

/// Runs the robot until `is_over` is true, or its mission or its time ends; shows it to viewers (`watch`).
///
/// # Errors
/// When a number of the plan is outside its range, or the start is not free.
pub fn drive(
    plan: LaserPlan,
    mut watch: Option<OperatorLink>,
    is_over: impl Fn(&Moment) -> bool,
) -> Result<LaserRun, AppError> {
    let config = plan.robot.with_seed(plan.seed);
    let mut robot = match &plan.known {
        Some(known) => Robot::on_map(config, known)?,
        None => Robot::new(config)?,
    };
    robot.begin(&plan.mission);
    let map_from_world = plan.scene.start.inverse();
    let mut body = Simulator::new(plan.scene, plan.body, plan.seed).map_err(AppError::input)?;
    let (mut moments, mut cycles_ms, mut plans) = (Vec::new(), Vec::new(), 0);
    let mut state = DriveState::Idle;
    while let Some(event) = RobotBody::next_event(&mut body).map_err(AppError::input)? {
        let before = cpu_clock::now();
        let report = robot.step(&event);
        let elapsed = (cpu_clock::now() - before).as_secs_f64() * 1e3;
        if let Some(link) = &mut watch {
            link.note_event(&event);
            link.publish(event.stamp(), &robot, &report);
        }
        plans += usize::from(report.replanned);
        state = report.state;
        let (SensorEvent::Wheels(_), Some(twist)) = (&event, report.twist) else { continue };
        cycles_ms.push(elapsed);
        RobotBody::command(&mut body, twist).map_err(AppError::input)?;
        let (time, pose) = (body.stamp().as_secs(), body.true_pose());
        let (clearance, contacts) = (body.clearance(), body.contacts());
        let estimate = robot.estimate();
        let estimate_error = estimate.pose.distance(&(map_from_world * pose));
        let estimate_sigma = estimate.position_sigma();
        let moment = Moment { time, pose, estimate_error, estimate_sigma, twist, clearance, contacts };
        moments.push(moment);
        let is_stopped = || stop::is_requested(|| format!("{time:.1} s of a run"));
        if report.finished || is_over(&moment) || time > plan.time_limit || is_stopped() {
            break;
        }
    }
    Ok(LaserRun { moments, state, robot, plans, cycles_ms })
}

impl LaserRun {
    /// The last moment.
    pub fn end(&self) -> &Moment {
        self.moments.last().expect("invariant: a run begins with a reading of the wheels")
    }

    /// Largest distance of the estimate from truth, m.
    pub fn worst_estimate(&self) -> f64 {
        self.moments.iter().map(|moment| moment.estimate_error).fold(0.0, f64::max)
    }

    /// Largest distance of the estimate from truth among the moments in which it exceeds three of its standard deviations, m.
    pub fn worst_unnoticed_estimate(&self) -> f64 {
        let is_unnoticed = |m: &&Moment| m.estimate_error > 3.0 * m.estimate_sigma;
        self.moments.iter().filter(is_unnoticed).map(|m| m.estimate_error).fold(0.0, f64::max)
    }

    /// True distance driven, m.
    pub fn path_length(&self) -> f64 {
        self.moments.windows(2).map(|pair| pair[1].pose.distance(&pair[0].pose)).sum()
    }
}
