//! Chain files: the delays of a carry chain, as data.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::error::{Input, Result, hint};
use crate::files::toml::Checked;
use crate::firmware::carry_chain::{Delays, TAPS};
use crate::kernel::Time;

use super::builtin::{self, Source};

/// A chain file. Either all taps are alike (`tap_ps`) or each has its own delay.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// What the chain is and where its numbers come from.
    #[serde(default)]
    pub description: String,
    /// From `tdc_stop` to tap 0, beyond the clock's own delay to the registers.
    #[schemars(range(min = 0.001, max = 100_000.0), extend("unit" = "ps"))]
    pub offset_ps: f64,
    /// How many taps there are, if `tap_delays_ps` does not say.
    #[schemars(range(min = 16, max = 2000), extend("unit" = "tap"))]
    pub taps: Option<usize>,
    /// Delay of each tap, if all are alike.
    #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "ps"))]
    pub tap_ps: Option<f64>,
    /// Delays of the taps, one by one; a tap may be reached before the one below it.
    #[schemars(length(min = 16, max = 2000))]
    pub tap_delays_ps: Option<Vec<f64>>,
    /// Delays that come on top.
    #[serde(default)]
    pub extra: Vec<Extra>,
}

/// A delay on top of a tap's own, as where the chain crosses a clock region.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Extra {
    /// The tap, from 0.
    #[schemars(range(min = 0, max = 1999), extend("unit" = "tap"))]
    pub tap: usize,
    /// The delay.
    #[schemars(range(min = -10_000.0, max = 10_000.0), extend("unit" = "ps"))]
    pub ps: f64,
}

/// Periods of `clk_sys` in which the last tap must be reached: the fall that `spad_rst` makes must have left
/// the chain when the first edge after the laser edge samples the next rise, and the decoder's ages reach
/// so far.
const LONGEST: u64 = 2;

/// The chain called `name`: a built-in profile, or a file whose path is taken from `base`. It samples with
/// a clock of the period `cycle`.
pub fn load(name: &str, base: &Source, cycle: Time) -> Result<Delays> {
    if let Some(text) = builtin::chain(name) {
        return parse(&format!("chain {name}"), text, cycle);
    }
    if !name.contains(['/', '.']) {
        let (hint, known) = hint(name, builtin::CHAINS.iter().map(|(name, _)| *name));
        let expected = format!("expected {known} or a chain file{hint}");
        return Err(Input::new("tdc.profile", expected).value(name).into());
    }
    let (source, text) = base.read(name)?;
    parse(&source, &text, cycle)
}

fn parse(source: &str, text: &str, cycle: Time) -> Result<Delays> {
    let checked = Checked::parse::<Chain>(source, text)?;
    let chain: Chain = checked.read()?;
    let taps_key = if chain.tap_ps.is_some() { "tap_ps" } else { "tap_delays_ps" };
    let mut taps_ps = match (chain.tap_ps, chain.tap_delays_ps) {
        (Some(tap_ps), None) => vec![tap_ps; chain.taps.unwrap_or(TAPS)],
        (None, Some(taps_ps)) => {
            if let Some(taps) = chain.taps.filter(|taps| *taps != taps_ps.len()) {
                let expected = format!("expected {}, as many as tap_delays_ps has", taps_ps.len());
                return Err(checked.fault("taps", expected).value(taps).into());
            }
            taps_ps
        }
        _ => return Err(Input::new(source, "expected either tap_ps or tap_delays_ps").into()),
    };
    let last = taps_ps.len() - 1;
    for (k, extra) in chain.extra.iter().enumerate() {
        let Some(tap_ps) = taps_ps.get_mut(extra.tap) else {
            let expected = format!("expected {last} at most, the last tap");
            return Err(checked.fault(&format!("extra.{k}.tap"), expected).value(extra.tap).into());
        };
        *tap_ps += extra.ps;
    }
    if let Some(tap) = taps_ps.iter().position(|ps| !(-1e5..=1e5).contains(ps)) {
        let fault = checked.fault(&format!("tap_delays_ps.{tap}"), "expected a delay up to 1e5 ps");
        return Err(fault.into());
    }
    let taps_fs: Vec<_> = taps_ps.iter().map(|ps| (ps * 1e3).round() as i64).collect();
    let delays = Delays::new(Time::from_ps_f64(chain.offset_ps), &taps_fs);
    let Some(delays) = delays else {
        let expected = "a tap would be reached before `tdc_stop` changes";
        return Err(checked.fault("offset_ps", expected).into());
    };
    if let Some(expected) = too_long(&delays, cycle) {
        return Err(checked.fault("offset_ps", expected).into());
    }
    if let Some(expected) = too_short(&delays, cycle) {
        return Err(checked.fault(taps_key, expected).into());
    }
    Ok(delays)
}

/// Of a chain whose last tap is not reached within two periods of the clock: what would do.
fn too_long(delays: &Delays, cycle: Time) -> Option<String> {
    let (longest, most) = (delays.longest(), Time::from_fs(LONGEST * cycle.fs()));
    if longest <= most {
        return None;
    }
    let (longest_ps, most_ns) = (longest.ps(), in_ps(most) / 1e3);
    let mhz = (LONGEST as f64 / longest.seconds() * 1e-3).floor() / 1e3;
    Some(format!(
        "the last tap is reached after {longest_ps} ps, expected {most_ns} ns at most, two periods of \
         clk_sys: one of {mhz} MHz or less would do"
    ))
}

/// Of a chain that takes less than a period of the clock from tap 0 to the end of the last tap: what would do.
///
/// A hit is seen at the first edge after it reaches tap 0, at an age of up to a period more than tap 0's.
/// What is older then than the chain is long has run through all taps, and the edge does not tell by how
/// much.
fn too_short(delays: &Delays, cycle: Time) -> Option<String> {
    let (taps, span) = (delays.taps(), delays.span());
    if span >= cycle {
        return None;
    }
    let (span_ps, cycle_ns, missing_ps) = (in_ps(span), in_ps(cycle) / 1e3, in_ps(cycle - span));
    let factor = (in_ps(cycle) / span_ps * 1e3).ceil() / 1e3;
    let mhz = (1.0 / span.seconds() * 1e-3).ceil() / 1e3;
    Some(format!(
        "the {taps} taps take {span_ps} ps, expected {cycle_ns} ns or more, a period of clk_sys: hits of the \
         other {missing_ps} ps would all have the same time; a delay {factor} times as long would do, or a \
         clk_sys of {mhz} MHz or more"
    ))
}

fn in_ps(time: Time) -> f64 {
    time.fs() as f64 / 1e3
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    const CYCLE: Time = Time::from_ns(8);

    #[test]
    fn a_chain_is_held_to_the_period_of_its_clock() {
        let message = |cycle_fs: u64| {
            let found = load("uniform", &Source::BuiltIn, Time::from_fs(cycle_fs));
            found.map(drop).map_err(|error| error.to_string())
        };
        // From 2230 ps on, 9200 ps.
        assert_eq!((message(9_200_000), message(5_710_000)), (Ok(()), Ok(())));
        let error = message(10_000_000).unwrap_err();
        let expected =
            "9200 ps, expected 10 ns or more, a period of clk_sys: hits of the other 800 ps";
        assert!(error.contains(expected), "{error}");
        let expected = "a delay 1.087 times as long would do, or a clk_sys of 108.696 MHz or more";
        assert!(error.contains(expected), "{error}");
        let error = message(5_700_000).unwrap_err();
        let expected = "after 11418 ps, expected 11.4 ns at most, two periods of clk_sys: one of 175.154 \
            MHz or less would do";
        assert!(error.contains(expected), "{error}");
    }

    #[test]
    fn table_6_3_is_reproduced() {
        let delays = load("table6_3", &Source::Folder(PathBuf::new()), CYCLE).unwrap();
        assert_eq!(delays.rank(Time::from_ns(8 - 2)), 328);
        assert_eq!(delays.rank(Time::from_ns(8 - 4)), 154);
        assert_eq!(delays.rank(Time::from_ns(16 - 8)), 492);
        assert_eq!(delays.rank(Time::from_ns(8 - 8)), 0, "8 ns is not seen at 8 ns");
    }

    #[test]
    fn a_fault_names_key_and_place() {
        let message = |text| parse("c.toml", text, CYCLE).unwrap_err().to_string();
        assert_eq!(
            message("offset_ps = 2000\ntap_ps = -1"),
            "c.toml:2:10: tap_ps = -1: expected a number from 0.001 to 1000.0 [ps]"
        );
        assert!(message("tap_ps = 12").contains("offset_ps: missing"));
        assert!(message("offset_ps = 2000\ntap_delays_ps = [1.0]").contains("16 to 2000"));
        assert!(message("offset_ps = 2000\ntap_ps = 30").contains("16 ns at most"));
        assert!(message("offset_ps = 2000\ntap_pz = 1").contains("did you mean `tap_ps`?"));
        assert!(
            message("offset_ps = 10\ntap_ps = 11\n[[extra]]\ntap=0\nps=-100").contains("before")
        );
    }

    #[test]
    fn a_chain_shorter_than_a_clock_period_is_refused_by_how_much() {
        let message =
            |text: &str| parse("c.toml", text, CYCLE).map(drop).map_err(|e| e.to_string());
        assert_eq!(
            message("offset_ps = 2230\ntap_ps = 5").unwrap_err(),
            "c.toml:2:10: tap_ps = 5: the 800 taps take 4000 ps, expected 8 ns or more, a period of \
             clk_sys: hits of the other 4000 ps would all have the same time; a delay 2 times as \
             long would do, or a clk_sys of 250 MHz or more"
        );
        assert_eq!(message("offset_ps = 2230\ntap_ps = 10"), Ok(()), "800 taps of 10 ps are 8 ns");
        let error = message("offset_ps = 7000\ntap_ps = 9.999").unwrap_err();
        assert!(error.contains("the other 0.8 ps"), "the offset is no tap: {error}");
        let one_by_one = format!("offset_ps = 2000\ntap_delays_ps = [{}]", "9.5, ".repeat(TAPS));
        let error = message(&one_by_one).unwrap_err();
        assert!(error.contains("tap_delays_ps = a list of 800: the 800 taps take 7600"), "{error}");
        let longer = format!("{one_by_one}\n[[extra]]\ntap = 400\nps = 400");
        assert_eq!(message(&longer), Ok(()), "an extra delay is part of the chain");
    }

    #[test]
    fn every_built_in_chain_covers_a_clock_period() {
        for (name, _) in builtin::CHAINS {
            let delays = load(name, &Source::BuiltIn, CYCLE).unwrap();
            assert!(delays.span() > CYCLE, "{name}");
        }
    }

    #[test]
    fn an_unknown_profile_lists_the_known_ones() {
        let error =
            load("unifrom", &Source::Folder(PathBuf::new()), CYCLE).unwrap_err().to_string();
        assert!(error.contains("uniform, table6_3, ideal"), "{error}");
    }
}
