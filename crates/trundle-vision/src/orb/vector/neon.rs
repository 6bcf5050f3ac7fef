//! Vectors of NEON, which every processor of the aarch64 family has.

use std::arch::aarch64::*;

/// Pixels of a block: as many as a register of NEON has bytes. Source: the processor's registers.
pub(crate) const BLOCK_PX: usize = 16;

/// A block of pixels, or of masks: bytes with all bits set or none.
#[derive(Clone, Copy)]
pub(crate) struct Bytes(uint8x16_t);

impl Bytes {
    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn load(from: &[u8; BLOCK_PX]) -> Self {
        Self(load_16(from))
    }

    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn store(self, to: &mut [u8; BLOCK_PX]) {
        // SAFETY: 16 bytes can be written, and need no alignment.
        unsafe { vst1q_u8(to.as_mut_ptr(), self.0) }
    }

    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn splat(value: u8) -> Self {
        Self(vdupq_n_u8(value))
    }

    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn min(self, other: Self) -> Self {
        Self(vminq_u8(self.0, other.0))
    }

    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn max(self, other: Self) -> Self {
        Self(vmaxq_u8(self.0, other.0))
    }

    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn saturating_sub(self, other: Self) -> Self {
        Self(vqsubq_u8(self.0, other.0))
    }

    /// The mask of bytes that are at least those of `other`.
    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn at_least(self, other: Self) -> Self {
        Self(vcgeq_u8(self.0, other.0))
    }

    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn and(self, other: Self) -> Self {
        Self(vandq_u8(self.0, other.0))
    }

    /// The bits that `other` does not have.
    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn and_not(self, other: Self) -> Self {
        Self(vbicq_u8(self.0, other.0))
    }

    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn is_zero(self) -> bool {
        vmaxvq_u32(vreinterpretq_u32_u8(self.0)) == 0
    }

    /// The rounded means of seven blocks. The weights, in 1/256, are those of the middle block and of the pairs around it. The seven
    /// weights add up to 256, so no sum exceeds 16 bits.
    #[inline]
    #[target_feature(enable = "neon")]
    pub(crate) fn mean_of_seven([a, b, c, d, e, f, g]: [Self; 7], weights: &[u8; 4]) -> Self {
        let [w0, w1, w2, w3] = weights.map(|weight| vdupq_n_u8(weight));
        let half = vget_low_u8(w0);
        let (mut low, mut high) = (vmull_u8(vget_low_u8(d.0), half), vmull_high_u8(d.0, w0));
        for (p, q, weight) in [(c, e, w1), (b, f, w2), (a, g, w3)] {
            for pixels in [p.0, q.0] {
                low = vmlal_u8(low, vget_low_u8(pixels), vget_low_u8(weight));
                high = vmlal_high_u8(high, pixels, weight);
            }
        }
        Self(vrshrn_high_n_u16::<8>(vrshrn_n_u16::<8>(low), high))
    }
}

/// Eight pixels interpolated within a row, four from either eight samples: `bytes` picks the pairs of samples, `weights` are theirs,
/// words in 1/256. The sums of products are rounded to 1/2^15.
#[inline]
#[target_feature(enable = "neon")]
pub(crate) fn shrink_8(samples: [&[i16; 8]; 2], bytes: [&[u8; 16]; 2], weights: [&[u8; 16]; 2]) -> [u8; 8] {
    let [first, last] = [0, 1].map(|k| {
        let pairs = vreinterpretq_s16_u8(vqtbl1q_u8(load_words(samples[k]), load_16(bytes[k])));
        let weights = vreinterpretq_s16_u8(load_16(weights[k]));
        let products =
            (vmull_s16(vget_low_s16(pairs), vget_low_s16(weights)), vmull_high_s16(pairs, weights));
        vrshrn_n_s32::<15>(vpaddq_s32(products.0, products.1))
    });
    let pixels = vreinterpret_u64_u8(vmovn_u16(vreinterpretq_u16_s16(vcombine_s16(first, last))));
    vget_lane_u64::<0>(pixels).to_le_bytes()
}

#[inline]
#[target_feature(enable = "neon")]
fn load_16(from: &[u8; 16]) -> uint8x16_t {
    // SAFETY: 16 bytes can be read, and need no alignment.
    unsafe { vld1q_u8(from.as_ptr()) }
}

#[inline]
#[target_feature(enable = "neon")]
fn load_words(from: &[i16; 8]) -> uint8x16_t {
    // SAFETY: 16 bytes can be read, and need no alignment.
    unsafe { vreinterpretq_u8_s16(vld1q_s16(from.as_ptr())) }
}
