//! Parameters of the whole firmware.

use tofsim::firmware::tdc;
use tofsim::firmware::tdc_calibration::Params as Calibration;
use tofsim::firmware::tof_top::{CodeSource, FirmwareEstimator, HistogramSource};
use tofsim::kernel::U;
use tofsim::network::mem;
use tofsim::sim::setup::Setup;

use super::{
    OPTIONS, Parameter, Parameters, all, centroid_estimator, clocks, codes, depth_estimator,
    every_clock, histogram, likelihood_estimator, options, sized, sizes_of, tap_delays,
    tdc_calibration,
};

const TOF_TOP: &str = include_str!("../../../../../rtl_ref/tof_top.v");

/// Parameters of the whole firmware. The memory of an unused stand-in is loaded too: zeros.
pub fn tof_top(setup: &Setup) -> Parameters {
    use Parameter::{Memory, Number};
    let params = &setup.params;
    let mut list = vec![
        ("ShotsPerFrame", Number(params.frame_ctrl.shots_per_frame.into())),
        ("LockTime", Number(setup.pll().locked_at.ps())),
    ];
    list.extend(clocks(&setup.scenario.pll.params()));
    list.extend(depth_estimator(&params.estimators.depth_estimator));
    list.extend([
        ("CalFile", Memory(mem::tdc_decoder(&params.tdc.decoder))),
        ("DelaysFile", Memory(tap_delays(&params.tdc.delays))),
    ]);
    list.extend(own_chains(&params.channels));
    list.extend(options(params, TOF_TOP));
    list.extend(params.tdc_calibration.iter().flat_map(tdc_calibration));
    list.extend(sized(params, TOF_TOP));
    let (preloads_codes, rom) = match &params.code_source {
        CodeSource::Tdc => (false, &[U::new(0)][..]),
        CodeSource::Preload(rom) => (true, &rom[..]),
    };
    let (preloads_histogram, words) = match &params.histogram_source {
        HistogramSource::Builder => (false, &vec![U::new(0); params.histogram.bins][..]),
        HistogramSource::Preload(rom) => (true, &rom[..]),
    };
    list.extend([
        ("CodeSource", Number(preloads_codes.into())),
        ("Codes", Number(rom.len() as u64)),
        ("CodeFile", Memory(codes(rom, &params.histogram))),
        ("HistogramSource", Number(preloads_histogram.into())),
        ("HistogramFile", Memory(histogram(words, &params.histogram))),
    ]);
    if params.estimator != FirmwareEstimator::default() {
        list.push(("Estimator", Number(params.estimator.number())));
    }
    match params.estimator {
        FirmwareEstimator::Centroid => {
            list.extend(centroid_estimator(&params.estimators.centroid_estimator));
        }
        FirmwareEstimator::LikelihoodEstimator => {
            list.extend(likelihood_estimator(&params.estimators.likelihood_estimator));
        }
        // The others have no parameters but sizes and memories, which are there already.
        _ => {}
    }
    list
}

/// Chains of the other columns of an array, if each has its own.
fn own_chains(channels: &[tdc::Params]) -> Option<(&'static str, Parameter)> {
    let memories = (1..).zip(channels).flat_map(|(column, tdc)| {
        let own = [mem::tdc_decoder(&tdc.decoder), tap_delays(&tdc.delays)];
        own.map(|memory| memory.of_column(column))
    });
    (!channels.is_empty()).then(|| ("OwnChains", Parameter::Flag(memories.collect())))
}

/// Parameters of the whole firmware, also where they are the default.
pub fn tof_top_in_full(setup: &Setup) -> Parameters {
    let params = &setup.params;
    let mut list = tof_top(setup);
    let every = [
        every_clock(&setup.scenario.pll.params()),
        all(params, OPTIONS.into_iter()),
        tdc_calibration(&Calibration::stand_in(&params.tdc)),
        all(params, sizes_of(TOF_TOP)),
        vec![("Estimator", Parameter::Number(params.estimator.number()))],
        centroid_estimator(&params.estimators.centroid_estimator),
        likelihood_estimator(&params.estimators.likelihood_estimator),
    ];
    let is_new = |(name, _): &(&str, Parameter)| list.iter().all(|(known, _)| known != name);
    let others: Vec<_> = every.concat().into_iter().filter(is_new).collect();
    list.extend(others);
    list
}
