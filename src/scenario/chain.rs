//! Chain files: the tap delays of a carry chain.

pub mod measured;
mod silicon;
mod span;

use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::error::{Input, Result, hint};
use crate::files::toml::Checked;
use crate::firmware::carry_chain::{Delays, LENGTHS, TAPS};
use crate::kernel::Time;

use super::builtin::{self, Source};
use silicon::Silicon;
pub(super) use span::{too_long, too_short};

/// A chain file. Its delays are given in one of five ways: equal taps (`tap_ps`), a list (`tap_delays_ps`), a random
/// model of silicon (`[silicon]`), or measurements (`delays_file`, `counts_file`).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// Description of the chain and the origin of its numbers.
    #[serde(default)]
    pub description: String,
    /// Delay from `tdc_stop` to the start of the chain (tap 0 if taps are reached in order), relative to the clock's
    /// own delay to the tap registers. It shifts all codes alike, which the calibration takes out: any value serves a
    /// chain of which only the taps are known.
    #[serde(default = "usual_offset_ps")]
    #[schemars(range(min = 0.0, max = 100_000.0), extend("unit" = "ps"))]
    pub offset_ps: f64,
    /// Number of taps, unless `tap_delays_ps` lists them.
    #[schemars(range(min = 16, max = 2000), extend("unit" = "tap"))]
    pub taps: Option<usize>,
    /// Delay of each tap, if all are equal.
    #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "ps"))]
    pub tap_ps: Option<f64>,
    /// Delay of each tap; a negative delay means that a tap is reached before its predecessor.
    #[schemars(length(min = 16, max = 2000))]
    pub tap_delays_ps: Option<Vec<f64>>,
    /// Random model of a chain in silicon.
    pub silicon: Option<Silicon>,
    /// CSV file with columns `tap` (from 0) and `delay_ps`, a row for each tap.
    pub delays_file: Option<String>,
    /// CSV file with columns `n` (from 0) and `count`: a code-density test, whose hits are spread evenly over
    /// `period_ps`.
    pub counts_file: Option<String>,
    /// Period of the clock with which the counts were measured; the period of `clk_sys` by default.
    #[schemars(range(min = 100.0, max = 1e6), extend("unit" = "ps"))]
    pub period_ps: Option<f64>,
    /// Additional delays of single taps.
    #[serde(default)]
    pub extra: Vec<Extra>,
}

/// Offset of the chain `uniform` [ps].
fn usual_offset_ps() -> f64 {
    2230.0
}

/// An additional delay of one tap, such as at the border of a clock region.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Extra {
    /// Tap number, from 0.
    #[schemars(range(min = 0, max = 1999), extend("unit" = "tap"))]
    pub tap: usize,
    /// Additional delay.
    #[schemars(range(min = -10_000.0, max = 10_000.0), extend("unit" = "ps"))]
    pub ps: f64,
}

/// A profile: a built-in chain, or a chain file.
pub struct Profile {
    /// Name of the file, for errors.
    source: String,
    text: String,
    /// Folder of the files that it names.
    files: Source,
}

impl Profile {
    /// Finds a built-in profile, or reads a file whose path is relative to `base`. If there is no such profile, `fault` makes
    /// the error from what was expected.
    ///
    /// # Errors
    /// If there is no such profile, or the file cannot be read.
    pub fn find(name: &str, base: &Source, fault: impl FnOnce(String) -> Input) -> Result<Self> {
        if let Some(text) = builtin::chain(name) {
            let (source, text) = (format!("chain {name}"), text.to_owned());
            return Ok(Profile { source, text, files: Source::BuiltIn });
        }
        if !name.contains(['/', '.']) {
            let (hint, known) = hint(name, builtin::CHAINS.iter().map(|(name, _)| *name));
            return Err(fault(format!("expected {known} or a chain file{hint}")).into());
        }
        let (source, text) = base.read(name)?;
        let folder = Path::new(&source).parent().unwrap_or(Path::new("")).to_owned();
        Ok(Profile { source, text, files: Source::Folder(folder) })
    }

    /// Returns the delays of the chain, which is sampled with the clock period `cycle`. A `seed` replaces that of its random
    /// model of silicon.
    ///
    /// # Errors
    /// If the file is invalid, or has no such model for a seed.
    pub fn delays(&self, seed: Option<u64>, cycle: Time) -> Result<Delays> {
        let Profile { source, text, files } = self;
        let checked = Checked::parse::<Chain>(source, text)?;
        let mut chain: Chain = checked.read()?;
        let key = chain.origin(source, &checked)?;
        if let Some(seed) = seed {
            let Some(silicon) = &mut chain.silicon else {
                let expected = "expected [silicon], a random model, for array.chains_file to have a seed of it";
                return Err(checked.fault(key, expected).into());
            };
            silicon.seed = seed;
        }
        let (first_ps, mut taps_ps) = chain.taps_ps(&checked, files, cycle)?;
        if let Some(taps) = chain.taps.filter(|taps| *taps != taps_ps.len()) {
            let expected = format!("expected {}, as many as {key} has", taps_ps.len());
            return Err(checked.fault("taps", expected).value(taps).into());
        }
        let last = taps_ps.len() - 1;
        for (k, extra) in chain.extra.iter().enumerate() {
            let Some(tap_ps) = taps_ps.get_mut(extra.tap) else {
                let expected = format!("expected {last} at most, the last tap");
                return Err(checked
                    .fault(&format!("extra.{k}.tap"), expected)
                    .value(extra.tap)
                    .into());
            };
            *tap_ps += extra.ps;
        }
        if let Some(tap) = taps_ps.iter().position(|ps| !(-1e5..=1e5).contains(ps)) {
            let fault =
                checked.fault(&format!("tap_delays_ps.{tap}"), "expected a delay up to 1e5 ps");
            return Err(fault.into());
        }
        if !LENGTHS.contains(&taps_ps.len()) {
            let expected =
                format!("expected {} taps or more, there are {}", LENGTHS.start(), last + 1);
            return Err(checked.fault(key, expected).into());
        }
        let taps_fs: Vec<_> = taps_ps.iter().map(|ps| (ps * 1e3).round() as i64).collect();
        let offset_ps = Some(chain.offset_ps + first_ps).filter(|ps| *ps >= 0.0);
        // No tap is reached at the very time of the change: 0 is a femtosecond.
        let offset = offset_ps.map(|ps| Time::from_ps_f64(ps).max(Time::from_fs(1)));
        let delays = offset.and_then(|offset| Delays::new(offset, &taps_fs));
        let Some(delays) = delays else {
            let expected = "a tap would be reached before `tdc_stop` changes";
            return Err(checked.fault("offset_ps", expected).into());
        };
        if let Some(expected) = too_long(&delays, cycle) {
            let is_late = delays.tap_0() > delays.span();
            return Err(checked.fault(if is_late { "offset_ps" } else { key }, expected).into());
        }
        if let Some(expected) = too_short(&delays, cycle) {
            return Err(checked.fault(key, expected).into());
        }
        Ok(delays)
    }
}

/// Loads the chain of `tdc.profile`: a built-in profile, or a file whose path is relative to `base`. The chain is sampled
/// with the clock period `cycle`.
///
/// # Errors
/// If the file cannot be read, or its delays are invalid.
pub fn load(name: &str, base: &Source, cycle: Time) -> Result<Delays> {
    let fault = |expected| Input::new("tdc.profile", expected).value(name);
    Profile::find(name, base, fault)?.delays(None, cycle)
}

impl Chain {
    /// Returns the one key that defines the delays.
    fn origin(&self, source: &str, checked: &Checked) -> Result<&'static str> {
        let given = [
            ("tap_ps", self.tap_ps.is_some()),
            ("tap_delays_ps", self.tap_delays_ps.is_some()),
            ("silicon", self.silicon.is_some()),
            ("delays_file", self.delays_file.is_some()),
            ("counts_file", self.counts_file.is_some()),
        ];
        let mut keys = given.iter().filter(|(_, is_given)| *is_given).map(|(key, _)| *key);
        let key = match (keys.next(), keys.next()) {
            (Some(key), None) => key,
            _ => {
                let names: Vec<_> = given.iter().map(|(key, _)| *key).collect();
                let expected = format!("expected either {}", names.join(" or "));
                return Err(Input::new(source, expected).into());
            }
        };
        if self.period_ps.is_some() && key != "counts_file" {
            let expected = "expected counts_file with it, a test by a clock of that period";
            return Err(checked.fault("period_ps", expected).into());
        }
        Ok(key)
    }

    /// Returns the delay before tap 0 in addition to the offset, and the delay of each tap [ps].
    fn taps_ps(&self, checked: &Checked, files: &Source, cycle: Time) -> Result<(f64, Vec<f64>)> {
        if let Some(silicon) = &self.silicon {
            return silicon.delays_ps(checked);
        }
        let taps_ps = if let Some(taps_ps) = &self.tap_delays_ps {
            taps_ps.clone()
        } else if let Some(name) = &self.delays_file {
            let (source, text) = files.read(name)?;
            measured::delays_ps(&source, &text)?
        } else if let Some(name) = &self.counts_file {
            let (source, text) = files.read(name)?;
            let period = self.period_ps.map_or(cycle, Time::from_ps_f64);
            measured::delays_of_counts_ps(&measured::counts(&source, &text)?, period)
        } else {
            vec![self.tap_ps.unwrap_or_default(); self.taps.unwrap_or(TAPS)]
        };
        Ok((0.0, taps_ps))
    }
}

#[cfg(test)]
mod tests;
