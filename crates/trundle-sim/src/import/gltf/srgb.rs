//! The conversion of linear colours to sRGB.

/// A linear share of light, 0 to 1, as an sRGB level (IEC 61966-2-1).
pub(super) fn srgb(linear: f32) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let level = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (level * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_become_srgb() {
        assert_eq!([0.0, 0.5, 1.0, 7.0].map(srgb), [0, 188, 255, 255]);
    }
}
