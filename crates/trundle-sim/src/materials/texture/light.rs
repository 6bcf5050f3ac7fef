//! Fixed-point colour arithmetic for texture filtering.

/// A colour as three 8.8 fixed-point numbers in one word: red at bit 0, blue at 16, green at 32. Arithmetic processes all three together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Light(pub(super) u64);

impl Light {
    /// A mixture of two colours with `part` of 256 of the second.
    #[inline(always)]
    pub(crate) fn blend(self, other: Self, part: u32) -> Self {
        let part = u64::from(part);
        Self(self.rounded() * (256 - part) + other.rounded() * part)
    }

    /// Red, green, blue under `strength` of 256 of the light; at most white.
    #[inline(always)]
    pub(crate) fn dimmed(self, strength: u32) -> [u8; 3] {
        let rounded = self.rounded();
        if strength > 256 {
            let channel =
                |shift: u32| (((rounded >> shift & 0xFF) * u64::from(strength) + 0x80) >> 8).min(255) as u8;
            return [channel(0), channel(32), channel(16)];
        }
        let dimmed = rounded * u64::from(strength) + 0x80_0080_0080;
        [(dimmed >> 8) as u8, (dimmed >> 40) as u8, (dimmed >> 24) as u8]
    }

    /// Whole numbers in the three lanes.
    #[inline(always)]
    fn rounded(self) -> u64 {
        (self.0 + 0x80_0080_0080) >> 8 & 0xFF_00FF_00FF
    }
}

/// The bytes of a texel in the lanes of [`Light`].
#[inline(always)]
pub(super) fn spread(texel: u32) -> u64 {
    let texel = u64::from(texel);
    texel & 0xFF_00FF | (texel & 0xFF00) << 24
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_blend_and_are_lit_up_to_white() {
        let (red, blue) = (Light(spread(0x00_00FF) << 8), Light(spread(0xFF_0000) << 8));
        assert_eq!(red.blend(blue, 64).dimmed(256), [191, 0, 64]);
        let grey = Light(spread(0x20_4080) << 8);
        assert_eq!(grey.dimmed(128), [64, 32, 16]);
        assert_eq!(grey.dimmed(640), [255, 160, 80]);
    }
}
