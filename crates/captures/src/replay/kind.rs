//! Kinds of stimulus in a replay.

use strum::{Display, IntoStaticStr, VariantArray};

use tofsim::firmware::tof_top::{CodeSource, HistogramSource};
use tofsim::kernel::U;
use tofsim::sim::setup::Setup;

use crate::source::Source;

/// Stimulus that replaces the light. Its text is its key in the scenario's table `stimulus`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display, IntoStaticStr, VariantArray)]
#[strum(serialize_all = "lowercase")]
pub enum ReplayKind {
    /// Arrival time of a photon in each shot
    Photons,
    /// Code of each shot
    Codes,
    /// Histogram that the estimator read
    Histogram,
}

impl ReplayKind {
    /// All kinds, most accurate first.
    pub const ALL: &[ReplayKind] = ReplayKind::VARIANTS;

    /// Returns the signals to probe for it.
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

    /// Returns the signals of the firmware with such a stimulus.
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
