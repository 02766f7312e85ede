//! Set-ups of viewers for the waveform of both sides: what differs first stands on top.

use std::fmt::Write;

use tofsim::waves::zoom;

use crate::source::Axis;

use super::result::{Compared, Comparison};

/// Scopes of the two sides and of what differs.
pub(super) const SCOPES: [&str; 3] = ["expected", "got", "differs"];
/// The scope around them.
pub(super) const TOP: &str = "compare";
/// Pairs that are shown at first.
const SHOWN: usize = 32;
/// Part of the waveform that is shown around the first difference.
const PART: u64 = 16;
/// Width that waves have in GTKWave's window [pixels].
const PIXELS: u32 = 680;
/// GTKWave's colours of the three scopes: green, yellow, red.
const COLOURS: [u32; 3] = [4, 3, 1];

/// What a viewer shows.
pub(super) struct View<'a> {
    pairs: Vec<&'a Compared>,
    /// First difference [ps].
    first: Option<u64>,
    /// Where the waveform begins and ends [ps].
    span: (u64, u64),
}

impl<'a> View<'a> {
    /// Of a waveform with that begin and end [ps].
    pub(super) fn new(result: &'a Comparison, span: (u64, u64)) -> Self {
        let time = |at: u64| match result.sides[0].axis {
            Axis::Time(tick) => (tick.femtoseconds(at) / 1000) as u64,
            Axis::Samples => at,
        };
        let firsts = result.pairs.iter().filter_map(|pair| pair.first.as_ref());
        let first = firsts.map(|first| time(first.at[0])).min();
        View { pairs: result.pairs.iter().take(SHOWN).collect(), first, span }
    }

    fn names(pair: &Compared) -> [String; 3] {
        let range = if pair.width > 1 { format!("[{}:0]", pair.width - 1) } else { String::new() };
        let name = flat(&pair.name);
        [0, 1, 2].map(|scope| {
            let range = if scope == 2 { "" } else { &range };
            format!("{TOP}.{}.{name}{range}", SCOPES[scope])
        })
    }

    /// GTKWave's save file for the waveform called `wave`.
    pub(super) fn gtkwave(&self, wave: &str) -> String {
        let first = self.first.map_or("-1".to_owned(), |first| first.to_string());
        let (begin, end) = self.span;
        let whole = end.saturating_sub(begin).max(1);
        let (from, shown) = match self.first {
            Some(first) => (first.saturating_sub(whole / PART / 2), (whole / PART).max(1)),
            None => (begin, whole),
        };
        let zoom = zoom(shown, PIXELS);
        let mut text = format!(
            "[dumpfile] \"{wave}\"\n[timestart] {from}\n[size] 1400 800\n*{zoom:.6} {first}\n\
             [sst_width] 160\n[signals_width] 420\n@28\n[color] 1\n{TOP}.any_differs\n"
        );
        for pair in &self.pairs {
            for (scope, name) in Self::names(pair).into_iter().enumerate() {
                let flags = if scope == 2 || pair.width == 1 { 28 } else { 22 };
                let shown = format!("{} {}", flat(&pair.name), SCOPES[scope]);
                // Writing to a string cannot fail.
                let _ = writeln!(text, "@{flags}\n[color] {}\n+{{{shown}}} {name}", COLOURS[scope]);
            }
        }
        text
    }

    /// Surfer's command file.
    pub(super) fn surfer(&self) -> String {
        let mut text = format!("variable_add {TOP}.any_differs\n");
        for pair in &self.pairs {
            let name = flat(&pair.name);
            for scope in SCOPES {
                let _ = writeln!(text, "variable_add {TOP}.{scope}.{name}");
            }
        }
        if let Some(first) = self.first {
            let _ = write!(text, "marker_set first {first}\ncursor_set {first}\n");
        }
        text
    }
}

/// A name without dots, which would be scopes, or spaces.
pub(super) fn flat(name: &str) -> String {
    name.replace('.', "/").replace(' ', "_").replace('\\', "")
}
