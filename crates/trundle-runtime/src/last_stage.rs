//! The last stage of a mission: which way the robot settles on its goal.
//!
//! Where there is room, an arc is faster; where it is tight, turns on the spot and straight moves get there, footprint-exact.
//! The rule: an arc, when the law's own run from here is free and takes no longer than the manoeuvre that was found.

use crate::{navigator::Surroundings, schedule::Ticker};
use serde::{Deserialize, Serialize};
use trundle_control::SettlePreview;
use trundle_core::{Footprint, Invalid, Pose2, Twist2, require_in};
use trundle_docking::{
    Docker, DockingConfig, Plan, Positioner, PositionerConfig, PositionerInput, Reason, Scene,
};

/// How the robot settles on its goal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LastStageConfig {
    /// Whether turns and straight moves may take over near the goal. Default true.
    pub enabled: bool,
    /// Nearer to the goal than this they may take over where no path is found or the safety monitor holds the robot, m, 0.05
    /// to 5. Default 0.6 (ours).
    pub near: f64,
    /// What an arc must keep from obstacles of the map, m, 0 to 0.5. Default 0.02 (ours).
    pub arc_margin: f64,
    /// Planning of turns and straight moves. Default: as it comes, but a margin of 0.05, so that the safety monitor, which
    /// stops 0.04 m before an obstacle, does not hold what was planned.
    pub planner: DockingConfig,
    /// Carrying them out.
    pub positioner: PositionerConfig,
}

impl Default for LastStageConfig {
    fn default() -> Self {
        Self {
            enabled: true,
            near: 0.6,
            arc_margin: 0.02,
            planner: DockingConfig { margin: 0.05, ..DockingConfig::default() },
            positioner: PositionerConfig::default(),
        }
    }
}

/// The scene is drawn anew so often, 1/s.
const SCENE_HZ: f64 = 10.0;
/// It gives up after so many stops by the safety monitor, or waits for a way, in a row.
const MOST_STOPS: u32 = 20;

/// Chooses between an arc and a manoeuvre, and carries the manoeuvre out.
#[derive(Debug)]
pub(crate) struct LastStage {
    config: LastStageConfig,
    docker: Docker,
    footprint: Footprint,
    positioner: Option<Positioner>,
    scene: Option<Scene>,
    scene_due: Ticker,
    stops: u32,
}

/// What a step of the manoeuvre came to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Progress {
    Moving(Twist2),
    Settled,
    GivenUp(String),
}

impl LastStage {
    pub(crate) fn new(config: &LastStageConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        require_in("docking.near", config.near, "m", 0.05, 5.0)?;
        require_in("docking.arc_margin", config.arc_margin, "m", 0.0, 0.5)?;
        // Its settings are checked here, once; later positioners are of the same.
        Positioner::new(config.planner.clone(), config.positioner, footprint.clone(), Pose2::IDENTITY)?;
        let docker =
            Docker::new(DockingConfig { overlap: config.positioner.overlap, ..config.planner.clone() })?;
        Ok(Self {
            docker,
            config: config.clone(),
            footprint: footprint.clone(),
            positioner: None,
            scene: None,
            scene_due: Ticker::new(SCENE_HZ),
            stops: 0,
        })
    }

    /// Forgets the goal.
    pub(crate) fn reset(&mut self) {
        self.positioner = None;
        self.stops = 0;
    }

    /// Whether a goal is so near that turns and straight moves may replace a path.
    pub(crate) fn is_near(&self, pose: &Pose2, goal: &Pose2) -> bool {
        self.config.enabled && pose.distance(goal) <= self.config.near
    }

    /// At the end of the trajectory: whether turns and straight moves take over from the arc that `preview` shows.
    pub(crate) fn takes_over(&mut self, s: &Surroundings<'_>, goal: Pose2, preview: &SettlePreview) -> bool {
        if !self.config.enabled {
            return false;
        }
        let arc = preview.time.filter(|_| self.is_free(s, preview));
        let manoeuvre = self.manoeuvre_time(s, goal);
        !arc_wins(arc, manoeuvre) && self.begin(goal)
    }

    /// Turns and straight moves, if there are such.
    pub(crate) fn begin_if_possible(&mut self, s: &Surroundings<'_>, goal: Pose2) -> bool {
        self.is_near(&s.estimate.pose, &goal) && self.manoeuvre_time(s, goal).is_some() && self.begin(goal)
    }

    fn begin(&mut self, goal: Pose2) -> bool {
        let (planner, config) = (self.config.planner.clone(), self.config.positioner);
        self.positioner = Positioner::new(planner, config, self.footprint.clone(), goal).ok();
        self.stops = 0;
        self.positioner.is_some()
    }

    /// Whether the arc keeps clear of what the map holds.
    fn is_free(&self, s: &Surroundings<'_>, preview: &SettlePreview) -> bool {
        let reach = preview.poses.iter().map(|p| p.distance(&s.estimate.pose)).fold(0.0, f64::max);
        let half = reach + self.footprint.circumscribed_radius() + self.config.arc_margin + 0.1;
        let scene = Scene::from_grid(s.grid, s.estimate.pose.position(), half, false);
        let clear = |pose: &Pose2| scene.clearance(&self.footprint, pose, self.config.arc_margin).is_none();
        preview.poses.iter().all(clear)
    }

    fn manoeuvre_time(&self, s: &Surroundings<'_>, goal: Pose2) -> Option<f64> {
        let scene = self.drawn(s, &goal);
        match self.docker.plan(&self.footprint, &scene, s.estimate.pose, goal) {
            // The pose is measured before the first motion and after the last one too.
            Ok(Plan::Found(solution)) => {
                Some(solution.manoeuvre.duration() + 2.0 * self.config.positioner.measure_time)
            }
            Ok(Plan::Impossible(_)) | Err(_) => None,
        }
    }

    /// What stands around, and what is unknown: no camera looks where a manoeuvre backs up.
    fn drawn(&self, s: &Surroundings<'_>, goal: &Pose2) -> Scene {
        let (center, half) = self.config.planner.view(&self.footprint, &s.estimate.pose, goal);
        Scene::from_grid(s.grid, center, half, true)
    }

    /// One control step of the manoeuvre.
    pub(crate) fn step(&mut self, s: &Surroundings<'_>) -> Progress {
        let Some(goal) = self.positioner.as_ref().map(Positioner::goal) else {
            return Progress::GivenUp("no goal to settle on".to_owned());
        };
        if self.scene_due.due(s.now) || self.scene.is_none() {
            self.scene = Some(self.drawn(s, &goal));
        }
        let (Some(positioner), Some(scene)) = (&mut self.positioner, &self.scene) else {
            return Progress::Moving(Twist2::ZERO);
        };
        let was_waiting = positioner.is_waiting();
        let (pose, covariance) = (s.estimate.pose, s.estimate.covariance);
        let report = positioner.step(&PositionerInput { stamp: s.now, pose, covariance, scene });
        if positioner.is_settled() {
            return Progress::Settled;
        }
        self.stops += u32::from(positioner.is_waiting() && !was_waiting);
        match report.reason {
            reason if self.stops > MOST_STOPS => Progress::GivenUp(told(&reason)),
            _ => Progress::Moving(report.twist),
        }
    }

    /// The safety monitor stopped the robot.
    pub(crate) fn interrupted(&mut self, s: &Surroundings<'_>) {
        if let Some(positioner) = &mut self.positioner {
            positioner.interrupted(s.now);
            self.stops += 1;
        }
    }
}

/// The rule: an arc that is free (its time, s), when no manoeuvre was found or none that is faster.
fn arc_wins(arc: Option<f64>, manoeuvre: Option<f64>) -> bool {
    match (arc, manoeuvre) {
        (Some(arc), Some(manoeuvre)) => arc <= manoeuvre,
        // Without either the arc is tried: the safety monitor watches it.
        (_, None) => true,
        (None, Some(_)) => false,
    }
}

/// Why it stands, for a person.
fn told(reason: &Reason) -> String {
    let at = |by: &Option<trundle_docking::Blocker>| {
        by.map_or_else(String::new, |by| format!(" at ({:.2}, {:.2}) m", by.at.x, by.at.y))
    };
    match reason {
        Reason::Obstacle(by) => format!("something in the way{} while settling", at(by)),
        Reason::NoWay(by) => format!("no turns and straight moves lead to the goal, blocked{}", at(by)),
        Reason::Refused(refusal) => refusal.to_string(),
        Reason::BadPose => "the pose is not a number".to_owned(),
        Reason::Measuring | Reason::Moving(_) | Reason::Settled => "stopped again and again".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{OccupancyGrid, PoseEstimate, Stamp};

    /// A corridor of 0.6 m.
    fn corridor() -> OccupancyGrid {
        let (wall, free) = ("#".repeat(60) + "\n", ".".repeat(60) + "\n");
        OccupancyGrid::from_ascii(0.05, &(wall.clone() + &free.repeat(12) + &wall)).unwrap()
    }

    fn surroundings(grid: &OccupancyGrid, pose: Pose2, time: f64) -> Surroundings<'_> {
        let (now, twist) = (Stamp::default().after(time), Twist2::ZERO);
        let covariance = nalgebra::Matrix3::from_diagonal_element(1e-6);
        Surroundings {
            now,
            estimate: PoseEstimate { stamp: now, pose, twist, covariance },
            grid,
            scan: None,
            seen: None,
        }
    }

    fn stage() -> LastStage {
        LastStage::new(&LastStageConfig::default(), &Footprint::KOBUKI).unwrap()
    }

    #[test]
    fn a_free_arc_stays_and_one_through_a_wall_is_taken_over_and_settles() {
        let (grid, mut stage) = (corridor(), stage());
        let (start, goal) = (Pose2::new(1.2, 0.32, 0.0), Pose2::new(1.5, 0.38, 0.0));
        let free = SettlePreview { time: Some(2.0), poses: vec![start, goal] };
        assert!(!stage.takes_over(&surroundings(&grid, start, 0.0), goal, &free));
        let swinging = SettlePreview { time: Some(2.0), poses: vec![start, Pose2::new(1.3, 0.2, 0.0), goal] };
        assert!(stage.takes_over(&surroundings(&grid, start, 0.0), goal, &swinging));
        let (mut pose, mut settled) = (start, None);
        for i in 1..3000 {
            match stage.step(&surroundings(&grid, pose, 0.02 * f64::from(i))) {
                Progress::Moving(twist) => pose = pose.advance(twist, 0.02),
                other => {
                    settled = Some(other);
                    break;
                }
            }
        }
        assert_eq!(settled, Some(Progress::Settled));
        assert!(pose.distance(&goal) < 0.01 && (pose.theta - goal.theta).abs() < 0.0175, "{pose:?}");
    }

    #[test]
    fn switched_off_or_far_away_it_never_takes_over() {
        let (grid, mut far) = (corridor(), stage());
        let (start, goal) = (Pose2::new(0.5, 0.35, 0.0), Pose2::new(2.5, 0.35, 0.0));
        assert!(!far.begin_if_possible(&surroundings(&grid, start, 0.0), goal));
        let config = LastStageConfig { enabled: false, ..LastStageConfig::default() };
        let mut off = LastStage::new(&config, &Footprint::KOBUKI).unwrap();
        let near = Pose2::new(0.8, 0.35, 0.0);
        let touching = SettlePreview { time: None, poses: vec![start, near] };
        assert!(!off.takes_over(&surroundings(&grid, start, 0.0), near, &touching));
        assert!(!off.begin_if_possible(&surroundings(&grid, start, 0.0), near));
    }

    #[test]
    fn the_faster_of_two_free_ways_is_taken() {
        assert!(arc_wins(Some(3.0), Some(5.0)));
        assert!(!arc_wins(Some(6.0), Some(5.0)));
        assert!(!arc_wins(None, Some(5.0)), "an arc that touches something");
        assert!(arc_wins(None, None) && arc_wins(Some(1.0), None));
    }
}
