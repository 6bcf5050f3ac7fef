//! An object of a scene file: kind, pose, size and appearance.

use super::{MAX_COORDINATE_M, PaintName, PropKind, SceneError};
use crate::materials::Finish;
use crate::rng::hash;
use crate::scenes::builder::Builder;
use crate::world::Solid;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose2, require_finite, require_in};

/// Colour of a prop without a given colour. Source: ours.
const WOOD: [u8; 3] = [176, 128, 80];

/// A prop in a scene file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prop {
    /// The kind.
    pub kind: PropKind,
    /// Middle, world frame, m.
    pub x: f64,
    /// Middle, world frame, m.
    pub y: f64,
    /// Heading of its own x axis, degrees from the world's, counter-clockwise. Default 0.
    #[serde(default)]
    pub heading_deg: f64,
    /// Height of the lower side above the floor, m, 0 to 20. Default 0.
    #[serde(default)]
    pub bottom: f64,
    /// Size along its own x, y and z, m, 0.005 to 50 each; round props need equal x and y. Default: [`PropKind::default_size`].
    pub size: Option<[f64; 3]>,
    /// Colour of the main paint, sRGB. Default: by seed, or wood.
    pub color: Option<[u8; 3]>,
    /// Paint of a box or cylinder. Default veneer.
    pub paint: Option<PaintName>,
    /// Props of one kind, size and seed are exactly equal. Default: no two are.
    pub seed: Option<u64>,
}

impl Prop {
    /// Solids of the prop; `item` is its name in messages, `index` its index in the list.
    pub(super) fn solids(&self, item: &str, seed: u64, index: usize) -> Result<Vec<Solid>, SceneError> {
        self.check(item)?;
        let size = self.checked_size(item)?;
        let mut build = Builder::new(0);
        build.tint = self.color;
        build.lift = self.bottom;
        let place = Pose2::new(self.x, self.y, self.heading_deg.to_radians());
        let looks = self.seed.unwrap_or_else(|| hash(hash(seed, 0x9120_9120), index as u64));
        build.alike(looks, |build| self.place(build, place, size));
        Ok(build.solids)
    }

    fn check(&self, item: &str) -> Result<(), Invalid> {
        require_in(&format!("{item}.x"), self.x, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
        require_in(&format!("{item}.y"), self.y, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
        require_finite(&format!("{item}.heading_deg"), self.heading_deg, "deg")?;
        require_in(&format!("{item}.bottom"), self.bottom, "m", 0.0, 20.0)?;
        if self.paint.is_some() && !self.kind.takes_paint() {
            return Err(Invalid::new(format!("{item}.paint"), "given", "", "only on a box or a cylinder"));
        }
        Ok(())
    }

    fn checked_size(&self, item: &str) -> Result<[f64; 3], Invalid> {
        let size = self.size.unwrap_or_else(|| self.kind.default_size());
        for length in size {
            require_in(&format!("{item}.size"), length, "m", 0.005, 50.0)?;
        }
        if self.kind.is_round() && size[0] != size[1] {
            let expected = "x and y equal: it is round";
            return Err(Invalid::new(format!("{item}.size"), format!("{size:?}"), "m", expected));
        }
        Ok(size)
    }

    fn place(&self, build: &mut Builder, place: Pose2, size: [f64; 3]) {
        let paint = self.paint.unwrap_or_default().paint(self.color.unwrap_or(WOOD));
        let [x, _, height] = size;
        match self.kind {
            PropKind::Box => build.block(place, (0.0, 0.0), 0.0, size, Finish::all(paint)),
            PropKind::Cylinder => build.pillar(place, (0.0, 0.0), 0.0, (x / 2.0, height), paint),
            PropKind::Table => build.table(place, size),
            PropKind::Chair => build.chair(place, size),
            PropKind::Stool => build.sized_stool(place, (x / 2.0, height)),
            PropKind::Sofa => build.sofa(place, size),
            PropKind::Bed => build.bed(place, size),
            PropKind::Shelf => build.bookcase(place, size),
            PropKind::Cabinet => build.cabinet(place, size),
            PropKind::Carton => build.carton(place, size),
            PropKind::Bin => build.sized_bin(place, (x / 2.0, height)),
            PropKind::Plant => build.sized_plant(place, (x / 2.0, height)),
            PropKind::Pallet => build.loaded_pallet(place, size),
        }
    }
}
