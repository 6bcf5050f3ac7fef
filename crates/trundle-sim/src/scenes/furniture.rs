//! Pieces of furniture, each placed by the pose of its middle on the floor.

use super::builder::Builder;
use crate::paint::{Finish, Paint};
use trundle_core::Pose2;

const WOODS: [[u8; 3]; 4] = [[176, 128, 80], [120, 80, 52], [204, 170, 120], [92, 66, 50]];
const CLOTHS: [[u8; 3]; 4] = [[70, 96, 128], [150, 74, 62], [92, 116, 84], [128, 112, 140]];
const METALS: [[u8; 3]; 3] = [[90, 94, 104], [150, 60, 50], [60, 110, 120]];

impl Builder {
    /// A table on four round legs, `size` (x, y, height to the top's surface, m). Below 0.6 m a Kobuki with a camera does not pass under.
    pub(super) fn table(&mut self, place: Pose2, [x, y, height]: [f64; 3]) {
        let wood = Paint::Veneer { color: self.choose(&WOODS) };
        let top = 0.05;
        self.block(place, (0.0, 0.0), height - top, [x, y, top], Finish::all(wood));
        let leg = Paint::Metal { color: self.choose(&METALS) };
        let (dx, dy) = (x / 2.0 - 0.06, y / 2.0 - 0.06);
        for offset in [(dx, dy), (-dx, dy), (-dx, -dy), (dx, -dy)] {
            self.pillar(place, offset, 0.0, (0.028, height - top), leg);
        }
    }

    /// A bookcase, its books toward its own -y.
    pub(super) fn bookcase(&mut self, place: Pose2, size: [f64; 3]) {
        let mut finish = Finish::all(Paint::Veneer { color: self.choose(&WOODS) });
        finish.faces[3] = Paint::Books;
        self.block(place, (0.0, 0.0), 0.0, size, finish);
    }

    /// A cabinet with doors.
    pub(super) fn cabinet(&mut self, place: Pose2, size: [f64; 3]) {
        let paint = Paint::Veneer { color: self.choose(&WOODS) };
        self.block(place, (0.0, 0.0), 0.0, size, Finish::all(paint));
    }

    /// A sofa of (depth, width) m that looks along its own x.
    pub(super) fn sofa(&mut self, place: Pose2, (depth, width): (f64, f64)) {
        let cloth = Finish::all(Paint::Fabric { color: self.choose(&CLOTHS) });
        self.block(place, (0.0, 0.0), 0.0, [depth, width, 0.42], cloth.clone());
        self.block(place, (-depth / 2.0 + 0.1, 0.0), 0.42, [0.2, width, 0.4], cloth.clone());
        for side in [-1.0, 1.0] {
            let offset = (0.0, side * (width / 2.0 - 0.08));
            self.block(place, offset, 0.42, [depth, 0.16, 0.18], cloth.clone());
        }
    }

    /// A carton.
    pub(super) fn carton(&mut self, place: Pose2, size: [f64; 3]) {
        self.block(place, (0.0, 0.0), 0.0, size, Finish::all(Paint::Cardboard));
    }

    /// A carton with a smaller one on it, turned.
    pub(super) fn cartons(&mut self, place: Pose2, size: [f64; 3]) {
        self.carton(place, size);
        let turned = Pose2::new(place.x, place.y, place.theta + 0.2 + self.jitter(0.15));
        let upper = [size[0] * 0.7, size[1] * 0.65, size[2] * 0.6];
        self.block(turned, (0.0, 0.0), size[2], upper, Finish::all(Paint::Cardboard));
    }

    /// A round bin.
    pub(super) fn bin(&mut self, place: Pose2) {
        let paint = Paint::Metal { color: self.choose(&METALS) };
        self.pillar(place, (0.0, 0.0), 0.0, (0.15, 0.42), paint);
    }

    /// A stool.
    pub(super) fn stool(&mut self, place: Pose2) {
        let paint = Paint::Fabric { color: self.choose(&CLOTHS) };
        self.pillar(place, (0.0, 0.0), 0.0, (0.18, 0.45), paint);
    }

    /// A pot with a round bush.
    pub(super) fn plant(&mut self, place: Pose2) {
        self.pillar(place, (0.0, 0.0), 0.0, (0.18, 0.36), Paint::Metal { color: [164, 92, 60] });
        self.pillar(place, (0.0, 0.0), 0.36, (0.04, 0.3), Paint::Metal { color: [84, 62, 44] });
        self.pillar(place, (0.0, 0.0), 0.66, (0.26, 0.55), Paint::Fabric { color: [62, 112, 58] });
    }
}
