//! Facts that the base reports on request: versions, unique id, gains.

use super::fields::Fields;
use std::fmt;

/// Factor from a gain to the protocol's whole number. Source: the protocol's "Set Controller Gain".
const GAIN_UNITS: f64 = 1000.0;

/// Version of hardware or firmware.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// Number of incompatible changes of the protocol.
    pub major: u8,
    /// Number of added features.
    pub minor: u8,
    /// Number of repaired faults.
    pub patch: u8,
}

impl Version {
    /// Version `major.minor.patch`.
    pub const fn new(major: u8, minor: u8, patch: u8) -> Self {
        Self { major, minor, patch }
    }

    /// Data of four bytes (patch, minor, major, unused). The first firmwares sent two: the digits of a decimal number, 104 for 1.0.4.
    pub(super) fn decode(data: &[u8]) -> Option<Self> {
        if let [patch, minor, major, ..] = *data {
            return Some(Self { major, minor, patch });
        }
        let digits = Fields(data).u16()?;
        let digit = |power: u16| (digits / power % 10) as u8;
        Some(Self { major: digit(100), minor: digit(10), patch: digit(1) })
    }

    pub(super) fn data(self) -> Vec<u8> {
        vec![self.patch, self.minor, self.major, 0]
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

/// Number that no other base has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct UniqueId(pub [u32; 3]);

impl UniqueId {
    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        Some(Self([data.u32()?, data.u32()?, data.u32()?]))
    }

    pub(super) fn data(self) -> Vec<u8> {
        self.0.iter().flat_map(|word| word.to_le_bytes()).collect()
    }
}

/// Three decimal numbers with hyphens between, as the vendor's tools print it.
impl fmt::Display for UniqueId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, second, third] = self.0;
        write!(f, "{first}-{second}-{third}")
    }
}

/// Gains of the wheels' speed controllers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains {
    /// Whether these gains hold; otherwise the factory's do.
    pub is_user: bool,
    /// Proportional gain, 0 or above, in steps of 0.001.
    pub p: f64,
    /// Integral gain, 0 or above, in steps of 0.001.
    pub i: f64,
    /// Derivative gain, 0 or above, in steps of 0.001.
    pub d: f64,
}

/// The factory's gains. Source: the protocol's "Set Controller Gain".
impl Default for Gains {
    fn default() -> Self {
        Self { is_user: false, p: 100.0, i: 0.1, d: 2.0 }
    }
}

impl Gains {
    pub(super) fn decode(mut data: Fields<'_>) -> Option<Self> {
        let is_user = data.u8()? != 0;
        let mut gain = || data.u32().map(|whole| f64::from(whole) / GAIN_UNITS);
        Some(Self { is_user, p: gain()?, i: gain()?, d: gain()? })
    }

    pub(super) fn data(self) -> Vec<u8> {
        let whole = |gain: f64| ((gain * GAIN_UNITS).round() as u32).to_le_bytes();
        let gains = [self.p, self.i, self.d].map(whole).concat();
        [vec![u8::from(self.is_user)], gains].concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_two_and_of_four_bytes_are_read() {
        assert_eq!(Version::decode(&[4, 0, 1, 0]), Some(Version::new(1, 0, 4)));
        assert_eq!(Version::decode(&[104, 0]), Some(Version::new(1, 0, 4)));
        assert_eq!(Version::decode(&[1]), None);
        assert!(Version::new(1, 1, 4) < Version::new(1, 2, 0));
        assert_eq!(Version::new(1, 2, 0).to_string(), "1.2.0");
    }

    #[test]
    fn the_unique_id_reads_as_the_vendor_prints_it() {
        let id = UniqueId([736_034_612, 892_621_875, 1_125_147_971]);
        assert_eq!(UniqueId::decode(Fields(&id.data())), Some(id));
        assert_eq!(id.to_string(), "736034612-892621875-1125147971");
    }

    #[test]
    fn gains_are_thousandths() {
        let gains = Gains { is_user: true, p: 80.5, i: 0.101, d: 0.0 };
        assert_eq!(gains.data(), [1, 0x74, 0x3A, 1, 0, 101, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(Gains::decode(Fields(&gains.data())), Some(gains));
    }
}
