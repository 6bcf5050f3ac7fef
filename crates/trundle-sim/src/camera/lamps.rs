//! Light on a surface by Lambert's law, in f32.

use super::rays::dot;
use crate::world::Lights;

/// [`Lights`] with directions of unit length, f32.
pub(super) struct Lamps {
    ambient: f32,
    /// Directions times strengths.
    lamps: Vec<[f32; 3]>,
}

impl Lamps {
    pub(super) fn new(lights: &Lights) -> Self {
        let lamps = lights.lamps.iter().map(|lamp| {
            let length = lamp.direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            lamp.direction.map(|x| (lamp.strength * x / length) as f32)
        });
        Self { ambient: lights.ambient as f32, lamps: lamps.collect() }
    }

    /// Light on a surface with this normal, of 256 (Lambert's law).
    #[inline(always)]
    pub(super) fn on(&self, normal: [f32; 3]) -> u32 {
        let mut light = self.ambient;
        for lamp in &self.lamps {
            let part = dot(*lamp, normal);
            light += if part > 0.0 { part } else { 0.0 };
        }
        (light * 256.0) as i32 as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_follows_lamberts_law() {
        let lamps = Lamps::new(&Lights::default());
        assert_eq!(lamps.on([0.0, 0.0, -1.0]), (0.64 * 256.0) as u32);
        let up = 0.64 + 0.24 * 0.84 / (0.31_f64.powi(2) + 0.45_f64.powi(2) + 0.84_f64.powi(2)).sqrt();
        let other = 0.12 * 0.59 / (0.62_f64.powi(2) + 0.52_f64.powi(2) + 0.59_f64.powi(2)).sqrt();
        assert_eq!(lamps.on([0.0, 0.0, 1.0]), ((up + other) * 256.0) as u32);
    }
}
