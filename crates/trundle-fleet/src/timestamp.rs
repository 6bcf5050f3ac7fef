//! Times as text.

use std::time::{SystemTime, UNIX_EPOCH};

/// Seconds of a day. Source: SI.
const DAY_S: u64 = 86_400;
/// Days of 400 years, after which the calendar repeats. Source: the Gregorian calendar.
const DAYS_OF_ERA: u64 = 146_097;
/// Days from 1 March of year 0 to 1 January 1970. Source: the Gregorian calendar.
const EPOCH_DAYS: u64 = 719_468;

/// A time as ISO 8601 in UTC with milliseconds, as `2026-11-26T16:30:05.120Z`. A time before 1970 is 1970.
#[must_use]
pub fn utc_text(time: SystemTime) -> String {
    let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
    let (days, seconds) = (since.as_secs() / DAY_S, since.as_secs() % DAY_S);
    let (year, month, day) = date_of(days);
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{:03}Z", since.subsec_millis())
}

/// Year, month and day of a number of days since 1 January 1970. Years start on 1 March, which makes a leap day the last of its year.
fn date_of(days: u64) -> (u64, u64, u64) {
    let days = days + EPOCH_DAYS;
    let (era, day_of_era) = (days / DAYS_OF_ERA, days % DAYS_OF_ERA);
    let leap_days = day_of_era / 1_460 - day_of_era / 36_524 + day_of_era / (DAYS_OF_ERA - 1);
    let year_of_era = (day_of_era - leap_days) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    (era * 400 + year_of_era + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn times_are_those_of_the_calendar() {
        // Source: `date -u -d @SECONDS`.
        let known = [
            (0, "1970-01-01T00:00:00.000Z"),
            (951_782_400, "2000-02-29T00:00:00.000Z"),
            (1_709_251_199, "2024-02-29T23:59:59.000Z"),
            (4_107_542_400, "2100-03-01T00:00:00.000Z"),
        ];
        for (seconds, text) in known {
            assert_eq!(utc_text(UNIX_EPOCH + Duration::from_secs(seconds)), text);
        }
        assert_eq!(utc_text(UNIX_EPOCH + Duration::from_millis(1_120)), "1970-01-01T00:00:01.120Z");
    }
}
