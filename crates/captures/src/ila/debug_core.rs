//! A probe configuration as Tcl, with which Vivado inserts an ILA core that has the same probes into the board's design.
//!
//! The commands are those that Vivado itself writes into an XDC file for a core that was set up in its window.

use std::fmt::Write;

use tofsim::error::{Input, Result};
use tofsim::hierarchy::{self, TOP};
use tofsim::kernel::scan::Scan;
use tofsim::sim::setup::Setup;

use super::clock::AnalyserClock;
use super::plan::AnalyserPlan;
use super::probes::SignalSlice;
use super::setup::AnalyserSetup;

/// Name of the core.
const CORE: &str = "u_ila_0";

/// Returns the Tcl, for the netlist of a board's top after `synth_design -flatten_hierarchy none`.
///
/// # Errors
/// If the scenario has an array, the core cannot have such a clock, or a probe's signal is a clock or has no net; with the position.
pub fn tcl(set_up: &AnalyserSetup, plan: &AnalyserPlan, setup: &Setup) -> Result<String> {
    one_pixel(setup)?;
    let (clock, clock_hz) = clock(set_up, plan, setup)?;
    let file = &set_up.file;
    let has_qualifier = file.capture.is_some();
    let mut text = format!("create_debug_core {CORE} ila\n");
    let mut set = |name: &str, value: &dyn std::fmt::Display, core: &str| {
        // Writing to memory does not fail.
        let _ = writeln!(text, "set_property {name} {value} [get_debug_cores {core}]");
    };
    // A comparison for the trigger, and one more for the condition under which a sample is stored.
    set("ALL_PROBE_SAME_MU", &true, CORE);
    set("ALL_PROBE_SAME_MU_CNT", &(1 + u32::from(has_qualifier)), CORE);
    set("C_ADV_TRIGGER", &false, CORE);
    set("C_DATA_DEPTH", &file.depth, CORE);
    set("C_EN_STRG_QUAL", &has_qualifier, CORE);
    set("C_INPUT_PIPE_STAGES", &file.input_stages, CORE);
    set("C_TRIGIN_EN", &false, CORE);
    set("C_TRIGOUT_EN", &false, CORE);
    text += &port("clk", &[format!("{TOP}/{clock}")]);
    for (k, bits) in plan.bits.iter().enumerate() {
        if k > 0 {
            text += &format!("create_debug_port {CORE} probe\n");
        }
        let nets = nets(setup, bits).map_err(|expected| {
            let signal = &file.probe[k].signal;
            set_up.fault(&format!("probe.{k}.signal"), signal, expected)
        })?;
        let name = format!("probe{k}");
        text +=
            &format!("set_property PROBE_TYPE DATA_AND_TRIGGER [get_debug_ports {CORE}/{name}]\n");
        text += &port(&name, &nets);
    }
    let _ = write!(
        text,
        "set_property C_CLK_INPUT_FREQ_HZ {clock_hz} [get_debug_cores dbg_hub]\n\
         set_property C_ENABLE_CLK_DIVIDER false [get_debug_cores dbg_hub]\n\
         set_property C_USER_SCAN_CHAIN 1 [get_debug_cores dbg_hub]\n\
         connect_debug_port dbg_hub/clk [get_nets [list {{{TOP}/{clock}}}]]\n"
    );
    Ok(text)
}

/// Refuses arrays.
fn one_pixel(setup: &Setup) -> Result<()> {
    let Scan { rows, columns, banks } = setup.params.frame_ctrl.scan;
    let counts = [("array.rows", rows), ("array.columns", columns), ("array.banks", banks)];
    let Some((key, count)) = counts.into_iter().find(|(_, count)| *count > 1) else {
        return Ok(());
    };
    let expected = "expected 1: the tops of the boards have a single pixel";
    Err(Input::new(format!("scenario {}", setup.name), expected).field(key).value(count).into())
}

/// Connects a port of the core to nets, the lowest bit first.
fn port(name: &str, nets: &[String]) -> String {
    let width = nets.len();
    let nets: String = nets.iter().map(|net| format!(" {{{net}}}")).collect();
    format!(
        "set_property port_width {width} [get_debug_ports {CORE}/{name}]\n\
         connect_debug_port {CORE}/{name} [get_nets [list{nets}]]\n"
    )
}

/// Name and frequency [Hz] of the core's clock.
fn clock(
    set_up: &AnalyserSetup,
    plan: &AnalyserPlan,
    setup: &Setup,
) -> Result<(&'static str, u64)> {
    let pll = setup.scenario.pll.params();
    match plan.sampling {
        AnalyserClock::System => Ok(("clk_sys", pll.system_hz())),
        AnalyserClock::Laser => Ok(("clk_laser", 2 * pll.system_hz())),
        AnalyserClock::Input | AnalyserClock::Free { .. } => {
            let expected =
                "expected clk_sys or clk_laser: a core in the FPGA has one of its buffered clocks";
            Err(set_up.fault("clock", &set_up.file.clock, expected))
        }
    }
}

/// The nets of a probe in the Verilog, the lowest bit first.
fn nets(setup: &Setup, bits: &SignalSlice) -> std::result::Result<Vec<String>, &'static str> {
    let entries = hierarchy::entries(&setup.params);
    let Some(entry) = entries.iter().find(|entry| entry.id == bits.id) else {
        return Err("expected a signal with a net: a word of a RAM has none");
    };
    if entry.scope == format!("{TOP}.pll") || entry.signal.name.starts_with("clk_") {
        return Err("expected no clock: an ILA core cannot sample one");
    }
    let net = entry.path().replace('.', "/");
    Ok(match (entry.signal.width, bits.width) {
        (1, _) => vec![net],
        (_, width) => (bits.low..bits.low + width).map(|bit| format!("{net}[{bit}]")).collect(),
    })
}
