//! Control signals in a capture.

use tofsim::hierarchy::TOP;
use tofsim::scenario::{Control, QuenchMode};

use crate::compare::Probed;

/// Names of the control signals.
const NAMES: [&str; 6] = ["laser_freq", "mode", "laser_en", "dsp_en", "dsp_rst", "rst"];
/// Latency of `control_sync` [cycles of clk_sys].
const SYNCHRONISERS: u64 = 2;

/// A control signal.
#[derive(Clone, Debug)]
struct Pin {
    name: &'static str,
    probe: usize,
    /// Delay of the probe relative to the pin [cycles].
    late: u64,
    first: Option<u64>,
    now: Option<u64>,
}

/// Control signals that are probed.
#[derive(Clone, Debug, Default)]
pub(super) struct Pins {
    pins: Vec<Pin>,
    /// Changes: sample, delay of the probe in cycles, and new value.
    pub(super) changes: Vec<(u64, u64, Control)>,
}

impl Pins {
    pub(super) fn new(probed: &Probed) -> Self {
        let pin = |name: &'static str| {
            let at = |text: String, late: u64| Some((probed.probe(&text)?, late));
            // Behind the synchroniser there is no doubt which edge took a change.
            let behind = at(format!("{TOP}.{name}_sync"), SYNCHRONISERS);
            let (probe, late) = behind.or_else(|| at(format!("{TOP}.{name}"), 0))?;
            Some(Pin { name, probe, late, first: None, now: None })
        };
        Pins { pins: NAMES.into_iter().filter_map(pin).collect(), changes: Vec::new() }
    }

    /// Processes a sample.
    pub(super) fn sample(&mut self, index: u64, probed: &mut Probed) {
        for pin in &mut self.pins {
            let Some(value) = probed.value(pin.probe) else { continue };
            if pin.now.is_some_and(|now| now != value) {
                let mut change = Control::default();
                set(&mut change, pin.name, value);
                self.changes.push((index, pin.late, change));
            }
            pin.first.get_or_insert(value);
            pin.now = Some(value);
        }
    }

    /// Returns the values at the start of the capture.
    pub(super) fn begin(&self) -> Control {
        let mut begin = Control::default();
        for pin in &self.pins {
            if let Some(first) = pin.first {
                set(&mut begin, pin.name, first);
            }
        }
        begin
    }
}

fn set(control: &mut Control, name: &str, value: u64) {
    let high = Some(value != 0);
    match name {
        "laser_freq" => control.laser_freq = Some(value),
        "mode" => {
            control.mode =
                Some(if value == 0 { QuenchMode::EachShot } else { QuenchMode::FreeRunning });
        }
        "laser_en" => control.laser_en = high,
        "dsp_en" => control.dsp_en = high,
        "dsp_rst" => control.dsp_rst = high,
        _ => control.rst = high,
    }
}
