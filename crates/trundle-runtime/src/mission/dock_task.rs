//! The task of driving onto the charging station: search its light, survey its axis, drive onto the contacts.

use crate::behaviour::drive_state::DriveState;
use crate::behaviour::goal::Goal;
use crate::behaviour::station_drive::StationGoal;
use crate::mission::dock_failure::DockFailure;
use crate::mission::light_search::LightSearch;
use crate::reason::{Reason, ReasonKind};
use crate::schedule::Ticker;
use crate::world_state::WorldState;
use std::f64::consts::PI;
use trundle_core::Pose2;
use trundle_estimation::StationEstimate;
use trundle_planning::{Exploration, Explorer, Frontier};

/// Poses from which the axis is surveyed, station frame \[m, m, rad\]: paths between them cross the edges of the light. Source: ours.
const SURVEY_POSES: [[f64; 3]; 3] = [[1.2, 0.3, PI], [1.0, -0.3, PI], [0.9, 0.2, PI]];
/// Distance of the base from the station before the last straight move \[m\]: within the range of the camera's measurement. Source: ours.
const STAGING_DISTANCE_M: f64 = 0.7;
/// Distance of the base from the station at the second sweep \[m\]: one degree of the light is 5 mm at this distance. Source: ours.
const NEAR_DISTANCE_M: f64 = 0.45;
/// Distance from the staging pose within which turns and straight moves are used \[m\]. Source: ours.
const ALIGN_DISTANCE_M: f64 = 0.5;
/// Largest standard deviation of the axis at the contacts, across \[m\] and heading \[rad\]. Source: ours, the plates' tolerances.
const MAX_LATERAL_SIGMA_M: f64 = 0.012;
const MAX_HEADING_SIGMA_RAD: f64 = 0.03;
/// Distance of a docked base from the station \[m\]. Source: the Kobuki's radius.
const DOCKED_DISTANCE_M: f64 = 0.18;
/// Rounds of the survey after which the axis is too uncertain. Source: ours.
const MAX_SURVEYS: u32 = 3;
/// Number of straight moves onto the contacts without charging after which the task fails. Source: ours.
const MAX_ATTEMPTS: u32 = 3;
/// Number of losses of the light after which the task fails. Source: ours.
const MAX_LOSSES: u32 = 3;
/// Distance of backing off after an attempt \[m\]. Source: ours.
const BACK_OFF_M: f64 = 0.5;
/// Change of the estimate after which the present goal is sent again \[m\]. Source: ours.
const MOVED_GOAL_M: f64 = 0.25;
/// Rate at which the change of the estimate is checked \[1/s\]. Source: ours.
const CHECK_RATE_HZ: f64 = 1.0;

/// Result of a step of the task.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum DockStep {
    Keep,
    Goal(Goal),
    Done,
    GivenUp(Reason),
}

/// Progress of the task.
#[derive(Debug)]
enum Phase {
    /// Start of the task.
    Begin,
    /// Turns on the spot.
    Spinning,
    /// Drive to a place at which light may be detected; the frontier, if the target is unknown floor.
    Searching(Option<Frontier>),
    /// Drive to a pose of the survey.
    Surveying {
        next: usize,
        at: Pose2,
    },
    /// Drive to the staging pose.
    Staging {
        at: Pose2,
    },
    Sweeping,
    Aligning,
    /// The robot drives on the axis, nearer to the station.
    Advancing,
    /// The second sweep, near the station.
    NearSweeping,
    Closing,
    BackingOff,
}

/// The task of driving onto the charging station.
#[derive(Debug)]
pub(crate) struct DockTask {
    explorer: Box<Explorer>,
    search: LightSearch,
    phase: Phase,
    surveys: u32,
    attempts: u32,
    losses: u32,
    check_due: Ticker,
}

impl DockTask {
    /// A task that searches by `explorer`.
    pub(crate) fn new(explorer: Box<Explorer>) -> Self {
        let check_due = Ticker::new(CHECK_RATE_HZ);
        let search = LightSearch::default();
        Self { explorer, search, phase: Phase::Begin, surveys: 0, attempts: 0, losses: 0, check_due }
    }

    /// The next step; the navigator is in `state`.
    pub(crate) fn step(&mut self, s: &WorldState<'_>, state: &DriveState) -> DockStep {
        if s.station.is_docked && (state.is_over() || matches!(self.phase, Phase::Begin)) {
            return DockStep::Done;
        }
        match self.phase {
            Phase::Begin => self.begin(s),
            _ if state.is_over() => self.on_over(s, state),
            _ => self.on_way(s, state),
        }
    }

    fn begin(&mut self, s: &WorldState<'_>) -> DockStep {
        match s.station.estimate {
            Some(station) => self.go_on(station),
            None => self.spin(),
        }
    }

    fn spin(&mut self) -> DockStep {
        self.phase = Phase::Spinning;
        DockStep::Goal(Goal::Spin)
    }

    /// During the drive: checks whether the light was detected, or the estimate of the station moved.
    fn on_way(&mut self, s: &WorldState<'_>, state: &DriveState) -> DockStep {
        let drives = matches!(state, DriveState::Driving | DriveState::Waiting { .. });
        if !drives || !self.check_due.due(s.now) {
            return DockStep::Keep;
        }
        match (&self.phase, s.station.estimate) {
            (Phase::Searching(_), Some(station)) => self.go_on(station),
            (Phase::Surveying { next, at }, Some(station)) => {
                let (next, moved) = (*next, survey_pose(&station, *next));
                if moved.distance(at) > MOVED_GOAL_M { self.survey(station, next) } else { DockStep::Keep }
            }
            (Phase::Staging { at }, Some(station)) if staging_pose(&station).distance(at) > MOVED_GOAL_M => {
                self.go_on(station)
            }
            _ => DockStep::Keep,
        }
    }

    /// Reaction to the end of the navigator's goal.
    fn on_over(&mut self, s: &WorldState<'_>, state: &DriveState) -> DockStep {
        let failure = match state {
            DriveState::Stopped { reason } => Some(reason),
            _ => None,
        };
        let Some(station) = s.station.estimate else { return self.without_light(s, failure.is_some()) };
        match (&self.phase, failure) {
            (Phase::Surveying { next, .. }, _) => self.after_survey_pose(station, *next),
            // The motions that follow are relative to the station's light: the staging pose needs no certain pose in the map.
            (Phase::Staging { .. }, Some(reason)) if reason.kind() == ReasonKind::ArrivalUncertain => {
                self.sweep(station)
            }
            (Phase::Staging { .. } | Phase::Aligning | Phase::Advancing, Some(reason)) => {
                DockStep::GivenUp(reason.clone())
            }
            (Phase::Staging { .. }, None) => self.sweep(station),
            (Phase::Sweeping, _) => self.after_sweep(station, s),
            (Phase::Aligning, None) => {
                self.to(Phase::Advancing, StationGoal::Advance(station, NEAR_DISTANCE_M))
            }
            (Phase::Advancing, None) => self.to(Phase::NearSweeping, StationGoal::Sweep(station.pose)),
            (Phase::NearSweeping, _) => self.to(Phase::Closing, StationGoal::Approach(station)),
            (Phase::Closing, _) => self.after_attempt(),
            (Phase::BackingOff, _) => self.go_on(station),
            _ => self.go_on(station),
        }
    }

    /// The next part for a known station: the survey of its axis, or the staging pose.
    fn go_on(&mut self, station: StationEstimate) -> DockStep {
        if is_precise(&station) { self.stage(station) } else { self.survey(station, 0) }
    }

    fn survey(&mut self, station: StationEstimate, next: usize) -> DockStep {
        let at = survey_pose(&station, next);
        self.phase = Phase::Surveying { next, at };
        DockStep::Goal(Goal::Viewpoint(at))
    }

    fn after_survey_pose(&mut self, station: StationEstimate, done: usize) -> DockStep {
        if is_precise(&station) || done + 1 >= SURVEY_POSES.len() {
            return self.stage(station);
        }
        self.survey(station, done + 1)
    }

    fn stage(&mut self, station: StationEstimate) -> DockStep {
        let at = staging_pose(&station);
        self.phase = Phase::Staging { at };
        DockStep::Goal(Goal::Exact(at))
    }

    fn sweep(&mut self, station: StationEstimate) -> DockStep {
        self.to(Phase::Sweeping, StationGoal::Sweep(station.pose))
    }

    fn after_sweep(&mut self, station: StationEstimate, s: &WorldState<'_>) -> DockStep {
        if is_precise(&station) {
            let at = staging_pose(&station);
            if at.distance(&s.estimate.pose) > ALIGN_DISTANCE_M {
                return self.stage(station);
            }
            self.phase = Phase::Aligning;
            return DockStep::Goal(Goal::Align(at));
        }
        self.surveys += 1;
        if self.surveys >= MAX_SURVEYS {
            let sigma = station.lateral_sigma(DOCKED_DISTANCE_M);
            return DockStep::GivenUp(Reason::Docking(DockFailure::AxisUncertain { sigma }));
        }
        self.survey(station, 0)
    }

    fn after_attempt(&mut self) -> DockStep {
        self.attempts += 1;
        if self.attempts >= MAX_ATTEMPTS {
            let attempts = self.attempts;
            return DockStep::GivenUp(Reason::Docking(DockFailure::NoCharging { attempts }));
        }
        self.to(Phase::BackingOff, StationGoal::BackOff(BACK_OFF_M))
    }

    fn to(&mut self, phase: Phase, goal: StationGoal) -> DockStep {
        self.phase = phase;
        DockStep::Goal(Goal::Station(goal))
    }

    /// A goal of the search is over, or the light is lost.
    fn without_light(&mut self, s: &WorldState<'_>, has_failed: bool) -> DockStep {
        match &self.phase {
            Phase::Spinning => {
                self.search.mark_searched(s.estimate.pose.position());
                self.search_on(s)
            }
            Phase::Searching(frontier) => {
                frontier.iter().for_each(|frontier| self.explorer.mark_viewed(frontier));
                self.search.end_place(has_failed);
                // No receiver covers the area behind the robot.
                if has_failed { self.search_on(s) } else { self.spin() }
            }
            _ => self.lost(),
        }
    }

    /// The next unsearched place of known floor; else the next viewpoint of unknown floor.
    fn search_on(&mut self, s: &WorldState<'_>) -> DockStep {
        if let Some(place) = self.search.next_place(s.permitted_grid(), s.estimate.pose) {
            self.phase = Phase::Searching(None);
            return DockStep::Goal(Goal::Viewpoint(place));
        }
        match self.explorer.next(s.permitted_grid(), s.estimate.pose) {
            Exploration::Next(view) => {
                self.phase = Phase::Searching(Some(view.frontier));
                DockStep::Goal(Goal::Viewpoint(view.pose))
            }
            Exploration::Complete { .. } => DockStep::GivenUp(Reason::Docking(DockFailure::NoLight)),
        }
    }

    /// Restarts the search, after readings that contradict the estimate of the station.
    fn lost(&mut self) -> DockStep {
        self.losses += 1;
        if self.losses > MAX_LOSSES {
            return DockStep::GivenUp(Reason::Docking(DockFailure::LightLost));
        }
        self.spin()
    }
}

fn is_precise(station: &StationEstimate) -> bool {
    station.lateral_sigma(DOCKED_DISTANCE_M) <= MAX_LATERAL_SIGMA_M
        && station.heading_sigma() <= MAX_HEADING_SIGMA_RAD
}

fn survey_pose(station: &StationEstimate, index: usize) -> Pose2 {
    let [x, y, heading] = SURVEY_POSES[index.min(SURVEY_POSES.len() - 1)];
    station.pose * Pose2::new(x, y, heading)
}

fn staging_pose(station: &StationEstimate) -> Pose2 {
    station.pose * Pose2::new(STAGING_DISTANCE_M, 0.0, PI)
}

#[cfg(test)]
mod tests;
