//! Light, detector and `tdc_stop` for custom firmware.

use crate::kernel::Time;

use super::device::{Device, Off};
use super::setup::Setup;

/// A target, its light and a detector, without the firmware that drives and reads them.
#[derive(Clone, Debug)]
pub struct Photons {
    device: Device,
    /// The earliest that the next edge can come.
    until: Time,
    cycle: Time,
    frames: u64,
    /// When the random numbers become those of the next frame, if one has just ended.
    frame_end: Option<Time>,
}

/// Outputs of the firmware to laser and detector after an edge of `clk_sys`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// A shot begins.
    pub start: bool,
    /// This edge has switched the laser on.
    pub laser: bool,
    /// Recharges the SPAD and keeps it off.
    pub spad_rst: bool,
    /// SPAD quench mode, as the SPAD has it: MODE 1 is free running.
    pub mode: bool,
    /// `tdc_stop` comes from the ring oscillator.
    pub ring_on: bool,
    /// A frame has ended: the next shot takes up the random numbers of the next frame, as in a run.
    pub frame_done: bool,
}

impl Photons {
    /// The detector of a scenario at power-up.
    pub fn new(setup: &Setup) -> Self {
        let (device, cycle) = (setup.device(), setup.cycle());
        Photons { device, until: setup.pll().locked_at, cycle, frames: 0, frame_end: None }
    }

    /// Returns the level of `tdc_stop`.
    pub fn level(&self) -> bool {
        self.device.top.pins.tdc_stop
    }

    /// Advances to the next change of `tdc_stop` before or at the firmware's next edge, and returns its instant.
    pub fn next_change(&mut self) -> Option<Time> {
        let level = self.level();
        while let Some(now) = self.next_event(self.until) {
            if self.level() != level {
                return Some(now);
            }
        }
        None
    }

    /// Takes an edge of `clk_sys` at `now`, after which the firmware's outputs are `shown`.
    pub fn edge(&mut self, now: Time, shown: Shown) {
        while self.next_event(now).is_some() {}
        let top = &mut self.device.top;
        top.vcsel_driver.registers.start = shown.start;
        top.spad_control.spad_rst = shown.spad_rst;
        top.control_sync.mode_sync = shown.mode;
        top.tdc_calibration.registers.ring_on = shown.ring_on;
        self.device.react(now, shown.laser);
        if shown.frame_done {
            self.frame_end = Some(now + Time::from_fs(self.cycle.fs() / 4 * 3));
        }
        self.until = now + self.cycle;
    }

    /// Handles the next asynchronous event before or at `until`, and returns its instant. In a run, the last fall of
    /// `clk_laser` in a frame is what ends it.
    fn next_event(&mut self, until: Time) -> Option<Time> {
        let now = self.device.next_event();
        if self.frame_end.is_some_and(|end| end < now.min(until)) {
            self.frame_end = None;
            self.frames += 1;
            self.device.begin_frame(self.frames);
        }
        (now <= until).then(|| {
            self.device.settle(now, &mut Off, &mut Off);
            now
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::tof_top::TofTop;
    use crate::sim::device::{Edge, SignalProbe};

    /// Keeps the instants at which the wire changes, and what each edge of both clocks shows.
    #[derive(Default)]
    struct Kept {
        level: bool,
        stops: Vec<Time>,
        lit: bool,
        edges: Vec<(Time, Shown)>,
    }

    impl SignalProbe for Kept {
        const ON: bool = true;
        const EDGES: bool = true;

        fn sample(&mut self, now: Time, top: &TofTop) {
            if top.pins.tdc_stop != self.level {
                self.level = top.pins.tdc_stop;
                self.stops.push(now);
            }
            if let Some((edge, shown)) = self.edges.last_mut()
                && *edge == now
            {
                *shown = Shown {
                    start: top.vcsel_driver.registers.start,
                    laser: top.nets.laser_on && !self.lit,
                    spad_rst: top.spad_control.spad_rst,
                    mode: top.control_sync.mode_sync,
                    ring_on: top.tdc_calibration.registers.ring_on,
                    frame_done: top.frame_ctrl.frame_done,
                };
            }
        }

        fn looks_before(&self, edge: Edge) -> bool {
            edge == Edge::Both
        }

        fn before_edge(&mut self, _: Edge, now: Time, top: &TofTop) {
            self.lit = top.nets.laser_on;
            self.edges.push((now, Shown::default()));
        }
    }

    /// The changes of the wire in `count` frames of a run, and beside the run's own firmware.
    fn both(count: u64, (scenario, set): (&str, &[&str])) -> [Vec<Time>; 2] {
        let setup = Setup::load(scenario, set).unwrap();
        let (mut device, mut kept, mut frames) = (setup.device(), Kept::default(), 0);
        device.power_up(&mut kept, &mut Off);
        while frames < count {
            device.step(&setup.params, &mut kept, &mut Off);
            if device.top.frame_ctrl.frame_done {
                frames += 1;
                device.begin_frame(frames);
            }
        }
        let (mut photons, mut stops) = (Photons::new(&setup), Vec::new());
        stops.extend(std::iter::from_fn(|| photons.next_change()));
        for (now, shown) in kept.edges {
            let level = photons.level();
            photons.edge(now, shown);
            stops.extend((photons.level() != level).then_some(now));
            stops.extend(std::iter::from_fn(|| photons.next_change()));
        }
        [kept.stops, stops]
    }

    #[test]
    fn the_wire_changes_when_it_does_in_a_run() {
        let short = "firmware.shots_per_frame=200";
        for (count, scene) in [
            (3, ("bright", &[short][..])),
            (3, ("bright", &[short, "firmware.mode=1", "spad.dead_time_ns=30"])),
            // An avalanche soon after the end of some of the frames.
            (40, ("kc705", &["firmware.shots_per_frame=300", "firmware.mode=1"])),
        ] {
            let [run, own] = both(count, scene);
            assert!(run.len() > 200, "{scene:?}: {}", run.len());
            assert_eq!(run.len(), own.len(), "{scene:?}");
            assert_eq!(run, own, "{scene:?}");
        }
    }
}
