//! From a request of a page to commands of the robot.

mod goal_check;
mod refusal;

pub use refusal::CommandRefusal;

use crate::run_facts::{RunFacts, RunKind};
use crate::wire::{Goal, Request, SettingText};
use goal_check::require_free;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use trundle_app::operator::{AnnotationEdit, FolderMap, HandId, MapFolder, Operator};
use trundle_core::{DriveLimits, Pose2, Twist2, Zone, require_in};
use trundle_planning::{FootprintCheck, require_on_map};
use trundle_runtime::{Mission, OperatorCommand, PoseGuess, RunSetting, Task};

/// Maximum number of goals of one request. Source: ours.
const MAX_GOALS: usize = 50;
/// Standard deviation of a position that a person points at \[m\]. Source: ours; a finger on a map of 10 m.
const POINTED_POSITION_SIGMA_M: f64 = 0.3;
/// Standard deviation of a heading that a person points at \[rad\]: 15 deg. Source: ours.
const POINTED_HEADING_SIGMA_RAD: f64 = 0.26;
/// Part of the highest speeds at which a person drives by hand. Source: ours.
const HAND_SPEED: f64 = 0.6;

/// Sends commands to the robot.
#[derive(Debug)]
pub struct RunSteering {
    operator: Operator,
    kind: RunKind,
    check: FootprintCheck,
    limits: DriveLimits,
    maps: Option<MapFolder>,
    /// Claimed while a map is read.
    reading: Arc<Semaphore>,
    /// Number of the page's last stop or twist by hand; 0 before. The next task of the page ends that pause, unless another request for a
    /// pause came after it.
    own_pause: AtomicU64,
}

impl RunSteering {
    /// The steering of a run.
    pub fn new(operator: Operator, facts: &RunFacts, maps: Option<MapFolder>) -> Self {
        let check = FootprintCheck::new(&facts.footprint);
        let (kind, limits) = (facts.kind, facts.limits);
        let reading = Arc::new(Semaphore::new(1));
        Self { operator, kind, check, limits, maps, reading, own_pause: AtomicU64::new(0) }
    }

    /// Carries out a request of a viewer for the robot; ignores others, and requests for a map, which is read first.
    ///
    /// # Errors
    /// When the robot cannot carry the request out: a goal in a wall, a number out of range, a run that is over.
    pub fn execute(&self, request: &Request, hand: HandId) -> Result<(), CommandRefusal> {
        let is_for_hand = matches!(request, Request::Drive { .. } | Request::Stop { .. });
        if !is_for_hand {
            self.require_robot()?;
        }
        match request {
            Request::Go { goals, append, .. } => self.go(goals, *append),
            Request::Explore { .. } => self.begin(vec![Task::Explore]),
            Request::Return { .. } => self.begin(vec![Task::Return]),
            Request::Dock { .. } => self.begin(vec![Task::Dock]),
            Request::Stop { .. } => self.stop(),
            Request::Pause { .. } => self.send(OperatorCommand::Pause),
            Request::Continue { .. } => self.send(OperatorCommand::Continue),
            Request::Drive { v, omega } => self.drive(hand, *v, *omega),
            Request::SetPose { pose, .. } => self.send(OperatorCommand::SetPose(PoseGuess {
                pose: pose.pose(),
                position_sigma: POINTED_POSITION_SIGMA_M,
                heading_sigma: POINTED_HEADING_SIGMA_RAD,
            })),
            Request::SetZone { zone, .. } => self.set_zone(zone),
            Request::RemoveZone { number, .. } => self.edit(&AnnotationEdit::RemoveZone(*number)),
            Request::SetPlace { place, .. } => self.edit(&AnnotationEdit::SetPlace(place.clone())),
            Request::RemovePlace { number, .. } => self.edit(&AnnotationEdit::RemovePlace(*number)),
            Request::Change { key, value, .. } => self.change(key, *value),
            Request::Record { on, .. } => self.record(*on),
            _ => Ok(()),
        }
    }

    /// Refuses requests without a robot.
    ///
    /// # Errors
    /// When the run has no missions and maps.
    pub fn require_robot(&self) -> Result<(), CommandRefusal> {
        if self.kind == RunKind::Robot {
            return Ok(());
        }
        Err(CommandRefusal::of("Nothing here has missions, poses or zones: drive by hand, or stop."))
    }

    /// The robot stops immediately, and the mission is dropped.
    ///
    /// # Errors
    /// When the run is over.
    pub fn stop(&self) -> Result<(), CommandRefusal> {
        let number = self.operator.stop()?;
        self.own_pause.store(number, Ordering::Relaxed);
        Ok(())
    }

    /// Stops the robot after the departure of its driver, unless another front end has paused it or let it go on since.
    pub fn end_of_hand(&self) {
        if !self.is_paused_here() {
            return;
        }
        match self.operator.send(OperatorCommand::Pause) {
            Ok(number) => self.own_pause.store(number, Ordering::Relaxed),
            Err(error) => tracing::debug!("live page: no stop after the departure of a driver: {error}"),
        }
    }

    fn is_paused_here(&self) -> bool {
        let own = self.own_pause.load(Ordering::Relaxed);
        own > 0 && own == self.operator.last_pause()
    }

    fn go(&self, goals: &[Goal], append: bool) -> Result<(), CommandRefusal> {
        if goals.is_empty() || goals.len() > MAX_GOALS {
            return Err(CommandRefusal::of(format!("{} goals: expected 1 to {MAX_GOALS}", goals.len())));
        }
        let view = self.operator.peek();
        let map = view.as_ref().and_then(|view| view.map.as_deref());
        let annotations = self.operator.annotations();
        for (number, goal) in goals.iter().enumerate() {
            let checked = Mission::new(vec![Task::go(goal.pose())]).map_err(CommandRefusal::from);
            let checked = checked.and_then(|_| {
                map.map_or(Ok(()), |map| require_free(&map.grid, &annotations, &self.check, goal.pose()))
            });
            checked.map_err(|refusal| CommandRefusal { goal: Some(number), ..refusal })?;
        }
        let left = view.filter(|_| append).map(|view| view.mission.left.to_vec()).unwrap_or_default();
        self.begin(left.into_iter().chain(goals.iter().map(|goal| Task::go(goal.pose()))).collect())
    }

    /// A zone outside the map is assumed to be a mistake.
    fn set_zone(&self, zone: &Zone) -> Result<(), CommandRefusal> {
        let zone = zone.clone().validated()?;
        let view = self.operator.peek();
        let map = view.as_ref().and_then(|view| view.map.as_deref());
        map.map_or(Ok(()), |map| require_on_map(&zone, map.grid.geometry()))?;
        self.edit(&AnnotationEdit::SetZone(zone))
    }

    /// The run switches the recording at its next step.
    fn record(&self, on: bool) -> Result<(), CommandRefusal> {
        let switch = self.operator.recording();
        let switch = switch.ok_or_else(|| CommandRefusal::of("This run has no recording to switch."))?;
        switch.turn(on);
        Ok(())
    }

    fn edit(&self, edit: &AnnotationEdit) -> Result<(), CommandRefusal> {
        Ok(self.operator.edit_annotations(edit)?)
    }

    fn change(&self, key: &str, value: f64) -> Result<(), CommandRefusal> {
        let setting = RunSetting::of_key(key, value);
        let setting =
            setting.ok_or_else(|| CommandRefusal::of(format!("{key} cannot change while the robot runs")))?;
        let (text, (min, max)) = (SettingText::of(setting, &self.limits), setting.range_within(&self.limits));
        require_in(key, value, text.unit, min, max)?;
        self.send(OperatorCommand::Change(setting))
    }

    /// The names of the maps to load.
    pub fn map_names(&self) -> Vec<String> {
        self.maps.as_ref().map_or_else(Vec::new, MapFolder::names)
    }

    /// The permission to read a map, for one request at a time.
    ///
    /// # Errors
    /// When another map is being read.
    pub fn claim_reading(&self) -> Result<OwnedSemaphorePermit, CommandRefusal> {
        let claimed = Arc::clone(&self.reading).try_acquire_owned();
        claimed.map_err(|_| CommandRefusal::of("Another map is being loaded: wait until it is there."))
    }

    /// The map of a name. This may take seconds, so the page's thread leaves it to another.
    ///
    /// # Errors
    /// When no folder of maps was given, or it has no such map for this robot.
    pub fn read_map(&self, name: &str) -> Result<FolderMap, CommandRefusal> {
        let maps = self.maps.as_ref();
        let maps = maps.ok_or_else(|| CommandRefusal::of("No folder of maps was given: --maps DIR"))?;
        maps.read(name).map_err(CommandRefusal::of)
    }

    /// Gives the robot a map with its zones and places.
    ///
    /// # Errors
    /// When the robot refuses the map, or the run is over.
    pub fn load_map(&self, map: FolderMap) -> Result<(), CommandRefusal> {
        Ok(self.operator.load_map(map.grid, map.annotations)?)
    }

    fn begin(&self, tasks: Vec<Task>) -> Result<(), CommandRefusal> {
        self.send(OperatorCommand::Begin(Mission::new(tasks)?))?;
        if self.is_paused_here() {
            self.send(OperatorCommand::Continue)?;
        }
        Ok(())
    }

    fn drive(&self, hand: HandId, v: f64, omega: f64) -> Result<(), CommandRefusal> {
        let number = self.operator.drive(hand, self.twist(v, omega))?;
        self.own_pause.store(number, Ordering::Relaxed);
        Ok(())
    }

    /// Notes a request of a viewer who is not in control: a stop holds against this hand, too.
    pub fn note_refused(&self, request: &Request, hand: HandId) {
        if let Request::Drive { v, omega } = request {
            self.operator.note_refused_drive(hand, self.twist(*v, *omega));
        }
    }

    /// The twist of a deflection, -1 to 1 each.
    fn twist(&self, v: f64, omega: f64) -> Twist2 {
        let part = |part: f64, max: f64| HAND_SPEED * max * part.clamp(-1.0, 1.0);
        Twist2::new(part(v, self.limits.v), part(omega, self.limits.omega))
    }

    fn send(&self, command: OperatorCommand) -> Result<(), CommandRefusal> {
        Ok(self.operator.send(command).map(drop)?)
    }
}

impl Goal {
    fn pose(&self) -> Pose2 {
        Pose2::new(self.x, self.y, self.theta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::operator::operator_link;
    use trundle_core::Footprint;

    const HAND: HandId = HandId::Viewer(1);

    fn steering() -> (RunSteering, trundle_app::operator::OperatorLink) {
        let (operator, link) = operator_link();
        let limits = DriveLimits::KOBUKI;
        let (kind, title, recording) = (RunKind::Robot, String::new(), "all");
        let facts = RunFacts { kind, title, footprint: Footprint::KOBUKI, limits, recording };
        (RunSteering::new(operator, &facts, None), link)
    }

    fn go(x: f64) -> Request {
        Request::Go { id: 1, goals: vec![Goal { x, y: 0.0, theta: 0.0 }], append: false }
    }

    #[test]
    fn goals_are_checked_before_the_robot_sees_them() {
        let (steering, _link) = steering();
        assert_eq!(steering.execute(&go(1.0), HAND), Ok(()));
        let refusal = steering.execute(&go(1e9), HAND).unwrap_err();
        assert_eq!(refusal.goal, Some(0));
        assert!(steering.execute(&Request::Go { id: 1, goals: vec![], append: false }, HAND).is_err());
        let many = vec![Goal { x: 0.0, y: 0.0, theta: 0.0 }; 1000];
        assert!(steering.execute(&Request::Go { id: 1, goals: many, append: true }, HAND).is_err());
    }

    #[test]
    fn tasks_without_a_goal_become_missions() {
        let (steering, link) = steering();
        let requests = [Request::Explore { id: 1 }, Request::Return { id: 2 }, Request::Dock { id: 3 }];
        for (request, task) in requests.iter().zip([Task::Explore, Task::Return, Task::Dock]) {
            steering.execute(request, HAND).unwrap();
            let mission = Mission::new(vec![task]).unwrap();
            assert_eq!(link.next_request().unwrap().command, OperatorCommand::Begin(mission));
        }
    }

    #[test]
    fn wrong_zones_and_settings_are_refused_with_the_reason() {
        let (steering, link) = steering();
        let zone = |outline: &[[f64; 2]]| Zone {
            id: 0,
            name: "rug".to_owned(),
            kind: trundle_core::ZoneKind::Slow(0.2),
            outline: outline.to_vec(),
        };
        let set = |zone| steering.execute(&Request::SetZone { id: 1, zone }, HAND);
        let bow = set(zone(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])).unwrap_err().text;
        assert!(bow.contains("crossed by itself"), "{bow}");
        assert!(set(zone(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])).is_ok());
        assert!(steering.execute(&Request::RemoveZone { id: 1, number: 7 }, HAND).is_err());
        let change =
            |key: &str, value| steering.execute(&Request::Change { id: 1, key: key.to_owned(), value }, HAND);
        let fast = change("limits.v_m_s", 5.0).unwrap_err().text;
        assert_eq!(fast, format!("limits.v_m_s is 5 m/s, expected 0.05 to {}", DriveLimits::KOBUKI.v));
        assert!(change("drive.wheel_radius_m", 1.0).unwrap_err().text.contains("cannot change"));
        assert!(change("mission_executor.patience_s", 20.0).is_ok());
        drop(link);
    }

    #[test]
    fn a_page_that_closes_or_sets_a_goal_leaves_the_pause_of_another_front_end() {
        let (steering, link) = steering();
        let other = link.operator();
        let taken =
            || std::iter::from_fn(|| link.next_request()).map(|request| request.command).collect::<Vec<_>>();
        let twist = |v| Request::Drive { v, omega: 0.0 };
        steering.execute(&twist(0.5), HAND).unwrap();
        steering.end_of_hand();
        assert_eq!(taken().last(), Some(&OperatorCommand::Pause), "its own drive ends with it");
        steering.execute(&go(1.0), HAND).unwrap();
        assert_eq!(
            taken().last(),
            Some(&OperatorCommand::Continue),
            "the next driver's task ends that pause"
        );
        steering.execute(&twist(0.5), HAND).unwrap();
        other.send(OperatorCommand::Continue).unwrap();
        steering.end_of_hand();
        assert_eq!(
            taken().last(),
            Some(&OperatorCommand::Continue),
            "the robot drives for another front end"
        );
        steering.stop().unwrap();
        other.send(OperatorCommand::Pause).unwrap();
        taken();
        steering.execute(&go(1.0), HAND).unwrap();
        assert!(!taken().contains(&OperatorCommand::Continue), "another front end paused the robot");
        steering.stop().unwrap();
        steering.execute(&go(1.0), HAND).unwrap();
        assert_eq!(taken().last(), Some(&OperatorCommand::Continue));
    }

    #[test]
    fn a_run_that_is_over_is_named() {
        let (steering, link) = steering();
        drop(link);
        assert_eq!(steering.execute(&Request::Stop { id: 1 }, HAND).unwrap_err().text, "the run is over");
        steering.end_of_hand();
    }
}
