//! Content of a run's recording, and its size.

use serde::{Deserialize, Serialize};
use trundle_core::PinholeCamera;

/// Content of a run's recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RecordingContent {
    /// No recording.
    None,
    /// Everything but images: wheels, gyro, bumper, scans, truth, twists, poses and trajectories. A replay is impossible.
    Events,
    /// Everything: a replay gives the same bytes.
    #[default]
    All,
}

impl RecordingContent {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 3] = [
        ("none", "There is no recording", Self::None),
        ("events", "Everything but images: about 0.1 MB per second", Self::Events),
        ("all", "Everything, images too: about 3 MB per second", Self::All),
    ];
}

/// Size of the events without images in a second of a run \[bytes\]. Source: recordings of the demo.
const EVENT_BYTES_PER_S: f64 = 40e3;
/// Size of a pixel of colour and depth, as JPEG and RVL in zstd \[bytes\]. Source: recordings of the demo.
const BYTES_PER_PIXEL: f64 = 0.9;
/// Number of bytes in a megabyte. Source: SI.
const BYTES_PER_MB: f64 = 1e6;

impl RecordingContent {
    /// The refusal of a recording without images.
    pub(crate) const NO_IMAGES: &str =
        "the recording holds no images (--record events), expected one of a run with --record all";

    /// Whether this is all, which setups of recordings do not name.
    pub(crate) fn is_all(&self) -> bool {
        *self == Self::All
    }

    /// Name of the content on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::CHOICES.iter().find(|(.., content)| *content == self).map_or("all", |(name, ..)| name)
    }

    /// Size of a second of a recording \[bytes\] with images of `camera` at `rate_hz`.
    #[must_use]
    pub fn bytes_per_second(self, camera: &PinholeCamera, rate_hz: f64) -> f64 {
        let pixels = (camera.width() * camera.height()) as f64;
        match self {
            Self::None => 0.0,
            Self::Events => EVENT_BYTES_PER_S,
            Self::All => EVENT_BYTES_PER_S + BYTES_PER_PIXEL * pixels * rate_hz,
        }
    }

    /// Size of the recording, in one sentence, for a run of at most `limit` s (`f64::MAX`: no limit) with images of `camera` at `rate_hz`.
    #[must_use]
    pub fn announcement(self, camera: &PinholeCamera, rate_hz: f64, limit: f64) -> String {
        let rate = self.bytes_per_second(camera, rate_hz) / BYTES_PER_MB;
        let total = rate * limit;
        let total = match total {
            _ if limit == f64::MAX => String::new(),
            _ if total < 1.0 => format!(", less than 1 MB in {limit} s"),
            _ => format!(", at most {total:.0} MB in {limit} s"),
        };
        match self {
            Self::None => "Nothing is recorded.".to_owned(),
            Self::Events => format!(
                "Records events without images, about {rate:.2} MB per second of the robot's time{total}."
            ),
            Self::All => {
                format!(
                    "Records events and images, about {rate:.1} MB per second of the robot's time{total}."
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_runtime::RobotConfig;

    #[test]
    fn the_announcement_names_rate_and_total() {
        let camera = RobotConfig::default().camera;
        let text = |content: RecordingContent| content.announcement(&camera, 15.0, 100.0);
        assert_eq!(text(RecordingContent::None), "Nothing is recorded.");
        assert!(text(RecordingContent::Events).contains("at most 4 MB in 100 s"));
        assert!(text(RecordingContent::All).contains("MB per second"));
        let short = RecordingContent::Events.announcement(&camera, 15.0, 6.0);
        assert!(short.contains("less than 1 MB in 6 s"), "{short}");
        let shorter = RecordingContent::Events.announcement(&camera, 15.0, 0.3);
        assert!(shorter.contains("less than 1 MB in 0.3 s"), "{shorter}");
        let endless = RecordingContent::Events.announcement(&camera, 15.0, f64::MAX);
        assert_eq!(endless, "Records events without images, about 0.04 MB per second of the robot's time.");
    }
}
