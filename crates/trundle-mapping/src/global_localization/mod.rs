//! Localization in a finished map, from an unknown pose.

mod map_localizer;

pub use map_localizer::{Localized, MapLocalizer};
