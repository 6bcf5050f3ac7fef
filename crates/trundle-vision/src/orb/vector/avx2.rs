//! Vectors of AVX2. This part is for processors of the x86-64 family alone.

use std::arch::x86_64::*;

/// Pixels of a block: as many as a register of AVX2 has bytes. Source: the processor's registers.
pub(crate) const BLOCK_PX: usize = 32;

/// A block of pixels, or of masks: bytes with all bits set or none.
#[derive(Clone, Copy)]
pub(crate) struct Bytes(__m256i);

impl Bytes {
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn load(from: &[u8; BLOCK_PX]) -> Self {
        // SAFETY: 32 bytes can be read, and need no alignment.
        Self(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn store(self, to: &mut [u8; BLOCK_PX]) {
        // SAFETY: 32 bytes can be written, and need no alignment.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), self.0) }
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn splat(value: u8) -> Self {
        Self(_mm256_set1_epi8(value as i8))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn min(self, other: Self) -> Self {
        Self(_mm256_min_epu8(self.0, other.0))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn max(self, other: Self) -> Self {
        Self(_mm256_max_epu8(self.0, other.0))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn saturating_sub(self, other: Self) -> Self {
        Self(_mm256_subs_epu8(self.0, other.0))
    }

    /// The mask of bytes that are at least those of `other`.
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn at_least(self, other: Self) -> Self {
        Self(_mm256_cmpeq_epi8(_mm256_max_epu8(self.0, other.0), self.0))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn and(self, other: Self) -> Self {
        Self(_mm256_and_si256(self.0, other.0))
    }

    /// The bits that `other` does not have.
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn and_not(self, other: Self) -> Self {
        Self(_mm256_andnot_si256(other.0, self.0))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn is_zero(self) -> bool {
        _mm256_testz_si256(self.0, self.0) == 1
    }

    /// The rounded means of seven blocks. The weights, in 1/256, are those of the middle block and of the pairs around it; the seven
    /// weights add up to 256. No weight of a pair and no half of the middle one exceeds 127.
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn mean_of_seven([a, b, c, d, e, f, g]: [Self; 7], weights: &[u8; 4]) -> Self {
        let both = |weight: u8| _mm256_set1_epi8(weight as i8);
        // The middle is paired with twos: 64 of these give the half for rounding.
        let (twos, middle) = (both(2), _mm256_set1_epi16(64 << 8 | i16::from(weights[0])));
        let pairs = [
            (d.0, twos, middle),
            (c.0, e.0, both(weights[1])),
            (b.0, f.0, both(weights[2])),
            (a.0, g.0, both(weights[3])),
        ];
        // No sum of two products exceeds 15 bits, nor that of all 16.
        let (mut low, mut high) = (_mm256_setzero_si256(), _mm256_setzero_si256());
        for (p, q, weights) in pairs {
            low = _mm256_add_epi16(low, _mm256_maddubs_epi16(_mm256_unpacklo_epi8(p, q), weights));
            high = _mm256_add_epi16(high, _mm256_maddubs_epi16(_mm256_unpackhi_epi8(p, q), weights));
        }
        Self(_mm256_packus_epi16(_mm256_srli_epi16::<8>(low), _mm256_srli_epi16::<8>(high)))
    }
}

/// 16 pixels interpolated between two rows, in 1/128; `weight` is that of the lower row, in 1/256.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn mix_16(upper: &[u8; 16], lower: &[u8; 16], weight: u16, to: &mut [i16; 16]) {
    let (of_upper, of_lower) = (_mm256_set1_epi16((256 - weight) as i16), _mm256_set1_epi16(weight as i16));
    let (a, b) = (_mm256_cvtepu8_epi16(load_16(upper)), _mm256_cvtepu8_epi16(load_16(lower)));
    let sum = _mm256_add_epi16(_mm256_mullo_epi16(a, of_upper), _mm256_mullo_epi16(b, of_lower));
    // SAFETY: 32 bytes can be written, and need no alignment.
    unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm256_srli_epi16::<1>(sum)) }
}

/// Eight pixels interpolated within a row, four from either eight samples: `bytes` picks the pairs of samples, `weights` are theirs,
/// words in 1/256. The sums of products are rounded to 1/2^15.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn shrink_8(samples: [&[i16; 8]; 2], bytes: [&[u8; 16]; 2], weights: [&[u8; 16]; 2]) -> [u8; 8] {
    // The lowest byte of each sum, four to either half.
    let lowest = _mm256_set1_epi32(0x0c08_0400);
    let both = |[low, high]: [__m128i; 2]| _mm256_set_m128i(high, low);
    let weights = both([load_16(weights[0]), load_16(weights[1])]);
    let samples = both([load_words(samples[0]), load_words(samples[1])]);
    let pairs = _mm256_shuffle_epi8(samples, both([load_16(bytes[0]), load_16(bytes[1])]));
    let sums = _mm256_add_epi32(_mm256_madd_epi16(pairs, weights), _mm256_set1_epi32(1 << 14));
    let packed = _mm256_shuffle_epi8(_mm256_srli_epi32::<15>(sums), lowest);
    let [low, high] = [_mm256_extract_epi32::<0>(packed), _mm256_extract_epi32::<4>(packed)];
    (low as u32 as u64 | (high as u32 as u64) << 32).to_le_bytes()
}

#[inline]
#[target_feature(enable = "avx2")]
fn load_16(from: &[u8; 16]) -> __m128i {
    // SAFETY: 16 bytes can be read, and need no alignment.
    unsafe { _mm_loadu_si128(from.as_ptr().cast()) }
}

#[inline]
#[target_feature(enable = "avx2")]
fn load_words(from: &[i16; 8]) -> __m128i {
    // SAFETY: 16 bytes can be read, and need no alignment.
    unsafe { _mm_loadu_si128(from.as_ptr().cast()) }
}
