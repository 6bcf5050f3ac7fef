//! Value noise for textures, deterministic from a seed.

use std::sync::LazyLock;

/// A hash of a lattice point, in [0, 1). Integer mixing after the "lowbias32" finaliser (Wellons 2018).
pub(super) fn lattice(seed: u32, x: i32, y: i32) -> f32 {
    let mut h = seed ^ (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 16)).wrapping_mul(0x7FEB_352D);
    h = (h ^ (h >> 15)).wrapping_mul(0x846C_A68B);
    (h ^ (h >> 16)) as f32 * (1.0 / 4_294_967_808.0)
}

/// Side of the table of lattice values: value noise repeats after that number of wavelengths. Source: ours.
const LATTICE_PERIOD: usize = 256;

/// Lattice values -128 to 127, drawn once: reading one costs a third of a hash.
static VALUES: LazyLock<Box<[i8; LATTICE_PERIOD * LATTICE_PERIOD]>> = LazyLock::new(|| {
    let mut values = Box::new([0; LATTICE_PERIOD * LATTICE_PERIOD]);
    for (i, value) in values.iter_mut().enumerate() {
        *value = (lattice(0x5EED, i as i32, 0) * 256.0 - 128.0) as i8;
    }
    values
});

/// The lattice value at (x, y) in the table, -128 to 127.
fn table(values: &[i8; LATTICE_PERIOD * LATTICE_PERIOD], x: u32, y: u32) -> f32 {
    let mask = LATTICE_PERIOD as u32 - 1;
    f32::from(values[((y & mask) << 8 | x & mask) as usize])
}

/// Offset of a seed's lattice in the table.
fn shift_of(seed: u32) -> (u32, u32) {
    let shift = seed.wrapping_mul(0x9E37_79B1);
    (shift >> 8, shift >> 20)
}

fn smooth(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t)
}

/// Value noise of unit wavelength, in [-1, 1]: lattice values, smoothly between them; `seed` shifts the lattice.
pub(super) fn value(seed: u32, x: f32, y: f32) -> f32 {
    let values: &[i8; LATTICE_PERIOD * LATTICE_PERIOD] = &VALUES;
    let (ix, iy) = (floor(x), floor(y));
    let (tx, ty) = (smooth(x - ix as f32), smooth(y - iy as f32));
    let shift = shift_of(seed);
    let (ix, iy) = ((ix as u32).wrapping_add(shift.0), (iy as u32).wrapping_add(shift.1));
    let row = |y: u32| {
        let left = table(values, ix, y);
        left + (table(values, ix.wrapping_add(1), y) - left) * tx
    };
    let (upper, lower) = (row(iy), row(iy.wrapping_add(1)));
    (upper + (lower - upper) * ty) * (1.0 / 128.0)
}

/// The next lower whole number, by a cast: without SSE 4.1 `f32::floor` is a function call.
pub(super) fn floor(x: f32) -> i32 {
    let toward_zero = x as i32;
    toward_zero - i32::from(x < toward_zero as f32)
}

/// Noise of several scales.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fractal {
    /// Wavelength of the coarsest octave, m; each further octave has half of the previous one.
    pub(super) wavelength: f32,
    pub(super) octaves: u32,
    /// Ratio of an octave's strength to that of the previous one.
    pub(super) gain: f32,
}

impl Fractal {
    /// (seed, strength, waves per metre) of every octave.
    fn scales(self, seed: u32) -> impl Iterator<Item = (u32, f32, f32)> {
        (0..self.octaves).map(move |octave| {
            let nth = octave as i32;
            let frequency = (1 << octave) as f32 / self.wavelength;
            (seed.wrapping_add(octave.wrapping_mul(0x51_7CC1)), self.gain.powi(nth), frequency)
        })
    }

    /// The noise at one point, m.
    pub(super) fn at(self, seed: u32, x: f32, y: f32) -> f32 {
        self.scales(seed).map(|(seed, strength, waves)| strength * value(seed, x * waves, y * waves)).sum()
    }

    /// The noise at `row.len()` points from (step / 2, y) on, `step` m apart. It costs a tenth of [`Fractal::at`], because lattice values
    /// are read once per wave.
    pub(super) fn fill_row(self, seed: u32, y: f32, step: f32, row: &mut [f32]) {
        row.fill(0.0);
        for (seed, strength, waves) in self.scales(seed) {
            add_octave_row(seed, strength / 128.0, y * waves, step * waves, row);
        }
    }
}

/// Adds value noise of unit wavelength at y and x = (i + 1/2) step.
fn add_octave_row(seed: u32, strength: f32, y: f32, step: f32, row: &mut [f32]) {
    let values: &[i8; LATTICE_PERIOD * LATTICE_PERIOD] = &VALUES;
    let iy = floor(y);
    let ty = smooth(y - iy as f32);
    let shift = shift_of(seed);
    let iy = (iy as u32).wrapping_add(shift.1);
    let on_lattice = |ix: u32| {
        let (upper, lower) = (table(values, ix, iy), table(values, ix, iy.wrapping_add(1)));
        strength * (upper + (lower - upper) * ty)
    };
    let (mut wave, mut done) = (0, 0);
    let mut right = on_lattice(shift.0);
    while done < row.len() {
        let left = right;
        right = on_lattice(shift.0.wrapping_add(wave + 1));
        let end = (((wave + 1) as f32 / step + 0.5) as usize).min(row.len());
        for (i, sum) in row.iter_mut().enumerate().take(end).skip(done) {
            let t = (i as f32 + 0.5) * step - wave as f32;
            *sum += left + (right - left) * smooth(t);
        }
        done = done.max(end);
        wave += 1;
    }
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

    #[test]
    fn a_row_at_once_is_point_by_point() {
        let noise = Fractal { wavelength: 0.64, octaves: 7, gain: 0.82 };
        let mut row = vec![0.0; 500];
        noise.fill_row(9, 1.234, 0.005, &mut row);
        for (i, sum) in row.iter().enumerate() {
            let point = noise.at(9, (i as f32 + 0.5) * 0.005, 1.234);
            assert!((sum - point).abs() < 2e-3, "{i}: {sum} {point}");
        }
    }
}
