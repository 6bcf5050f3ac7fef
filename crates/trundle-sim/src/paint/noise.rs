use std::sync::LazyLock;

/// A hash of a lattice point, in [0, 1). Integer mixing after the "lowbias32" finaliser (Wellons 2018).
pub(super) fn lattice(seed: u32, x: i32, y: i32) -> f32 {
    let mut h = seed ^ (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 16)).wrapping_mul(0x7FEB_352D);
    h = (h ^ (h >> 15)).wrapping_mul(0x846C_A68B);
    (h ^ (h >> 16)) as f32 * (1.0 / 4_294_967_808.0)
}

/// Side of the table of lattice values: value noise repeats after so many wavelengths.
const PERIOD: usize = 256;

/// Lattice values -128 to 127, drawn once: a look-up costs a third of a hash.
static VALUES: LazyLock<Vec<i8>> = LazyLock::new(|| {
    (0..PERIOD * PERIOD).map(|i| (lattice(0x5EED, i as i32, 0) * 256.0 - 128.0) as i8).collect()
});

/// Value noise of unit wavelength, in [-1, 1]: lattice values, smoothly between them; `seed` shifts the lattice.
pub(super) fn value(seed: u32, x: f32, y: f32) -> f32 {
    let (ix, iy) = (floor(x), floor(y));
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (tx, ty) = (smooth(x - ix as f32), smooth(y - iy as f32));
    let shift = seed.wrapping_mul(0x9E37_79B1);
    let (ix, iy) = ((ix as u32).wrapping_add(shift >> 8), (iy as u32).wrapping_add(shift >> 20));
    let mask = PERIOD as u32 - 1;
    let values = VALUES.as_slice();
    let row = |y: u32| {
        let at = |x: u32| f32::from(values[((y & mask) << 8 | x & mask) as usize]);
        at(ix) + (at(ix.wrapping_add(1)) - at(ix)) * tx
    };
    let (upper, lower) = (row(iy), row(iy.wrapping_add(1)));
    (upper + (lower - upper) * ty) * (1.0 / 128.0)
}

/// The whole number below, by a cast: `f32::floor` is a call where SSE 4.1 is not taken for granted.
pub(super) fn floor(x: f32) -> i32 {
    let toward_zero = x as i32;
    toward_zero - i32::from(x < toward_zero as f32)
}

/// Noise of several scales: `octaves` of value noise from `wavelength` (m) down by halves, each `gain` as strong as the one before.
pub(super) fn fractal(seed: u32, x: f32, y: f32, wavelength: f32, octaves: u32, gain: f32) -> f32 {
    let (mut sum, mut strength, mut frequency) = (0.0, 1.0, 1.0 / wavelength);
    for octave in 0..octaves {
        sum += strength * value(seed.wrapping_add(octave * 0x51_7CC1), x * frequency, y * frequency);
        strength *= gain;
        frequency *= 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn value_noise_is_bounded_continuous_and_seeded() {
        for i in 0..1000 {
            let (x, y) = (i as f32 * 0.137, i as f32 * -0.071);
            let here = value(3, x, y);
            assert!((-1.0..=1.0).contains(&here));
            assert!((here - value(3, x + 1e-3, y)).abs() < 0.01);
        }
        assert_ne!(value(3, 0.5, 0.5), value(4, 0.5, 0.5));
    }
}
