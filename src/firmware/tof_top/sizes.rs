//! How wide words are and how many there are of each, where elaboration decides it.

use crate::firmware::carry_chain::TAPS;
use crate::firmware::coarse_counter::DEFAULT_COARSE_BITS;
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::firmware::forward2::NEURONS;
use crate::firmware::tdc_decoder::TimeScale;
use crate::firmware::{
    centroid_estimator, estimator_ctrl, frame_ctrl, histogram_builder, likelihood_estimator,
    vcsel_driver,
};
use crate::kernel::ones_width;
use crate::kernel::signals::{Signal, SignalFormat};

use super::ports::Params;

/// What widths and numbers of signals follow from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Taps of the chain.
    pub taps: usize,
    /// Bits of the coarse count.
    pub coarse_bits: u32,
    /// A clock period as times count it [units].
    pub cycle: u64,
    /// Binary digits of a time below a bin.
    pub digits: u32,
    /// Bits of the calibration ROM.
    pub age_bits: u32,
    /// Whether the firmware calibrates its TDC.
    pub calibrates: bool,
    /// Hits of such a calibration, as a power of two.
    pub hits_log2: u32,
    /// Laser rates to choose from.
    pub rates: usize,
    /// The longest laser period [cycles of clk_sys].
    pub longest_period: u64,
    /// Length of the laser pulse [half cycles of clk_laser].
    pub pulse_half_cycles: u32,
    /// Length of Drain [cycles of clk_sys].
    pub drain_cycles: u64,
    /// How large the histogram is.
    pub histogram: histogram_builder::Params,
    /// Hidden neurons.
    pub neurons: usize,
    /// Number formats of the network.
    pub datapath: Datapath,
    /// Cycles of the likelihood estimator [cycles of clk_sys].
    pub likelihood_cycles: u64,
}

impl Default for Sizes {
    /// The KC705's.
    fn default() -> Self {
        let (laser, scale) = (vcsel_driver::Params::default(), TimeScale::default());
        Sizes {
            taps: TAPS,
            coarse_bits: DEFAULT_COARSE_BITS,
            cycle: scale.cycle(),
            digits: scale.digits(),
            age_bits: 14,
            calibrates: false,
            hits_log2: 13,
            rates: laser.periods.len(),
            longest_period: laser.longest_period(),
            pulse_half_cycles: laser.pulse_half_cycles,
            drain_cycles: frame_ctrl::DRAIN_CYCLES,
            histogram: histogram_builder::Params::default(),
            neurons: NEURONS,
            datapath: Datapath::THESIS,
            likelihood_cycles: 0,
        }
    }
}

/// In [`Signal::size`], of ports that only a TDC with a calibration has.
const CALIBRATION: &str = "Calibration";
/// Fewest bits of what counts pairs of neurons: as many as eight neurons have had.
const FEWEST_PAIR_BITS: u32 = 3;

/// Bits of a word that counts up to `last`.
fn bits_to(last: u64) -> u32 {
    (u64::BITS - last.leading_zeros()).max(1)
}

impl Sizes {
    /// What the steps of the network's estimation follow from.
    pub fn network(&self) -> estimator_ctrl::Params {
        estimator_ctrl::Params { bins: self.histogram.bins, neurons: self.neurons }
    }

    /// A centroid estimator of such a histogram, with the KC705's window and scale.
    pub fn centroid(&self) -> centroid_estimator::Params {
        let histogram = self.histogram;
        centroid_estimator::Params { histogram, ..centroid_estimator::Params::default() }
    }

    /// The width of a word that is called that in [`Signal::size`]; 0 where there is no such word [bits].
    pub fn width(&self, size: &str) -> Option<u32> {
        let (histogram, datapath) = (&self.histogram, &self.datapath);
        let (bin_bits, count_bits) = (histogram.bins.ilog2(), histogram.count_bits);
        let position_bits = centroid_estimator::position_bits(histogram);
        let (rest_bits, weight_bits) = (count_bits + bin_bits, (count_bits + 8).max(24));
        let groups = |group: usize| (self.taps.div_ceil(group) * ones_width(group)) as u32;
        Some(match size {
            "Taps" => self.taps as u32,
            "Sixteens" => groups(16),
            "Hundreds" => groups(128),
            "CountOfTaps" => bits_to(self.taps as u64),
            "CoarseBits" => self.coarse_bits,
            "AgeBits" => self.age_bits,
            "HitsBits" => self.hits_log2 + 1,
            "HitsSumBits" => self.age_bits + self.hits_log2 + 1,
            "TimeBits" => {
                let edge_bits = bits_to(self.cycle) + self.coarse_bits;
                let code_bits = bin_bits + self.digits;
                edge_bits.max(self.age_bits).max(code_bits) + 1
            }
            "RateBits" => bits_to(self.rates as u64 - 1),
            "PeriodBits" => bits_to(self.longest_period - 1),
            "Halves" => self.pulse_half_cycles.min(2),
            "SecondHalf" => u32::from(self.pulse_half_cycles > 1),
            "Stretch" => self.pulse_half_cycles.div_ceil(2) - 1,
            "DrainBits" => bits_to(self.drain_cycles - 1),
            "BinBits" => bin_bits,
            "CountBits" => count_bits,
            "W1Bits" => datapath.w1.width,
            "B1Bits" => datapath.b1.width,
            "W2Bits" => datapath.w2.width,
            "B2Bits" => datapath.b2.width,
            "ActivationBits" => datapath.l1_out.width,
            "ProductBits" => datapath.product_bits(histogram),
            "SumBits" => datapath.sum_bits(histogram),
            "TermBits" => datapath.term_bits(),
            "OutputSumBits" => datapath.output_sum_bits(),
            "PairBits" => bits_to(self.neurons.div_ceil(2) as u64 - 1).max(FEWEST_PAIR_BITS),
            "StepBits" => bits_to(self.network().done() - 1),
            "CentroidStepBits" => bits_to(self.centroid().done() - 1),
            "ChangeBits" => count_bits + 1,
            "WindowBits" => count_bits + 6,
            "AgesBits" => count_bits + 11,
            "RemainderBits" => count_bits + 13,
            "PlaceBits" => bin_bits + 1,
            "RestBits" => rest_bits,
            "ExposureBits" => rest_bits + 10,
            "WidthBits" => likelihood_estimator::params::WIDTH_BITS,
            "EdgeBits" => bin_bits + 8,
            "ArrivalBits" => bin_bits + 11,
            "ArrivalTimeBits" => bin_bits + 12,
            "ThreeBits" => count_bits + 2,
            "BegunBits" => count_bits + 4,
            "SurplusBits" => rest_bits + 18,
            "FirstShiftBits" => rest_bits + 16,
            "FactorBits" => (count_bits + 2).max(14),
            "FirstProductBits" => count_bits + 23,
            "SecondProductBits" => weight_bits + (count_bits + 2).max(14) + 1,
            "ThirdProductBits" => weight_bits + 15,
            "FourthProductBits" => weight_bits + 10,
            "SquareOverBits" => 2 * count_bits + 9,
            "ResidualBits" => count_bits + 9,
            "ExpectedBits" => count_bits + 18,
            "MiddleBits" => count_bits + 1,
            "EndedBits" => rest_bits + 17,
            "WaitingProductBits" => rest_bits + 14,
            "WeightBits" => weight_bits,
            "SquareBits" => 2 * count_bits,
            "UnseenBits" => count_bits + 10,
            "MixedBits" | "VarianceBits" => weight_bits + 1,
            "SeenSlopeBits" => count_bits + 18,
            "WeightSlopeBits" => weight_bits + 9,
            "SlopeSumBits" => count_bits + 24,
            "SumWordBits" => count_bits + 19,
            "LastSumBits" => (count_bits + 19).max(bin_bits + 25) + 1,
            "ChiBits" => bin_bits + 25,
            "ExcessBits" | "BoxExpectedBits" => rest_bits + 14,
            "BoxMiddleBits" => rest_bits + 1,
            "BoxTermBits" => count_bits + 15,
            "BoxSumBits" => bin_bits + 2,
            "WaitBits" => bin_bits + 3,
            "WordBits" => likelihood_estimator::params::word_bits(histogram),
            "LowProductBits" => likelihood_estimator::params::word_bits(histogram) + 18,
            "LowTermBits" => likelihood_estimator::params::word_bits(histogram) + 1,
            "HighTermBits" => 2 * (likelihood_estimator::params::word_bits(histogram) - 17),
            "FineBits" => likelihood_estimator::params::word_bits(histogram) + 18,
            "SumOfWordBits" => likelihood_estimator::params::word_bits(histogram) + 3,
            "MagnitudeBits" => likelihood_estimator::params::word_bits(histogram) - 14,
            "ShiftedBits" => likelihood_estimator::params::word_bits(histogram) + 2,
            "PositionBits" => position_bits,
            "PositionCoarseBits" => position_bits - 1,
            "DistanceBits" => position_bits + 10,
            _ => return None,
        })
    }

    /// Whether a signal that is a port is one in a design of these sizes: not if it is for a calibration of the TDC that
    /// there is not.
    pub fn shares(&self, signal: &Signal) -> bool {
        self.calibrates || !signal.size.is_some_and(|size| size.starts_with(CALIBRATION))
    }

    /// A signal as a design of these sizes has it, if it has it.
    pub fn fitted(&self, signal: Signal) -> Option<Signal> {
        let mut sizes =
            signal.size.unwrap_or_default().split(' ').filter(|size| !size.is_empty()).peekable();
        if sizes.next_if_eq(&"Neurons").is_some() {
            let place = signal.name.rsplit('_').next()?.parse::<usize>().ok()?;
            if place >= self.neurons {
                return None;
            }
        }
        sizes.next_if_eq(&CALIBRATION);
        let Some(size) = sizes.next() else { return Some(signal) };
        let (width, datapath) = (self.width(size)?, &self.datapath);
        let format = match (signal.format, size) {
            (SignalFormat::Unsigned, _) if width == 1 => SignalFormat::Bits,
            (SignalFormat::Signed { .. }, "SumBits") => {
                SignalFormat::Signed { fraction: datapath.w1.fraction }
            }
            (SignalFormat::Signed { .. }, "ActivationBits") => {
                SignalFormat::Signed { fraction: datapath.l1_out.fraction }
            }
            (SignalFormat::Signed { .. }, "TermBits" | "OutputSumBits") => {
                SignalFormat::Signed { fraction: datapath.term_fraction() }
            }
            (format, _) => format,
        };
        (width > 0).then_some(Signal { width, format, ..signal })
    }
}

impl Params {
    /// Widths and numbers that they come to.
    pub fn sizes(&self) -> Sizes {
        let usual = Sizes::default();
        Sizes {
            taps: self.tdc.delays.taps(),
            coarse_bits: self.tdc.coarse_counter.coarse_bits,
            cycle: self.tdc.decoder.scale.cycle(),
            digits: self.tdc.decoder.scale.digits(),
            age_bits: self.tdc.decoder.age_bits(),
            calibrates: self.tdc_calibration.is_some(),
            hits_log2: self.tdc_calibration.as_ref().map_or(usual.hits_log2, |p| p.hits_log2),
            rates: self.vcsel_driver.periods.len(),
            longest_period: self.vcsel_driver.longest_period(),
            pulse_half_cycles: self.vcsel_driver.pulse_half_cycles,
            drain_cycles: self.frame_ctrl.drain_cycles,
            histogram: self.histogram,
            neurons: self.depth_estimator.neurons(),
            datapath: self.depth_estimator.forward2.datapath,
            likelihood_cycles: self.likelihood_estimator.done(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_is_what_the_largest_value_needs() {
        let kc705 = Sizes::default();
        let widths = |sizes: Sizes, names: &[&str]| -> Vec<u32> {
            names.iter().map(|name| sizes.width(name).unwrap()).collect()
        };
        let names =
            ["Taps", "Sixteens", "Hundreds", "CountOfTaps", "TimeBits", "RateBits", "PeriodBits"];
        assert_eq!(widths(kc705, &names), [800, 250, 56, 10, 17, 2, 5]);
        let other = Sizes { taps: 17, coarse_bits: 12, rates: 1, longest_period: 65_535, ..kc705 };
        assert_eq!(widths(other, &names), [17, 10, 8, 5, 26, 1, 16]);
        let pulses = [1, 2, 3, 8].map(|pulse_half_cycles| {
            let sizes = Sizes { pulse_half_cycles, ..kc705 };
            widths(sizes, &["Halves", "SecondHalf", "Stretch"])
        });
        assert_eq!(pulses, [[1, 0, 0], [2, 1, 0], [2, 1, 1], [2, 1, 3]]);
    }
}
