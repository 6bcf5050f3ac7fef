//! The smoother in parallel with the filter, on drives of the whole robot in the simulator: error against the truth and its normalised
//! square.
//!
//! `cargo run --release -p trundle-experiments --example smoother_beside_filter`
//!
//! The robot drives by the filter. The smoother receives the same measurements; its estimate is not used.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use trundle_core::{Pose2, PoseEstimate, RobotBody, SensorEvent, Stamp};
use trundle_estimation::{Smoother, SmootherConfig};
use trundle_runtime::{Mission, PoseMeasurements, Robot, RobotConfig, Task};
use trundle_sim::{Scene, SimConfig, Simulator};

/// Scenes of the drives.
const SCENES: [&str; 2] = ["demo", "house"];
/// Seeds of the drives. Source: ours.
const SEEDS: [u64; 3] = [1, 2, 3];
/// Robot's time after which a drive ends \[s\]. Source: ours.
const TIME_LIMIT_S: f64 = 120.0;
/// Time between two comparisons \[s\]. Source: ours.
const SAMPLE_S: f64 = 0.1;

/// Errors of one estimator.
#[derive(Debug, Default)]
struct Errors {
    count: f64,
    position: f64,
    heading: f64,
    worst: f64,
    nees: Vec<f64>,
}

impl Errors {
    fn add(&mut self, estimate: &PoseEstimate, truth: &Pose2) {
        let off = (estimate.pose.inverse() * *truth).log();
        self.count += 1.0;
        self.position += off.xy().norm_squared();
        self.heading += off.z * off.z;
        self.worst = self.worst.max(off.xy().norm());
        let squared = estimate.covariance.cholesky().map_or(0.0, |lower| off.dot(&lower.solve(&off)));
        self.nees.push(squared);
    }

    fn row(&mut self) -> String {
        self.nees.sort_by(f64::total_cmp);
        let at = |part: f64| {
            let place = (part * self.nees.len() as f64) as usize;
            self.nees.get(place).copied().unwrap_or(f64::NAN)
        };
        format!(
            "{:6.1} mm {:6.2} deg  worst {:6.1} mm  NEES mean {:6.2} median {:6.2} 95 % {:6.2}",
            (self.position / self.count).sqrt() * 1e3,
            (self.heading / self.count).sqrt().to_degrees(),
            self.worst * 1e3,
            self.nees.iter().sum::<f64>() / self.count,
            at(0.5),
            at(0.95),
        )
    }
}

/// The smoother in parallel with a robot.
struct Shadow {
    smoother: Smoother,
    used: usize,
    gated: usize,
    places: usize,
}

impl Shadow {
    fn add(&mut self, measurements: &PoseMeasurements) {
        measurements.motion.iter().for_each(|motion| {
            self.smoother.add_motion(motion);
        });
        let uses = [
            measurements.visual.as_ref().map(|visual| self.smoother.add_visual(visual)),
            measurements.scan.as_ref().map(|scan| self.smoother.add_scan(scan)),
        ];
        for used in uses.into_iter().flatten() {
            use trundle_estimation::MeasurementUse::{Applied, Gated, Switched};
            self.used += usize::from(matches!(used, Applied(_)));
            self.gated += usize::from(matches!(used, Gated(_)));
            self.places += usize::from(matches!(used, Switched { .. }));
        }
    }
}

fn drive(name: &str, seed: u64) -> Result<(), Box<dyn Error>> {
    let scene = Scene::by_name(name, seed)?;
    let (map_from_world, goal) = (scene.start.inverse(), scene.start_from_goal());
    let config = RobotConfig::default().with_seed(seed);
    let mount = config.mount.validated()?.base_from_camera();
    let smoother = Smoother::new(SmootherConfig::default(), config.odometry.clone(), config.drive, mount)?;
    let mut shadow = Shadow { smoother, used: 0, gated: 0, places: 0 };
    let mut body = Simulator::new(scene, SimConfig::default(), seed)?;
    let mut robot = Robot::new(config)?;
    robot.begin(&Mission::new(vec![Task::go(goal), Task::go(Pose2::IDENTITY)])?);
    let (mut filter, mut smoothed) = (Errors::default(), Errors::default());
    let (mut truth, mut sampled) = (None, Stamp::default());
    while let Some(event) = body.next_event()? {
        if let SensorEvent::Truth { stamp, pose } = event {
            truth = Some((stamp, map_from_world * pose));
        }
        let report = robot.step(&event);
        shadow.add(&report.measurements);
        let estimate = shadow.smoother.estimate();
        if let (Some((stamp, pose)), Some(by_filter)) = (truth, report.estimate)
            && (stamp, stamp) == (by_filter.stamp, estimate.stamp)
            && stamp - sampled >= SAMPLE_S
        {
            sampled = stamp;
            filter.add(&by_filter, &pose);
            smoothed.add(&estimate, &pose);
        }
        if let Some(twist) = report.twist {
            body.command(twist)?;
        }
        if report.finished || event.stamp().as_secs() > TIME_LIMIT_S {
            break;
        }
    }
    println!(
        "{name} {seed}: {} s, {} measurements, {} gated, {} places, {} failures",
        sampled,
        shadow.used,
        shadow.gated,
        shadow.places,
        shadow.smoother.failures()
    );
    println!("  filter    {}", filter.row());
    println!("  smoother  {}", smoothed.row());
    if let Some(found) = shadow.smoother.calibration() {
        println!(
            "  bias {:.5} +- {:.5} rad/s, scale {:.4} +- {:.4}, radii {:.4} {:.4} +- {:.4}, delay {:.4} s",
            found.gyro_bias.value,
            found.gyro_bias.sigma,
            found.gyro_scale.value,
            found.gyro_scale.sigma,
            found.left_radius.value,
            found.right_radius.value,
            found.left_radius.sigma,
            found.camera_delay.value
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    for name in SCENES {
        for seed in SEEDS {
            drive(name, seed)?;
        }
    }
    Ok(())
}
