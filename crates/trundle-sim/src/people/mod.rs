//! People who walk along given way-points, two legs each, and wait while the robot blocks them.

mod body;
mod crowd;
mod gait;
mod person;
mod walker;

pub(crate) use crowd::{Crowd, CrowdView};
pub use person::Person;
