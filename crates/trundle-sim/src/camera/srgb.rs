//! The transfer function of sRGB.

use std::sync::LazyLock;

/// A level of sRGB (IEC 61966-2-1) as linear light, white = 1.
pub(super) fn linear_from_srgb(level: u8) -> f32 {
    static TABLE: LazyLock<[f32; 256]> = LazyLock::new(|| {
        std::array::from_fn(|level| {
            let x = level as f64 / 255.0;
            let light = if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) };
            light as f32
        })
    });
    TABLE[usize::from(level)]
}

/// Linear light as a level of sRGB, 0 to 255, clipped, not rounded.
pub(super) fn srgb(light: f64) -> f64 {
    let x = light.clamp(0.0, 1.0);
    255.0 * if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_survives_the_way_to_light_and_back() {
        for level in 0..=255 {
            let back = srgb(f64::from(linear_from_srgb(level)));
            assert!((back - f64::from(level)).abs() < 1e-3, "{level}: {back}");
        }
        assert!(srgb(-1.0) == 0.0 && (srgb(2.0) - 255.0).abs() < 1e-9, "clipped");
    }
}
