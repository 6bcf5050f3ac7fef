//! RGB from YUV by ITU-R BT.601, limited range.
//!
//! Y' runs from 16 to 235, Cb and Cr from 16 to 240 (\[BT601\]). The inverse is
//! R = 255/219 (Y - 16) + 255/112 (1 - Kr) (Cr - 128), and so on, with Kr = 0.299 and Kb = 0.114.
//! The weights are held in 16 bits after the point: the result is at most 1 off the rounded exact value.

/// Bits after the binary point of the weights. Source: ours.
const FRACTION_BITS: i32 = 16;
/// Half of the last digit, for rounding.
const ROUNDING_HALF: i32 = 1 << (FRACTION_BITS - 1);
/// Weight of Y' - 16: 255/219, times 2^16. Source: \[BT601\].
const LUMA_WEIGHT: i32 = 76_309;
/// Weight of Cr - 128 in red: 255/112 (1 - 0.299), times 2^16. Source: ITU-R BT.601-7.
const RED_FROM_CR: i32 = 104_597;
/// Weight of Cb - 128 in green: 255/112 (1 - 0.114) 0.114 / 0.587, times 2^16. Source: ITU-R BT.601-7.
const GREEN_FROM_CB: i32 = 25_675;
/// Weight of Cr - 128 in green: 255/112 (1 - 0.299) 0.299 / 0.587, times 2^16. Source: ITU-R BT.601-7.
const GREEN_FROM_CR: i32 = 53_279;
/// Weight of Cb - 128 in blue: 255/112 (1 - 0.114), times 2^16. Source: ITU-R BT.601-7.
const BLUE_FROM_CB: i32 = 132_201;

/// Red, green and blue of a pixel of luma `y` and chroma `u` (Cb) and `v` (Cr).
#[inline]
pub fn rgb_from_yuv(y: u8, u: u8, v: u8) -> [u8; 3] {
    let luma = LUMA_WEIGHT * (y as i32 - 16) + ROUNDING_HALF;
    let (u, v) = (u as i32 - 128, v as i32 - 128);
    let byte = |value: i32| (value >> FRACTION_BITS).clamp(0, 255) as u8;
    [
        byte(luma + RED_FROM_CR * v),
        byte(luma - GREEN_FROM_CB * u - GREEN_FROM_CR * v),
        byte(luma + BLUE_FROM_CB * u),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(y: u8, u: u8, v: u8) -> [f64; 3] {
        let (y, u, v) = ((y as f64 - 16.0) * 255.0 / 219.0, u as f64 - 128.0, v as f64 - 128.0);
        let (kr, kb) = (0.299, 0.114);
        let (cr, cb) = (255.0 / 112.0 * (1.0 - kr) * v, 255.0 / 112.0 * (1.0 - kb) * u);
        let green = y - (kr * cr + kb * cb) / (1.0 - kr - kb);
        [y + cr, green, y + cb].map(|value| value.clamp(0.0, 255.0))
    }

    #[test]
    fn every_colour_is_the_rounded_formula() {
        for (y, u, v) in (0..=255).flat_map(|y| (0..=255).step_by(3).map(move |u| (y, u, 255 - u / 2))) {
            for v in [v, u, 0, 128, 255] {
                let (found, exact) = (rgb_from_yuv(y, u, v), exact(y, u, v));
                for channel in 0..3 {
                    let error = (found[channel] as f64 - exact[channel]).abs();
                    assert!(error < 0.51, "{y} {u} {v}: {found:?} {exact:?}");
                }
            }
        }
    }

    #[test]
    fn black_white_and_primaries() {
        assert_eq!(rgb_from_yuv(16, 128, 128), [0, 0, 0]);
        assert_eq!(rgb_from_yuv(235, 128, 128), [255, 255, 255]);
        assert_eq!(rgb_from_yuv(81, 90, 240), [254, 0, 0]);
    }
}
