//! Objects in warehouses, each placed by the pose of its middle on the floor.

use super::builder::Builder;
use crate::materials::{Finish, Paint};
use trundle_core::Pose2;

/// Colours of packed goods: this number of paintings per size, for any number of pallets.
const GOODS: [[u8; 3]; 6] =
    [[182, 140, 92], [166, 122, 76], [196, 160, 112], [120, 134, 150], [214, 210, 200], [96, 122, 104]];

/// Height of an empty pallet, m. Source: EN 13698-1, the Euro pallet.
pub(super) const PALLET_HEIGHT_M: f64 = 0.144;

impl Builder {
    /// An empty pallet of (x, y) m: boards over three skids along x.
    pub(super) fn pallet(&mut self, place: Pose2, (x, y): (f64, f64), bottom: f64) {
        let wood = Finish::all(Paint::Boards { color: [188, 152, 104] }).seeded(1);
        for offset in [-1.0, 0.0, 1.0] {
            let skid = [x, 0.1, PALLET_HEIGHT_M - 0.03];
            self.block(place, (0.0, offset * (y / 2.0 - 0.05)), bottom, skid, wood.clone());
        }
        self.block(place, (0.0, 0.0), bottom + PALLET_HEIGHT_M - 0.03, [x, y, 0.03], wood);
    }

    /// A pallet of `size` (x, y, height with its load, m).
    pub(super) fn loaded_pallet(&mut self, place: Pose2, [x, y, height]: [f64; 3]) {
        self.pallet(place, (x, y), 0.0);
        if height > PALLET_HEIGHT_M + 0.01 {
            self.goods(place, (0.0, 0.0), PALLET_HEIGHT_M, [x - 0.06, y - 0.06, height - PALLET_HEIGHT_M]);
        }
    }

    /// A stack of goods at `offset` from `place`, `size` m, with one of a few textures.
    pub(super) fn goods(&mut self, place: Pose2, offset: (f64, f64), bottom: f64, size: [f64; 3]) {
        let look = self.choose(&[0, 1, 2, 3, 4, 5]);
        let color = self.tint.unwrap_or(GOODS[look]);
        self.block(
            place,
            offset,
            bottom,
            size,
            Finish::all(Paint::Goods { color }).seeded(100 + look as u64),
        );
    }

    /// A steel drum.
    pub(super) fn drum(&mut self, place: Pose2, bottom: f64) {
        let color = self.choose(&[[38, 78, 140], [150, 40, 34], [58, 104, 72]]);
        self.pillar(place, (0.0, 0.0), bottom, (0.29, 0.88), Paint::Metal { color });
    }

    /// A post that guards a corner.
    pub(super) fn guard(&mut self, place: Pose2) {
        self.pillar(place, (0.0, 0.0), 0.0, (0.06, 0.5), Paint::Metal { color: [224, 180, 40] });
    }
}
