//! The orientation of a patch.

use super::patch::{DISC_RADIUS_PX, PATCH_STRIDE, Patch};
use std::num::Wrapping;
use trundle_core::angle_of_f32;

/// Direction of a patch: from its middle to its centre of mass \[Rosin99\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Direction {
    /// Rad, x right, y down.
    pub angle: f32,
    pub cos: f32,
    pub sin: f32,
}

/// The direction of the intensity centroid within the disc; along x if undefined.
pub(crate) fn direction(patch: &Patch) -> Direction {
    let (m10, m01) = moments(patch);
    let (x, y) = (m10 as f32, m01 as f32);
    let length = (x * x + y * y).sqrt();
    if length == 0.0 {
        return Direction { angle: 0.0, cos: 1.0, sin: 0.0 };
    }
    Direction { angle: angle_of_f32(x, y), cos: x / length, sin: y / length }
}

fn moments(patch: &Patch) -> (i32, i32) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { moments_by_avx2(patch) };
    }
    moments_plainly(patch)
}

/// The same as [`moments_plainly`], more numbers per instruction.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn moments_by_avx2(patch: &Patch) -> (i32, i32) {
    moments_plainly(patch)
}

/// m_10 and m_01: sums of x I(x, y) and y I(x, y) over the disc, from its middle \[Rublee11, eq. 1\]. Column by column, in 16 bits: a
/// column's sum is at most 31 * 255, and its sum of y I is at most (1 + ... + 15) * 255 in magnitude. No sum can overflow. `Wrapping` is
/// used because overflow checks would prevent vector code.
#[inline(always)]
fn moments_plainly(patch: &Patch) -> (i32, i32) {
    let (mut sums, mut downs) = ([Wrapping(0i16); PATCH_STRIDE], [Wrapping(0i16); PATCH_STRIDE]);
    for ((row, disc), y) in patch
        .as_chunks::<PATCH_STRIDE>()
        .0
        .iter()
        .zip(&DISC)
        .zip(-(DISC_RADIUS_PX as i16)..=DISC_RADIUS_PX as i16)
    {
        for x in 0..PATCH_STRIDE {
            let value = Wrapping(i16::from(row[x] & disc[x]));
            sums[x] += value;
            downs[x] += value * Wrapping(y);
        }
    }
    let m10 = sums.iter().zip(-(DISC_RADIUS_PX as i32)..).map(|(sum, x)| x * i32::from(sum.0)).sum();
    (m10, downs.iter().map(|down| i32::from(down.0)).sum())
}

/// All bits set within the disc, none outside.
static DISC: [[u8; PATCH_STRIDE]; PATCH_STRIDE] = disc();

const fn disc() -> [[u8; PATCH_STRIDE]; PATCH_STRIDE] {
    let mut disc = [[0; PATCH_STRIDE]; PATCH_STRIDE];
    let mut i = 0;
    while i < PATCH_STRIDE * PATCH_STRIDE {
        let (x, y) =
            ((i % PATCH_STRIDE).abs_diff(DISC_RADIUS_PX), (i / PATCH_STRIDE).abs_diff(DISC_RADIUS_PX));
        if x * x + y * y <= DISC_RADIUS_PX * DISC_RADIUS_PX {
            disc[i / PATCH_STRIDE][i % PATCH_STRIDE] = u8::MAX;
        }
        i += 1;
    }
    disc
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(value: impl Fn(f32, f32) -> f32) -> Patch {
        std::array::from_fn(|i| {
            let middle = DISC_RADIUS_PX as f32;
            value((i % PATCH_STRIDE) as f32 - middle, (i / PATCH_STRIDE) as f32 - middle) as u8
        })
    }

    #[test]
    fn a_ramp_points_uphill() {
        for degrees in (-175..180).step_by(10) {
            let (sin, cos) = (degrees as f32).to_radians().sin_cos();
            let found = direction(&patch(|x, y| 128.0 + 5.0 * (x * cos + y * sin)));
            assert!((found.angle.to_degrees() - degrees as f32).abs() < 0.5, "{degrees}: {found:?}");
            assert!((found.cos - cos).abs() < 0.01 && (found.sin - sin).abs() < 0.01);
        }
    }

    #[test]
    fn the_moments_are_the_sums_that_define_them() {
        for image in [patch(|x, y| x * y + 90.0), patch(|_, y| if y > 0.0 { 255.0 } else { 0.0 })] {
            let disc = || {
                let at = |i: usize| (i32::from(image[i]), i % PATCH_STRIDE, i / PATCH_STRIDE);
                let centred =
                    |(v, x, y)| (v, x as i32 - DISC_RADIUS_PX as i32, y as i32 - DISC_RADIUS_PX as i32);
                (0..image.len()).map(at).map(centred).filter(|(_, x, y)| x * x + y * y <= 225)
            };
            let expected = (disc().map(|(v, x, _)| v * x).sum(), disc().map(|(v, _, y)| v * y).sum());
            assert_eq!(moments(&image), expected);
            assert_eq!(moments_plainly(&image), expected);
        }
    }

    #[test]
    fn a_flat_patch_and_pixels_outside_the_disc_have_no_orientation() {
        let flat = Direction { angle: 0.0, cos: 1.0, sin: 0.0 };
        assert_eq!(direction(&patch(|_, _| 90.0)), flat);
        assert_eq!(direction(&patch(|x, y| if x * x + y * y > 225.0 { 9.0 + x } else { 50.0 })), flat);
    }
}
