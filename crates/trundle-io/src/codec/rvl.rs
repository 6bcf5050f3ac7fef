//! Depth images in RVL: differences along the rows in groups of three bits, runs of zeros by their length. Source: \[Wilson17\].

use super::error::CodecError;
use trundle_core::Image;

/// Bytes of the width and the height in front of the stream. Source: `compressed_depth_image_transport`.
const SIZE_BYTES: usize = 8;
/// Largest number of pixels of an RVL image that is read: 8.4 Mpx, above 3840 x 2160. A run of zeros takes a few bytes at any length, so
/// the number of bytes is no bound. Source: ours.
const MAX_RVL_PIXELS: usize = 1 << 23;
/// Number of groups that a word of the stream holds. Source: \[Wilson17\].
const GROUPS_PER_WORD: u32 = 8;

/// Width and height (32 bits each, little endian) and the stream of the image.
pub(crate) fn encode_rvl(image: &Image<u16>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(SIZE_BYTES + image.data().len());
    bytes.extend((image.width() as u32).to_le_bytes());
    bytes.extend((image.height() as u32).to_le_bytes());
    let mut groups = GroupWriter { bytes, word: 0, count: 0 };
    let (mut rest, mut before) = (image.data(), 0_i32);
    while !rest.is_empty() {
        let zeros = rest.iter().take_while(|value| **value == 0).count();
        let readings = rest[zeros..].iter().take_while(|value| **value != 0).count();
        groups.write(zeros as u32);
        groups.write(readings as u32);
        for &value in &rest[zeros..zeros + readings] {
            let difference = i32::from(value) - before;
            groups.write(((difference << 1) ^ (difference >> 31)).cast_unsigned());
            before = i32::from(value);
        }
        rest = &rest[zeros + readings..];
    }
    groups.finish()
}

/// The image of width, height and stream.
///
/// # Errors
/// When the size is 0, too large for the bytes, or the stream ends early or does not fit the size.
pub(crate) fn decode_rvl(bytes: &[u8]) -> Result<Image<u16>, CodecError> {
    let failed = |problem: &str| CodecError::decode("depth", format!("RVL: {problem}"));
    let side = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let (width, height) = side(0).zip(side(4)).ok_or_else(|| failed("the size is cut"))?;
    if width.checked_mul(height).is_none_or(|pixels| !(1..=MAX_RVL_PIXELS).contains(&pixels)) {
        return Err(failed(&format!("{width} x {height} px, expected 1 to {MAX_RVL_PIXELS} px")));
    }
    let mut groups = GroupReader { bytes: &bytes[SIZE_BYTES..], word: 0, count: 0 };
    let mut values = Vec::with_capacity(width * height);
    let mut before = 0_i32;
    let mut empty_runs = 0;
    while values.len() < width * height {
        let left = width * height - values.len();
        let zeros = groups.read().ok_or_else(|| failed("the stream is cut"))? as usize;
        let readings = groups.read().ok_or_else(|| failed("the stream is cut"))? as usize;
        if zeros.checked_add(readings).is_none_or(|run| run > left) {
            return Err(failed("a run is longer than the image"));
        }
        empty_runs = if zeros + readings == 0 { empty_runs + 1 } else { 0 };
        if empty_runs > 1 {
            return Err(failed("runs without pixels"));
        }
        values.resize(values.len() + zeros, 0);
        for _ in 0..readings {
            let coded = groups.read().ok_or_else(|| failed("the stream is cut"))?;
            before = before.wrapping_add((coded >> 1).cast_signed() ^ -(coded & 1).cast_signed());
            values.push(u16::try_from(before).map_err(|_| failed("a value is beyond 16 bits"))?);
        }
    }
    Ok(Image::new(width, height, values)?)
}

/// Writes numbers as groups of three bits, low ones first; the fourth bit is set if another group follows.
struct GroupWriter {
    bytes: Vec<u8>,
    word: u32,
    count: u32,
}

impl GroupWriter {
    fn write(&mut self, mut value: u32) {
        loop {
            let rest = value >> 3;
            self.push((value & 7) | if rest == 0 { 0 } else { 8 });
            if rest == 0 {
                return;
            }
            value = rest;
        }
    }

    fn push(&mut self, group: u32) {
        self.word = self.word << 4 | group;
        self.count += 1;
        if self.count == GROUPS_PER_WORD {
            self.bytes.extend(self.word.to_le_bytes());
            (self.word, self.count) = (0, 0);
        }
    }

    fn finish(mut self) -> Vec<u8> {
        while self.count > 0 {
            self.push(0);
        }
        self.bytes
    }
}

/// Reads the bytes of [`GroupWriter`].
struct GroupReader<'a> {
    bytes: &'a [u8],
    word: u32,
    count: u32,
}

impl GroupReader<'_> {
    fn read(&mut self) -> Option<u32> {
        let (mut value, mut shift) = (0_u32, 0_u32);
        loop {
            let group = self.next_group()?;
            value |= (group & 7).checked_shl(shift)?;
            if group & 8 == 0 {
                return Some(value);
            }
            shift += 3;
        }
    }

    fn next_group(&mut self) -> Option<u32> {
        if self.count == 0 {
            let (word, rest) = self.bytes.split_first_chunk::<4>()?;
            (self.word, self.bytes, self.count) = (u32::from_le_bytes(*word), rest, GROUPS_PER_WORD);
        }
        let group = self.word >> 28;
        self.word <<= 4;
        self.count -= 1;
        Some(group)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_stream_by_hand() {
        // Two zeros, one reading 1000: difference 1000, coded 2000 = 0b11_111_010_000: groups 0, 2, 7, 3.
        let image = Image::new(3, 1, vec![0, 0, 1000]).unwrap();
        let bytes = encode_rvl(&image);
        assert_eq!(bytes[8..], 0x218a_f300_u32.to_le_bytes());
        assert_eq!(decode_rvl(&bytes).unwrap(), image);
    }

    #[test]
    fn a_broken_stream_is_refused_without_much_memory() {
        let bytes = encode_rvl(&Image::from_fn(20, 10, |x, y| (x * y) as u16));
        for end in 0..bytes.len() {
            assert!(decode_rvl(&bytes[..end]).is_err(), "{end} of {}", bytes.len());
        }
        let mut wide = bytes.clone();
        wide[..4].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(decode_rvl(&wide).unwrap_err().to_string().contains("expected 1 to"));
        let mut endless = bytes[..8].to_vec();
        endless.extend([0; 64]);
        assert!(decode_rvl(&endless).unwrap_err().to_string().contains("runs without pixels"));
    }

    proptest! {
        #[test]
        fn every_image_comes_back(
            width in 1_usize..20,
            values in prop::collection::vec(prop_oneof![Just(0_u16), any::<u16>(), 990..1010_u16], 1..300),
        ) {
            let height = values.len().div_ceil(width);
            let image = Image::from_fn(width, height, |x, y| values.get(y * width + x).copied().unwrap_or(0));
            prop_assert_eq!(decode_rvl(&encode_rvl(&image)).unwrap(), image);
        }

        #[test]
        fn any_bytes_do_not_panic(size in any::<[u8; 2]>(), bytes in prop::collection::vec(any::<u8>(), 0..80)) {
            let head = [size[0], 0, 0, 0, size[1], 0, 0, 0];
            let _ = decode_rvl(&[&head[..], &bytes].concat());
        }
    }
}
