//! Probes that show shots, and the response to them.

use tofsim::hierarchy::TOP;

use crate::compare::Probed;

use super::super::kind::ReplayKind;
use super::super::timebase::Timebase;

/// Probes that show shots, and the response to them.
pub(super) struct Probes {
    pub(super) start: Bit,
    pub(super) acquire: Bit,
    pub(super) valid: Bit,
    pub(super) stop: Bit,
    /// TDC code.
    pub(super) code: Option<usize>,
    /// Shot count of the frame.
    pub(super) counter: Option<usize>,
}

impl Probes {
    /// Finds the probes; `None` if neither the detector's nor the TDC's response is probed.
    pub(super) fn new(probed: &Probed, kind: ReplayKind) -> Option<Probes> {
        let module = if kind == ReplayKind::Codes { "code_preload" } else { "tdc" };
        let port = |port: &str| [format!("{module}.{port}"), port.to_owned()];
        let name = |name: &str| [name.to_owned()];
        let valid = Bit::new(probed, &port("tdc_valid"));
        let code = find(probed, &port("tdc_code")).filter(|_| valid.probe.is_some());
        let stop = name("tdc_stop");
        let stop = Bit::new(probed, if kind == ReplayKind::Photons { &stop } else { &[] });
        if code.is_none() && stop.probe.is_none() {
            return None;
        }
        Some(Probes {
            start: Bit::new(probed, &name("start")),
            acquire: Bit::new(probed, &name("acquire")),
            valid,
            stop,
            code,
            counter: find(probed, &name("frame_ctrl.shots")),
        })
    }

    /// Discards all previous levels, at the start of a window.
    pub(super) fn begin_window(&mut self) {
        for bit in [&mut self.start, &mut self.acquire, &mut self.valid, &mut self.stop] {
            bit.before = None;
        }
    }
}

/// A one-bit probe, with its previous level.
pub(super) struct Bit {
    pub(super) probe: Option<usize>,
    before: Option<bool>,
}

impl Bit {
    fn new(probed: &Probed, names: &[String]) -> Self {
        Bit { probe: find(probed, names), before: None }
    }

    /// Returns the present and the previous level.
    pub(super) fn sample(&mut self, probed: &mut Probed) -> (bool, bool) {
        let now = self.probe.and_then(|probe| probed.value(probe)) == Some(1);
        (now, self.before.replace(now).unwrap_or(now))
    }

    /// Returns whether a cycle begins in which a signal is high that is high for one cycle at a time.
    pub(super) fn pulse(&mut self, probed: &mut Probed, timebase: &Timebase) -> bool {
        let (now, before) = self.sample(probed);
        now && (timebase.per_cycle == 1 || !before)
    }
}

fn find(probed: &Probed, names: &[String]) -> Option<usize> {
    names.iter().find_map(|name| probed.probe(&format!("{TOP}.{name}")))
}
