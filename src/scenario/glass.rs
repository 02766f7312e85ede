//! Template of a cover window's light: its hazard in each bin, from a CSV file that `tofsim calibrate glass` writes.

use std::sync::Arc;

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;

use super::builtin::Source;
use super::model::Estimator;

/// Columns of the file.
pub const HEADER: [&str; 5] = ["code", "from_ps", "until_ps", "hazard", "hazard_se"];
/// Latest limit of a bin [ps].
const LATEST_PS: f64 = 1e9;
/// Largest hazard of a bin: no shot of the longest frame would wait any longer [1].
const MOST_HAZARD: f64 = 20.0;
/// Largest difference between a limit in the file and the instrument's [bin widths].
const TOLERANCE: f64 = 0.01;

/// A bin of a template.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GlassBin {
    /// Begin of the bin, from the laser edge [ps].
    pub from_ps: f64,
    /// End of the bin [ps].
    pub until_ps: f64,
    /// Mean number of detected photons of the window's light per shot: of the shots that still wait, the fraction
    /// 1 - exp(-hazard) ends in the bin [1].
    pub hazard: f64,
    /// Standard error of the hazard [1].
    pub hazard_se: f64,
}

impl GlassBin {
    /// Returns the middle of the bin, from the laser edge [ps].
    pub fn middle_ps(&self) -> f64 {
        0.5 * (self.from_ps + self.until_ps)
    }
}

/// The light of a cover window in each bin of one instrument.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassTemplate {
    bins: Arc<[GlassBin]>,
    /// Error at the begin and the end of each bin, but for the text of what was expected.
    limits: Arc<[[Input; 2]]>,
}

impl GlassTemplate {
    /// Creates a template; `source` names it in errors.
    ///
    /// # Errors
    /// If there is no bin with light.
    pub fn new(source: &str, bins: Vec<GlassBin>) -> Result<Self> {
        let limit = |name: &str, ps: f64| Input::new(source, "").field(name).value(ps);
        let limits =
            bins.iter().map(|bin| [limit(HEADER[1], bin.from_ps), limit(HEADER[2], bin.until_ps)]);
        GlassTemplate::with(source, limits.collect(), bins)
    }

    fn with(source: &str, limits: Vec<[Input; 2]>, bins: Vec<GlassBin>) -> Result<Self> {
        if bins.iter().all(|bin| bin.hazard == 0.0) {
            let expected =
                "expected a bin with a hazard above 0, or no template (estimator.glass_file)";
            return Err(Input::new(source, expected).field(HEADER[3]).into());
        }
        Ok(GlassTemplate { bins: bins.into(), limits: limits.into() })
    }

    /// Returns the bins, by code.
    pub fn bins(&self) -> &[GlassBin] {
        &self.bins
    }

    /// Returns the same light in other bins, between whose limits the photons up to a time run straight [ps].
    pub fn over(&self, limits_ps: &[[f64; 2]]) -> Self {
        let own: Vec<_> = self.bins.iter().filter(|bin| bin.until_ps > bin.from_ps).collect();
        let within = |[from_ps, until_ps]: [f64; 2], of: &dyn Fn(&GlassBin) -> f64| {
            let part = |bin: &&GlassBin| {
                let shared_ps = until_ps.min(bin.until_ps) - from_ps.max(bin.from_ps);
                of(bin) * (shared_ps / (bin.until_ps - bin.from_ps)).max(0.0)
            };
            own.iter().map(part).sum::<f64>()
        };
        let bin = |&[from_ps, until_ps]: &[f64; 2]| GlassBin {
            from_ps,
            until_ps,
            hazard: within([from_ps, until_ps], &|bin| bin.hazard),
            hazard_se: within([from_ps, until_ps], &|bin| bin.hazard_se.powi(2)).sqrt(),
        };
        let bins: Vec<_> = limits_ps.iter().map(bin).collect();
        let limits = vec![self.limits[0].clone(); bins.len()];
        GlassTemplate { bins: bins.into(), limits: limits.into() }
    }

    /// Returns the mean number of detected photons of the window's light per shot [1].
    pub fn photons(&self) -> f64 {
        self.bins.iter().map(|bin| bin.hazard).sum()
    }

    /// Checks that the template has an instrument's bins: begin and end for each code, both 0 for one that never
    /// occurs, and their nominal width [ps].
    ///
    /// # Errors
    /// The first limit that differs, or another number of bins.
    pub fn check(&self, limits_ps: &[[f64; 2]], bin_ps: f64) -> std::result::Result<(), Input> {
        let (own, count) = (self.bins.len(), limits_ps.len());
        if own != count {
            let (source, rows) = (&self.limits[0][0].source, format!("{own} rows"));
            let expected = format!("expected {count}, one for each bin (tdc.bins)");
            return Err(Input::new(source, expected).field(HEADER[0]).value(rows));
        }
        for ((bin, faults), limits_ps) in self.bins.iter().zip(&*self.limits).zip(limits_ps) {
            for ((found, fault), ps) in
                [bin.from_ps, bin.until_ps].iter().zip(faults).zip(limits_ps)
            {
                if (found - ps).abs() > TOLERANCE * bin_ps {
                    let expected = format!(
                        "expected {ps:.3}, the limit of this instrument's bin: the template is for another chain \
                         or bin width; calibrate anew (tofsim calibrate glass)"
                    );
                    return Err(Input { expected, ..fault.clone() });
                }
            }
        }
        Ok(())
    }
}

/// Loads the template that the estimator's keys name, if they name one; its path is relative to `base`.
///
/// # Errors
/// If the file cannot be read, or is not a template.
pub fn load(keys: &Estimator, base: &Source) -> Result<Option<Arc<GlassTemplate>>> {
    let Some(name) = &keys.glass_file else { return Ok(None) };
    let (source, text) = base.read(name)?;
    Ok(Some(Arc::new(parse(&source, &text)?)))
}

fn parse(source: &str, text: &str) -> Result<GlassTemplate> {
    let mut input = CsvInput::new(source, text, &HEADER)?;
    let (mut bins, mut limits) = (Vec::new(), Vec::new());
    while input.advance()? {
        if input.field::<usize>(0) != Some(bins.len()) {
            return Err(input
                .fault(0, format!("expected {}, the next from 0 on", bins.len()))
                .into());
        }
        let number = |index, least, most: f64, expected: &str| {
            let found = input.field::<f64>(index).filter(|found| (least..=most).contains(found));
            found.ok_or_else(|| input.fault(index, expected))
        };
        let from_ps = number(1, 0.0, LATEST_PS, "expected the begin of the bin, 0 to 1e9 ps")?;
        let until_ps =
            number(2, from_ps, LATEST_PS, "expected the end of the bin, from_ps to 1e9 ps")?;
        let hazard = number(3, 0.0, MOST_HAZARD, "expected photons per shot in the bin, 0 to 20")?;
        let hazard_se = number(4, 0.0, MOST_HAZARD, "expected a standard error, 0 to 20")?;
        limits.push([1, 2].map(|index| input.fault(index, "")));
        bins.push(GlassBin { from_ps, until_ps, hazard, hazard_se });
    }
    if bins.is_empty() {
        return Err(Input::new(source, "expected a row for each bin").field(HEADER[0]).into());
    }
    GlassTemplate::with(source, limits, bins)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS_PS: [[f64; 2]; 3] = [[0.0, 25.0], [25.0, 50.0], [50.0, 75.0]];

    fn parsed(rows: &str) -> Result<GlassTemplate> {
        parse("g.csv", &format!("# tofsim\n{}\n{rows}", HEADER.join(",")))
    }

    #[test]
    fn a_file_has_the_hazard_of_each_bin() {
        let found = parsed("0,0,25,0.5,0.01\n1,25,50,0.25,0.02\n2,50,75,0,0\n").unwrap();
        assert_eq!((found.bins().len(), found.photons()), (3, 0.75));
        assert_eq!((found.bins()[1].middle_ps(), found.bins()[1].hazard_se), (37.5, 0.02));
        assert_eq!(found.check(&LIMITS_PS, 25.0), Ok(()));
    }

    #[test]
    fn another_chain_or_bin_width_is_a_fault_at_its_place() {
        let found = parsed("0,0,25,0.5,0.01\n1,25,51,0.25,0.02\n2,51,75,0,0\n").unwrap();
        let error = found.check(&LIMITS_PS, 25.0).unwrap_err().to_string();
        assert!(
            error.starts_with("g.csv:4:6: until_ps = 51: expected 50.000, the limit"),
            "{error}"
        );
        let error = found.check(&LIMITS_PS[..2], 25.0).unwrap_err().to_string();
        assert_eq!(error, "g.csv: code = 3 rows: expected 2, one for each bin (tdc.bins)");
        let made = GlassTemplate::new("made", found.bins().to_vec()).unwrap();
        let error = made.check(&LIMITS_PS, 25.0).unwrap_err().to_string();
        assert!(error.starts_with("made: until_ps = 51: expected 50.000"), "{error}");
    }

    #[test]
    fn the_same_light_in_other_bins() {
        let found = parsed("0,0,25,0.5,0.03\n1,25,50,0.25,0.04\n2,0,0,0,0\n").unwrap();
        let other = found.over(&[[0.0, 12.5], [12.5, 50.0], [0.0, 0.0], [50.0, 75.0]]);
        let hazards: Vec<_> = other.bins().iter().map(|bin| bin.hazard).collect();
        assert_eq!(hazards, [0.25, 0.5, 0.0, 0.0]);
        assert!((other.bins()[1].hazard_se - 0.04f64.hypot(0.03 * 0.5f64.sqrt())).abs() < 1e-12);
        assert_eq!(other.photons(), found.photons());
        assert_eq!(found.over(&LIMITS_PS[..2]).bins(), &found.bins()[..2]);
    }

    #[test]
    fn faults_name_line_column_and_field() {
        let error = |rows: &str| parsed(rows).unwrap_err().to_string();
        for (rows, said) in [
            ("0,0,25,-0.1,0\n", "g.csv:3:8: hazard = -0.1: expected photons per shot"),
            ("0,0,25,nan,0\n", "g.csv:3:8: hazard = nan: expected photons per shot"),
            ("0,0,25,0.1,-1\n", "g.csv:3:12: hazard_se = -1: expected a standard error"),
            ("0,0,25,0.1,0\n2,25,50,0,0\n", "g.csv:4:1: code = 2: expected 1, the next"),
            ("0,25,0,0.1,0\n", "g.csv:3:6: until_ps = 0: expected the end of the bin"),
            ("0,0,25,0.1\n", "g.csv:3:1: the row has 4 fields, expected 5"),
            ("", "g.csv: code: expected a row for each bin"),
            ("0,0,25,0,0\n", "g.csv: hazard: expected a bin with a hazard above 0"),
        ] {
            let found = error(rows);
            assert!(found.contains(said), "{rows}: {found}");
        }
        assert!(parse("g.csv", "").unwrap_err().to_string().contains("g.csv: empty; expected"));
    }
}
