//! Control signals in a capture.

use tofsim::hierarchy::TOP;
use tofsim::scenario::{Control, QuenchMode};

use crate::compare::Probed;

/// Assignment of a control signal's value.
type Setter = fn(&mut Control, u64);

/// Names of the control signals, and how they are set.
const PINS: [(&str, Setter); 6] = [
    ("laser_freq", |control, value| control.laser_freq = Some(value)),
    ("mode", |control, value| {
        let is_free = value != 0;
        control.mode = Some(if is_free { QuenchMode::FreeRunning } else { QuenchMode::EachShot });
    }),
    ("laser_en", |control, value| control.laser_en = Some(value != 0)),
    ("dsp_en", |control, value| control.dsp_en = Some(value != 0)),
    ("dsp_rst", |control, value| control.dsp_rst = Some(value != 0)),
    ("rst", |control, value| control.rst = Some(value != 0)),
];
/// Latency of `control_sync` [cycles of clk_sys].
const SYNCHRONISERS: u64 = 2;

/// A control signal.
#[derive(Clone, Debug)]
struct Pin {
    set: Setter,
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
        let pin = |(name, set): (&str, Setter)| {
            let at = |text: String, late: u64| Some((probed.probe(&text)?, late));
            // Behind the synchroniser there is no doubt which edge took a change.
            let behind = at(format!("{TOP}.{name}_sync"), SYNCHRONISERS);
            let (probe, late) = behind.or_else(|| at(format!("{TOP}.{name}"), 0))?;
            Some(Pin { set, probe, late, first: None, now: None })
        };
        Pins { pins: PINS.into_iter().filter_map(pin).collect(), changes: Vec::new() }
    }

    /// Processes a sample.
    pub(super) fn sample(&mut self, index: u64, probed: &mut Probed) {
        for pin in &mut self.pins {
            let Some(value) = probed.value(pin.probe) else { continue };
            if pin.now.is_some_and(|now| now != value) {
                let mut change = Control::default();
                (pin.set)(&mut change, value);
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
                (pin.set)(&mut begin, first);
            }
        }
        begin
    }
}
