//! Drives of a simulated robot with a 2-D laser through a map, with odometry and truth at each scan.

use crate::pose_history::pose_at;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use trundle_app::AppError;
use trundle_core::{
    Beam, Cell, Footprint, OccupancyGrid, Pose2, RobotBody, Scan, SensorEvent, Stamp, Twist2, deskewed,
};
use trundle_estimation::{OdometryConfig, WheelOdometry};
use trundle_sim::import::{RaisedMap, raise_map};
use trundle_sim::{HeightBand, LaserConfig, Lights, Scene, SimConfig, Simulator, World};

/// Clearance of a start \[m\]. Source: ours.
const START_CLEARANCE_M: f64 = 0.1;
/// Number of random cells in the search for a start. Source: ours.
const MAX_START_TRIALS: u64 = 100_000;
/// Speed of the drive \[m/s\]. Source: the usual speed of small indoor robots.
const DRIVE_SPEED_M_S: f64 = 0.3;
/// Turn rate away from an obstacle \[rad/s\]. Source: as the speed.
const TURN_RATE_RAD_S: f64 = 0.8;
/// Distance ahead below which the robot turns away \[m\]. Source: ours.
const MIN_DISTANCE_AHEAD_M: f64 = 0.7;
/// Half of the sector ahead that must be free \[rad\]. Source: ours.
const SECTOR_AHEAD_RAD: f64 = 0.7;
/// Time after which the robot chooses another curvature \[s\]. Source: ours.
const CURVE_PERIOD_S: f64 = 4.0;

/// A scan with the poses of its stamp.
#[derive(Debug, Clone)]
pub struct DriveScan {
    /// The scan; beams without a return are unseen, as in a log.
    pub scan: Scan,
    /// Pose by wheels and gyro.
    pub odom_from_base: Pose2,
    /// True pose.
    pub world_from_base: Pose2,
}

/// A drive's data.
#[derive(Debug, Clone, Default)]
pub struct LaserDrive {
    /// The scans, by rising stamps.
    pub scans: Vec<DriveScan>,
    /// odom_from_base at each wheel reading.
    pub odometry: Vec<(Stamp, Pose2)>,
}

impl LaserDrive {
    /// The scans with their beams corrected by the odometry for the motion during the sweep.
    #[must_use]
    pub fn deskewed(mut self) -> Self {
        for entry in &mut self.scans {
            entry.scan = deskewed(entry.scan.clone(), |stamp| pose_at(&self.odometry, stamp));
        }
        self
    }
}

/// The walls of a map as a world.
///
/// # Errors
/// When the map has no known cell.
pub fn world_of(name: &str, map: &OccupancyGrid) -> Result<World, AppError> {
    let solids = raise_map(name, map, &RaisedMap::default());
    Ok(World::new(solids.map_err(|error| AppError::Input(error.to_string()))?, 1)?)
}

/// A random pose in free space.
///
/// # Errors
/// When none is found.
pub fn random_start(map: &OccupancyGrid, world: &World, seed: u64) -> Result<Pose2, AppError> {
    let body = SimConfig::default().kobuki;
    let footprint = Footprint::disc(body.footprint_radius)?;
    let band = HeightBand::new(body.step_over, body.height)?;
    let geometry = map.geometry();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    for _ in 0..MAX_START_TRIALS {
        let (at, turn) = (rng.random_range(0..geometry.len()), rng.random_range(-PI..PI));
        let place = geometry.center(geometry.cell(at));
        let pose = Pose2::new(place.x, place.y, turn);
        if map.cells()[at] == Cell::Free && world.clearance(&footprint, pose, band)? > START_CLEARANCE_M {
            return Ok(pose);
        }
    }
    Err(AppError::Input(format!("no free start in {MAX_START_TRIALS} random cells of the map, expected one")))
}

/// Drives for `seconds` of the robot's time from `start`: ahead in curves, and away from near obstacles.
///
/// # Errors
/// When the simulator refuses the start or a number.
pub fn drive(
    world: World,
    (laser, start): (LaserConfig, Pose2),
    seconds: f64,
    seed: u64,
) -> Result<LaserDrive, AppError> {
    let mut config = SimConfig::default();
    config.has_camera = false;
    config.laser = Some(laser);
    let scene = Scene {
        name: "laser drive".to_owned(),
        world,
        lights: Lights::default(),
        people: Vec::new(),
        start,
        goal: start,
        station: None,
    };
    let mut wheels = WheelOdometry::new(config.kobuki.drive, OdometryConfig::default())?;
    let mut robot = Simulator::new(scene, config, seed).map_err(AppError::input)?;
    let (mut scans, mut odometry, mut truth) = (Vec::new(), Vec::new(), start);
    let mut wander = RandomDriver::new(seed);
    while let Some(event) = robot.next_event().map_err(AppError::input)? {
        if event.stamp().as_secs() > seconds {
            break;
        }
        match event {
            SensorEvent::Wheels(ticks) => {
                odometry.push((ticks.stamp, wheels.step_wheels(&ticks).pose));
                let last = scans.last().map(|(scan, _)| scan);
                robot.command(wander.twist(last, ticks.stamp)).map_err(AppError::input)?;
            }
            SensorEvent::Gyro(rate) => wheels.step_gyro(&rate),
            SensorEvent::Truth { pose, .. } => truth = pose,
            SensorEvent::Scan(scan) => scans.push((as_in_a_log(scan), truth)),
            _ => {}
        }
    }
    let placed = scans.into_iter().filter_map(|(scan, world_from_base)| {
        let odom_from_base = pose_at(&odometry, scan.stamp())?;
        Some(DriveScan { scan, odom_from_base, world_from_base })
    });
    Ok(LaserDrive { scans: placed.collect(), odometry: odometry.clone() })
}

/// The scan with beams without a return as unseen.
fn as_in_a_log(scan: Scan) -> Scan {
    let (stamp, origin, angles) = (scan.stamp(), scan.origin(), (scan.angle_min(), scan.angle_increment()));
    let times = scan.beam_times();
    let mut parts = scan.into_parts();
    parts
        .beams
        .iter_mut()
        .filter(|beam| matches!(beam, Beam::Free { .. }))
        .for_each(|beam| *beam = Beam::Unseen);
    let scan = Scan::from_parts(stamp, origin, angles, parts).expect("invariant: an unseen beam is valid");
    match times {
        Some(times) => scan.with_beam_times(times).expect("invariant: the times were accepted before"),
        None => scan,
    }
}

/// A driver without a goal.
struct RandomDriver {
    rng: ChaCha8Rng,
    /// Turn rate in free space, rad/s, and the time of its next change, s.
    curve: (f64, f64),
    /// Side of the turn: 1 for left, -1 for right.
    side: f64,
    is_turning: bool,
}

impl RandomDriver {
    fn new(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        Self { rng, curve: (0.0, 0.0), side, is_turning: false }
    }

    /// The command at a time, by the last scan.
    fn twist(&mut self, scan: Option<&Scan>, stamp: Stamp) -> Twist2 {
        if stamp.as_secs() >= self.curve.1 {
            let rate = self.rng.random_range(-0.5..0.5) * TURN_RATE_RAD_S;
            self.curve = (rate, stamp.as_secs() + CURVE_PERIOD_S);
        }
        let nearest = scan.map_or(f64::INFINITY, nearest_ahead);
        // A turn continues until the space ahead exceeds the threshold by a half.
        self.is_turning = nearest < MIN_DISTANCE_AHEAD_M * if self.is_turning { 1.5 } else { 1.0 };
        if self.is_turning {
            return Twist2::new(0.0, self.side * TURN_RATE_RAD_S);
        }
        Twist2::new(DRIVE_SPEED_M_S, self.curve.0)
    }
}

fn nearest_ahead(scan: &Scan) -> f64 {
    let hits = scan.hits().filter(|hit| hit.y.atan2(hit.x).abs() < SECTOR_AHEAD_RAD);
    hits.map(|hit| hit.norm()).fold(f64::INFINITY, f64::min)
}
