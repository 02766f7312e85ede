//! The top for a part's board and its constraints: those of `rtl_ref`, with an instrument's widths and clocks.

use tofsim::kernel::sizes::{Size, Sizes};
use tofsim::scenario::Part;
use tofsim::sim::setup::Setup;

use crate::golden::parameters::hash::parameters_hash;
use crate::golden::parameters::{self, Parameter, Parameters};

use super::wrapper;

/// The ring oscillator of the boards' tops.
pub(super) const RING_OSCILLATOR: &str = include_str!("../../../../rtl_ref/ring_oscillator.v");

const KC705_TOP: &str = include_str!("../../../../rtl_ref/kc705_top.v");
const KC705_XDC: &str = include_str!("../../../../rtl_ref/kc705.xdc");
const ECP5_TOP: &str = include_str!("../../../../rtl_ref/ecp5_top.v");
const ECP5_LPF: &str = include_str!("../../../../rtl_ref/ecp5.lpf");

/// Oscillator of both boards [Hz].
const BOARD_HZ: u64 = 200_000_000;

/// The board's module.
pub(super) fn name(setup: &Setup) -> &'static str {
    match setup.scenario.pll.part {
        Part::Kintex7 => "kc705_top",
        Part::Ecp5 => "ecp5_top",
    }
}

/// Ports whose width the instrument decides: name, width on the board, own width.
fn vectors(setup: &Setup) -> [(&'static str, u32, u32); 3] {
    let sizes = setup.params.sizes();
    [("laser_freq", Size::RateBits), ("hist_bin", Size::BinBits), ("hist_count", Size::CountBits)]
        .map(|(port, size)| (port, Sizes::default().of(size), sizes.of(size)))
}

/// A frequency as people write it [MHz].
fn in_mhz(hz: u64) -> String {
    format!("{}", hz as f64 / 1e6)
}

/// The board's top, with the instrument's parameters in it.
pub fn top(setup: &Setup) -> String {
    let pll = &setup.scenario.pll;
    let text = match pll.part {
        Part::Kintex7 => KC705_TOP,
        Part::Ecp5 => ECP5_TOP,
    };
    let mut text = text.to_owned();
    for (port, usual, own) in vectors(setup) {
        let of = |width: u32| format!("wire [{}:0] {port}", width - 1);
        text = text.replace(&of(usual), &of(own));
    }
    let usual = format!("{} MHz", in_mhz(BOARD_HZ));
    text = text.replace(&usual, &format!("{} MHz", in_mhz(pll.input_hz)));
    let mut all = parameters::whole::tof_top_in_full(setup);
    all.retain(|(name, _)| *name != "Hosted");
    all.extend(host(setup));
    let shots = setup.params.frame_ctrl.shots_per_frame.to_string();
    let instance = format!("    tof_top {} tof_top (", wrapper::set(&all, &shots));
    let text = text.replace("    // The VCO at 500 MHz.\n", "");
    // The board's own parameters are in the instance.
    let text = replaced(&text, (" #(\n", "\n) ("), " (");
    replaced(&text, ("    tof_top #(", "    ) tof_top ("), &instance)
}

/// Text with what stands from a beginning to an end replaced.
fn replaced(text: &str, (begin, end): (&str, &str), by: &str) -> String {
    let parts = text.split_once(begin).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(end)?;
        Some(format!("{before}{by}{after}"))
    });
    parts.unwrap_or_else(|| text.to_owned())
}

/// Parameters of a board's host: half a second of silence, and a laser that keeps the instrument's pulse and periods.
fn host(setup: &Setup) -> Parameters {
    let laser = &setup.params.vcsel_driver;
    let shortest = laser.periods.iter().copied().min().unwrap_or_default();
    let system_hz = setup.scenario.pll.params().system_hz();
    [
        ("Hosted", 1),
        ("ParametersHash", parameters_hash(setup)),
        ("HostTimeout", system_hz / 2),
        ("LongestPulse", laser.pulse_half_cycles.into()),
        ("ShortestPeriod", 2 * shortest),
    ]
    .map(|(name, value)| (name, Parameter::Number(value)))
    .into()
}

/// Constraints of the board's top: pins of the board, and the instrument's clocks.
pub fn constraints(setup: &Setup) -> String {
    let hz = setup.scenario.pll.input_hz;
    let text = match setup.scenario.pll.part {
        Part::Kintex7 => {
            let period = format!("create_clock -period {:.3} ", 1e9 / hz as f64);
            let between_ns = setup.cycle().fs() as f64 / 2e6;
            KC705_XDC
                .replace("create_clock -period 5.000 ", &period)
                .replace("SiT9102, 200 MHz", &format!("SiT9102, {} MHz", in_mhz(hz)))
                .replace("has 4 ns.", &format!("has {between_ns} ns."))
        }
        Part::Ecp5 => {
            let between_ns = setup.cycle().fs() as f64 / 2e6;
            ECP5_LPF
                .replace(
                    "FREQUENCY PORT \"clk_in\" 200 MHZ;",
                    &format!("FREQUENCY PORT \"clk_in\" {} MHZ;", in_mhz(hz)),
                )
                .replace("Of 200 MHz:", &format!("Of {} MHz:", in_mhz(hz)))
                .replace("has 4 ns.", &format!("has {between_ns} ns."))
        }
    };
    vectors(setup).iter().fold(text, |text, vector| with_width(&text, vector))
}

/// With as many lines of pins for a port as it has bits.
fn with_width(text: &str, &(port, usual, own): &(&str, u32, u32)) -> String {
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        let bit = (own..usual).find(|bit| line.contains(&format!("{port}[{bit}]")));
        if bit.is_some() && !line.starts_with('#') {
            continue;
        }
        lines.push(line.to_owned());
        if line.contains(&format!("{port}[{}]", usual - 1)) {
            let more = usual..own;
            lines.extend(more.map(|bit| {
                format!(
                    "# {port}[{bit}]: this board's file has no pin for it; give it one of yours"
                )
            }));
        }
    }
    lines.join("\n") + "\n"
}
