//! The acquisition computer's signals over time, asynchronous to the clocks.

use crate::firmware::tof_top::Pins;
use crate::kernel::{Time, U};
use crate::scenario::{Control, Firmware, QuenchMode, Scenario};

/// Control changes still to come, in order of time.
#[derive(Clone, Debug)]
pub struct Timeline {
    changes: std::vec::IntoIter<(Time, Control)>,
    next: Time,
    /// Delay after a depth of the acquisition computer's answer, which turns the laser on or off.
    response: Option<Time>,
    /// The next answer.
    turn: Time,
}

impl Timeline {
    /// The control timeline of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let changes = scenario.control.iter();
        let changes: Vec<_> =
            changes.map(|change| (Time::from_ps_f64(change.at_us * 1e6), change.clone())).collect();
        let Firmware { dark_frames, response_ns, .. } = scenario.firmware;
        let response = dark_frames.then(|| Time::from_ps_f64(response_ns * 1e3));
        let changes = changes.into_iter();
        let mut timeline = Timeline { changes, next: Time::ZERO, response, turn: Time::NEVER };
        timeline.look_ahead();
        timeline
    }

    /// Returns the instant of the next change.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Schedules the answer to a depth that is ready from the edge at `now` on.
    #[inline]
    pub fn take_depth(&mut self, now: Time) {
        if let Some(response) = self.response {
            self.turn = now + response;
            self.look_ahead();
        }
    }

    /// Delays the answer to a depth.
    pub fn pass(&mut self, time: Time) {
        self.turn = self.turn.saturating_add(time);
        self.look_ahead();
    }

    /// Makes the next change.
    pub fn event(&mut self, pins: &mut Pins) {
        if self.turn == self.next {
            (pins.laser_en, self.turn) = (!pins.laser_en, Time::NEVER);
        } else if let Some((_, change)) = self.changes.next() {
            drive(&change, pins);
        }
        self.look_ahead();
    }

    /// Adds a change, after those of the same instant.
    pub fn insert(&mut self, at: Time, change: Control) {
        let mut changes: Vec<_> = self.changes.by_ref().collect();
        let place = changes.partition_point(|(other, _)| *other <= at);
        changes.insert(place, (at, change));
        self.changes = changes.into_iter();
        self.look_ahead();
    }

    /// Returns the number of changes still to come.
    pub fn left(&self) -> usize {
        self.changes.len()
    }

    fn look_ahead(&mut self) {
        let change = self.changes.as_slice().first().map_or(Time::NEVER, |(at, _)| *at);
        self.next = change.min(self.turn);
    }
}

/// Applies a change to the pins.
pub(super) fn drive(change: &Control, pins: &mut Pins) {
    pins.laser_freq = change.laser_freq.map_or(pins.laser_freq, U::new);
    pins.mode = change.mode.map_or(pins.mode, |mode| mode == QuenchMode::FreeRunning);
    pins.laser_en = change.laser_en.unwrap_or(pins.laser_en);
    pins.dsp_en = change.dsp_en.unwrap_or(pins.dsp_en);
    pins.dsp_rst = change.dsp_rst.unwrap_or(pins.dsp_rst);
    pins.rst = change.rst.unwrap_or(pins.rst);
}

/// Returns the pins at power-up.
pub fn pins_at_power_up(firmware: &Firmware) -> Pins {
    Pins {
        rst: firmware.rst,
        tdc_stop: false,
        mode: firmware.mode == QuenchMode::FreeRunning,
        laser_freq: U::new(firmware.laser_freq),
        laser_en: firmware.laser_en && !firmware.dark_frames,
        dsp_en: firmware.dsp_en,
        dsp_rst: firmware.dsp_rst,
        ..Pins::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline(dark_frames: bool) -> (Timeline, Pins) {
        let mut scenario = Scenario::default();
        scenario.firmware.dark_frames = dark_frames;
        scenario.firmware.response_ns = 200.5;
        scenario.control =
            vec![Control { at_us: 1.0, mode: Some(QuenchMode::FreeRunning), ..Control::default() }];
        (Timeline::new(&scenario), pins_at_power_up(&scenario.firmware))
    }

    #[test]
    fn every_depth_turns_the_laser_within_clear() {
        let (mut timeline, mut pins) = timeline(true);
        assert!(!pins.laser_en);
        for (edge_ns, lit) in [(504, true), (992, false), (8000, true)] {
            timeline.take_depth(Time::from_ns(edge_ns));
            while timeline.next_event() < Time::from_ns(edge_ns + 200) {
                timeline.event(&mut pins);
            }
            assert_eq!(timeline.next_event(), Time::from_fs(edge_ns * 1_000_000 + 200_500_000));
            timeline.event(&mut pins);
            assert_eq!(pins.laser_en, lit);
        }
        assert!(pins.mode, "the timeline's own changes come when they are due");
        assert_eq!((timeline.next_event(), timeline.left()), (Time::NEVER, 0));
    }

    #[test]
    fn an_answer_moves_with_the_frame() {
        let (mut timeline, _) = timeline(true);
        timeline.take_depth(Time::from_ns(8));
        timeline.pass(Time::from_ns(700));
        assert_eq!(timeline.next_event(), Time::from_fs(908_500_000));
        timeline.event(&mut Pins::default());
        timeline.pass(Time::from_ns(800));
        assert_eq!(timeline.next_event(), Time::from_ns(1000), "no answer is due");
    }

    #[test]
    fn without_dark_frames_a_depth_changes_nothing() {
        let (mut timeline, pins) = timeline(false);
        assert!(pins.laser_en);
        timeline.take_depth(Time::from_ns(8));
        assert_eq!(timeline.next_event(), Time::from_ns(1000));
    }
}
