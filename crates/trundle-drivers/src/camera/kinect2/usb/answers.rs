//! Short answers of the device.

/// Place of the main version among the versions. Source: \[Freenect2\].
const MAIN_VERSION: usize = 3;
/// Words of one version: major and minor, revision, build, unused. Source: \[Freenect2\].
const VERSION_WORDS: usize = 4;

/// The main version of the firmware, as 4.3.3912.0; `None` if the answer is too short.
pub fn firmware(data: &[u8]) -> Option<String> {
    let words = words(data);
    let version = words.chunks_exact(VERSION_WORDS).nth(MAIN_VERSION)?;
    let [both, revision, build, _] = *version.first_chunk()?;
    Some(format!("{}.{}.{revision}.{build}", both >> 16, both & 0xffff))
}

/// The serial number: characters of two bytes up to a zero. Characters that are not printable ASCII become `?`.
pub fn serial_number(data: &[u8]) -> String {
    let (pairs, _) = data.as_chunks::<2>();
    let codes = pairs.iter().map(|pair| u16::from_le_bytes(*pair)).take_while(|code| *code != 0);
    codes.map(|code| char::from_u32(code.into()).filter(char::is_ascii_graphic).unwrap_or('?')).collect()
}

/// Whether the sensor is ready; `None` if the answer is too short.
pub fn is_ready(data: &[u8]) -> Option<bool> {
    words(data).first().map(|word| word & 1 != 0)
}

fn words(data: &[u8]) -> Vec<u32> {
    data.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_main_version_is_the_fourth() {
        let mut data = vec![0; 48];
        data.extend([0x0004_0003_u32, 3912, 0, 0].iter().flat_map(|word| word.to_le_bytes()));
        assert_eq!(firmware(&data).as_deref(), Some("4.3.3912.0"));
        assert_eq!(firmware(&data[..63]), None);
    }

    #[test]
    fn the_serial_number_ends_at_a_zero() {
        let data: Vec<u8> = "0123\u{7}5\0junk".bytes().flat_map(|byte| [byte, 0]).collect();
        assert_eq!(serial_number(&data), "0123?5");
        assert_eq!(serial_number(&[]), "");
    }

    #[test]
    fn bit_0_of_the_status_is_ready() {
        assert_eq!(
            (is_ready(&[3, 0, 0, 0]), is_ready(&[2, 0, 0, 0]), is_ready(&[1])),
            (Some(true), Some(false), None)
        );
    }
}
