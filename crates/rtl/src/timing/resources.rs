//! Resources of a part that a design takes, by Yosys.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use tofsim::error::{Input, Result, read_text};

use crate::verify::Rtl;
use crate::verify::process::Limits;
use crate::verify::yosys;

use super::synthesis::Part;

/// Resources of a part that a design takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Resources {
    /// LUTs, those of carry cells and distributed RAM among them.
    pub lut: u64,
    /// Of these, those that are RAM.
    pub lut_ram: u64,
    /// Flip-flops.
    pub ff: u64,
    /// Block RAMs: of 36 Kb on a Kintex-7, of 18 Kb on an ECP5; half of one of 36 Kb counts as a half.
    pub bram: f64,
    /// Multipliers: DSP48E1, or MULT18X18D.
    pub dsp: u64,
    /// Every primitive by its type.
    pub cells: BTreeMap<String, u64>,
}

/// Returns the LUTs of a primitive, and whether they are RAM (UG474; Lattice FPGA-TN-02205).
fn luts(part: Part, cell: &str) -> (u64, bool) {
    match (part, cell) {
        (Part::Kintex7, "RAM256X1S") => (4, true),
        (Part::Kintex7, "RAM128X1S" | "RAM64X1D" | "RAM32X1D") => (2, true),
        (Part::Kintex7, "RAM64X1S" | "RAM32X1S" | "SRL16E" | "SRLC32E") => (1, true),
        (Part::Kintex7, "RAM64M" | "RAM32M" | "RAM128X1D") => (4, true),
        (Part::Kintex7, "INV") => (1, false),
        (Part::Kintex7, name) if name.starts_with("LUT") => (1, false),
        (Part::Ecp5, "LUT4") => (1, false),
        (Part::Ecp5, "CCU2C") => (2, false),
        // Four of RAM and two that write.
        (Part::Ecp5, "TRELLIS_DPR16X4") => (6, true),
        _ => (0, false),
    }
}

impl Resources {
    /// Of so many primitives of each type.
    pub fn of(part: Part, cells: BTreeMap<String, u64>) -> Self {
        let sum =
            |of: &dyn Fn(&str) -> u64| cells.iter().map(|(name, n)| n * of(name)).sum::<u64>();
        let is = |wanted: bool| u64::from(wanted);
        let halves = |name: &str| match name {
            "RAMB36E1" | "DP16KD" => 2,
            "RAMB18E1" => 1,
            _ => 0,
        };
        Resources {
            lut: sum(&|name| luts(part, name).0),
            lut_ram: sum(&|name| luts(part, name).0 * is(luts(part, name).1)),
            ff: sum(&|name| match part {
                Part::Kintex7 => is(name.starts_with("FD")),
                Part::Ecp5 => is(name == "TRELLIS_FF"),
            }),
            bram: sum(&halves) as f64 / 2.0,
            dsp: sum(&|name| is(name == "DSP48E1" || name == "MULT18X18D")),
            cells,
        }
    }
}

/// Synthesises the module `top` of a design; what it loads is beside its sources in `folder`. The netlist's
/// numbers go to a file in `work`.
///
/// # Errors
/// When Yosys is missing, refuses the sources, or does not end.
pub fn resources(
    rtl: &Rtl,
    (top, part): (&str, Part),
    [folder, work]: [&Path; 2],
    limits: &Limits,
) -> Result<Resources> {
    let absolute = std::path::absolute(work).unwrap_or_else(|_| work.to_owned());
    let stat = absolute.join(format!("{top}.{}.json", part.name()));
    let script = format!("{}\ntee -q -o {} stat -json\n", part.synth(top), stat.display());
    let sources = yosys::sources(rtl, top, folder, part.define())?;
    yosys::synthesise((rtl, top), folder, sources, script, limits)?;
    let found: Option<Value> = serde_json::from_str(&read_text(&stat)?).ok();
    let cells = found.and_then(|mut found| {
        let cells = found.pointer_mut("/design/num_cells_by_type").map(Value::take)?;
        serde_json::from_value(cells).ok()
    });
    let expected = "expected what `stat -json` of Yosys writes";
    let cells = cells.ok_or_else(|| Input::new(stat.display(), expected))?;
    Ok(Resources::of(part, cells))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn primitives_are_counted_as_the_parts_count_them() {
        let cells = |list: &[(&str, u64)]| {
            list.iter().map(|(name, count)| ((*name).to_owned(), *count)).collect()
        };
        let xilinx = [("LUT6", 10), ("INV", 1), ("RAM256X1S", 2), ("FDRE", 7), ("FDCE", 1)];
        let memory = [("RAMB36E1", 3), ("RAMB18E1", 1), ("DSP48E1", 4), ("CARRY4", 5)];
        let all = Resources::of(Part::Kintex7, cells(&[&xilinx[..], &memory].concat()));
        assert_eq!((all.lut, all.lut_ram, all.ff, all.bram, all.dsp), (19, 8, 8, 3.5, 4));
        let lattice = [("LUT4", 10), ("CCU2C", 3), ("TRELLIS_DPR16X4", 2), ("TRELLIS_FF", 9)];
        let memory = [("DP16KD", 3), ("MULT18X18D", 2)];
        let all = Resources::of(Part::Ecp5, cells(&[&lattice[..], &memory].concat()));
        assert_eq!((all.lut, all.lut_ram, all.ff, all.bram, all.dsp), (28, 12, 9, 3.0, 2));
    }
}
