//! What the firmware of an array takes of the device.

use std::fmt::Write;
use std::fs;

use super::RESOURCES;
use super::cells::{COLUMNS, Cells};
use super::recorded::MAKER;
use super::yosys;

const BEGIN: &str = "<!-- array -->";
const END: &str = "<!-- end of array -->";

/// Rows and columns. With the modules apart, the second bank of a design of one bank would stay.
const SIZES: [[u32; 2]; 2] = [[1, 1], [40, 30]];
const BANKS: u32 = 2;

/// Number of the likelihood estimator.
const LIKELIHOOD: u32 = 2;

#[test]
#[ignore = "long: ./check --full"]
fn an_array_of_the_thesis_fits_the_device_with_a_tdc_and_two_histograms_for_each_column() {
    let sources = yosys::rtl_ref();
    let of = |[rows, columns]: [u32; 2]| {
        let command = format!(
            "chparam -set Rows {rows} -set Columns {columns} -set Banks {BANKS} -set Estimator {LIKELIHOOD} tof_top"
        );
        let name = format!("tof_top.{rows}x{columns}x{BANKS}");
        Cells::of_modules(&sources, "tof_top", &name, &command)
    };
    let found = SIZES.map(|size| (size, of(size)));
    let (_, single) = &found[0];
    for ([_, columns], cells) in &found {
        assert!(cells.odd().is_empty(), "{:?}", cells.odd());
        // Each is 256 bits, of which a histogram has 16.
        assert_eq!(cells.count("RAM256X1S"), u64::from(16 * columns * BANKS));
        // The ROMs of the estimator, and that of each TDC.
        let roms = cells.count("RAMB18E1") - single.count("RAMB18E1");
        assert_eq!(roms, u64::from(columns - 1), "{columns} columns");
        assert_eq!(cells.chain, u64::from(200 * columns), "CARRY4 of the chains");
        assert_eq!(cells.count("DSP48E1"), single.count("DSP48E1"), "one estimator");
    }

    let mut table = format!("| {} |", single.maker);
    COLUMNS.iter().for_each(|(name, _)| write!(table, " {name} |").unwrap());
    table += &format!("\n|---|{}\n", "---:|".repeat(COLUMNS.len()));
    for ([rows, columns], cells) in &found {
        writeln!(table, "| {rows} x {columns} |{}", cells.row()).unwrap();
    }
    writeln!(table, "| of the XC7K325T |{}", found[1].1.used()).unwrap();

    let old = fs::read_to_string(RESOURCES).unwrap();
    let (before, rest) = old.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    let new = format!("{before}{BEGIN}\n\n{table}\n{END}{after}");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(RESOURCES, &new).unwrap();
    } else if single.maker == MAKER {
        let how =
            "UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli synthesis -- --include-ignored";
        assert!(old == new, "docs/resources.md is out of date: {how}");
    }
}
