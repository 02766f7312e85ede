//! A decoder's ROM from measured counts: a table, a file, and the same for scripts.

use serde_json::{Value, json};

use tofsim::scenario::calibration::HEADER;
use tofsim_learn::characterisation::rom::{CalibratedRom, RomEntry};

use crate::text::table::{self, grouped};

/// Rows of the table, spread evenly over the words that hits came to.
const SHOWN: usize = 16;

/// What it comes of, and some of its words.
pub fn text(rom: &CalibratedRom) -> String {
    let hit: Vec<&RomEntry> = rom.entries.iter().filter(|entry| entry.count > 0).collect();
    let shown = (0..SHOWN.min(hit.len())).filter_map(|k| match hit.len() {
        len if len <= SHOWN => hit.get(k),
        len => hit.get(k * (len - 1) / (SHOWN - 1)),
    });
    let rows = shown.map(|entry| {
        [
            entry.n.to_string(),
            grouped(entry.count),
            format!("{:.2}", entry.age_ps),
            format!("{:.2}", entry.age_se_ps),
            entry.units.to_string(),
        ]
    });
    let header = ["n", "count", "age [ps]", "se [ps]", "word"];
    let facts = table::facts([
        ("hits", grouped(rom.hits)),
        ("words", format!("{}, {} of them with hits", rom.entries.len(), hit.len())),
        ("mean tap", format!("{:.3} ps", rom.lsb_ps)),
        ("standard error", format!("{:.2} ps at most", rom.largest_se_ps)),
    ]);
    format!("{facts}\n\n{}\n", table::table(header, rows, 0..))
}

/// The file that `tdc.calibration` reads.
pub fn csv(rom: &CalibratedRom) -> String {
    let rows = rom.entries.iter();
    let rows =
        rows.map(|entry| format!("{},{:.3},{:.3}\n", entry.n, entry.age_ps, entry.age_se_ps));
    format!("{}\n{}", HEADER.join(","), rows.collect::<String>())
}

/// The same for scripts.
pub fn json(rom: &CalibratedRom) -> Value {
    let entry = |entry: &RomEntry| {
        json!({
            "n": entry.n,
            "count": entry.count,
            "age_ps": entry.age_ps,
            "age_se_ps": entry.age_se_ps,
            "units": entry.units,
        })
    };
    json!({
        "schema": "tofsim.tdc_calibration/1",
        "hits": rom.hits,
        "lsb_ps": rom.lsb_ps,
        "largest_se_ps": rom.largest_se_ps,
        "enough_hits": rom.enough(),
        "entries": rom.entries.iter().map(entry).collect::<Vec<_>>(),
    })
}
