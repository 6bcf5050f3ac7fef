//! Rotated BRIEF descriptors.

use super::orientation::Direction;
use super::patch::{DISC_RADIUS_PX, PATCH_STRIDE, Patch};
use crate::Descriptor;

/// Brightness comparisons, a bit each. Source: \[Rublee11\].
const BRIGHTNESS_TESTS: usize = 256;

/// Rotated BRIEF: bit i is set if the first point of test i is darker than the second. The tests are rotated by the patch's direction
/// \[Rublee11, sec. 4.1\]. The patch must be smoothed.
pub(crate) fn describe(patch: &Patch, direction: Direction) -> Descriptor {
    let [first, second] = turned(direction);
    let value = |at: u32| patch[at as usize % (PATCH_STRIDE * PATCH_STRIDE)];
    let mut words = [0; 4];
    let (first, second) = (first.as_chunks::<64>().0, second.as_chunks::<64>().0);
    for (word, (first, second)) in words.iter_mut().zip(first.iter().zip(second)) {
        // From the last to the first, each pushing the others up: the cheapest way to bring bits together.
        for (a, b) in first.iter().zip(second).rev() {
            *word = *word << 1 | u64::from(value(*a) < value(*b));
        }
    }
    Descriptor(words)
}

/// Indices in a patch of both ends of every rotated test.
type Places = [[u32; BRIGHTNESS_TESTS]; 2];

fn turned(direction: Direction) -> Places {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { turned_by_avx2(direction) };
    }
    turned_plainly(direction)
}

/// The same as [`turned_plainly`], more numbers per instruction. No product and sum are fused, so the bits are equal.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn turned_by_avx2(direction: Direction) -> Places {
    turned_plainly(direction)
}

#[inline(always)]
fn turned_plainly(direction: Direction) -> Places {
    let mut places = [[0; BRIGHTNESS_TESTS]; 2];
    for (places, points) in places.iter_mut().zip(&PATTERN) {
        for ((at, x), y) in places.iter_mut().zip(&points.x).zip(&points.y) {
            let across = rounded_bits(direction.cos * x - direction.sin * y);
            let down = rounded_bits(direction.sin * x + direction.cos * y);
            *at = (down.wrapping_mul(PATCH_STRIDE as u32)).wrapping_add(across).wrapping_add(MIDDLE_INDEX);
        }
    }
    places
}

/// Index of the patch's middle, less what [`rounded_bits`] adds.
const MIDDLE_INDEX: u32 = ((DISC_RADIUS_PX * PATCH_STRIDE + DISC_RADIUS_PX) as u32)
    .wrapping_sub(ROUNDING_OFFSET.to_bits().wrapping_mul(PATCH_STRIDE as u32 + 1));
/// A sum with this number has no bits for a fraction: its last bits are the nearest whole number. Source: IEEE 754, 1.5 x 2^23.
const ROUNDING_OFFSET: f32 = 12_582_912.0;

/// The nearest whole number plus the bits of [`ROUNDING_OFFSET`], without a conversion that the compiler cannot vectorise.
fn rounded_bits(value: f32) -> u32 {
    (value + ROUNDING_OFFSET).to_bits()
}

/// Position of one end of every test, px from the middle.
struct Points {
    x: [f32; BRIGHTNESS_TESTS],
    y: [f32; BRIGHTNESS_TESTS],
}

/// Both ends of every test, from an isotropic normal distribution of variance S^2 / 25 for a patch of side S, the best one in \[Calonder10,
/// sec. 3.2\] (G II). Ours: from a fixed seed, not the learned table of \[Rublee11\].
static PATTERN: [Points; 2] = pattern();

/// Largest distance of a test point from the middle, px: the point is in the patch for every rotation. Source: ours.
const MAX_TEST_RADIUS_PX: f32 = DISC_RADIUS_PX as f32 - 0.5;
/// Standard deviation of the test points, px. Source: \[Calonder10\], S / 5.
const TEST_SIGMA_PX: f32 = (2 * DISC_RADIUS_PX + 1) as f32 / 5.0;

const fn pattern() -> [Points; 2] {
    let mut points = [const { Points { x: [0.0; BRIGHTNESS_TESTS], y: [0.0; BRIGHTNESS_TESTS] } }; 2];
    let mut state = 0x7472_756e_646c_6531; // "trundle1"
    let mut i = 0;
    while i < 2 * BRIGHTNESS_TESTS {
        let (x, y);
        (x, state) = normal(state);
        (y, state) = normal(state);
        if x * x + y * y <= MAX_TEST_RADIUS_PX * MAX_TEST_RADIUS_PX / (TEST_SIGMA_PX * TEST_SIGMA_PX) {
            points[i % 2].x[i / 2] = x * TEST_SIGMA_PX;
            points[i % 2].y[i / 2] = y * TEST_SIGMA_PX;
            i += 1;
        }
    }
    points
}

/// An approximately normal number, the sum of twelve uniform ones minus six; and the generator's next state.
const fn normal(mut state: u64) -> (f32, u64) {
    let (mut sum, mut i) = (0, 0);
    while i < 12 {
        let bits;
        (bits, state) = split_mix(state);
        sum += (bits >> 48) as i32;
        i += 1;
    }
    ((sum - 6 * 65536) as f32 / 65536.0, state)
}

/// SplitMix64 (Steele, Lea, Flood 2014).
const fn split_mix(state: u64) -> (u64, u64) {
    let state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31), state)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Hypotenuse;

    fn turned_by(degrees: f32) -> Direction {
        let angle = degrees.to_radians();
        Direction { angle, cos: angle.cos(), sin: angle.sin() }
    }

    #[test]
    fn the_pattern_is_normal_and_stays_in_the_patch() {
        let all: Vec<f32> = PATTERN.iter().flat_map(|p| p.x.iter().chain(&p.y)).copied().collect();
        let mean = all.iter().sum::<f32>() / all.len() as f32;
        let variance = all.iter().map(|v| (v - mean) * (v - mean)).sum::<f32>() / all.len() as f32;
        assert!(mean.abs() < 0.6, "{mean}");
        assert!((variance.sqrt() - TEST_SIGMA_PX).abs() < 0.9, "{}", variance.sqrt());
        for points in &PATTERN {
            assert!(
                points.x.iter().zip(&points.y).all(|(x, y)| x.hypotenuse(*y) < MAX_TEST_RADIUS_PX + 1e-3)
            );
        }
    }

    #[test]
    fn every_test_reads_its_pixel() {
        let patch: Patch = std::array::from_fn(|i| (i * 37 % 251) as u8);
        for degrees in [0.0, 33.0, -120.0] {
            let direction = turned_by(degrees);
            let descriptor = describe(&patch, direction);
            for test in 0..BRIGHTNESS_TESTS {
                let [a, b] = [0, 1].map(|end| {
                    let (x, y) = (PATTERN[end].x[test], PATTERN[end].y[test]);
                    let across =
                        (direction.cos * x - direction.sin * y).round_ties_even() + DISC_RADIUS_PX as f32;
                    let down =
                        (direction.sin * x + direction.cos * y).round_ties_even() + DISC_RADIUS_PX as f32;
                    patch[down as usize * PATCH_STRIDE + across as usize]
                });
                assert_eq!(
                    descriptor.0[test / 64] >> (test % 64) & 1 == 1,
                    a < b,
                    "test {test} at {degrees}"
                );
            }
        }
    }

    #[test]
    fn many_points_at_once_change_nothing() {
        for tenths in -1800..1800 {
            let direction = turned_by(tenths as f32 / 10.0);
            assert_eq!(turned(direction), turned_plainly(direction), "{tenths}");
        }
    }

    #[test]
    fn brightness_and_contrast_do_not_matter() {
        let patch: Patch = std::array::from_fn(|i| (i * 53 % 101) as u8);
        let brighter = patch.map(|v| v * 2 + 40);
        assert_eq!(describe(&patch, turned_by(20.0)), describe(&brighter, turned_by(20.0)));
    }
}
