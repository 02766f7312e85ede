//! Dates in output files: none by default, so that outputs are reproducible, unless the environment sets one.

use crate::error::{Input, Result};

/// Environment variable that sets the date of outputs (reproducible-builds.org) [s since 1970].
const VARIABLE: &str = "SOURCE_DATE_EPOCH";
/// First second of the year 10000.
const LIMIT: u64 = 253_402_300_800;

/// Returns the date to write, if the environment sets one.
///
/// # Errors
/// If the variable is not a valid time.
pub fn fixed() -> Result<Option<String>> {
    let Some(value) = std::env::var_os(VARIABLE) else { return Ok(None) };
    match value.to_string_lossy().parse() {
        Ok(seconds) if seconds < LIMIT => Ok(Some(spell(seconds))),
        _ => {
            let fault = Input::new(VARIABLE, "expected whole seconds since 1970");
            Err(fault.value(value.to_string_lossy()).into())
        }
    }
}

/// Formats a time since 1970 as ISO 8601 in UTC.
fn spell(seconds: u64) -> String {
    let (mut day, second) = (seconds / 86_400, seconds % 86_400);
    let leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut year = 1970;
    while day >= 365 + leap(year) as u64 {
        day -= 365 + leap(year) as u64;
        year += 1;
    }
    let february = 28 + leap(year) as u64;
    let mut month = 1;
    for days in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if day < days {
            break;
        }
        day -= days;
        month += 1;
    }
    let (hour, minute) = (second / 3600, second / 60 % 60);
    format!("{year:04}-{month:02}-{:02}T{hour:02}:{minute:02}:{:02}Z", day + 1, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(spell(0), "1970-01-01T00:00:00Z");
        assert_eq!(spell(951_782_399), "2000-02-28T23:59:59Z");
        assert_eq!(spell(951_868_799), "2000-02-29T23:59:59Z");
        assert_eq!(spell(1_735_689_599), "2024-12-31T23:59:59Z");
        assert_eq!(spell(1_795_219_200), "2026-11-21T00:00:00Z");
        assert_eq!(spell(LIMIT - 1), "9999-12-31T23:59:59Z");
    }
}
