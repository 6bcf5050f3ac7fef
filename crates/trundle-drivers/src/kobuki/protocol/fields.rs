//! A reader of little-endian numbers from the data of a sub-payload.

/// Little-endian numbers, taken one after the other. `None` if the data ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields<'a>(pub(super) &'a [u8]);

impl<'a> Fields<'a> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*taken)
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.take().map(u8::from_le_bytes)
    }

    pub(super) fn i8(&mut self) -> Option<i8> {
        self.take().map(i8::from_le_bytes)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub(super) fn i16(&mut self) -> Option<i16> {
        self.take().map(i16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }
}

/// Bits of a byte or word, the lowest first.
pub(super) fn bits<const N: usize>(word: u16) -> [bool; N] {
    std::array::from_fn(|i| word & (1 << i) != 0)
}

/// The word whose lowest bits are `bits`.
pub(super) fn word_of(bits: &[bool]) -> u16 {
    bits.iter().enumerate().map(|(i, bit)| u16::from(*bit) << i).sum()
}

/// The byte whose lowest bits are `bits`, at most eight.
pub(super) fn byte_of(bits: &[bool]) -> u8 {
    (word_of(bits) & 0xFF) as u8
}
