//! Description of a waveform, and of how it may differ from its text dump.

use super::table::Column;

/// Writer of a waveform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tool {
    Ghdl,
    Icarus,
    /// Converters `vcd2fst` and `fst2vcd`.
    Gtkwave,
    Verilator,
    Yosys,
    /// MyHDL, Amaranth, pyvcd and PyRTL.
    Python,
}

/// A waveform file.
pub(super) struct Waveform {
    pub(super) tool: Tool,
    pub(super) name: &'static str,
    /// Beginnings of names in the text dump, and what the file has instead.
    tops: &'static [[&'static str; 2]],
    /// Kinds and names, or their beginnings, of the columns that the file lacks.
    absent: &'static [&'static str],
    /// Number of these columns.
    pub(super) lacking: usize,
    /// Signals without a column, sorted.
    pub(super) others: &'static [&'static str],
    /// Kind and name of a column whose signal never has a value, if there is one.
    pub(super) valueless: &'static str,
    /// Whether integers have their lowest bit only.
    pub(super) is_cut: bool,
    /// Significant digits of real numbers.
    pub(super) digits: usize,
    /// Whether vectors have indices.
    pub(super) has_ranges: bool,
    /// Whether the first values contain events that never occurred.
    pub(super) has_first_events: bool,
}

impl Waveform {
    /// Returns the name of the design, which its text dump has too.
    pub(super) fn design(&self) -> &str {
        self.name.split('.').next().unwrap()
    }

    /// Returns whether the file lacks a column.
    pub(super) fn lacks(&self, column: &Column) -> bool {
        let title = column.title();
        let is_it = |rest: &str, absent: &str| rest.is_empty() || absent.ends_with(['.', '[', ' ']);
        self.absent
            .iter()
            .any(|absent| title.strip_prefix(absent).is_some_and(|rest| is_it(rest, absent)))
    }

    /// Returns the name of a column in the file.
    pub(super) fn renamed(&self, name: &str) -> String {
        let renamed = |[from, to]: &[&str; 2]| Some(format!("{to}{}", name.strip_prefix(from)?));
        self.tops.iter().find_map(renamed).unwrap_or_else(|| name.to_owned())
    }

    /// Sets the columns that the file lacks, and their number.
    pub(super) const fn absent(self, lacking: usize, absent: &'static [&'static str]) -> Waveform {
        Waveform { absent, lacking, ..self }
    }

    /// Sets the signals without a column.
    pub(super) const fn others(self, others: &'static [&'static str]) -> Waveform {
        Waveform { others, ..self }
    }

    /// Sets the beginnings of names.
    pub(super) const fn tops(self, tops: &'static [[&'static str; 2]]) -> Waveform {
        Waveform { tops, ..self }
    }

    /// Marks a file whose vectors have no indices.
    pub(super) const fn without_ranges(self) -> Waveform {
        Waveform { has_ranges: false, ..self }
    }

    /// Marks an FST of GHDL: a real number has no value, an integer its lowest bit only.
    pub(super) const fn cut(self, valueless: &'static str) -> Waveform {
        Waveform { valueless, is_cut: true, ..self }
    }

    /// Sets the significant digits of real numbers.
    pub(super) const fn digits(self, digits: usize) -> Waveform {
        Waveform { digits, ..self }
    }

    /// Marks a file of Icarus, whose first values contain every event.
    pub(super) const fn first_events(self) -> Waveform {
        Waveform { has_first_events: true, ..self }
    }
}

/// Creates a waveform that has every column, with every digit.
pub(super) const fn file(tool: Tool, name: &'static str) -> Waveform {
    Waveform {
        tool,
        name,
        tops: &[],
        absent: &[],
        lacking: 0,
        others: &[],
        valueless: "",
        is_cut: false,
        digits: 17,
        has_ranges: true,
        has_first_events: false,
    }
}
