//! Fast rounding of f32 to the nearest whole number.

/// 2^23: f32 has no digits behind the point from here on. Source: IEEE 754, 23 bits of fraction.
const FIRST_WHOLE_F32: f32 = 8_388_608.0;

/// The whole number nearest to `x`, 0 to 2^22 (ties to even), by an addition. A conversion would cost seven instructions for numbers
/// outside this range.
pub(super) fn nearest(x: f32) -> u32 {
    (x + FIRST_WHOLE_F32).to_bits() & 0x7F_FFFF
}

/// [`nearest`] as f32; beyond 2^22 `x` itself.
pub(super) fn nearest_f32(x: f32) -> f32 {
    if x < FIRST_WHOLE_F32 / 2.0 { (x + FIRST_WHOLE_F32) - FIRST_WHOLE_F32 } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_as_the_library_does() {
        for i in 0..400_000 {
            let x = i as f32 * 10.37;
            assert_eq!(nearest(x), x.round_ties_even() as u32, "{x}");
            assert_eq!(nearest_f32(x), x.round_ties_even());
        }
        assert_eq!(nearest_f32(5e6 + 0.5), 5e6 + 0.5);
    }
}
