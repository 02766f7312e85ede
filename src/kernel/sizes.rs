//! The sizes of the firmware: the one table of what elaboration decides about its words.
//!
//! A signal names its size with `#[size(BinBits)]` ([`crate::signals`]), a Verilog module with a
//! parameter of the same name.

mod design;
pub mod likelihood;

use likelihood::{EDGE_BITS, WIDTH_BITS};

pub use design::Sizes;

/// Declares [`Size`]: a line has the meaning of a size, its name in Rust and Verilog, its value in a
/// design, and after `point` the fraction bits of a signed word of that width.
macro_rules! sizes {
    ($sizes:ident: $(#[doc = $doc:literal] $name:ident = $value:expr $(, point $fraction:expr)?;)*) => {
        /// A number that elaboration decides: most are the width of a word [bits].
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Size { $(#[doc = $doc] $name,)* }

        impl Size {
            /// All sizes, in the order of the table.
            pub const ALL: &[Size] = &[$(Size::$name),*];

            /// Name of the Verilog parameter.
            pub fn name(self) -> &'static str {
                match self { $(Size::$name => stringify!($name),)* }
            }
        }

        impl Sizes {
            /// Value of a size in this design.
            pub fn of(&self, size: Size) -> u32 {
                let $sizes = self;
                match size { $(Size::$name => $value,)* }
            }

            /// Fraction bits of a signed word of that size, where they vary too.
            pub fn fraction(&self, size: Size) -> Option<u32> {
                let $sizes = self;
                match size {
                    $($(Size::$name => Some($fraction),)?)*
                    _ => None,
                }
            }
        }
    };
}

sizes! { s:
    /// Taps of the delay chain.
    Taps = s.taps;
    /// Bits of the ones counts of 16 taps each, side by side.
    Sixteens = s.taps.div_ceil(16) * bits_to(16);
    /// Bits of the ones counts of 128 taps each, side by side.
    Hundreds = s.taps.div_ceil(128) * bits_to(128);
    /// Bits of a number of taps.
    CountOfTaps = bits_to(s.taps);
    /// Bits of the coarse count.
    CoarseBits = s.coarse_bits;
    /// Clock period [time units].
    Cycle = s.cycle;
    /// Binary digits of a time below a bin.
    Digits = s.digits;
    /// Bits of an age in the calibration ROM.
    AgeBits = s.age_bits;
    /// Bits of a time that the decoder reckons with.
    TimeBits = (bits_to(s.cycle) + s.coarse_bits).max(s.age_bits).max(s.bin_bits() + s.digits) + 1;
    /// Registers of the ones count.
    CountStages = s.count_stages;
    /// 1 if the firmware calibrates its TDC.
    Calibrated = s.calibrates.into();
    /// 1 if a host controls the firmware through registers.
    Hosted = s.hosted.into();
    /// Rows of the array.
    Rows = s.rows;
    /// Columns of the array.
    Columns = s.columns;
    /// Number of the last column.
    LastColumn = s.columns - 1;
    /// Banks of histograms.
    Banks = s.banks;
    /// 1 if there is more than one row, column or bank.
    Scanned = u32::from(s.rows * s.columns * s.banks > 1);
    /// Bits of a number of hits of a calibration.
    HitsBits = s.hits_log2 + 1;
    /// Bits of a sum over the hits of a calibration.
    HitsSumBits = s.age_bits + s.hits_log2 + 1;

    /// Bits of a laser rate's code.
    RateBits = bits_to(s.rates - 1);
    /// Bits of a count of cycles in a laser period.
    PeriodBits = bits_to(s.longest_period - 1);
    /// Length of the laser pulse [half cycles of clk_laser].
    PulseHalfCycles = s.pulse_half_cycles;
    /// Half cycles of clk_laser that the pulse is given for at once.
    Halves = s.pulse_half_cycles.min(2);
    /// 1 if the pulse lasts into the second half cycle.
    SecondHalf = u32::from(s.pulse_half_cycles > 1);
    /// Registers that stretch the pulse by a cycle each.
    Stretch = s.pulse_half_cycles.div_ceil(2) - 1;
    /// Length of Drain [cycles of clk_sys].
    DrainCycles = s.drain_cycles;
    /// Bits of a count of cycles of Drain.
    DrainBits = bits_to(s.drain_cycles - 1);

    /// Bits of a bin's number.
    BinBits = s.bin_bits();
    /// Bits of a bin count.
    CountBits = s.count_bits;

    /// Hidden neurons.
    Neurons = s.neurons;
    /// Bits of a hidden weight.
    W1Bits = s.w1.width;
    /// Fraction bits of a hidden weight.
    W1Fraction = s.w1.fraction;
    /// Bits of a hidden bias.
    B1Bits = s.b1.width;
    /// Fraction bits of a hidden bias.
    B1Fraction = s.b1.fraction;
    /// Bits of a bin count times a weight.
    ProductBits = s.count_bits + s.w1.width + 1;
    /// Bits of a sum of the hidden layer.
    SumBits = s.sum_bits, point s.w1.fraction;
    /// Bits of an address of the activation table.
    AddressBits = s.address_bits;
    /// Range of the activation table: minus to plus two to this power.
    RangeLog2 = s.range_log2;
    /// Bits of an activation.
    ActivationBits = s.activation.width, point s.activation.fraction;
    /// Fraction bits of an activation.
    ActivationFraction = s.activation.fraction;
    /// Bits of an output weight.
    W2Bits = s.w2.width;
    /// Fraction bits of an output weight.
    W2Fraction = s.w2.fraction;
    /// Bits of the output bias.
    B2Bits = s.b2.width;
    /// Fraction bits of the output bias.
    B2Fraction = s.b2.fraction;
    /// Bits of an activation times its weight.
    TermBits = s.w2.width + s.activation.width, point s.w2.fraction + s.activation.fraction;
    /// Bits of a sum of the output layer.
    OutputSumBits = s.output_sum_bits, point s.w2.fraction + s.activation.fraction;
    /// Bits of the number of a pair of neurons, at least those of eight neurons.
    PairBits = bits_to(s.neurons.div_ceil(2) - 1).max(3);
    /// Bits of a count of the network's cycles.
    StepBits = bits_to(s.network_cycles - 1);

    /// Bits of a count of the centroid estimator's cycles.
    CentroidStepBits = bits_to(s.centroid_cycles - 1);
    /// Bits of the change of the window's sum.
    ChangeBits = s.count_bits + 1;
    /// Bits of the window's sum.
    WindowBits = s.count_bits + 6;
    /// Bits of the window's first moment.
    AgesBits = s.count_bits + 11;
    /// Bits of a remainder of the division.
    RemainderBits = s.count_bits + 13;
    /// Bits of a position in the histogram.
    PositionBits = s.position_bits;
    /// Bits of the position's upper part.
    PositionCoarseBits = s.position_bits - 1;
    /// Bits of a distance before it is cut to a depth.
    DistanceBits = s.position_bits + 10;

    /// 1 if the likelihood estimator knows of a cover glass.
    Glass = s.has_glass.into();
    /// 1 if the likelihood estimator looks for a second target.
    HasSecond = s.has_second.into();
    /// 1 if the likelihood estimator knows of a cover glass, or looks for a second target.
    MoreLight = (s.has_glass || s.has_second).into();
    /// Bits of a place in the likelihood estimator's program.
    ProgramBits = 6 + u32::from(s.has_glass || s.has_second);
    /// Bits of a sum of hazards.
    HazardSumBits = 27 + u32::from(s.has_glass || s.has_second);
    /// Bits of the last factor of the glass's products: a slope, or a share.
    GlassFactorBits = 9 + 5 * u32::from(s.has_second);
    /// Bits of the last of the glass's products.
    GlassProductBits = s.weight_bits() + 9 + 5 * u32::from(s.has_second);
    /// Bits of a number of bins.
    PlaceBits = s.bin_bits() + 1;
    /// Bits of a sum of bin counts.
    RestBits = s.rest_bits();
    /// Bits of an exposure.
    ExposureBits = s.rest_bits() + WIDTH_BITS;
    /// Bits of a bin's width.
    WidthBits = WIDTH_BITS;
    /// Bits of a bin's edge [half units].
    EdgeBits = s.bin_bits() + EDGE_BITS;
    /// Bits of an arrival.
    ArrivalBits = s.bin_bits() + 11;
    /// Bits of a signed time from an arrival.
    ArrivalTimeBits = s.bin_bits() + 12;
    /// Bits of a sum of three bin counts.
    ThreeBits = s.count_bits + 2;
    /// Bits of the counts at a histogram's begin.
    BegunBits = s.count_bits + 4;
    /// Bits of what the counts exceed the ambient by.
    SurplusBits = s.rest_bits() + 18;
    /// Bits of the first operand, shifted.
    FirstShiftBits = s.rest_bits() + 16;
    /// Bits of a factor of the second product.
    FactorBits = (s.count_bits + 2).max(14);
    /// Bits of the first product.
    FirstProductBits = s.count_bits + 23;
    /// Bits of the second product.
    SecondProductBits = s.weight_bits() + (s.count_bits + 2).max(14) + 1;
    /// Bits of the third product.
    ThirdProductBits = s.weight_bits() + 15;
    /// Bits of the fourth product.
    FourthProductBits = s.weight_bits() + 10;
    /// Bits of a square over its expectation.
    SquareOverBits = 2 * s.count_bits + 9;
    /// Bits of a residual.
    ResidualBits = s.count_bits + 9;
    /// Bits of an expected count.
    ExpectedBits = s.count_bits + 18;
    /// Bits of a middle count.
    MiddleBits = s.count_bits + 1;
    /// Bits of a product of the shots that ended.
    EndedBits = s.rest_bits() + 17;
    /// Bits of a product of the shots that wait.
    WaitingProductBits = s.rest_bits() + 14;
    /// Bits of a weight.
    WeightBits = s.weight_bits();
    /// Bits of a squared count.
    SquareBits = 2 * s.count_bits;
    /// Bits of an unseen count.
    UnseenBits = s.count_bits + 10;
    /// Bits of a mixed weight.
    MixedBits = s.weight_bits() + 1;
    /// Bits of a variance.
    VarianceBits = s.weight_bits() + 1;
    /// Bits of a seen count times a slope.
    SeenSlopeBits = s.count_bits + 18;
    /// Bits of a weight times a slope.
    WeightSlopeBits = s.weight_bits() + 9;
    /// Bits of a sum of slopes.
    SlopeSumBits = s.count_bits + 24;
    /// Bits of a sum for the solver.
    SumWordBits = s.count_bits + 19;
    /// Bits of the last sum.
    LastSumBits = (s.count_bits + 19).max(s.bin_bits() + 25) + 1;
    /// Bits of a chi-square.
    ChiBits = s.bin_bits() + 25;
    /// Bits of an excess over the ambient.
    ExcessBits = s.rest_bits() + 14;
    /// Bits of a box's expected count.
    BoxExpectedBits = s.rest_bits() + 14;
    /// Bits of a box's middle count.
    BoxMiddleBits = s.rest_bits() + 1;
    /// Bits of a term of a box's score.
    BoxTermBits = s.count_bits + 15;
    /// Bits of a number of terms of a box.
    BoxSumBits = s.bin_bits() + 2;
    /// Bits of a count of the likelihood estimator's cycles.
    WaitBits = s.bin_bits() + 3 + u32::from(s.has_second);
    /// Bits of a word of the solver.
    WordBits = s.word_bits();
    /// Bits of the product of a word's lower part.
    LowProductBits = s.word_bits() + 18;
    /// Bits of a term of lower parts.
    LowTermBits = s.word_bits() + 1;
    /// Bits of a term of upper parts.
    HighTermBits = 2 * (s.word_bits() - 17);
    /// Bits of a word before its last bits are dropped.
    FineBits = s.word_bits() + 18;
    /// Bits of a sum of words.
    SumOfWordBits = s.word_bits() + 3;
    /// Bits of a magnitude's upper part.
    MagnitudeBits = s.word_bits() - 14;
    /// Bits of a shifted word.
    ShiftedBits = s.word_bits() + 2;
}

impl Size {
    /// Size of a Verilog parameter.
    pub fn named(name: &str) -> Option<Self> {
        Size::ALL.iter().copied().find(|size| size.name() == name)
    }
}

/// Bits of a word that counts up to `last`.
fn bits_to(last: u32) -> u32 {
    (u32::BITS - last.leading_zeros()).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_is_what_the_largest_value_needs() {
        use Size::*;
        let kc705 = Sizes::default();
        let names = [Taps, Sixteens, Hundreds, CountOfTaps, TimeBits, RateBits, PeriodBits];
        assert_eq!(names.map(|size| kc705.of(size)), [800, 250, 56, 10, 17, 2, 5]);
        let other = Sizes { taps: 17, coarse_bits: 12, rates: 1, longest_period: 65_535, ..kc705 };
        assert_eq!(names.map(|size| other.of(size)), [17, 10, 8, 5, 26, 1, 16]);
        let pulses = [1, 2, 3, 8].map(|pulse_half_cycles| {
            let sizes = Sizes { pulse_half_cycles, ..kc705 };
            [Halves, SecondHalf, Stretch].map(|size| sizes.of(size))
        });
        assert_eq!(pulses, [[1, 0, 0], [2, 1, 0], [2, 1, 1], [2, 1, 3]]);
    }

    #[test]
    fn a_size_is_found_by_its_name_and_no_other_is() {
        assert!(Size::ALL.iter().all(|&size| Size::named(size.name()) == Some(size)));
        assert_eq!(Size::named("BinBit"), None);
    }
}
