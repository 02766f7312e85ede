//! What the connections do not tell: clocks, ports that show what is held elsewhere, and the order
//! of the modules.

use crate::firmware::tof_top::Estimator;

use super::Kind;

/// Clock inputs, by scope below the top; a module that serves any domain calls its clock `clk`.
pub(super) const CLOCKS: &[(&str, &[&str])] = &[
    ("pll", &["clk_200"]),
    ("control_sync", &["clk_125"]),
    ("frame_ctrl", &["clk_125"]),
    ("vcsel_driver", &["clk_125", "clk_250"]),
    ("vcsel_driver.ddr_output", &["clk_250"]),
    ("spad_control", &["clk_125"]),
    ("tdc", &["clk_125"]),
    ("tdc.carry_chain", &["clk_125"]),
    ("tdc.coarse_counter", &["clk_125"]),
    ("tdc.tdc_latch", &["clk_125"]),
    ("tdc.tdc_decoder", &["clk_125"]),
    ("code_preload", &["clk_125"]),
    ("histogram_builder", &["clk_125"]),
    ("depth_estimator", &["clk_125"]),
    ("depth_estimator.estimator_ctrl", &["clk_125"]),
    ("depth_estimator.forward1", &["clk_125"]),
    ("depth_estimator.tansig", &["clk_125"]),
    ("depth_estimator.forward2", &["clk_125"]),
    ("centroid_estimator", &["clk_125"]),
];

/// Ports and wires that show a value held elsewhere: scope below the top, name, kind, holder.
pub(super) const SHOWN: &[(&str, &str, Kind, &str)] = &[
    ("", "rst_125", Kind::Internal, "reset_sync_125.rst_sync"),
    ("", "rst_250", Kind::Internal, "reset_sync_250.rst_sync"),
    ("", "mode_sync", Kind::Internal, "control_sync.mode_sync"),
    ("", "laser_freq_sync", Kind::Internal, "control_sync.laser_freq_sync"),
    ("", "laser_en_sync", Kind::Internal, "control_sync.laser_en_sync"),
    ("", "dsp_en_sync", Kind::Internal, "control_sync.dsp_en_sync"),
    ("", "dsp_rst_sync", Kind::Internal, "control_sync.dsp_rst_sync"),
    ("", "clear", Kind::Internal, "frame_ctrl.clear"),
    ("", "clear_addr", Kind::Internal, "frame_ctrl.clear_addr"),
    ("", "acquire", Kind::Internal, "frame_ctrl.acquire"),
    ("", "algo_start", Kind::Internal, "frame_ctrl.algo_start"),
    ("", "pre_start", Kind::Internal, "vcsel_driver.registers.pre_start"),
    ("", "start", Kind::Internal, "vcsel_driver.registers.start"),
    ("", "read_en", Kind::Internal, "socket.read_en"),
    ("", "read_addr", Kind::Internal, "socket.read_addr"),
    ("", "laser_on_lvds_p", Kind::Output, "lvds_output.o"),
    ("", "laser_on_lvds_n", Kind::Output, "lvds_output.ob"),
    ("", "spad_rst", Kind::Output, "spad_control.spad_rst"),
    ("", "spad_sel", Kind::Output, "spad_control.spad_sel"),
    ("", "depth", Kind::Output, "socket.depth"),
    ("", "algo_done", Kind::Output, "socket.algo_done"),
    ("", "hist_valid", Kind::Output, "socket.read_en"),
    ("", "hist_bin", Kind::Output, "socket.read_addr"),
    ("", "hist_count", Kind::Output, "nets.count"),
    ("", "frame_done", Kind::Output, "frame_ctrl.frame_done"),
    ("", "locked", Kind::Output, "pll.locked"),
    ("reset_sync_125", "clk", Kind::Input, "clocks.clk_125"),
    ("reset_sync_250", "clk", Kind::Input, "clocks.clk_250"),
    ("pll", "clk_125", Kind::Output, "clocks.clk_125"),
    ("pll", "clk_250", Kind::Output, "clocks.clk_250"),
    ("vcsel_driver", "laser_on", Kind::Output, "vcsel_driver.ddr_output.q"),
    ("tdc", "tdc_code", Kind::Output, "tdc.tdc_decoder.tdc_code"),
    ("tdc", "tdc_valid", Kind::Output, "tdc.tdc_decoder.tdc_valid"),
    ("histogram_builder", "count", Kind::Output, "nets.count"),
    ("histogram_preload", "count", Kind::Output, "nets.count"),
    ("depth_estimator", "read_en", Kind::Output, "depth_estimator.estimator_ctrl.read_en"),
    ("depth_estimator", "read_addr", Kind::Output, "depth_estimator.estimator_ctrl.read_addr"),
    ("depth_estimator", "depth", Kind::Output, "depth_estimator.forward2.depth"),
    ("depth_estimator", "algo_done", Kind::Output, "depth_estimator.estimator_ctrl.algo_done"),
];

/// The register that shows at an output of the socket; of another signal its own path.
pub(super) fn in_socket(estimator: Estimator, holder: &str) -> &str {
    match (holder, estimator) {
        ("socket.read_en", Estimator::Network) => "depth_estimator.estimator_ctrl.read_en",
        ("socket.read_addr", Estimator::Network) => "depth_estimator.estimator_ctrl.read_addr",
        ("socket.depth", Estimator::Network) => "depth_estimator.forward2.depth",
        ("socket.algo_done", Estimator::Network) => "depth_estimator.estimator_ctrl.algo_done",
        ("socket.read_en", Estimator::Centroid) => "centroid_estimator.registers.read_en",
        ("socket.read_addr", Estimator::Centroid) => "centroid_estimator.registers.read_addr",
        ("socket.depth", Estimator::Centroid) => "centroid_estimator.registers.depth",
        ("socket.algo_done", Estimator::Centroid) => "centroid_estimator.registers.algo_done",
        _ => holder,
    }
}

/// Modules in the order of data flow, each parent before its children.
pub(super) fn place(scope: &str) -> Vec<usize> {
    const FLOW: &[&str] = &[
        "tof_top",
        "pll",
        "reset_sync_125",
        "reset_sync_250",
        "control_sync",
        "frame_ctrl",
        "vcsel_driver",
        "ddr_output",
        "lvds_output",
        "spad_control",
        "tdc",
        "carry_chain",
        "coarse_counter",
        "tdc_latch",
        "tdc_decoder",
        "code_preload",
        "histogram_builder",
        "histogram_preload",
        "depth_estimator",
        "estimator_ctrl",
        "forward1",
        "tansig",
        "forward2",
        "centroid_estimator",
    ];
    let at = |module| FLOW.iter().position(|&name| name == module).unwrap_or(FLOW.len());
    scope.split('.').map(at).collect()
}
