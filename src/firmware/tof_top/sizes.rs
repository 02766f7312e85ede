//! The sizes of a design, from the parameters of its blocks.

use crate::firmware::carry_chain::TAPS;
use crate::firmware::coarse_counter::DEFAULT_COARSE_BITS;
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::firmware::forward2::NEURONS;
use crate::firmware::tdc_decoder::{COUNT_STAGES, TimeScale};
use crate::firmware::{
    centroid_estimator, estimator_ctrl, frame_ctrl, histogram_builder, vcsel_driver,
};
use crate::kernel::sizes::Sizes;

use super::ports::Params;

/// Bits of an age in the ROM of the KC705's chain.
const AGE_BITS: u32 = 14;
/// Hits of a calibration as a power of two, of a design without one.
const HITS_LOG2: u32 = 13;

impl Default for Sizes {
    /// Sizes of the KC705.
    fn default() -> Self {
        let (scale, laser) = (TimeScale::default(), vcsel_driver::Params::default());
        usual(&scale, &laser, &histogram_builder::Params::default(), &Datapath::THESIS, NEURONS)
    }
}

impl Params {
    /// Sizes of this design.
    pub fn sizes(&self) -> Sizes {
        let (decoder, network) = (&self.tdc.decoder, &self.estimators.depth_estimator);
        let calibration = self.tdc_calibration.as_ref();
        Sizes {
            taps: self.tdc.delays.taps() as u32,
            coarse_bits: self.tdc.coarse_counter.coarse_bits,
            age_bits: (0..=self.channels.len())
                .map(|column| self.tdc_of(column).decoder.age_bits())
                .max()
                .unwrap_or(AGE_BITS),
            count_stages: decoder.count_stages as u32,
            hosted: self.is_hosted,
            calibrates: calibration.is_some(),
            rows: self.frame_ctrl.scan.rows,
            columns: self.frame_ctrl.scan.columns,
            banks: self.frame_ctrl.scan.banks,
            hits_log2: calibration.map_or(HITS_LOG2, |own| own.hits_log2),
            drain_cycles: self.frame_ctrl.drain_cycles as u32,
            has_glass: self.estimators.likelihood_estimator.glass.bins() > 0,
            has_second: self.estimators.likelihood_estimator.has_second(),
            likelihood_cycles: self.estimators.likelihood_estimator.done() as u32,
            ..usual(
                &decoder.scale,
                &self.vcsel_driver,
                &self.histogram,
                &network.forward2.datapath,
                network.neurons(),
            )
        }
    }
}

/// Sizes of a design with the KC705's chain and drain, and no calibration or likelihood estimator.
fn usual(
    scale: &TimeScale,
    laser: &vcsel_driver::Params,
    histogram: &histogram_builder::Params,
    datapath: &Datapath,
    neurons: usize,
) -> Sizes {
    let network = estimator_ctrl::Params { bins: histogram.bins, neurons };
    let usual = centroid_estimator::Params::default();
    let centroid = centroid_estimator::Params { histogram: *histogram, ..usual };
    Sizes {
        taps: TAPS as u32,
        coarse_bits: DEFAULT_COARSE_BITS,
        cycle: scale.cycle() as u32,
        digits: scale.digits(),
        age_bits: AGE_BITS,
        count_stages: COUNT_STAGES as u32,
        hosted: false,
        calibrates: false,
        rows: 1,
        columns: 1,
        banks: 1,
        hits_log2: HITS_LOG2,
        rates: laser.periods.len() as u32,
        longest_period: laser.longest_period() as u32,
        pulse_half_cycles: laser.pulse_half_cycles,
        drain_cycles: frame_ctrl::DRAIN_CYCLES as u32,
        bins: histogram.bins as u32,
        count_bits: histogram.count_bits,
        neurons: neurons as u32,
        w1: datapath.w1,
        b1: datapath.b1,
        w2: datapath.w2,
        b2: datapath.b2,
        activation: datapath.l1_out,
        address_bits: datapath.address_bits,
        range_log2: datapath.range_log2,
        sum_bits: datapath.sum_bits(histogram),
        output_sum_bits: datapath.output_sum_bits(),
        network_cycles: network.done() as u32,
        centroid_cycles: centroid.done() as u32,
        position_bits: centroid_estimator::position_bits(histogram),
        has_glass: false,
        has_second: false,
        likelihood_cycles: 0,
    }
}
