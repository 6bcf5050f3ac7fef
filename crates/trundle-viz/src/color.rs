//! Colours and the palette.

/// An sRGB colour with straight alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Color {
    /// Red, 0 to 255.
    pub r: u8,
    /// Green, 0 to 255.
    pub g: u8,
    /// Blue, 0 to 255.
    pub b: u8,
    /// Opacity, 0 to 255.
    pub a: u8,
}

/// The palette of Okabe and Ito (2008), which readers with any kind of colour vision can distinguish, and a few greys.
impl Color {
    /// Black.
    pub const BLACK: Self = Self::rgb(0x00_00_00);
    /// Orange.
    pub const ORANGE: Self = Self::rgb(0xe6_9f_00);
    /// Sky blue.
    pub const SKY: Self = Self::rgb(0x56_b4_e9);
    /// Bluish green.
    pub const GREEN: Self = Self::rgb(0x00_9e_73);
    /// Yellow.
    pub const YELLOW: Self = Self::rgb(0xf0_e4_42);
    /// Blue.
    pub const BLUE: Self = Self::rgb(0x00_72_b2);
    /// Vermillion.
    pub const VERMILLION: Self = Self::rgb(0xd5_5e_00);
    /// Reddish purple.
    pub const PURPLE: Self = Self::rgb(0xcc_79_a7);
    /// White.
    pub const WHITE: Self = Self::rgb(0xff_ff_ff);
    /// Text.
    pub(crate) const INK: Self = Self::rgb(0x22_26_2b);
    /// Axes and minor text.
    pub(crate) const FAINT_INK: Self = Self::rgb(0x6b_72_7a);
    /// Colour of unobtrusive lines.
    pub(crate) const HAIRLINE: Self = Self::rgb(0xe2_e5_e9);
    /// Free cells.
    pub(crate) const FREE: Self = Self::rgb(0xfd_fd_fb);
    /// Unknown cells.
    pub(crate) const UNKNOWN: Self = Self::rgb(0xbf_c4_ca);
    /// Occupied cells.
    pub(crate) const OCCUPIED: Self = Self::rgb(0x1d_21_26);

    /// The opaque colour `0xRRGGBB`.
    pub const fn rgb(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self { r, g, b, a: 255 }
    }

    /// The same colour, as opaque as `a` of 255.
    pub const fn alpha(self, a: u8) -> Self {
        Self { a, ..self }
    }

    /// This colour laid over an opaque one.
    pub(crate) fn over(self, below: [u8; 3]) -> [u8; 3] {
        let a = u32::from(self.a);
        let mix = |top: u8, low: u8| ((u32::from(top) * a + u32::from(low) * (255 - a) + 127) / 255) as u8;
        [mix(self.r, below[0]), mix(self.g, below[1]), mix(self.b, below[2])]
    }

    /// The colour in CSS notation.
    pub(crate) fn css(self) -> String {
        match self.a {
            255 => format!("#{:02x}{:02x}{:02x}", self.r, self.g, self.b),
            a => format!("#{:02x}{:02x}{:02x}{a:02x}", self.r, self.g, self.b),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blending_keeps_its_ends() {
        assert_eq!(Color::BLUE.over([9, 9, 9]), [0x00, 0x72, 0xb2]);
        assert_eq!(Color::BLUE.alpha(0).over([9, 8, 7]), [9, 8, 7]);
        assert_eq!(Color::WHITE.alpha(128).over([0, 0, 0]), [128; 3]);
        assert_eq!(Color::ORANGE.css(), "#e69f00");
        assert_eq!(Color::ORANGE.alpha(16).css(), "#e69f0010");
    }
}
