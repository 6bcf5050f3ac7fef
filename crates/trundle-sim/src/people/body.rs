//! Body measures of a person, as cylinders.

use crate::materials::{Finish, Paint};
use crate::world::{Cylinder, HeightBand, Obstacles, Shape, Solid, World};
use trundle_core::{Invalid, Vector3};

/// Heights of the joints of a leg of three upright pieces, m: below and above the knee of a person of 1.75 m. Source: Drillis and Contini
/// 1966, knee at 0.285 and hip at 0.53 of the height.
const CALF_HEIGHT_M: f64 = 0.32;
const LAP_HEIGHT_M: f64 = 0.62;
const HIP_HEIGHT_M: f64 = 0.92;

/// Radii of shin, knee, thigh, trunk and head, m. Source: ours.
const SHIN_RADIUS_M: f64 = 0.055;
const KNEE_RADIUS_M: f64 = 0.065;
const THIGH_RADIUS_M: f64 = 0.08;
const TRUNK_RADIUS_M: f64 = 0.16;
const HEAD_RADIUS_M: f64 = 0.095;

/// Top of trunk and head, m. Source: ours.
const SHOULDER_HEIGHT_M: f64 = 1.48;
const CROWN_HEIGHT_M: f64 = 1.75;

/// Clothes of people: trousers and jumper, sRGB. Source: ours.
const CLOTHES: [([u8; 3], [u8; 3]); 4] = [
    ([52, 62, 92], [168, 64, 56]),
    ([70, 66, 60], [72, 120, 156]),
    ([44, 46, 50], [196, 170, 92]),
    ([98, 88, 72], [92, 128, 84]),
];

/// Colour of face and hands, sRGB. Source: ours.
const SKIN: [u8; 3] = [206, 164, 134];

/// The parts of a person, upright cylinders around their own origin; the pieces of a leg are one part for both legs.
#[derive(Debug)]
pub(super) struct Body {
    pub(super) shin: Part,
    pub(super) knee: Part,
    pub(super) thigh: Part,
    pub(super) trunk: Part,
}

/// A part that moves as one.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) world: World,
    /// Part of the body that the robot can touch.
    pub(super) obstacles: Obstacles,
}

impl Body {
    /// The body of person number `index`, for a robot of this height band.
    ///
    /// # Errors
    /// Never: the sizes are constants.
    pub(super) fn new(index: usize, band: HeightBand) -> Result<Self, Invalid> {
        let (trousers, jumper) = CLOTHES[index % CLOTHES.len()];
        let cloth = |color| Paint::Fabric { color };
        let seed = index as u64 + 1;
        let part = |cylinders: Vec<Solid>| {
            let world = World::new(cylinders, seed)?;
            Ok::<_, Invalid>(Part { obstacles: world.obstacles(band), world })
        };
        Ok(Self {
            shin: part(vec![upright(0.0, CALF_HEIGHT_M, SHIN_RADIUS_M, cloth(trousers))])?,
            knee: part(vec![upright(CALF_HEIGHT_M, LAP_HEIGHT_M, KNEE_RADIUS_M, cloth(trousers))])?,
            thigh: part(vec![upright(LAP_HEIGHT_M, HIP_HEIGHT_M, THIGH_RADIUS_M, cloth(trousers))])?,
            trunk: part(vec![
                upright(HIP_HEIGHT_M, SHOULDER_HEIGHT_M, TRUNK_RADIUS_M, cloth(jumper)),
                upright(SHOULDER_HEIGHT_M, CROWN_HEIGHT_M, HEAD_RADIUS_M, Paint::Flat { color: SKIN }),
            ])?,
        })
    }

    /// Draws the textures.
    pub(super) fn prepare_textures(&self) {
        for part in [&self.shin, &self.knee, &self.thigh, &self.trunk] {
            part.world.prepare_textures();
        }
    }
}

fn upright(bottom: f64, top: f64, radius: f64, paint: Paint) -> Solid {
    let cylinder = Cylinder { base: Vector3::new(0.0, 0.0, bottom), radius, height: top - bottom };
    Solid { shape: Shape::Cylinder(cylinder), finish: Finish::all(paint) }
}
