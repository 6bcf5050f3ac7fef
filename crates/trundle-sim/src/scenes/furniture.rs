//! Pieces of furniture, each placed by the pose of its middle on the floor.

use super::builder::Builder;
use crate::materials::{Finish, Paint};
use trundle_core::Pose2;

const WOODS: [[u8; 3]; 4] = [[176, 128, 80], [120, 80, 52], [204, 170, 120], [92, 66, 50]];
const CLOTHS: [[u8; 3]; 4] = [[70, 96, 128], [150, 74, 62], [92, 116, 84], [128, 112, 140]];
const METALS: [[u8; 3]; 3] = [[90, 94, 104], [150, 60, 50], [60, 110, 120]];

impl Builder {
    /// A colour of wood.
    pub(super) fn wood(&mut self) -> [u8; 3] {
        let wood = self.choose(&WOODS);
        self.tint.unwrap_or(wood)
    }

    /// A colour of cloth.
    pub(super) fn cloth(&mut self) -> [u8; 3] {
        let cloth = self.choose(&CLOTHS);
        self.tint.unwrap_or(cloth)
    }

    /// A colour of painted metal.
    pub(super) fn metal(&mut self) -> [u8; 3] {
        let metal = self.choose(&METALS);
        self.tint.unwrap_or(metal)
    }

    /// A table on four round legs, `size` (x, y, height to the top's surface, m). Below 0.6 m a Kobuki with a camera does not pass under.
    pub(super) fn table(&mut self, place: Pose2, [x, y, height]: [f64; 3]) {
        let wood = Paint::Veneer { color: self.wood() };
        let top = 0.05;
        self.block(place, (0.0, 0.0), height - top, [x, y, top], Finish::all(wood));
        let leg = Paint::Metal { color: self.metal() };
        let (dx, dy) = (x / 2.0 - 0.06, y / 2.0 - 0.06);
        for offset in [(dx, dy), (-dx, dy), (-dx, -dy), (dx, -dy)] {
            self.pillar(place, offset, 0.0, (0.028, height - top), leg);
        }
    }

    /// A bookcase, its books toward its own -y.
    pub(super) fn bookcase(&mut self, place: Pose2, size: [f64; 3]) {
        let mut finish = Finish::all(Paint::Veneer { color: self.wood() });
        finish.faces[3] = Paint::Books;
        self.block(place, (0.0, 0.0), 0.0, size, finish);
    }

    /// A cabinet with doors.
    pub(super) fn cabinet(&mut self, place: Pose2, size: [f64; 3]) {
        let paint = Paint::Veneer { color: self.wood() };
        self.block(place, (0.0, 0.0), 0.0, size, Finish::all(paint));
    }

    /// A sofa of `size` (depth, width, height, m) that faces along its own x.
    pub(super) fn sofa(&mut self, place: Pose2, [depth, width, height]: [f64; 3]) {
        let cloth = Finish::all(Paint::Fabric { color: self.cloth() });
        let (seat, arms) = (height * 21.0 / 41.0, height * 9.0 / 41.0);
        self.block(place, (0.0, 0.0), 0.0, [depth, width, seat], cloth.clone());
        self.block(place, (-depth / 2.0 + 0.1, 0.0), seat, [0.2, width, height / 2.05], cloth.clone());
        for side in [-1.0, 1.0] {
            let offset = (0.0, side * (width / 2.0 - 0.08));
            self.block(place, offset, seat, [depth, 0.16, arms], cloth.clone());
        }
    }

    /// A chair of `size` (depth, width, height of the back, m) that faces along its own x.
    pub(super) fn chair(&mut self, place: Pose2, [depth, width, height]: [f64; 3]) {
        let wood = Paint::Veneer { color: self.wood() };
        let seat = height / 2.0;
        let cloth = Finish::all(Paint::Fabric { color: self.cloth() });
        self.block(place, (0.0, 0.0), seat - 0.05, [depth, width, 0.05], cloth);
        let back = [0.04, width * 0.9, height - seat - 0.1];
        self.block(place, (-depth / 2.0 + 0.02, 0.0), seat + 0.1, back, Finish::all(wood));
        let (dx, dy) = (depth / 2.0 - 0.03, width / 2.0 - 0.03);
        for (offset, top) in [((dx, dy), seat - 0.05), ((dx, -dy), seat - 0.05)] {
            self.pillar(place, offset, 0.0, (0.02, top), wood);
        }
        for offset in [(-dx, dy), (-dx, -dy)] {
            self.pillar(place, offset, 0.0, (0.02, height - 0.1), wood);
        }
    }

    /// A carton.
    pub(super) fn carton(&mut self, place: Pose2, size: [f64; 3]) {
        self.block(place, (0.0, 0.0), 0.0, size, Finish::all(Paint::Cardboard));
    }

    /// A carton with a smaller, rotated one on top.
    pub(super) fn cartons(&mut self, place: Pose2, size: [f64; 3]) {
        self.carton(place, size);
        let turned = Pose2::new(place.x, place.y, place.theta + 0.2 + self.jitter(0.15));
        let upper = [size[0] * 0.7, size[1] * 0.65, size[2] * 0.6];
        self.block(turned, (0.0, 0.0), size[2], upper, Finish::all(Paint::Cardboard));
    }

    /// A round bin.
    pub(super) fn bin(&mut self, place: Pose2) {
        self.sized_bin(place, (0.15, 0.42));
    }

    /// A round bin of (radius, height), m.
    pub(super) fn sized_bin(&mut self, place: Pose2, size: (f64, f64)) {
        let paint = Paint::Metal { color: self.metal() };
        self.pillar(place, (0.0, 0.0), 0.0, size, paint);
    }

    /// A stool.
    pub(super) fn stool(&mut self, place: Pose2) {
        self.sized_stool(place, (0.18, 0.45));
    }

    /// A stool of (radius, height), m.
    pub(super) fn sized_stool(&mut self, place: Pose2, size: (f64, f64)) {
        let paint = Paint::Fabric { color: self.cloth() };
        self.pillar(place, (0.0, 0.0), 0.0, size, paint);
    }

    /// A pot with a round bush.
    pub(super) fn plant(&mut self, place: Pose2) {
        self.sized_plant(place, (0.26, 1.21));
    }

    /// A pot with a round bush of (radius, height to its top), m.
    pub(super) fn sized_plant(&mut self, place: Pose2, (radius, height): (f64, f64)) {
        let (r, h) = (radius / 0.26, height / 1.21);
        self.pillar(place, (0.0, 0.0), 0.0, (0.18 * r, 0.36 * h), Paint::Metal { color: [164, 92, 60] });
        self.pillar(place, (0.0, 0.0), 0.36 * h, (0.04 * r, 0.3 * h), Paint::Metal { color: [84, 62, 44] });
        let leaves = self.tint.unwrap_or([62, 112, 58]);
        self.pillar(place, (0.0, 0.0), 0.66 * h, (0.26 * r, 0.55 * h), Paint::Fabric { color: leaves });
    }
}
