//! The least spread that is possible.

use serde::Serialize;

use tofsim::error::Result;
use tofsim::firmware::tdc;
use tofsim::firmware::tdc_decoder::TimeScale;
use tofsim::kernel::Time;
use tofsim::optics::Bins;
use tofsim::scenario::effects::Method;
use tofsim::sim::setup::Setup;

use crate::estimation::Acquisition;
use crate::estimation::likelihood::Model;

/// Bins as good as none, of each bin.
const FINER: u64 = 8;

/// The Cramer-Rao bound of a distance, with signal and background unknown too, and a second echo and the amplitude of a
/// cover window's light if there are such: twice the standard deviation that no
/// unbiased estimate is below. `None` if an effect invalidates the model of the light, or no light returns [mm].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Bound {
    /// With the chain's own bins [mm].
    pub two_sd_mm: Option<f64>,
    /// With exact bins of an eighth of the width [mm].
    pub fine_two_sd_mm: Option<f64>,
    /// Effect that invalidates the bound, as a clause.
    #[serde(skip)]
    pub invalid_because: Option<&'static str>,
}

impl Bound {
    /// Of a scenario's scene.
    ///
    /// # Errors
    /// When its acquisition makes no sense.
    pub fn of(setup: &Setup) -> Result<Self> {
        let invalid_because = setup.why_not(Method::CramerRaoBound);
        if invalid_because.is_some() {
            return Ok(Bound { invalid_because, ..Bound::default() });
        }
        let of = |bins: &Bins| -> Result<Option<f64>> {
            let glass = setup.glass.as_ref().map(|glass| glass.over(&bins.limits_ps()));
            let acquisition = Acquisition::of(setup, bins, setup.shots(1));
            let model = Model::new(&Acquisition { glass: glass.as_ref(), ..acquisition })?;
            let second_m = setup.scenario.target.second_distance_m;
            Ok(model.bound_of_scene_m(&setup.budget, second_m).map(|sd_m| 2e3 * sd_m))
        };
        let (own, scale) = (&setup.params.tdc, setup.params.tdc.decoder.scale);
        let bin = Time::from_fs(scale.bin().fs() / FINER);
        let (bins, coarse_bits) = (scale.bins() * FINER as usize, setup.scenario.tdc.coarse_bits);
        let fine = TimeScale::new(scale.period(), bin, scale.first(), coarse_bits, bins);
        let stages = own.decoder.count_stages;
        let fine = tdc::Params::new(own.delays.clone(), fine, coarse_bits, stages);
        let fine_two_sd_mm = of(&Bins::without_taps(&fine))?;
        Ok(Bound { two_sd_mm: of(&setup.bins())?, fine_two_sd_mm, invalid_because })
    }
}
