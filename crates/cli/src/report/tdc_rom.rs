//! A decoder's ROM from measured counts: a table, a file and JSON.

use serde_json::{Value, json};

use tofsim_learn::characterisation::rom::{CalibratedRom, RomEntry};

use crate::text::table::{self, grouped};

use super::sheet::Digits::{Fixed, Shortest};
use super::sheet::{Sheet, evenly};
use super::writer::Findings;

/// Rows of the table, spread evenly over the words with hits.
const SHOWN: usize = 16;

impl Findings for CalibratedRom {
    const SCHEMA: &'static str = "tofsim.tdc_calibration/1";

    fn json(&self) -> Value {
        json!({
            "hits": self.hits,
            "lsb_ps": self.lsb_ps,
            "largest_se_ps": self.largest_se_ps,
            "enough_hits": self.enough(),
            "entries": self.entries,
        })
    }

    /// The source of the ROM, and some of its words.
    fn text(&self) -> String {
        let words = self.entries.len();
        let hit: Vec<_> = (0..words).filter(|&n| self.entries[n].count > 0).collect();
        let facts = table::facts([
            ("hits", grouped(self.hits)),
            ("words", format!("{words}, {} of them with hits", hit.len())),
            ("mean tap", format!("{:.3} ps", self.lsb_ps)),
            ("standard error", format!("{:.2} ps at most", self.largest_se_ps)),
        ]);
        let shown = evenly(hit.len(), SHOWN).map(|k| hit[k]);
        format!("{facts}\n\n{}\n", sheet(self).table_of(shown))
    }
}

/// Returns the file that `tdc.calibration` reads.
pub fn csv(rom: &CalibratedRom) -> String {
    sheet(rom).csv()
}

fn sheet(rom: &CalibratedRom) -> Sheet<'_, RomEntry> {
    Sheet::of(&rom.entries)
        .both(("n", Shortest), ("n", Shortest), |entry| entry.n)
        .words("count", |entry| grouped(entry.count))
        .both(("age_ps", Fixed(3)), ("age [ps]", Fixed(2)), |entry| entry.age_ps)
        .both(("age_se_ps", Fixed(3)), ("se [ps]", Fixed(2)), |entry| entry.age_se_ps)
        .words("word", |entry| entry.units)
}
