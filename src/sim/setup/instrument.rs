//! The likelihood estimator that an instrument would have.

use crate::error::Input;
use crate::firmware::likelihood_estimator::params::{Params, Unfit, Wanted};
use crate::firmware::likelihood_estimator::pulse::Pulse;
use crate::optics::budget::LIGHT_M_S;
use crate::scenario::QuenchMode;

use super::Setup;

impl Setup {
    /// What the estimator's parameters and ROMs are for histograms of so many shots.
    ///
    /// # Errors
    /// When its model does not hold: hits before the first bin use up shots that no word counts
    /// (`tdc.first_bin_ps`), the SPAD is not armed for each shot (`firmware.mode`), or the pulse or the window
    /// is too long for its words.
    pub fn likelihood(&self, shots: u64) -> Result<Params, Input> {
        let scenario = &self.scenario;
        let fault = |field: &str, value: f64, expected: String| {
            let source = format!("scenario {}", self.name);
            Input::new(source, expected).field(field).value(value)
        };
        if scenario.firmware.mode != QuenchMode::EachShot {
            let expected =
                "expected 0 for likelihood_estimator: its shots are armed at the laser edge";
            return Err(fault("firmware.mode", 1.0, expected.to_owned()));
        }
        let bins = self.bins();
        if bins.first_ps() != 0.0 {
            let expected = "expected 0 for likelihood_estimator: hits before the first bin use up shots, and it \
                            does not hear of them";
            return Err(fault("tdc.first_bin_ps", bins.first_ps(), expected.to_owned()));
        }
        let told = &scenario.estimator;
        let most = self.params.histogram.most_hits();
        if told.told_shots > most {
            let expected = format!("expected {most} or less, what a word of the histogram holds");
            return Err(fault("estimator.told_shots", told.told_shots as f64, expected));
        }
        let or = |told: f64, own: f64| if told > 0.0 { told } else { own };
        let wanted = Wanted {
            histogram: self.params.histogram,
            shots: if told.told_shots > 0 { told.told_shots } else { shots },
            edges_ps: &bins.edges_ps(),
            bin_ps: bins.bin_ps(),
            pulse: Pulse::Gaussian {
                sigma_ps: or(told.told_sigma_ps, scenario.laser.pulse_sigma_ps),
            },
            metres_per_ps: LIGHT_M_S / 2e12,
        };
        Params::new(&wanted).map_err(|unfit| {
            let (field, value) = match unfit {
                Unfit::Short(_) | Unfit::Long(..) => {
                    ("laser.pulse_sigma_ps", scenario.laser.pulse_sigma_ps)
                }
                Unfit::Late(_) | Unfit::Wide(_) | Unfit::Far(..) => ("tdc.bin_ps", bins.bin_ps()),
            };
            fault(field, value, format!("likelihood_estimator: {unfit}"))
        })
    }
}
