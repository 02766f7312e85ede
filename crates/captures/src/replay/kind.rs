//! What stands in for the light in a replay.

use tofsim::firmware::tof_top::{CodeSource, HistogramSource};
use tofsim::kernel::U;
use tofsim::sim::setup::Setup;

use crate::source::Source;

/// What stands in for the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplayKind {
    /// When a photon arrived in each shot
    Photons,
    /// The code of each shot
    Codes,
    /// The histogram that the estimator read
    Histogram,
}

impl ReplayKind {
    /// All, the most faithful first.
    pub const ALL: [ReplayKind; 3] =
        [ReplayKind::Photons, ReplayKind::Codes, ReplayKind::Histogram];

    /// Its key below `stimulus` in a scenario.
    pub const fn key(self) -> &'static str {
        match self {
            ReplayKind::Photons => "photons",
            ReplayKind::Codes => "codes",
            ReplayKind::Histogram => "histogram",
        }
    }

    /// What has to be probed for it.
    pub(super) const fn probes(self) -> &'static str {
        match self {
            ReplayKind::Photons => {
                "tdc.tdc_valid and tdc.tdc_code, or tdc_stop, with vcsel_driver.start"
            }
            ReplayKind::Codes => {
                "code_preload.tdc_valid and code_preload.tdc_code with vcsel_driver.start"
            }
            ReplayKind::Histogram => {
                "hist_valid, hist_bin and hist_count, or estimator_ctrl.forward1_en and \
                 forward1.l1_in_0 .., while all words are read"
            }
        }
    }

    /// The firmware that a capture of that kind is of.
    pub(super) fn design(self, setup: &Setup) -> Source {
        let mut setup = setup.clone();
        let params = &mut setup.params;
        match self {
            ReplayKind::Photons | ReplayKind::Histogram => params.code_source = CodeSource::Tdc,
            ReplayKind::Codes => params.code_source = CodeSource::Preload([U::new(0)].into()),
        }
        params.histogram_source = HistogramSource::Builder;
        Source::simulation(setup, None)
    }
}
