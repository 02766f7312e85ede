//! Measured chains: tap delays, or the counts of a code-density test.

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;
use crate::firmware::carry_chain::LENGTHS;
use crate::kernel::Time;

/// Columns of a delay file.
const DELAYS: [&str; 2] = ["tap", "delay_ps"];
/// Columns of a count file.
const COUNTS: [&str; 2] = ["n", "count"];
/// Longest delay of a tap [ps].
const LONGEST_PS: f64 = 1e5;
/// Largest count; sums and products of counts are then exact.
const MOST: u64 = 1 << 32;

/// Parses the delay of each tap [ps].
///
/// # Errors
/// If taps are not numbered consecutively, a delay is negative or not a number, or the number of taps is out of
/// range.
pub fn delays_ps(source: &str, text: &str) -> Result<Vec<f64>> {
    let mut delays = Vec::new();
    let mut input = CsvInput::new(source, text, &DELAYS)?;
    while input.advance()? {
        in_turn(&input, delays.len(), *LENGTHS.end())?;
        let delay = input.field::<f64>(1).filter(|ps| (0.0..=LONGEST_PS).contains(ps));
        let expected =
            "expected a delay from 0 to 100000 ps: a negative delay is possible in tap_delays_ps";
        delays.push(delay.ok_or_else(|| input.fault(1, expected))?);
    }
    long_enough(source, "tap", delays.len())?;
    Ok(delays)
}

/// Parses the hit counts of a code-density test, indexed by ones count from 0.
///
/// # Errors
/// If ones counts are not consecutive, a count is not a whole number, their number does not fit a chain, or all
/// counts are zero.
pub fn counts(source: &str, text: &str) -> Result<Vec<u64>> {
    let mut counts = Vec::new();
    let mut input = CsvInput::new(source, text, &COUNTS)?;
    while input.advance()? {
        in_turn(&input, counts.len(), *LENGTHS.end() + 1)?;
        let count = input.field::<u64>(1).filter(|count| *count <= MOST);
        let expected = format!("expected a whole number from 0 to {MOST}");
        counts.push(count.ok_or_else(|| input.fault(1, expected))?);
    }
    long_enough(source, "n", counts.len().saturating_sub(1))?;
    if counts.iter().all(|count| *count == 0) {
        return Err(Input::new(source, "expected a hit, all are 0").field("count").into());
    }
    if counts[0] > 0 {
        let expected = "expected 0: a hit has reached a tap at least";
        return Err(Input::new(source, expected).field("count of n 0").value(counts[0]).into());
    }
    Ok(counts)
}

/// Computes tap delays from the counts of a code-density test with hits uniform over `period`: each delay is the
/// period times its share of the hits. Taps beyond the last one that was hit are unknown and left out [ps].
pub fn delays_of_counts_ps(counts: &[u64], period: Time) -> Vec<f64> {
    let last = counts.iter().rposition(|&count| count > 0).unwrap_or(0);
    let all: u128 = counts.iter().map(|&count| u128::from(count)).sum::<u128>().max(1);
    let (mut sum, mut before) = (0, 0);
    // Ends are rounded and not widths, so that the whole is a period.
    let delays = counts[1..=last.max(1)].iter().map(|&count| {
        sum += u128::from(count);
        let end = (2 * sum * u128::from(period.fs()) + all) / (2 * all);
        let delay_fs = end - before;
        before = end;
        delay_fs as f64 / 1e3
    });
    delays.collect()
}

/// Checks that a row has the next number, and that the list is not too long.
fn in_turn(input: &CsvInput, next: usize, most: usize) -> Result<()> {
    if next == most {
        return Err(input.fault(0, format!("expected {most} rows at most")).into());
    }
    match input.field::<usize>(0) {
        Some(found) if found == next => Ok(()),
        _ => Err(input.fault(0, format!("expected {next}, the next from 0 on")).into()),
    }
}

fn long_enough(source: &str, field: &str, taps: usize) -> Result<()> {
    let least = *LENGTHS.start();
    if taps >= least {
        return Ok(());
    }
    let expected = format!("expected {least} or more of a chain");
    Err(Input::new(source, expected).field(field).value(format!("{taps} taps")).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(header: &str, count: usize, row: impl Fn(usize) -> String) -> String {
        format!("{header}\n{}", (0..count).map(row).collect::<String>())
    }

    #[test]
    fn delays_are_read_in_order_and_faults_have_line_and_column() {
        let text = rows("tap,delay_ps", 20, |tap| format!("{tap},{}.5\n", tap));
        assert_eq!(delays_ps("d.csv", &text).unwrap()[19], 19.5);
        let error = |from: &str, to: &str| {
            delays_ps("d.csv", &text.replace(from, to)).unwrap_err().to_string()
        };
        assert_eq!(error("\n3,3.5", ""), "d.csv:5:1: tap = 4: expected 3, the next from 0 on");
        assert!(error("3,3.5", "3,-3.5").starts_with("d.csv:5:3: delay_ps = -3.5: expected a"));
        assert!(error("3,3.5", "3,nan").starts_with("d.csv:5:3: delay_ps = nan: expected a"));
        assert!(error("3,3.5", "3,inf").starts_with("d.csv:5:3: delay_ps = inf: expected a"));
        let few = delays_ps("d.csv", "tap,delay_ps\n0,1\n").unwrap_err().to_string();
        assert_eq!(few, "d.csv: tap = 1 taps: expected 16 or more of a chain");
    }

    #[test]
    fn counts_are_read_and_the_widths_they_stand_for_fill_a_period() {
        let count = |n: usize| if n == 0 || n > 30 { 0 } else { n % 7 };
        let text = rows("n,count", 41, |n| format!("{n},{}\n", count(n)));
        let counts = counts("c.csv", &text).unwrap();
        let period = Time::from_ns(8);
        let delays = delays_of_counts_ps(&counts, period);
        let all: usize = (0..41).map(count).sum();
        assert_eq!(delays.len(), 30);
        assert!((delays[3] - 8000.0 * 4.0 / all as f64).abs() < 1e-3, "{}", delays[3]);
        let sum_fs: i64 = delays.iter().map(|ps| (ps * 1e3).round() as i64).sum();
        assert_eq!(sum_fs as u64, period.fs());
    }

    #[test]
    fn counts_that_tell_nothing_are_refused() {
        let error = |text: &str| counts("c.csv", text).unwrap_err().to_string();
        let zero = rows("n,count", 41, |n| format!("{n},0\n"));
        assert_eq!(error(&zero), "c.csv: count: expected a hit, all are 0");
        assert!(error(&zero.replace("\n0,0", "\n0,3")).contains("count of n 0 = 3"));
        assert!(error(&zero.replace("\n7,0", "\n7,-1")).starts_with("c.csv:9:3: count = -1"));
        assert!(error(&zero.replace("\n7,0\n", "\n")).starts_with("c.csv:9:1: n = 8: expected 7"));
    }
}
