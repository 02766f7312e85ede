//! One instrument as a design of its own: our modules, its ROMs, a module with its parameters set, a top for
//! its board, and that board's constraints.

mod board;
mod wrapper;

pub use board::{constraints, top};
pub use wrapper::{MAP, MODULE, map};

use tofsim::scenario::Part;
use tofsim::sim::setup::Setup;

use crate::golden::{blocks, parameters};

/// Name and text of each file of its Verilog; paths in it are from the folder that has them.
pub fn verilog(setup: &Setup) -> Vec<(String, String)> {
    let all = parameters::whole::tof_top_in_full(setup);
    let mut files: Vec<_> = blocks::verilog().map(|(name, text)| (name, text.to_owned())).collect();
    files.extend(
        parameters::memories(&all).map(|memory| (memory.name.to_string(), memory.text.clone())),
    );
    files.push((format!("{MODULE}.v"), wrapper::module(setup, &all)));
    files.push((format!("{}.v", board::name(setup)), top(setup)));
    files.push(("ring_oscillator.v".to_owned(), board::RING_OSCILLATOR.to_owned()));
    files.push((MAP.to_owned(), map(&all)));
    files
}

/// The ending of a file of constraints, which the part's tools have.
pub fn constraints_ending(part: Part) -> &'static str {
    match part {
        Part::Kintex7 => "xdc",
        Part::Ecp5 => "lpf",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup(set: &[&str]) -> Setup {
        Setup::load("kc705", set).unwrap()
    }

    fn file(files: &[(String, String)], name: &str) -> String {
        files.iter().find(|(known, _)| known == name).unwrap().1.clone()
    }

    #[test]
    fn the_kc705_has_the_constraints_of_rtl_ref_and_all_its_parameters() {
        let setup = setup(&[]);
        assert_eq!(constraints(&setup), include_str!("../../../rtl_ref/kc705.xdc"));
        let text = file(&verilog(&setup), "instrument.v");
        for set in [".Taps(800)", ".BinBits(8)", ".OutputDivide(8)", ".Neurons(8)", "ShotsPerFrame"]
        {
            assert!(text.contains(set), "{set}: {text}");
        }
    }

    #[test]
    fn the_boards_tops_have_the_hash_of_their_parameters() {
        let ecp5 = ["pll.part=ecp5", "pll.divide=2", "pll.output_divide=4"];
        let tops = [
            (&[][..], include_str!("../../../rtl_ref/kc705_top.v")),
            (&ecp5[..], include_str!("../../../rtl_ref/ecp5_top.v")),
        ];
        for (set, text) in tops {
            let setup = setup(&[&["tdc.recalibrate_frames=64"], set].concat());
            let hash = parameters::hash::parameters_hash(&setup);
            let expected = format!("parameter [63:0] ParametersHash = 64'h{hash:016x}");
            assert!(text.contains(&expected), "expected {expected}");
        }
    }

    #[test]
    fn other_widths_and_clocks_reach_top_and_constraints() {
        let setup = setup(&[
            "tdc.bins=64",
            "tdc.bin_ps=100",
            "firmware.count_bits=18",
            "estimator.kind=centroid",
            "tdc.profile=ecp5",
            "firmware.laser_periods=[10]",
            "firmware.laser_freq=0",
            "pll.input_hz=100000000",
            "pll.multiply=10",
        ]);
        let (files, pins) = (verilog(&setup), constraints(&setup));
        let top = file(&files, "kc705_top.v");
        assert!(top.contains("output wire [5:0] hist_bin") && top.contains("[17:0] hist_count"));
        assert!(top.contains("tof_top #("), "{top}");
        assert!(pins.contains("create_clock -period 10.000 "), "{pins}");
        assert!(pins.contains("hist_bin[5]") && !pins.contains("hist_bin[6]"), "{pins}");
        assert!(!pins.contains("laser_freq[1]"), "{pins}");
        let without = "# hist_count[17]: this board's file has no pin for it";
        assert!(pins.contains(without), "{pins}");
    }

    #[test]
    fn an_ecp5_has_a_top_and_constraints_of_its_own() {
        let setup = setup(&[
            "pll.part=ecp5",
            "pll.input_hz=25000000",
            "pll.multiply=24",
            "pll.output_divide=6",
            "tdc.profile=ecp5",
        ]);
        let (files, pins) = (verilog(&setup), constraints(&setup));
        let top = file(&files, "ecp5_top.v");
        assert!(top.contains(".InputHz(25000000)") && !top.contains("200000000"), "{top}");
        assert!(top.contains("// oscillator, 25 MHz"), "{top}");
        assert!(top.contains(".Hosted(1)") && top.contains(".HostTimeout(50000000)"), "{top}");
        assert!(pins.contains("FREQUENCY PORT \"clk_in\" 25 MHZ;"), "{pins}");
    }
}
