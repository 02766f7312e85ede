//! Waveforms that show expected and actual signals side by side, and viewer setups for them.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use vcd::{IdCode, Writer};

pub use vcd::{TimescaleUnit, Value};

/// Names of the scopes of the two sides.
pub const SIDES: [&str; 2] = ["expected", "got"];

/// Structure of the waveform.
#[derive(Clone, Debug)]
pub struct Layout<'a> {
    /// Name and version of the program, to be written to the header.
    pub version: Option<&'a str>,
    /// Unit of its times.
    pub unit: TimescaleUnit,
    /// Name of the outermost scope.
    pub top: &'a str,
    /// Name of a bit declared before the inner scopes.
    pub first: Option<&'a str>,
    /// Name of a bit declared after the inner scopes.
    pub last: Option<&'a str>,
}

/// A scope with the names and widths of its signals [bits].
pub type Scope<'a> = (&'a str, Vec<(String, u32)>);

/// Writer of a side-by-side waveform.
#[derive(Debug)]
pub struct SideBySide<W> {
    out: W,
    /// Identifier codes of each scope's signals.
    codes: Vec<Vec<IdCode>>,
    /// Identifier code of the bit outside the inner scopes.
    bit: IdCode,
}

impl<W: Write> SideBySide<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn begin(mut out: W, layout: &Layout, scopes: &[Scope]) -> io::Result<Self> {
        let mut vcd = Writer::new(&mut out);
        if let Some(version) = layout.version {
            vcd.version(version)?;
        }
        vcd.timescale(1, layout.unit)?;
        vcd.add_module(layout.top)?;
        let mut bit = layout.first.map(|name| vcd.add_wire(1, name)).transpose()?;
        let mut codes = Vec::new();
        for (name, signals) in scopes {
            vcd.add_module(name)?;
            let signals = signals.iter().map(|(name, width)| vcd.add_wire(*width, name));
            codes.push(signals.collect::<io::Result<_>>()?);
            vcd.upscope()?;
        }
        if let Some(name) = layout.last {
            bit = Some(vcd.add_wire(1, name)?);
        }
        vcd.upscope()?;
        vcd.enddefinitions()?;
        Ok(SideBySide { out, codes, bit: bit.unwrap_or(IdCode::FIRST) })
    }

    /// Sets the time of the changes that follow, in the layout's unit.
    ///
    /// # Errors
    /// If the output cannot be written.
    pub fn time(&mut self, at: u64) -> io::Result<()> {
        Writer::new(&mut self.out).timestamp(at)
    }

    /// Writes a change of the bit outside the inner scopes.
    ///
    /// # Errors
    /// If the output cannot be written.
    pub fn bit(&mut self, level: bool) -> io::Result<()> {
        Writer::new(&mut self.out).change_scalar(self.bit, level)
    }

    /// Writes a change of a one-bit signal.
    ///
    /// # Errors
    /// If the output cannot be written.
    pub fn scalar(&mut self, scope: usize, signal: usize, level: Value) -> io::Result<()> {
        Writer::new(&mut self.out).change_scalar(self.codes[scope][signal], level)
    }

    /// Writes a change of a vector; bits are given most significant first.
    ///
    /// # Errors
    /// If the output cannot be written.
    pub fn vector(
        &mut self,
        scope: usize,
        signal: usize,
        bits: impl IntoIterator<Item = Value>,
    ) -> io::Result<()> {
        Writer::new(&mut self.out).change_vector(self.codes[scope][signal], bits)
    }

    /// Returns the output.
    pub fn out(&self) -> &W {
        &self.out
    }

    /// Unwraps the output.
    pub fn into_out(self) -> W {
        self.out
    }
}

/// GTKWave's flags for a signal in hexadecimal.
pub const HEXADECIMAL: &str = "22";
/// GTKWave's flags for a signal in binary.
pub const BINARY: &str = "28";

/// A signal as a viewer shows it.
#[derive(Clone, Debug)]
pub struct Shown<'a> {
    /// GTKWave's flags.
    pub flags: &'static str,
    /// GTKWave's colour number, if any.
    pub colour: Option<u32>,
    /// Label in GTKWave.
    pub label: String,
    /// Name of its scope.
    pub scope: &'a str,
    /// Name in its scope.
    pub name: String,
    /// Width [bits].
    pub width: u32,
}

/// Returns the bit range that GTKWave appends to a vector's name.
pub fn range(width: u32) -> String {
    if width > 1 { format!("[{}:0]", width - 1) } else { String::new() }
}

/// Initial view of a viewer.
#[derive(Clone, Debug)]
pub struct View<'a> {
    /// Name of the outermost scope, and of the bit in it.
    pub top: [&'a str; 2],
    /// GTKWave's colour number of that bit.
    pub colour: Option<u32>,
    /// Start of the visible time range, in the waveform's unit.
    pub from: u64,
    /// GTKWave's zoom value.
    pub zoom: String,
    /// Height of the window [pixels].
    pub height: u32,
    /// Widths of the columns of scopes and names, if set [pixels].
    pub columns: Option<[u32; 2]>,
    /// Time of the first difference, in the waveform's unit.
    pub marker: Option<u64>,
    /// Signals, in display order.
    pub signals: Vec<Shown<'a>>,
}

impl View<'_> {
    /// Formats GTKWave's save file for the waveform `wave`, which has the same stem and folder.
    pub fn gtkwave(&self, wave: &str) -> String {
        let View { top: [top, bit], from, zoom, height, .. } = self;
        let marker = self.marker.map_or("-1".to_owned(), |at| at.to_string());
        // With its own name in it, the paths in a save file count from where it is.
        let own = Path::new(wave).with_extension("gtkw");
        let mut text = format!(
            "[dumpfile] \"{wave}\"\n[savefile] \"{}\"\n[timestart] {from}\n[size] 1400 {height}\n\
            *{zoom} {marker}\n",
            own.display()
        );
        // Writing to a string cannot fail.
        if let Some([scopes, names]) = self.columns {
            let _ = writeln!(text, "[sst_width] {scopes}\n[signals_width] {names}");
        }
        let colour =
            |colour: Option<u32>| colour.map_or(String::new(), |n| format!("[color] {n}\n"));
        let _ = writeln!(text, "@{BINARY}\n{}{top}.{bit}", colour(self.colour));
        for Shown { flags, colour: own, label, scope, name, width } in &self.signals {
            let (own, range) = (colour(*own), range(*width));
            let _ = writeln!(text, "@{flags}\n{own}+{{{label}}} {top}.{scope}.{name}{range}");
        }
        text
    }

    /// Formats Surfer's command file.
    pub fn surfer(&self) -> String {
        let [top, bit] = self.top;
        let mut text = format!("variable_add {top}.{bit}\n");
        for Shown { scope, name, .. } in &self.signals {
            let _ = writeln!(text, "variable_add {top}.{scope}.{name}");
        }
        if let Some(at) = self.marker {
            let _ = write!(text, "marker_set first {at}\ncursor_set {at}\n");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_stand_under_one_top_with_the_bit_that_goes_with_them() {
        let unit = TimescaleUnit::PS;
        let layout = Layout { version: None, unit, top: "pair", first: None, last: Some("any") };
        let scopes = SIDES.map(|side| (side, vec![("depth".to_owned(), 2)]));
        let mut wave = SideBySide::begin(Vec::new(), &layout, &scopes).unwrap();
        wave.time(8).unwrap();
        wave.vector(1, 0, [Value::V1, Value::X]).unwrap();
        wave.bit(true).unwrap();
        let text = String::from_utf8(wave.into_out()).unwrap();
        let expected = "$timescale 1 ps $end\n$scope module pair $end\n\
            $scope module expected $end\n$var wire 2 ! depth $end\n$upscope $end\n\
            $scope module got $end\n$var wire 2 \" depth $end\n$upscope $end\n\
            $var wire 1 # any $end\n$upscope $end\n$enddefinitions $end\n#8\nb1x \"\n1#\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_view_begins_with_the_bit_and_puts_a_marker_on_the_first_difference() {
        let depth = Shown {
            flags: HEXADECIMAL,
            colour: Some(4),
            label: "depth got".to_owned(),
            scope: "got",
            name: "depth".to_owned(),
            width: 36,
        };
        let view = View {
            top: ["pair", "any"],
            colour: None,
            from: 8,
            zoom: "-14.0".to_owned(),
            height: 700,
            columns: None,
            marker: Some(16),
            signals: vec![depth],
        };
        let save = "[dumpfile] \"a.vcd\"\n[savefile] \"a.gtkw\"\n[timestart] 8\n[size] 1400 700\n*-14.0 16\n@28\npair.any\n\
            @22\n[color] 4\n+{depth got} pair.got.depth[35:0]\n";
        assert_eq!(view.gtkwave("a.vcd"), save);
        let commands = "variable_add pair.any\nvariable_add pair.got.depth\n\
            marker_set first 16\ncursor_set 16\n";
        assert_eq!(view.surfer(), commands);
    }
}
