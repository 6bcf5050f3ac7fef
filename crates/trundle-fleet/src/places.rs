//! Named places of a run.

use trundle_app::operator::Operator;
use trundle_core::Pose2;

/// Named places of the program. They may change during a run.
pub trait Places: Send {
    /// The names, in display order.
    fn names(&self) -> Vec<String>;
    /// Pose of a place, map frame.
    fn pose(&self, name: &str) -> Option<Pose2>;
}

/// The places stored with the map of a run.
impl Places for Operator {
    fn names(&self) -> Vec<String> {
        self.annotations().places.iter().map(|place| place.name.clone()).collect()
    }

    fn pose(&self, name: &str) -> Option<Pose2> {
        self.goal_of_place(name).ok()
    }
}
