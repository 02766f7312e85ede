//! GTKWave save files (checked with version 3.3.118).

use std::fmt::Write;

use crate::hierarchy::{CHANNEL, Entry};
use crate::kernel::signals::SignalFormat;

use super::layout::{Group, ShownSignal};
use super::marks::Marks;
use super::side_by_side::range;
use super::writer::WaveFormat;

/// Trace flags, which a save file holds in hexadecimal.
mod flag {
    pub(super) const HEXADECIMAL: u64 = 0x2;
    pub(super) const DECIMAL: u64 = 0x4;
    pub(super) const BINARY: u64 = 0x8;
    pub(super) const RIGHT: u64 = 0x20;
    pub(super) const BLANK: u64 = 0x200;
    pub(super) const SIGNED: u64 = 0x400;
    pub(super) const COLLAPSED: u64 = 0x1000;
    pub(super) const NAMES: u64 = 0x2000;
    pub(super) const STEPS: u64 = 0x8000;
    pub(super) const STRETCH: u64 = 0x20000;
    pub(super) const FULL_SCALE: u64 = 0x80000;
    pub(super) const CLOSED: u64 = 0x400000;
    pub(super) const BEGIN: u64 = 0x800000;
    pub(super) const END: u64 = 0x1000000;
    pub(super) const ONES: u64 = 0x20000000;
    pub(super) const FIXED_POINT: u64 = 0x40000000;
    pub(super) const STATES: u64 = 0x100000000;
}

/// Size of the window [pixels].
const SIZE: (u32, u32) = (1600, 900);
/// Widths of the column of scopes, and of that of names and values [pixels].
const COLUMNS: (u32, u32) = (180, 400);
/// Width of frames and scroll bars [pixels].
const FRAMES: u32 = 110;
/// Width that shows 2^n units of time at a zoom of -n [pixels].
const ZOOM_PIXELS: f64 = 200.0;
/// Rows of a curve in addition to its first one.
const CURVE_ROWS: usize = 2;
/// Most fraction bits that GTKWave shows; with more, it drops them.
const FRACTION: u32 = 30;
/// Largest number of named markers.
const MARKERS: usize = 26;

/// Formats the save file for the waveform `wave`, whose files of state names, if it needs some, begin with `stem`.
pub(super) fn save_file(
    (wave, format): (&str, WaveFormat),
    stem: &str,
    groups: &[Group<'_>],
    marks: &Marks,
) -> String {
    let mut text = String::new();
    let mut lines = Lines { text: &mut text, stem, format };
    lines.header(wave, marks);
    for group in groups {
        let closed = if group.closed { flag::CLOSED } else { 0 };
        let hidden = if group.closed { flag::CLOSED | flag::COLLAPSED } else { 0 };
        lines.label(flag::BEGIN | flag::BLANK | closed, group.name);
        for row in &group.rows {
            lines.row(row);
        }
        lines.label(flag::END | flag::BLANK | hidden, group.name);
    }
    text
}

/// Returns the name of the file that holds the state names of `row`.
pub(super) fn names_file(stem: &str, row: &ShownSignal<'_>) -> String {
    format!("{stem}.{}.txt", row.name)
}

/// Formats a file of state names: each code in binary as GTKWave displays it, and its name.
pub(super) fn names(states: &[&str], width: usize) -> String {
    states.iter().enumerate().map(|(code, state)| format!("{code:0width$b} {state}\n")).collect()
}

struct Lines<'a> {
    text: &'a mut String,
    stem: &'a str,
    format: WaveFormat,
}

impl Lines<'_> {
    fn line(&mut self, line: impl std::fmt::Display) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{line}");
    }

    fn header(&mut self, wave: &str, marks: &Marks) {
        // With its own name in it, the paths in a save file count from where it is.
        let (stem, from) = (self.stem, marks.from.ps());
        self.line(format_args!("[dumpfile] \"{wave}\"\n[savefile] \"{stem}.gtkw\""));
        let ((width, height), (tree, names)) = (SIZE, COLUMNS);
        self.line(format_args!("[timestart] {from}\n[size] {width} {height}\n[pos] -1 -1"));
        let named = marks.named();
        let mut places: Vec<String> = named.iter().map(|(_, at)| at.ps().to_string()).collect();
        places.resize(MARKERS, "-1".into());
        let primary = marks.laser_edge.map_or("-1".into(), |at| at.ps().to_string());
        let zoom = zoom(marks.to.since(marks.from).ps(), width - tree - names - FRAMES);
        self.line(format_args!("*{zoom:.6} {primary} {}", places.join(" ")));
        for ((name, _), letter) in named.iter().zip('A'..) {
            self.line(format_args!("[markername] {letter}{name}"));
        }
        self.line(format_args!("[treeopen] tof_top.\n[sst_width] {tree}"));
        self.line(format_args!("[signals_width] {names}\n[sst_expanded] 1"));
    }

    fn label(&mut self, flags: u64, name: &str) {
        self.line(format_args!("@{flags:x}\n-{name}"));
    }

    fn row(&mut self, row: &ShownSignal<'_>) {
        let signal = &row.entry.signal;
        let fraction = Some(signal.fraction()).filter(|bits| (1..=FRACTION).contains(bits));
        let point = if fraction.is_some() { flag::FIXED_POINT } else { 0 };
        let radix = match signal.format {
            SignalFormat::State(_) if self.format == WaveFormat::Fst => flag::BINARY | flag::STATES,
            SignalFormat::State(_) => flag::BINARY | flag::NAMES,
            SignalFormat::Bits if signal.width == 1 => flag::BINARY,
            SignalFormat::Bits => flag::HEXADECIMAL,
            SignalFormat::Unsigned if fraction.is_none() && signal.width > 32 => flag::HEXADECIMAL,
            SignalFormat::Unsigned => flag::DECIMAL | point,
            SignalFormat::Signed { .. } => flag::SIGNED | point,
            SignalFormat::Taps => flag::DECIMAL | flag::ONES,
        };
        self.line(format_args!("@{:x}", radix | flag::RIGHT));
        match (signal.format, fraction) {
            (SignalFormat::State(_), _) if self.format == WaveFormat::Vcd => {
                self.line(format_args!("^1 {}", names_file(self.stem, row)));
            }
            (SignalFormat::Unsigned | SignalFormat::Signed { .. }, Some(fraction)) => {
                self.line(format_args!("[fpshift_count] {fraction}"));
            }
            _ => {}
        }
        let unit = signal.unit.without(if fraction.is_some() { 0 } else { signal.fraction() });
        let unit = if unit.is_empty() { unit } else { format!(" [{unit}]") };
        let note = if signal.format == SignalFormat::Taps { " (ones)" } else { &unit };
        self.named(row, note);
        if row.curve {
            let signed = matches!(signal.format, SignalFormat::Signed { .. });
            let radix = if signed { flag::SIGNED } else { flag::DECIMAL };
            let curve = radix | flag::RIGHT | flag::STEPS | flag::FULL_SCALE;
            self.line(format_args!("@{curve:x}"));
            self.named(row, " (curve)");
            self.line(format_args!("@{:x}{}", flag::STRETCH, "\n-".repeat(CURVE_ROWS)));
        }
    }

    fn named(&mut self, row: &ShownSignal<'_>, note: &str) {
        // GTKWave would show a name with dots from the last dot on.
        let parts: Vec<_> = row.name.split('.').collect();
        let (outer, last) = parts.split_at(parts.len().saturating_sub(2));
        let channel = outer.first().filter(|scope| scope.starts_with(CHANNEL));
        let shown = channel.into_iter().chain(last).copied().collect::<Vec<_>>().join("/");
        self.line(format_args!("+{{{shown}{note}}} {}", full_name(row.entry)));
    }
}

/// Returns GTKWave's name of a signal.
fn full_name(entry: &Entry) -> String {
    entry.path() + &range(entry.signal.width)
}

/// Computes GTKWave's zoom value that shows `span` units of time in `pixels`.
pub fn zoom(span: u64, pixels: u32) -> f64 {
    -(span.max(1) as f64 * ZOOM_PIXELS / f64::from(pixels)).log2()
}
