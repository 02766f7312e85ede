//! The decoder's calibration ROM: ages computed from the chain's delays, from the nominal tap width, or read from a
//! file.

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;
use crate::firmware::carry_chain::Delays;
use crate::firmware::tdc_decoder::{Calibration, Decoder, Encoder, Params, TimeScale};

use super::builtin::Source;
use super::model::TdcCalibration;

mod known;

/// Columns of a calibration file.
pub const HEADER: [&str; 3] = ["n", "age_ps", "age_se_ps"];
/// Upper limit of an age in a calibration file, beyond the last tap of any chain [ps].
const OLDEST_PS: f64 = 1e6;

/// The contents of the decoder's calibration ROM, with the chain that it assumes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rom {
    /// ROM words: the age for each ones count.
    pub cal: Calibration,
    /// Chain that the calibration assumes, if it differs from the simulated one.
    pub chain: Option<Delays>,
}

/// Builds the ROM for a chain and a decoder. The path of a calibration file is relative to `base`.
///
/// # Errors
/// If the file cannot be read, or does not fit a chain of this length.
pub fn load(
    calibration: &TdcCalibration,
    base: &Source,
    (delays, decoder): (&Delays, Decoder),
    scale: &TimeScale,
) -> Result<Rom> {
    let name = match calibration {
        TdcCalibration::True => {
            return Ok(Rom { cal: Params::calibration(delays, decoder, scale), chain: None });
        }
        TdcCalibration::Uniform => {
            let cal = Params::uniform_calibration(delays, scale);
            return Ok(Rom { cal, chain: Some(delays.evened()) });
        }
        TdcCalibration::File(name) => name,
    };
    if !name.contains(['/', '.']) {
        let expected = "expected true, uniform or the path of a file";
        return Err(Input::new("tdc.calibration", expected).value(name).into());
    }
    let (source, text) = base.read(name)?;
    let ages_ps = parse(&source, &text, delays.taps())?;
    let twice_fs = ages_ps.iter().map(|ps| (2e3 * ps).round() as u64);
    let at_start = Encoder::new(decoder, delays).of_rank(delays.rank(scale.period()));
    let cal = Params::calibration_of(twice_fs, at_start, scale);
    Ok(Rom { cal, chain: known::chain(&ages_ps, delays.tap_0()) })
}

/// Parses the age for each ones count `n` [ps].
fn parse(source: &str, text: &str, taps: usize) -> Result<Vec<f64>> {
    let mut ages = Vec::new();
    let mut input = CsvInput::new(source, text, &HEADER)?;
    while input.advance()? {
        let next = ages.len();
        if next > taps {
            let expected = format!("expected {taps} at most, the last of the chain's {taps} taps");
            return Err(input.fault(0, expected).into());
        }
        if input.field::<usize>(0) != Some(next) {
            return Err(input.fault(0, format!("expected {next}, the next from 0 on")).into());
        }
        let age = input.field::<f64>(1).filter(|ps| (0.0..=OLDEST_PS).contains(ps));
        ages.push(age.ok_or_else(|| input.fault(1, "expected an age from 0 to 1000000 ps"))?);
        let error = input.field::<f64>(2).filter(|ps| (0.0..=OLDEST_PS).contains(ps));
        error.ok_or_else(|| input.fault(2, "expected a standard error of 0 ps or more"))?;
    }
    if ages.len() != taps + 1 {
        let expected = format!("expected 0 to {taps}, for a chain of {taps} taps");
        let rows = format!("{} rows", ages.len());
        return Err(Input::new(source, expected).field("n").value(rows).into());
    }
    Ok(ages)
}

#[cfg(test)]
mod tests {
    use crate::kernel::Time;

    use super::*;

    fn delays() -> Delays {
        Delays::new(Time::from_ns(2), &[500_000; 16]).unwrap()
    }

    fn read(text: &str) -> std::result::Result<Calibration, String> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("c.csv"), text).unwrap();
        let base = Source::Folder(folder.path().to_owned());
        let file = TdcCalibration::File("c.csv".to_owned());
        let found = load(&file, &base, (&delays(), Decoder::Ones), &TimeScale::default());
        found.map(|rom| rom.cal).map_err(|error| error.to_string())
    }

    fn rows(ages: impl Iterator<Item = f64>) -> String {
        let rows = ages.enumerate().map(|(n, ps)| format!("{n},{ps},0.5\n"));
        format!("n,age_ps,age_se_ps\n{}", rows.collect::<String>())
    }

    /// Midpoints of the age intervals, computed by hand.
    fn ages() -> impl Iterator<Item = f64> {
        (0..=16).map(|n| if n == 0 { 2000.0 } else { 1750.0 + 500.0 * f64::from(n) })
    }

    #[test]
    fn a_file_with_the_chain_s_own_ages_is_the_chain_s_own_calibration() {
        let own = Params::calibration(&delays(), Decoder::Ones, &TimeScale::default());
        assert_eq!(read(&rows(ages())), Ok(own.clone()));
        assert_ne!(read(&rows(ages().map(|ps| ps + 2.0))), Ok(own.clone()));
        // A ROM need not be in order.
        let swapped = read(&rows(ages().map(|ps| 12_000.0 - ps))).unwrap();
        assert!(swapped[3] > swapped[4]);
        // Time 0 has a code, whatever the file says.
        assert_eq!(read(&rows(ages().map(|ps| ps + 300.0))).unwrap()[13], 5120);
    }

    #[test]
    fn faults_are_named_by_line_and_column() {
        let own = rows(ages());
        let error = |from: &str, to: &str| read(&own.replace(from, to)).unwrap_err();
        assert!(error("\n3,3250,0.5", "").contains("c.csv:5:1: n = 4: expected 3, the next"));
        assert!(error("3,3250", "3,nan").contains("c.csv:5:3: age_ps = nan: expected an age"));
        assert!(error("3,3250", "3,-1").contains("c.csv:5:3: age_ps = -1"));
        assert!(error("3,3250,0.5", "3,3250,x").contains("c.csv:5:8: age_se_ps = x"));
        assert!(error("\n16,9750,0.5", "").contains("n = 16 rows: expected 0 to 16, for a chain"));
        let long = read(&format!("{own}17,9,1\n")).unwrap_err();
        assert!(long.contains("c.csv:19:1: n = 17: expected 16 at most"), "{long}");
        let word = TdcCalibration::File("unifrom".to_owned());
        let error =
            load(&word, &Source::BuiltIn, (&delays(), Decoder::Ones), &TimeScale::default())
                .unwrap_err();
        let expected = "tdc.calibration: unifrom: expected true, uniform or the path of a file";
        assert_eq!(error.to_string(), expected);
    }
}
