//! Where the robot is in a map that is there already: found anywhere in it, then followed.

mod global;
mod localizer;
mod restart;

pub(crate) use global::GlobalSearch;
pub use global::Lost;
pub use localizer::{Localized, MapLocalizer};
