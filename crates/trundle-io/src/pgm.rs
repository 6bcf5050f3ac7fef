//! Parser of PGM pictures, the cells of a map_server map.

use crate::excerpt::excerpt;

/// Maximum number of pixels of a map: 2^28, 819 m a side at 5 cm. Source: ours.
pub(crate) const MAX_PIXELS: usize = 1 << 28;

/// A grey picture, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pgm {
    pub width: usize,
    pub height: usize,
    /// White, 1 to 65,535.
    pub maxval: u16,
    pub values: Vec<u16>,
}

impl Pgm {
    /// A PGM of Netpbm: `P5` (binary, 8 or 16 bits) or `P2` (text), comments from `#` to the end of their line. Only blanks may follow the
    /// pixels.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        let mut scan = Scanner { bytes, at: 2 };
        let binary = match bytes.get(..2) {
            Some(b"P5") => true,
            Some(b"P2") => false,
            _ => return Err("not a PGM picture: it starts with neither P5 nor P2".to_owned()),
        };
        let (width, height) = scan.size()?;
        let maxval = scan.number("maxval")?;
        let pixels = width.checked_mul(height).filter(|pixels| (1..=MAX_PIXELS).contains(pixels));
        let pixels = pixels
            .ok_or_else(|| format!("size is {width} x {height} px, expected 1 to {MAX_PIXELS} px in all"))?;
        let maxval = u16::try_from(maxval).ok().filter(|&maxval| maxval > 0);
        let maxval = maxval.ok_or_else(|| "maxval is not in 1 to 65535".to_owned())?;
        let values = if binary { scan.binary(pixels, maxval) } else { scan.text(pixels) }?;
        match values.iter().position(|&value| value > maxval) {
            Some(i) => Err(format!("pixel {i} is {}, expected 0 to maxval {maxval}", values[i])),
            None => Ok(Self { width, height, maxval, values }),
        }
    }

    /// Width and height that the header claims.
    pub fn size(bytes: &[u8]) -> Result<(usize, usize), String> {
        Scanner { bytes, at: 2 }.size()
    }
}

struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Scanner<'a> {
    /// The next word, after blanks and comments; empty at the end.
    fn word(&mut self) -> &'a [u8] {
        let rest = |at: usize| self.bytes.get(at..).unwrap_or_default();
        loop {
            self.at += rest(self.at).iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            if rest(self.at).first() != Some(&b'#') {
                break;
            }
            self.at += rest(self.at).iter().take_while(|&&byte| byte != b'\n').count();
        }
        let word = rest(self.at);
        let len = word.iter().take_while(|&&byte| !byte.is_ascii_whitespace() && byte != b'#').count();
        self.at += len;
        &word[..len]
    }

    fn size(&mut self) -> Result<(usize, usize), String> {
        Ok((self.number("width")?, self.number("height")?))
    }

    fn number(&mut self, name: &str) -> Result<usize, String> {
        let word = String::from_utf8_lossy(self.word());
        if word.is_empty() {
            return Err(format!("the file ends before its {name}"));
        }
        word.parse().map_err(|_| format!("{name} is '{}', expected a whole number", excerpt(&word)))
    }

    /// Pixels behind the header; two bytes each, high first, when `maxval` is above 255.
    fn binary(&self, pixels: usize, maxval: u16) -> Result<Vec<u16>, String> {
        let size = if maxval > 255 { 2 } else { 1 };
        let data = self.behind_header(pixels * size);
        let Some((data, rest)) = data.split_at_checked(pixels * size) else {
            return Err(format!("truncated: {} of {} bytes of pixels", data.len(), pixels * size));
        };
        require_blank(rest)?;
        Ok(match size {
            1 => data.iter().map(|&byte| u16::from(byte)).collect(),
            _ => data.as_chunks::<2>().0.iter().map(|&pair| u16::from_be_bytes(pair)).collect(),
        })
    }

    /// The bytes after the blank that ends the header. `\r\n` counts as one blank if `needed` bytes of pixels follow.
    fn behind_header(&self, needed: usize) -> &'a [u8] {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        match rest.strip_prefix(b"\r\n") {
            Some(behind) if behind.len() >= needed => behind,
            _ => rest.get(1..).unwrap_or_default(),
        }
    }

    fn text(&mut self, pixels: usize) -> Result<Vec<u16>, String> {
        let max = self.bytes.len() / 2 + 1; // a digit and a blank each
        let mut values = Vec::with_capacity(pixels.min(max));
        for i in 0..pixels {
            let word = self.word();
            if word.is_empty() {
                return Err(format!("truncated: {i} of {pixels} pixels"));
            }
            let value = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
            let word = String::from_utf8_lossy(word);
            values
                .push(value.ok_or_else(|| format!("pixel {i} is '{}', expected a number", excerpt(&word)))?);
        }
        require_blank(if self.word().is_empty() { &[] } else { &self.bytes[self.at - 1..] })?;
        Ok(values)
    }
}

/// Refuses content after the last pixel.
fn require_blank(rest: &[u8]) -> Result<(), String> {
    if rest.iter().all(u8::is_ascii_whitespace) {
        return Ok(());
    }
    let problem = "more bytes follow the last pixel, expected the end of the file: the size in its header is wrong, or it holds several pictures; save one";
    Err(problem.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn parse(bytes: &[u8]) -> Result<Pgm, String> {
        Pgm::parse(bytes)
    }

    #[test]
    fn text_binary_and_sixteen_bits_are_the_same_picture() {
        let text = parse(b"P2\n# a comment\n3 2 # another\n255\n0 205 254\n1 2 3\n").unwrap();
        assert_eq!((text.width, text.height, text.maxval), (3, 2, 255));
        assert_eq!(text.values, [0, 205, 254, 1, 2, 3]);
        assert_eq!(parse(b"P5 3 2 255\n\x00\xcd\xfe\x01\x02\x03").unwrap(), text);
        let wide = parse(b"P5\n2 1\n1000\n\x03\xe8\x00\x05").unwrap();
        assert_eq!((wide.maxval, wide.values), (1000, vec![1000, 5]));
        assert_eq!(parse(b"P5 1 1 255\n#").unwrap().values, [35]);
    }

    #[test]
    fn errors_say_what_is_wrong() {
        for (bytes, problem) in [
            (&b"P6 1 1 255\n..."[..], "not a PGM picture: it starts with neither P5 nor P2"),
            (b"", "not a PGM picture: it starts with neither P5 nor P2"),
            (b"P5 3", "the file ends before its height"),
            (b"P5 3 x 255\n", "height is 'x', expected a whole number"),
            (b"P5 0 4 255\n", "size is 0 x 4 px, expected 1 to 268435456 px in all"),
            (b"P5 99999 99999 255\n", "size is 99999 x 99999 px, expected 1 to 268435456 px in all"),
            (b"P5 2 2 70000\n", "maxval is not in 1 to 65535"),
            (b"P5 2 2 255\nabc", "truncated: 3 of 4 bytes of pixels"),
            (b"P2 2 2 255\n1 2 3", "truncated: 3 of 4 pixels"),
            (b"P2 2 1 9\n1 10", "pixel 1 is 10, expected 0 to maxval 9"),
            (b"P2 2 1 9\n1 -1", "pixel 1 is '-1', expected a number"),
        ] {
            assert_eq!(parse(bytes).unwrap_err(), problem);
        }
    }

    #[test]
    fn lines_of_a_header_may_end_in_two_bytes() {
        assert_eq!(parse(b"P5\r\n2 1\r\n255\r\n\x07\x08").unwrap().values, [7, 8]);
        assert_eq!(parse(b"P5\r\n2 1\r\n255\r\n\x07\x08\n").unwrap().values, [7, 8]);
        assert_eq!(parse(b"P5\r\n1 1\r\n1000\r\n\x03\xe8").unwrap().values, [1000]);
        assert_eq!(parse(b"P5 2 1 255\r\n\x08").unwrap().values, [10, 8], "the first pixel is 10");
    }

    #[test]
    fn pixels_beyond_the_size_are_refused() {
        for bytes in [&b"P5 1 1 255\n\x07\x08"[..], b"P2 1 1 255\n7 8", b"P5 1 1 9\n\x07P5 1 1 9\n\x07"] {
            assert!(parse(bytes).unwrap_err().contains("or it holds several pictures"));
        }
        assert!(parse(b"P5 1 1 255\n\x07\n").is_ok() && parse(b"P2 1 1 255\n7 # end\n").is_ok());
    }

    proptest! {
        #[test]
        fn any_bytes_do_not_panic(head in "P[25][ \n#0-9]{0,20}", tail in prop::collection::vec(any::<u8>(), 0..40)) {
            let _ = parse(&[head.as_bytes(), &tail].concat());
        }
    }
}
