//! The laser pulse, defined by keys or a file.

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;
use crate::kernel::pulse::{Pulse, Samples, Unusable};

use super::builtin::Source;
use super::model::Laser;

/// Columns of a pulse file.
const HEADER: [&str; 2] = ["time_ps", "density"];
/// Largest number of rows of a pulse file.
const MOST_ROWS: usize = 100_000;
/// Largest relative deviation of a time step from the mean step [1].
const UNEVEN: f64 = 1e-3;
/// Smallest and largest standard deviation, the same as for `laser.pulse_sigma_ps` [ps].
const SIGMA_PS: [f64; 2] = [1.0, 2000.0];

/// Loads the pulse of a laser. The path of a pulse file is relative to `base`.
///
/// # Errors
/// If the file cannot be read, or does not describe a pulse.
pub fn load(laser: &Laser, base: &Source) -> Result<Pulse> {
    let Some(name) = &laser.pulse_file else {
        return Ok(Pulse::tailed(laser.pulse_sigma_ps, laser.pulse_tail_ps));
    };
    let (source, text) = base.read(name)?;
    parse(&source, &text)
}

fn parse(source: &str, text: &str) -> Result<Pulse> {
    let mut input = CsvInput::new(source, text, &HEADER)?;
    let (mut times_ps, mut density) = (Vec::new(), Vec::new());
    while input.advance()? {
        if times_ps.len() == MOST_ROWS {
            return Err(input.fault(0, format!("expected {MOST_ROWS} rows at most")).into());
        }
        let time_ps = input.field::<f64>(0).filter(|t| t.is_finite());
        let later = time_ps.filter(|t| times_ps.last().is_none_or(|last| last < t));
        times_ps.push(later.ok_or_else(|| {
            input.fault(0, "expected a time in ps, later than in the row before")
        })?);
        let value = input.field::<f64>(1).filter(|value| (0.0..=1e100).contains(value));
        density.push(value.ok_or_else(|| input.fault(1, "expected a number, 0 or more"))?);
    }
    let fault = |unusable: Unusable| Input::new(source, unusable).field("density");
    if times_ps.len() < 3 {
        return Err(fault(Unusable::Few).into());
    }
    let last = times_ps.len() - 1;
    let step_ps = (times_ps[last] - times_ps[0]) / last as f64;
    let uneven = |k: &usize| {
        let expected_ps = times_ps[0] + *k as f64 * step_ps;
        (times_ps[*k] - expected_ps).abs() > UNEVEN * step_ps * last as f64
            || (times_ps[*k] - times_ps[*k - 1] - step_ps).abs() > 0.01 * step_ps
    };
    if let Some(k) = (1..=last).find(uneven) {
        let expected = format!("expected even steps of {step_ps} ps, from {} on", times_ps[0]);
        return Err(Input::new(source, expected).field("time_ps").value(times_ps[k]).into());
    }
    let samples = Samples::new(step_ps, &density).map_err(fault)?;
    let [least, most] = SIGMA_PS;
    if !(least..=most).contains(&samples.sigma_ps()) {
        let expected = format!("a standard deviation, expected {least} to {most} ps");
        return Err(Input::new(source, expected).value(samples.sigma_ps()).into());
    }
    Ok(Pulse::Sampled(samples))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        parse("p.csv", text).unwrap_err().to_string()
    }

    #[test]
    fn a_file_is_a_pulse_whose_mean_is_zero() {
        let pulse = parse("p.csv", "time_ps,density\n1000,1\n1010,2\n1020,1\n").unwrap();
        assert!((pulse.part(0.0) - 0.5).abs() < 1e-12);
        assert!((pulse.sigma_ps() - (50.0f64 + 100.0 / 6.0).sqrt()).abs() < 1e-9);
    }

    #[test]
    fn faults_are_named_by_line_and_column() {
        let rows = |rows: &str| format!("time_ps,density\n{rows}");
        assert_eq!(
            error(&rows("0,1\n10,-2\n")),
            "p.csv:3:4: density = -2: expected a number, 0 or more"
        );
        assert_eq!(
            error(&rows("0,1\n0,2\n")),
            "p.csv:3:1: time_ps = 0: expected a time in ps, later than in the row before"
        );
        assert!(error("bin,count\n").contains("expected the header `time_ps,density`"));
        assert!(error(&rows("0,1\n10,nan\n")).contains("density = nan"));
        assert!(error(&rows("0,1\n10,1\n")).contains("expected three samples or more"));
        assert!(error(&rows("0,0\n10,0\n20,0\n")).contains("not zero everywhere"));
        assert!(error(&rows("0,1\n10,1\n30,1\n")).contains("expected even steps of 15 ps"));
        let long = error(&rows("0,1\n10000,1\n20000,1\n"));
        assert!(long.contains("expected 1 to 2000 ps"), "{long}");
    }
}
