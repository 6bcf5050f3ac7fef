//! A setting that may change while the robot runs, with its text and range.

use serde::Serialize;
use trundle_core::DriveLimits;
use trundle_runtime::RunSetting;
use trundle_runtime::settings::reference;

/// A setting that may change while the robot runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SettingText {
    /// Key of the setting in the robot file.
    pub key: &'static str,
    /// Meaning of the setting, from the reference of settings.
    pub text: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Present value.
    pub value: f64,
    /// Smallest value.
    pub min: f64,
    /// Largest value of this robot.
    pub max: f64,
}

impl SettingText {
    /// The setting with its present value, for a robot with these limits.
    pub fn of(setting: RunSetting, limits: &DriveLimits) -> Self {
        let known = reference().iter().find(|known| known.key == setting.key());
        let (min, max) = setting.range_within(limits);
        Self {
            key: setting.key(),
            text: known.map_or("", |known| known.doc),
            unit: known.map_or("", |known| known.unit),
            value: setting.value(),
            min,
            max,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_has_text_unit_and_the_range_of_the_robot() {
        let limits = DriveLimits::KOBUKI;
        let speed = SettingText::of(RunSetting::Speed(0.25), &limits);
        assert_eq!((speed.unit, speed.value, speed.max), ("m/s", 0.25, limits.v));
        assert!(speed.text.contains("forward speed"), "{speed:?}");
        let patience = SettingText::of(RunSetting::Patience(20.0), &limits);
        assert_eq!((patience.unit, patience.min, patience.max), ("s", 1.0, 3600.0));
    }
}
