//! Objects on walls, floors and desks. An object on a wall is placed by a pose on the wall's face, x into the room.

use super::builder::Builder;
use super::partition::{DOOR_HEIGHT, DOOR_WIDTH};
use crate::materials::{Finish, Paint};
use trundle_core::Pose2;

impl Builder {
    /// A board of (width, height) m on a wall, its middle `middle` m up, 15 mm thick.
    pub(super) fn board(&mut self, place: Pose2, middle: f64, (width, height): (f64, f64), paint: Paint) {
        let mut finish = Finish::all(Paint::Flat { color: [72, 66, 60] });
        finish.faces[0] = paint;
        self.block(place, (0.0075, 0.0), middle - height / 2.0, [0.015, width, height], finish);
    }

    /// A closed door on a wall.
    pub(super) fn closed_door(&mut self, place: Pose2, color: [u8; 3]) {
        let frame = Finish::all(Paint::Flat { color: [206, 204, 198] });
        self.block(place, (0.01, 0.0), 0.0, [0.02, DOOR_WIDTH + 0.12, DOOR_HEIGHT + 0.06], frame);
        let leaf = Finish::all(Paint::Door { color });
        self.block(place, (0.02, 0.0), 0.005, [0.03, DOOR_WIDTH - 0.04, DOOR_HEIGHT - 0.02], leaf);
    }

    /// A window on a wall, (width, height) m, its sill 0.9 m up.
    pub(super) fn window(&mut self, place: Pose2, (width, height): (f64, f64)) {
        self.board(place, 0.9 + height / 2.0, (width, height), Paint::Window);
    }

    /// A rug of (x, y) m, 6 mm thick.
    pub(super) fn rug(&mut self, place: Pose2, (x, y): (f64, f64)) {
        let cloth = Paint::Fabric { color: self.cloth() };
        self.block(place, (0.0, 0.0), 0.0, [x, y, 0.006], Finish::all(cloth));
    }

    /// A desk of (depth, width) m whose user sits toward its +x, with a screen, a keyboard and a box of drawers.
    pub(super) fn desk(&mut self, place: Pose2, (depth, width): (f64, f64)) {
        self.table(place, [depth, width, 0.73]);
        let drawers = Finish::all(Paint::Fronts { color: [196, 194, 188] });
        self.block(place, (-0.05, width / 2.0 - 0.3), 0.0, [depth - 0.2, 0.38, 0.6], drawers);
        let mut screen = Finish::all(Paint::Flat { color: [38, 38, 42] });
        self.block(place, (-0.17, -0.1), 0.73, [0.06, 0.08, 0.12], screen.clone());
        screen.faces[0] = Paint::Screen;
        self.block(place, (-0.15, -0.1), 0.83, [0.04, 0.55, 0.32], screen);
        let keys = Finish::all(Paint::Tiles { color: [90, 90, 96] });
        self.block(place, (0.12, -0.1), 0.73, [0.15, 0.42, 0.02], keys);
    }

    /// A fire extinguisher, its middle on the floor.
    pub(super) fn extinguisher(&mut self, place: Pose2) {
        self.pillar(place, (0.0, 0.0), 0.0, (0.08, 0.46), Paint::Metal { color: [186, 32, 28] });
        self.pillar(place, (0.0, 0.0), 0.46, (0.025, 0.1), Paint::Flat { color: [28, 28, 30] });
    }

    /// A lamp on a pole.
    pub(super) fn floor_lamp(&mut self, place: Pose2) {
        let metal = Paint::Metal { color: [70, 70, 74] };
        self.pillar(place, (0.0, 0.0), 0.0, (0.15, 0.03), metal);
        self.pillar(place, (0.0, 0.0), 0.03, (0.015, 1.4), metal);
        self.pillar(place, (0.0, 0.0), 1.43, (0.19, 0.3), Paint::Fabric { color: [224, 206, 170] });
    }
}
