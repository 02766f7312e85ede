//! Lookup of the design's signals by the names in probe configurations and conditions.

use std::collections::{BTreeMap, BTreeSet};

use tofsim::error::hint;
use tofsim::firmware::tof_top::Params;
use tofsim::hierarchy::{self, CHANNEL, TOP};
use tofsim::kernel::signals::{Signal, SignalFormat};

use crate::condition::slice;

use super::capture::{Probe, Radix};

/// A slice of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SignalSlice {
    /// Id of the signal in the hierarchy.
    pub id: usize,
    /// Lowest bit.
    pub low: u32,
    /// Number of bits.
    pub width: u32,
    /// Whether the value is in two's complement.
    pub signed: bool,
}

/// Signals of a design, by path below the top.
#[derive(Clone, Debug)]
pub struct Design {
    signals: BTreeMap<String, (usize, Signal)>,
    /// Signals that exist only with other settings of the scenario.
    left_out: BTreeSet<String>,
    /// Columns of the array, 1 of a single pixel.
    columns: u32,
}

impl Design {
    /// Creates the list of signals of a design with the given parameters.
    pub fn new(params: &Params) -> Self {
        let entries = hierarchy::entries(params);
        let has_ram = entries.iter().any(|entry| entry.scope.ends_with(".histogram_builder"));
        let ram = hierarchy::ram_entries(&params.histogram);
        let here = entries.into_iter().chain(ram.iter().filter(|_| has_ram).cloned());
        let columns = hierarchy::column_entries(params);
        let signals: BTreeMap<_, _> = here
            .chain(columns)
            .map(|entry| (below(&entry.path()), (entry.id, entry.signal)))
            .collect();
        let every = hierarchy::every_entry().into_iter().chain(ram);
        let mut left_out: BTreeSet<_> = every.map(|entry| below(&entry.path())).collect();
        left_out.retain(|path| !signals.contains_key(path));
        Design { signals, left_out, columns: params.frame_ctrl.scan.columns }
    }

    /// Looks up a whole signal by its path, with dots or slashes, with or without the top.
    ///
    /// # Errors
    /// Description of what was expected.
    pub fn signal(&self, path: &str) -> Result<SignalSlice, String> {
        let (id, signal) = self.look_up(path)?;
        let signed = matches!(signal.format, SignalFormat::Signed { .. });
        Ok(SignalSlice { id, low: 0, width: signal.width, signed })
    }

    /// Creates a probe on a signal or a slice of it, and returns it with its bits. The default name is the path with
    /// slashes; the default radix suits the signal.
    ///
    /// # Errors
    /// Description of what was expected.
    pub fn probe(
        &self,
        text: &str,
        name: Option<&str>,
        radix: Option<Radix>,
    ) -> Result<(Probe, SignalSlice), String> {
        let (path, range) = match (self.look_up(text), slice(text)) {
            (Err(_), Some((path, high, low))) => (path, Some((high, low))),
            _ => (text, None),
        };
        let (_, signal) = self.look_up(path)?;
        let mut bits = self.signal(path)?;
        let (high, low) = range.unwrap_or((signal.width - 1, 0));
        if high < low || high >= signal.width {
            let width = signal.width;
            return Err(format!("`{path}` has {width} bits; expected [high:low] within"));
        }
        let whole = high - low + 1 == bits.width;
        bits =
            SignalSlice { id: bits.id, low, width: high - low + 1, signed: bits.signed && whole };
        let single = range.is_some() && bits.width == 1;
        let own = |path: &str| if single { format!("{path}[{low}]") } else { path.to_owned() };
        let probe = Probe {
            name: name.map_or_else(|| own(&below(path).replace('.', "/")), str::to_owned),
            width: bits.width,
            lsb: if single { 0 } else { low },
            vector: bits.width > 1,
            radix: radix.unwrap_or(match signal.format {
                SignalFormat::Signed { .. } if bits.signed => Radix::Signed,
                SignalFormat::Unsigned if bits.width > 1 => Radix::Unsigned,
                _ => Radix::Hex,
            }),
        };
        Ok((probe, bits))
    }

    /// Returns what was expected of a path of a channel that the design does not have.
    fn no_channel(&self, path: &str) -> Option<String> {
        let last = self.columns - 1;
        match (column(path)?, last) {
            (0, _) => Some(
                "no such signal; expected the names of a single pixel for column 0, such as tdc_code"
                    .to_owned(),
            ),
            (_, 0) => Some("no such signal: the scenario has one column (array.columns)".to_owned()),
            (column, _) if column > last => Some(format!(
                "no such signal: the array has {} columns (array.columns); expected {CHANNEL}1 to {CHANNEL}{last}",
                self.columns
            )),
            _ => None,
        }
    }

    fn look_up(&self, path: &str) -> Result<(usize, &Signal), String> {
        let path = below(&path.replace('/', "."));
        if let Some((id, signal)) = self.signals.get(&path) {
            return Ok((*id, signal));
        }
        if self.left_out.contains(&path) {
            return Err("the scenario's design leaves this module out".to_owned());
        }
        if let Some(expected) = self.no_channel(&path) {
            return Err(expected);
        }
        let (hint, _) = hint(&path, self.signals.keys().map(String::as_str));
        Err(format!("no such signal{hint}; expected a path below {TOP}"))
    }
}

/// Returns the column of a path of another column's channel, below the top.
pub(crate) fn column(path: &str) -> Option<u32> {
    path.strip_prefix(CHANNEL)?.split(['.', '/']).next()?.parse().ok()
}

/// Converts a path with or without the top to one below the top.
pub(crate) fn below(path: &str) -> String {
    let below = path.strip_prefix(TOP).and_then(|rest| rest.strip_prefix(['.', '/']));
    below.unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::kernel::scan::Scan;
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    #[test]
    fn a_slice_keeps_its_place_but_no_sign() {
        let setup = Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap();
        let design = Design::new(&setup.params);
        let is_signed = |signal: &Signal| matches!(signal.format, SignalFormat::Signed { .. });
        let mut signed = design.signals.iter().filter(|(_, (_, signal))| is_signed(signal));
        let (path, _) = signed.find(|(_, (_, signal))| signal.width > 5).unwrap();
        let (probe, bits) = design.probe(path, None, None).unwrap();
        assert_eq!((probe.radix, probe.lsb, bits.signed), (Radix::Signed, 0, true));
        let (probe, bits) = design.probe(&format!("{path}[5:2]"), None, None).unwrap();
        assert_eq!((probe.radix, probe.lsb, probe.width), (Radix::Hex, 2, 4));
        assert_eq!((bits.low, bits.width, bits.signed), (2, 4, false));
        let (probe, bits) = design.probe(&format!("{path}[3]"), None, None).unwrap();
        assert_eq!((probe.lsb, probe.vector, bits.low), (0, false, 3));
        assert!(probe.name.ends_with("[3]"));
    }

    #[test]
    fn a_channel_that_the_design_lacks_is_told_from_a_misspelt_signal() {
        let of = |columns| {
            let mut params = Setup::load("kc705", &[]).unwrap().params;
            params.frame_ctrl.scan = Scan { rows: 2, columns, banks: 1 };
            Design::new(&params)
        };
        let (array, single) = (of(4), of(1));
        let (probe, bits) =
            array.probe("channel_3/tdc.tdc_decoder.tdc_code[4:1]", None, None).unwrap();
        assert_eq!(
            (probe.name.as_str(), bits.low, bits.width),
            ("channel_3/tdc/tdc_decoder/tdc_code", 1, 4)
        );
        assert_eq!(array.signal("tof_top.channel_3.code").unwrap().id, bits.id);
        for (design, path, said) in [
            (
                &array,
                "channel_4.code",
                "the array has 4 columns (array.columns); expected channel_1 to channel_3",
            ),
            (&array, "tof_top/channel_64/tdc_stop", "expected channel_1 to channel_3"),
            (&array, "channel_0.code", "expected the names of a single pixel for column 0"),
            (&array, "channel_2.cod", "no such signal (`channel_2.code`?)"),
            (&array, "channel_2.bank_1.counting", "no such signal"),
            (&single, "channel_1.code", "the scenario has one column (array.columns)"),
        ] {
            let error = design.signal(path).unwrap_err();
            assert!(error.contains(said), "{path}: {error}");
        }
    }
}
