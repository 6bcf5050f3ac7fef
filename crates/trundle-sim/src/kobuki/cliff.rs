//! The cliff sensors under the base.

use crate::world::World;
use trundle_core::{Pose2, Vector2, Vector3};

/// Sensors under the base that measure the floor below.
#[derive(Debug)]
pub(super) struct CliffSensors {
    places: Vec<Vector2>,
    /// Height of the sensors above the floor, m: above the obstacles that the base can cross.
    height: f64,
    /// A floor lower than this is a cliff, m.
    depth: f64,
    is_over_edge: bool,
}

impl CliffSensors {
    /// Sensors at `places`, base frame, m; `step_over` is the height of steps that the base passes, `depth` the minimum depth of a cliff,
    /// m.
    pub(super) fn new(places: &[[f64; 2]], step_over: f64, depth: f64) -> Self {
        let places = places.iter().map(|p| Vector2::new(p[0], p[1])).collect();
        Self { places, height: step_over + 0.01, depth, is_over_edge: false }
    }

    /// Whether any has no floor below, when that changed.
    pub(super) fn update(&mut self, pose: Pose2, world: &World) -> Option<bool> {
        let reach = self.height + self.depth;
        let has_floor = |place: &Vector2| {
            let p = pose.transform(*place);
            world.cast(Vector3::new(p.x, p.y, self.height), -Vector3::z(), reach).is_some()
        };
        let is_over_edge = !self.places.iter().all(has_floor);
        let changed = is_over_edge != self.is_over_edge;
        self.is_over_edge = is_over_edge;
        changed.then_some(is_over_edge)
    }
}
