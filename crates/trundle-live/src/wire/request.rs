//! Requests of a page.

use serde::Deserialize;
use trundle_core::{NamedPlace, Zone};

/// A request of a page. `id` identifies the request in the answer.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Request {
    /// First of all: version and token.
    Hello {
        /// Version of the page's messages.
        version: u32,
        /// The token of the link.
        token: String,
        /// Display name of this viewer.
        #[serde(default)]
        name: String,
    },
    /// The page has drawn the views up to this one.
    Seen {
        /// Number of the view.
        batch: u64,
    },
    /// Send images of the camera, or do not.
    Camera {
        /// Whether to send them.
        on: bool,
        /// Whether to send their depth too.
        #[serde(default)]
        depth: bool,
    },
    /// Send the visual map, or do not.
    VisualMap {
        /// Whether to send the visual map.
        on: bool,
    },
    /// Drive to goals, one after the other.
    Go {
        /// Number of the request.
        id: u64,
        /// The goals.
        goals: Vec<Goal>,
        /// Whether the goals follow the remaining tasks.
        #[serde(default)]
        append: bool,
    },
    /// Explore until the map is complete.
    Explore {
        /// Number of the request.
        id: u64,
    },
    /// Drive back to the start.
    Return {
        /// Number of the request.
        id: u64,
    },
    /// Drive onto the charging station.
    Dock {
        /// Number of the request.
        id: u64,
    },
    /// Stop immediately and drop the mission.
    Stop {
        /// Number of the request.
        id: u64,
    },
    /// Stop and keep the mission.
    Pause {
        /// Number of the request.
        id: u64,
    },
    /// Go on after a pause.
    Continue {
        /// Number of the request.
        id: u64,
    },
    /// Drive by hand. Silence of 0.3 s stops the robot.
    Drive {
        /// Part of the highest speed, -1 to 1, ahead positive.
        v: f64,
        /// Part of the highest turn rate, -1 to 1, to the left positive.
        omega: f64,
    },
    /// Sets the pose of the robot.
    SetPose {
        /// Number of the request.
        id: u64,
        /// The pose.
        pose: Goal,
    },
    /// Replaces the zone with the same number; number 0 adds a zone.
    SetZone {
        /// Number of the request.
        id: u64,
        /// The zone.
        zone: Zone,
    },
    /// Delete a zone.
    RemoveZone {
        /// Number of the request.
        id: u64,
        /// Number of the zone.
        number: u32,
    },
    /// Replaces the named place with the same number; number 0 adds a place.
    SetPlace {
        /// Number of the request.
        id: u64,
        /// The place.
        place: NamedPlace,
    },
    /// Delete a named place.
    RemovePlace {
        /// Number of the request.
        id: u64,
        /// Number of the place.
        number: u32,
    },
    /// Change a setting.
    Change {
        /// Number of the request.
        id: u64,
        /// Key of the setting in the robot file.
        key: String,
        /// Value of the setting, in the unit of the key.
        value: f64,
    },
    /// Begin a recording, or end it.
    Record {
        /// Number of the request.
        id: u64,
        /// Whether to record.
        on: bool,
    },
    /// Another map of the folder of maps in place of the present one.
    LoadMap {
        /// Number of the request.
        id: u64,
        /// Name of the map.
        name: String,
    },
    /// Take control, from the viewer that has it.
    TakeWheel {
        /// Number of the request.
        id: u64,
    },
    /// Leave the wheel to others.
    LeaveWheel {
        /// Number of the request.
        id: u64,
    },
}

/// A pose in the map frame.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Goal {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// Heading \[rad\].
    pub theta: f64,
}

impl Request {
    /// Number of the request in its answer; `None` for a request without an answer.
    pub fn id(&self) -> Option<u64> {
        match self {
            Self::Hello { .. }
            | Self::Seen { .. }
            | Self::Camera { .. }
            | Self::VisualMap { .. }
            | Self::Drive { .. } => None,
            Self::Go { id, .. }
            | Self::Explore { id }
            | Self::Return { id }
            | Self::Dock { id }
            | Self::Stop { id }
            | Self::Pause { id }
            | Self::Continue { id }
            | Self::SetPose { id, .. }
            | Self::SetZone { id, .. }
            | Self::RemoveZone { id, .. }
            | Self::SetPlace { id, .. }
            | Self::RemovePlace { id, .. }
            | Self::Change { id, .. }
            | Self::Record { id, .. }
            | Self::LoadMap { id, .. }
            | Self::TakeWheel { id }
            | Self::LeaveWheel { id } => Some(*id),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Request> {
        serde_json::from_str(text).ok()
    }

    #[test]
    fn requests_are_read_and_broken_ones_refused() {
        let goal = Goal { x: 1.0, y: -2.0, theta: 0.5 };
        let go = r#"{"type":"go","id":7,"goals":[{"x":1,"y":-2,"theta":0.5}]}"#;
        assert_eq!(read(go), Some(Request::Go { id: 7, goals: vec![goal], append: false }));
        assert_eq!(read(r#"{"type":"stop","id":8}"#).unwrap().id(), Some(8));
        assert_eq!(read(r#"{"type":"drive","v":0.5,"omega":0}"#).unwrap().id(), None);
        let zone = r#"{"type":"set_zone","id":9,"zone":{"id":0,"name":"a","kind":{"slow":0.2},"outline":[[0,0],[1,0],[0,1]]}}"#;
        assert!(matches!(read(zone), Some(Request::SetZone { id: 9, zone: Zone { id: 0, .. } })));
        assert_eq!(read(&zone.replace("[1,0]", "[1,0,0]")), None);
        assert_eq!(read(&zone.replace("[1,0]", "[NaN,0]")), None);
        let nested = format!(r#"{{"type":"go","id":1,"goals":{}"#, "[".repeat(4000));
        for wrong in [
            "",
            "[]",
            r#"{"type":"fly","id":1}"#,
            r#"{"type":"stop"}"#,
            r#"{"type":"stop","id":-1}"#,
            r#"{"type":"stop","id":1,"more":2}"#,
            r#"{"type":"drive","v":NaN,"omega":0}"#,
            r#"{"type":"drive","v":1e999,"omega":0}"#,
            &nested,
        ] {
            assert_eq!(read(wrong), None, "{wrong:.60}");
        }
    }
}
