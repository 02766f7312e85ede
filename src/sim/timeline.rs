//! The acquisition computer's signals over time, asynchronous to the clocks.

use crate::firmware::tof_top::Pins;
use crate::kernel::{Time, U};
use crate::scenario::{Control, Firmware, Scenario};

/// Changes still to come, in order of time.
#[derive(Clone, Debug)]
pub struct Timeline {
    changes: std::vec::IntoIter<(Time, Control)>,
    next: Time,
}

impl Timeline {
    /// The control timeline of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let changes = scenario.control.iter();
        let changes: Vec<_> =
            changes.map(|change| (Time::from_ps_f64(change.at_us * 1e6), change.clone())).collect();
        let mut timeline = Timeline { changes: changes.into_iter(), next: Time::ZERO };
        timeline.look_ahead();
        timeline
    }

    /// When the next change comes.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Makes the next change.
    pub fn event(&mut self, pins: &mut Pins) {
        if let Some((_, change)) = self.changes.next() {
            pins.laser_freq = change.laser_freq.map_or(pins.laser_freq, U::new);
            pins.mode = change.mode.map_or(pins.mode, |mode| mode == 1);
            pins.laser_en = change.laser_en.unwrap_or(pins.laser_en);
            pins.dsp_en = change.dsp_en.unwrap_or(pins.dsp_en);
            pins.dsp_rst = change.dsp_rst.unwrap_or(pins.dsp_rst);
            pins.rst = change.rst.unwrap_or(pins.rst);
        }
        self.look_ahead();
    }

    /// Changes still to come.
    pub fn left(&self) -> usize {
        self.changes.len()
    }

    fn look_ahead(&mut self) {
        self.next = self.changes.as_slice().first().map_or(Time::NEVER, |(at, _)| *at);
    }
}

/// The pins at power-up.
pub fn pins_at_power_up(firmware: &Firmware) -> Pins {
    Pins {
        rst: firmware.rst,
        tdc_stop: false,
        mode: firmware.mode == 1,
        laser_freq: U::new(firmware.laser_freq),
        laser_en: firmware.laser_en,
        dsp_en: firmware.dsp_en,
        dsp_rst: firmware.dsp_rst,
    }
}
