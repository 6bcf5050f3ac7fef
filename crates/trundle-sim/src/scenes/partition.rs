//! Walls with door openings, and door leaves.

use super::builder::{Builder, ROOM_HEIGHT, Side};
use crate::materials::{Finish, Paint};
use trundle_core::Pose2;

/// Clear width and height of doors, m. Source: ours.
pub(super) const DOOR_WIDTH: f64 = 1.0;
pub(super) const DOOR_HEIGHT: f64 = 2.02;

/// Direction of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Along {
    X,
    Y,
}

/// A wall with door openings, from the floor to the ceiling.
#[derive(Debug, Clone)]
pub(super) struct Partition {
    pub(super) along: Along,
    /// Ends of the wall along its direction, m.
    pub(super) span: [f64; 2],
    /// Faces of the wall across its direction, m.
    pub(super) faces: [f64; 2],
    /// Paints of the faces, the one at lower coordinates first.
    pub(super) paints: [Paint; 2],
    /// Paint of the openings' sides.
    pub(super) jamb: Paint,
}

impl Builder {
    /// Places `wall` with a door opening about each of `doors` (m along the wall, rising).
    pub(super) fn partition(&mut self, wall: &Partition, doors: &[f64]) {
        let half = DOOR_WIDTH / 2.0;
        let ends = doors.iter().map(|door| door - half).chain([wall.span[1]]);
        let begins = [wall.span[0]].into_iter().chain(doors.iter().map(|door| door + half));
        for (begin, end) in begins.zip(ends).filter(|(begin, end)| end - begin > 1e-9) {
            self.stretch(wall, [begin, end], 0.0);
        }
        for door in doors {
            self.stretch(wall, [door - half, door + half], DOOR_HEIGHT);
        }
    }

    fn stretch(&mut self, wall: &Partition, [begin, end]: [f64; 2], bottom: f64) {
        let ([low, high], jamb) = (wall.faces, wall.jamb);
        let [below, above] = wall.paints;
        match wall.along {
            Along::X => {
                let seen = [
                    (Side::South, below),
                    (Side::North, above),
                    (Side::West, jamb),
                    (Side::East, jamb),
                    (Side::Bottom, jamb),
                ];
                self.slab([begin, low, bottom], [end, high, ROOM_HEIGHT], &seen);
            }
            Along::Y => {
                let seen = [
                    (Side::West, below),
                    (Side::East, above),
                    (Side::South, jamb),
                    (Side::North, jamb),
                    (Side::Bottom, jamb),
                ];
                self.slab([low, begin, bottom], [high, end, ROOM_HEIGHT], &seen);
            }
        }
    }

    /// A door leaf at `hinge`, open along the hinge's x axis.
    pub(super) fn door_leaf(&mut self, hinge: Pose2, color: [u8; 3]) {
        let leaf = Finish::all(Paint::Door { color });
        let size = [DOOR_WIDTH - 0.06, 0.04, DOOR_HEIGHT - 0.02];
        self.block(hinge, (size[0] / 2.0, 0.0), 0.005, size, leaf);
    }
}
