//! Named places of a run.

use trundle_app::operator::Operator;
use trundle_core::Pose2;

/// Named places, if the program has them. They may change while a run goes.
pub trait Places: Send {
    /// The names, in the order in which they are shown.
    fn names(&self) -> Vec<String>;
    /// Pose of a place, map frame.
    fn pose(&self, name: &str) -> Option<Pose2>;
}

/// The places that are kept with the map of a run.
impl Places for Operator {
    fn names(&self) -> Vec<String> {
        self.annotations().places.iter().map(|place| place.name.clone()).collect()
    }

    fn pose(&self, name: &str) -> Option<Pose2> {
        self.goal_of_place(name).ok()
    }
}
