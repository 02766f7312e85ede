//! The module with an instrument's parameters set, and the map that `verify` needs for it.

use tofsim::sim::setup::Setup;

use crate::golden::blocks;
use crate::golden::parameters::{Parameter, Parameters};

/// The module.
pub const MODULE: &str = "instrument";
/// The map's file.
pub const MAP: &str = "instrument.map.toml";
/// The parameter that stays one, so that a simulation can have short frames.
pub(super) const SHOTS: &str = "ShotsPerFrame";

/// `tof_top` with its parameters set.
pub(super) fn module(setup: &Setup, parameters: &Parameters) -> String {
    let sizes = setup.params.sizes();
    let ports = blocks::find("tof_top").map_or(Vec::new(), |spec| spec.ports(&sizes));
    let declared = ports.iter().map(|port| match port.name.as_str() {
        "depth" => format!("    {}", port.declaration().replace("wire ", "wire signed ")),
        _ => format!("    {}", port.declaration()),
    });
    let connected = ports.iter().map(|port| format!("        {}", port.connection()));
    format!(
        "`timescale 1ps / 1fs\n`default_nettype none\n\n\
         // {}, by tofsim {}: tof_top with its parameters.\n\
         module {MODULE} #(\n    parameter [23:0] {SHOTS} = 24'd{}  // [shots]\n) (\n{}\n);\n    \
         tof_top {} tof_top (\n{}\n    );\nendmodule\n",
        setup.name,
        env!("CARGO_PKG_VERSION"),
        setup.params.frame_ctrl.shots_per_frame,
        declared.collect::<Vec<_>>().join(",\n"),
        set(parameters, SHOTS),
        connected.collect::<Vec<_>>().join(",\n"),
    )
}

/// The list of parameters as an instance sets them; the shots of a frame are `shots`.
pub(super) fn set(parameters: &Parameters, shots: &str) -> String {
    let own = |(name, value): &(&'static str, Parameter)| match *name {
        SHOTS => format!("        .{SHOTS}({shots})"),
        name => format!("        .{name}({})", value.literal()),
    };
    format!("#(\n{}\n    )", parameters.iter().map(own).collect::<Vec<_>>().join(",\n"))
}

/// Says that the module is `tof_top`, and that all but one of its parameters are constants inside.
pub fn map(parameters: &Parameters) -> String {
    let constants = parameters.iter().filter(|(name, _)| *name != SHOTS);
    let constants: String = constants.map(|(name, _)| format!("{name} = \"\"\n")).collect();
    format!("[block.tof_top]\nmodule = \"{MODULE}\"\n\n[block.tof_top.parameters]\n{constants}")
}
