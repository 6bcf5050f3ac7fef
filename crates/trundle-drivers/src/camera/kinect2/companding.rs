//! Measurements from their 11-bit codes.
//!
//! A code is a sign and a magnitude of 10 bits. Larger magnitudes are coarser: the step is 1 below 256 and doubles with every further 128
//! codes. This is the division into segments of \[G711\], A-law, with seven bits per segment. The code of minus zero marks a saturated
//! pixel. This code is an assumption; see [`super`].

/// Codes in one segment. Source: assumed, as in \[G711\].
const SEGMENT_CODES: u16 = 128;
/// Bit of the sign in a code. Source: assumed, as in \[G711\].
const SIGN_BIT: u16 = 1 << 10;
/// Number of codes. Source: the 11 bits of a code.
const CODE_COUNT: usize = 2048;
/// Measurement of a saturated pixel, which no code yields otherwise. Source: ours.
pub const SATURATED_MEASUREMENT: i16 = i16::MAX;

/// The measurement of each code.
#[derive(Debug, Clone)]
pub struct Companding {
    values: Box<[i16; CODE_COUNT]>,
}

impl Companding {
    /// The table of all codes.
    pub fn new() -> Self {
        Self { values: Box::new(std::array::from_fn(|code| measurement(code as u16))) }
    }

    /// The measurement of a code, -16320 to 16320, or [`SATURATED_MEASUREMENT`]. Bits above the eleventh are ignored.
    #[inline]
    pub fn measurement(&self, code: u16) -> i16 {
        self.values[code as usize % CODE_COUNT]
    }
}

impl Default for Companding {
    fn default() -> Self {
        Self::new()
    }
}

fn measurement(code: u16) -> i16 {
    if code == SIGN_BIT {
        return SATURATED_MEASUREMENT;
    }
    let magnitude = magnitude(code % SIGN_BIT);
    if code < SIGN_BIT { magnitude } else { -magnitude }
}

/// Two segments of step 1, then each with twice the previous step.
fn magnitude(code: u16) -> i16 {
    let (segment, within) = (code / SEGMENT_CODES, code % SEGMENT_CODES);
    let doublings = segment.saturating_sub(1);
    let start = if segment == 0 { 0 } else { SEGMENT_CODES << doublings };
    (start + (within << doublings)) as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnitudes_rise_without_a_gap_and_double_their_step() {
        let steps: Vec<i16> = (1..1024).map(|code| magnitude(code) - magnitude(code - 1)).collect();
        for (code, step) in steps.iter().enumerate() {
            let segment = code / 128;
            assert_eq!(*step, 1 << (segment.max(1) - 1), "from code {code}");
        }
        assert_eq!((magnitude(0), magnitude(255), magnitude(256), magnitude(1023)), (0, 255, 256, 16320));
    }

    #[test]
    fn signs_are_symmetric_and_minus_zero_is_saturated() {
        let table = Companding::new();
        assert!((1..1024).all(|code| table.measurement(code) == -table.measurement(code + 1024)));
        assert_eq!((table.measurement(0), table.measurement(1024)), (0, SATURATED_MEASUREMENT));
        assert_eq!(table.measurement(2048 + 5), 5, "upper bits are ignored");
    }
}
