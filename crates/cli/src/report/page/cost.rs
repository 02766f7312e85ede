//! Resources of the instrument on two parts.

use serde_json::Value;

use crate::page::html::table;

/// Resources of the parts: LUT, FF, block RAM, multipliers (docs/resources.md; Lattice FPGA-DS-02012).
const PARTS: [(&str, &str, [u64; 4]); 2] = [
    ("kintex7", "XC7K325T", [203_800, 407_600, 445, 840]),
    ("ecp5", "LFE5UM5G-85F", [83_640, 83_640, 208, 156]),
];
const KINDS: [(&str, &str); 4] =
    [("lut", "LUT"), ("ff", "flip-flops"), ("bram", "block RAM"), ("dsp", "multipliers")];

/// A table for both parts.
pub fn section(cost: &Value) -> String {
    if cost.is_null() {
        return "<p class=\"bad\">This was not counted: Yosys was not there.</p>\n".to_owned();
    }
    let rows = PARTS.into_iter().flat_map(|(part, name, has)| {
        KINDS.into_iter().zip(has).filter_map(move |((key, what), has)| {
            let used = cost["parts"][part][key].as_f64()?;
            let share = format!("{:.1} %", 100.0 * used / has as f64);
            Some([name.to_owned(), what.to_owned(), used.to_string(), has.to_string(), share])
        })
    });
    let maker = cost["maker"].as_str().unwrap_or("Yosys");
    format!(
        "{}<p>{maker}, without place and route; a vendor's tool comes to other numbers. LUTs include those that are \
         RAM or carry. Block RAM is of 36 Kb on the Kintex-7, and of 18 Kb on the ECP5.</p>\n",
        table(&["part", "primitive", "used", "of", "share"], rows)
    )
}
