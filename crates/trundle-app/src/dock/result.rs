//! The result of planning a manoeuvre: a plan, or the reason why the task admits none.

use super::impossible::impossible_text;
use super::table::{rows, verdict};
use super::task::DockingTask;
use trundle_core::Invalid;
use trundle_docking::{DockingConfig, DockingPlan, DockingPlanner, DockingRefusal, Solution};

/// The result of planning a manoeuvre.
#[derive(Debug, Clone, PartialEq)]
pub enum DockingResult {
    /// The planner's answer: a manoeuvre, or that none was found.
    Planned(DockingPlan),
    /// The task admits no manoeuvre: start or goal are off the map, overlap an obstacle or are too far apart, or the scan is empty.
    Refused(String),
}

impl DockingResult {
    /// Plans the manoeuvre of a task.
    ///
    /// # Errors
    /// When a setting is outside its range or a number is not finite.
    pub fn of(task: &DockingTask, config: DockingConfig) -> Result<Self, Invalid> {
        let planner = DockingPlanner::new(config)?;
        if let Some(refusal) = &task.refusal {
            return Ok(Self::Refused(refusal.clone()));
        }
        match planner.plan(&task.footprint, &task.scene, task.start, task.goal) {
            Ok(plan) => Ok(Self::Planned(plan)),
            Err(DockingRefusal::Invalid(invalid)) => Err(invalid),
            Err(refusal) => Ok(Self::Refused(refusal.to_string())),
        }
    }

    /// The manoeuvre; `None` if the task has none.
    #[must_use]
    pub fn found(&self) -> Option<&Solution> {
        match self {
            Self::Planned(DockingPlan::Found(found)) => Some(found),
            _ => None,
        }
    }

    /// The reason why the task has no manoeuvre.
    #[must_use]
    pub fn refusal(&self) -> Option<&str> {
        match self {
            Self::Refused(why) => Some(why),
            Self::Planned(_) => None,
        }
    }

    /// The steps, one row each, and a closing sentence. `seconds`: wall-clock time of planning.
    #[must_use]
    pub fn report(&self, seconds: f64) -> (Vec<Vec<String>>, String) {
        match self {
            Self::Planned(DockingPlan::Found(found)) if found.manoeuvre.steps().is_empty() => {
                (Vec::new(), "Already there: nothing to do.".to_owned())
            }
            Self::Planned(DockingPlan::Found(found)) => {
                let line = format!("\n{}; planned in {:.1} ms.", verdict(found), seconds * 1e3);
                (rows(&found.manoeuvre), line)
            }
            Self::Planned(DockingPlan::Impossible(impossible)) => (Vec::new(), impossible_text(impossible)),
            Self::Refused(_) => (Vec::new(), "No manoeuvre is planned.".to_owned()),
        }
    }
}
