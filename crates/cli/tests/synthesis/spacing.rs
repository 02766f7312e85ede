//! Smallest distance of hits, proven with Yosys by induction.

use std::path::Path;

use tofsim_rtl::verify::process::YOSYS;

use super::yosys::{output, paths};

/// The property, and what makes the hits.
const CHECK: &str = "crates/cli/tests/synthesis/spacing.sv";

/// Longest induction.
const STEPS: u32 = 40;

/// Whether no hit of `source` comes in the `gap` cycles after another. Its ROM is open: any word may come
/// at any time; so are the taps.
pub fn is_proven(source: &str, gap: u64) -> bool {
    let stop = if source == "tdc" { "-DHAS_STOP" } else { "" };
    let parts =
        ["vcsel_driver", "coarse_counter", "tdc_latch", "tdc_decoder", "tdc", "code_preload"];
    let script = [
        &format!("read_verilog -defer {}", paths(parts)),
        &format!("read_verilog -sv -formal -DSOURCE={source} -DGap={gap} {stop} {CHECK}"),
        "hierarchy -top spacing; proc; flatten; delete t:$mem*; opt_clean; async2sync; opt_clean",
        &format!(
            "sat -tempinduct -prove-asserts -set-assumes -ignore_unknown_cells -seq 1 -maxsteps {STEPS} spacing"
        ),
    ]
    .join("\n");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let says = output(YOSYS, &root, &["-p", &script]);
    let holds = says.contains("Induction step proven: SUCCESS!");
    assert!(holds || says.contains("FAIL!"), "neither proven nor refuted: {source}, {gap} cycles");
    holds
}
