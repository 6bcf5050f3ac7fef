//! The robot file: reads `robot.toml` with units in its keys, prints each key with its meaning, and checks plausibility.

mod file;
mod former_names;
mod missing_keys;
mod overrides;
mod plausibility;
mod print;
mod reference;
mod refusal;
mod schema;
mod settings_error;
mod translation;
mod value_kind;

pub use file::RobotFile;
pub use former_names::with_present_names;
pub use print::to_commented_toml;
pub use reference::{Setting, reference};
pub use schema::json_schema;
pub use settings_error::SettingsError;
