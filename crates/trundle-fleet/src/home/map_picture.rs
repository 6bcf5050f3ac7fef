//! Pictures of the map for a home.

use crate::RobotFacts;
use std::time::Duration;
use trundle_app::operator::MapView;
use trundle_core::Pose2;
use trundle_viz::{Color, MapPicture, PoseStyle};

/// Shortest time between two pictures. Source: ours; a picture of a house takes 20 ms.
const PICTURE_PERIOD: Duration = Duration::from_secs(5);

/// Makes pictures of the map if the map or the pose changed.
#[derive(Debug, Default)]
pub struct MapPictures {
    since_picture: Duration,
    /// Revision of the map in the last picture, and its bytes.
    last: Option<(u64, Vec<u8>)>,
}

impl MapPictures {
    /// Makes the next picture due even without changes.
    pub fn begin_anew(&mut self) {
        self.last = None;
        self.since_picture = PICTURE_PERIOD;
    }

    /// Whether a picture is due.
    #[must_use]
    pub fn is_due(&self) -> bool {
        self.since_picture >= PICTURE_PERIOD
    }

    /// A PNG if one is due and differs from the last one.
    pub fn due(
        &mut self,
        passed: Duration,
        map: Option<&MapView>,
        pose: Pose2,
        facts: &RobotFacts,
    ) -> Option<Vec<u8>> {
        self.since_picture += passed;
        let map = map.filter(|_| self.is_due())?;
        self.since_picture = Duration::ZERO;
        if self.last.as_ref().is_some_and(|(revision, _)| *revision == map.revision) {
            return None;
        }
        let style = PoseStyle::named(Color::BLUE).nameless().with_footprint(facts.footprint.clone());
        let png = MapPicture::over(&map.grid).pose("robot", pose, style).without_legend().to_png();
        let is_same = self.last.as_ref().is_some_and(|(_, last)| *last == png);
        self.last = Some((map.revision, png.clone()));
        (!is_same).then_some(png)
    }
}
