//! Exact conversion between stamps and decimal text in seconds.

use crate::excerpt::excerpt;
use trundle_core::{Invalid, Stamp};

/// A stamp from decimal text in seconds, exact: `1305031229.528748`, `-0.5`, `1.305031229528748e9`.
///
/// The text is not converted to f64, so every digit down to the nanosecond is preserved; finer digits are rounded half up.
///
/// # Errors
/// When the text is not a decimal number or is more than 292 years from the epoch.
pub fn parse_stamp(text: &str) -> Result<Stamp, Invalid> {
    parse_scaled_stamp(text, 0)
}

/// A stamp from decimal text in units of `10^-decimals` s, exact.
pub(crate) fn parse_scaled_stamp(text: &str, decimals: i64) -> Result<Stamp, Invalid> {
    let invalid = |expected| Invalid::new("timestamp", format!("'{}'", excerpt(text)), "", expected);
    let (negative, digits, exponent) = decimal(text).ok_or_else(|| invalid("a decimal number of seconds"))?;
    let nanos = nanoseconds(&digits, exponent - decimals)
        .ok_or_else(|| invalid("a time within 292 years of the epoch"))?;
    Ok(Stamp::from_nanos(if negative { -nanos } else { nanos }))
}

/// Sign, digits and power of ten: the number is `0.DIGITS * 10^power`.
fn decimal(text: &str) -> Option<(bool, Vec<u8>, i64)> {
    let (negative, rest) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    let (mantissa, exponent) = match rest.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (rest, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: Vec<u8> = whole.bytes().chain(fraction.bytes()).collect();
    let decimal = !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
    decimal.then(|| (negative, digits, whole.len() as i64 + i64::from(exponent)))
}

/// `0.DIGITS * 10^power` seconds in nanoseconds; `None` beyond i64.
fn nanoseconds(digits: &[u8], power: i64) -> Option<i64> {
    let leading = digits.iter().take_while(|&&digit| digit == b'0').count();
    let (digits, power) = (&digits[leading..], power - leading as i64 + 9);
    if digits.is_empty() || power < 0 {
        return Some(0);
    }
    let digit = |i: usize| digits.get(i).map_or(0, |digit| i64::from(digit - b'0'));
    let power = usize::try_from(power).ok().filter(|&power| power <= 19)?;
    let whole = (0..power).try_fold(0i64, |sum, i| sum.checked_mul(10)?.checked_add(digit(i)))?;
    whole.checked_add(i64::from(digit(power) >= 5))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn every_digit_survives() {
        for (text, nanos) in [
            ("1305031229.528748", 1_305_031_229_528_748_000),
            ("1305031229.5287481239", 1_305_031_229_528_748_124),
            ("1.305031102175804e+09", 1_305_031_102_175_804_000),
            ("-0.5", -500_000_000),
            ("+3", 3_000_000_000),
            (".25", 250_000_000),
            ("7.", 7_000_000_000),
            ("0.0000000004", 0),
            ("0.0000000005", 1),
            ("000000000000000000000001.5", 1_500_000_000),
            ("0e99", 0),
            ("1e-2147483648", 0),
            ("9223372036.854775807", i64::MAX),
        ] {
            assert_eq!(parse_stamp(text).unwrap().nanos, nanos, "{text}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        for text in
            ["", ".", "-", "e5", "1e", "1.2.3", "NaN", "inf", "0x10", "1_0", "٣", "1e10", "1e2147483647"]
        {
            assert!(parse_stamp(text).is_err(), "{text}");
        }
        let error = parse_stamp("9223372036.854775808").unwrap_err().to_string();
        assert!(error.contains("292 years"), "{error}");
    }

    proptest! {
        #[test]
        fn reads_what_display_writes(nanos in -i64::MAX..=i64::MAX) {
            let stamp = Stamp::from_nanos(nanos);
            prop_assert_eq!(parse_stamp(&stamp.to_string()).unwrap(), stamp);
        }

        #[test]
        fn never_panics(text in ".*") {
            let _ = parse_stamp(&text);
        }
    }
}
