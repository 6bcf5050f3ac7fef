/// A hash of a lattice point, in [0, 1). Integer mixing after the "lowbias32" finaliser (Wellons 2018).
pub(super) fn lattice(seed: u32, x: i32, y: i32) -> f32 {
    let mut h = seed ^ (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 16)).wrapping_mul(0x7FEB_352D);
    h = (h ^ (h >> 15)).wrapping_mul(0x846C_A68B);
    (h ^ (h >> 16)) as f32 * (1.0 / 4_294_967_808.0)
}

/// Value noise of unit wavelength, in [-1, 1]: lattice values, smoothly between them.
pub(super) fn value(seed: u32, x: f32, y: f32) -> f32 {
    let (fx, fy) = (x.floor(), y.floor());
    let (ix, iy) = (fx as i32, fy as i32);
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (tx, ty) = (smooth(x - fx), smooth(y - fy));
    let row = |y| {
        let left = lattice(seed, ix, y);
        left + (lattice(seed, ix + 1, y) - left) * tx
    };
    let (upper, lower) = (row(iy), row(iy + 1));
    (upper + (lower - upper) * ty) * 2.0 - 1.0
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
