//! Exact contact of a rounded convex hull with straight pieces: standing, turning on the spot, driving straight.

mod driving;
mod hull;
mod profile;
mod segment;
mod turning;

pub use driving::InTheWay;
pub use hull::{Hull, LEAST_RADIUS};
pub use profile::{Profile, once_round};
pub use segment::Segment;
pub use turning::Arc;
