//! Furniture of bedrooms, kitchens and baths, each placed by the pose of its middle on the floor; fronts toward +x.

use super::builder::Builder;
use crate::materials::{Finish, Paint};
use trundle_core::Pose2;

/// Glazed ware.
const CERAMIC: Paint = Paint::Plain { color: [232, 232, 228] };

impl Builder {
    /// A bed of `size` (length, width, height of the mattress, m), its head at its -x.
    pub(super) fn bed(&mut self, place: Pose2, [length, width, height]: [f64; 3]) {
        let wood = Paint::Veneer { color: self.wood() };
        let cloth = Paint::Fabric { color: self.cloth() };
        let frame = height * 0.6;
        self.block(place, (0.0, 0.0), 0.0, [length, width, frame], Finish::all(wood));
        self.block(place, (-length / 2.0 - 0.02, 0.0), 0.0, [0.04, width, height + 0.45], Finish::all(wood));
        let linen = Finish::all(Paint::Plain { color: [226, 222, 212] });
        self.block(place, (0.02, 0.0), frame, [length - 0.08, width - 0.06, height - frame], linen.clone());
        self.block(place, (0.3, 0.0), height, [length - 0.7, width - 0.02, 0.05], Finish::all(cloth));
        for side in [-1.0, 1.0] {
            let offset = (-length / 2.0 + 0.28, side * width / 4.0);
            self.block(place, offset, height, [0.36, width * 0.4, 0.12], linen.clone());
        }
    }

    /// Fitted fronts of `size` (depth, width, height, m): counters, wardrobes.
    pub(super) fn fitted(&mut self, place: Pose2, size: [f64; 3], color: [u8; 3]) {
        let mut finish = Finish::all(Paint::Plain { color });
        finish.faces[0] = Paint::Fronts { color };
        self.block(place, (0.0, 0.0), 0.0, size, finish);
    }

    /// A kitchen counter of `size` (depth, width, height, m) with a worktop.
    pub(super) fn counter(&mut self, place: Pose2, [depth, width, height]: [f64; 3], color: [u8; 3]) {
        self.fitted(place, [depth, width, height - 0.04], color);
        let top = Finish::all(Paint::Veneer { color: [112, 92, 74] });
        self.block(place, (0.0, 0.0), height - 0.04, [depth + 0.03, width, 0.04], top);
    }

    /// A fridge with magnets and notes on its door.
    pub(super) fn fridge(&mut self, place: Pose2) {
        let mut finish = Finish::all(Paint::Plain { color: [214, 216, 218] });
        finish.faces[0] = Paint::Plaster { color: [222, 224, 226], prints: 0.5 };
        self.block(place, (0.0, 0.0), 0.0, [0.62, 0.6, 1.78], finish);
    }

    /// A bath tub of `size` (x, y, height, m) with its upper edge.
    pub(super) fn tub(&mut self, place: Pose2, [x, y, height]: [f64; 3]) {
        self.block(place, (0.0, 0.0), 0.0, [x, y, height - 0.12], Finish::all(CERAMIC));
        for side in [-1.0, 1.0] {
            let along = (0.0, side * (y / 2.0 - 0.05));
            self.block(place, along, height - 0.12, [x, 0.1, 0.12], Finish::all(CERAMIC));
            let across = (side * (x / 2.0 - 0.05), 0.0);
            self.block(place, across, height - 0.12, [0.1, y - 0.2, 0.12], Finish::all(CERAMIC));
        }
    }

    /// A toilet, its cistern at its -x.
    pub(super) fn toilet(&mut self, place: Pose2) {
        self.block(place, (-0.25, 0.0), 0.0, [0.18, 0.38, 0.82], Finish::all(CERAMIC));
        self.pillar(place, (0.06, 0.0), 0.0, (0.12, 0.3), CERAMIC);
        self.pillar(place, (0.06, 0.0), 0.3, (0.21, 0.12), CERAMIC);
    }

    /// A wash basin on a cupboard, a mirror above.
    pub(super) fn basin(&mut self, place: Pose2) {
        self.fitted(place, [0.45, 0.6, 0.7], [148, 160, 166]);
        self.block(place, (0.0, 0.0), 0.7, [0.48, 0.62, 0.14], Finish::all(CERAMIC));
    }

    /// A washing machine.
    pub(super) fn washer(&mut self, place: Pose2) {
        self.block(place, (0.0, 0.0), 0.0, [0.58, 0.6, 0.85], Finish::all(CERAMIC));
        let port = Finish::all(Paint::Flat { color: [60, 66, 74] });
        self.block(place, (0.292, 0.0), 0.3, [0.01, 0.32, 0.32], port);
        self.block(place, (0.292, 0.0), 0.74, [0.01, 0.5, 0.08], Finish::all(Paint::Screen));
    }
}
