//! Resources of the estimator, by word lengths and table size.

use serde::Serialize;

use tofsim::firmware::depth_estimator::datapath::Datapath;

/// Resources of a datapath.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Cost {
    /// Whole block RAMs, of 36 Kb.
    pub ramb36: u32,
    /// Halves of block RAMs, of 18 Kb, beside those.
    pub ramb18: u32,
    /// DSP slices.
    pub dsp48: u32,
}

impl Cost {
    /// Block RAMs and DSP slices as `rtl_ref` is built for so many neurons: MEM1 a row a bin, MEM2 a copy for each two
    /// neurons, since a block RAM has two ports; a multiplier of 25 x 18 bits a neuron, and two.
    pub fn of(datapath: &Datapath, neurons: usize) -> Cost {
        let neurons = neurons as u32;
        // One port of twice the width: 512 words of 72 bits, or of 36 in a half (UG473, tables 1-7 and 1-8).
        let mem1 = BlockRams::of(neurons * datapath.w1.width, 72, 36);
        // Two ports: a half has half the words of the same width (UG473, table 1-3).
        let mem2 = match datapath.address_bits {
            0..=14 => {
                let width = |kilobits: u32| match kilobits.saturating_sub(datapath.address_bits) {
                    // Parity bits are data from words of 8 bits on.
                    bits @ 0..=2 => 1 << bits,
                    bits => (1 << bits.min(kilobits - 10)) / 8 * 9,
                };
                BlockRams::of(datapath.l1_out.width, width(15), width(14))
            }
            deep => BlockRams { whole: datapath.l1_out.width << (deep - 15), half: 0 },
        };
        let copies = neurons.div_ceil(2);
        // A count of 16 bits is 17 with its sign; activation and W2 take either side.
        let slices = |a: u32, b: u32| if a.min(b) <= 18 && a.max(b) <= 25 { 1 } else { 2 };
        let hidden = neurons * slices(17, datapath.w1.width);
        Cost {
            ramb36: mem1.whole + copies * mem2.whole,
            ramb18: mem1.half + copies * mem2.half,
            dsp48: hidden + neurons.min(2) * slices(datapath.l1_out.width, datapath.w2.width),
        }
    }
    /// Block RAMs, two halves counted as one.
    pub fn block_rams(&self) -> f64 {
        f64::from(self.ramb36) + f64::from(self.ramb18) / 2.0
    }
}

/// Block RAMs side by side, which make a wide word together.
struct BlockRams {
    whole: u32,
    half: u32,
}

impl BlockRams {
    /// The fewest for a word of so many bits, when a whole one and a half hold so many each; of as many
    /// halves, those with more whole ones.
    fn of(bits: u32, whole: u32, half: u32) -> BlockRams {
        let with = |count: u32| {
            let left = bits.saturating_sub(count * whole);
            BlockRams { whole: count, half: left.div_ceil(half) }
        };
        let choices = (0..=bits.div_ceil(whole)).rev().map(with);
        choices.min_by_key(|rams| 2 * rams.whole + rams.half).unwrap_or(with(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::kernel::WordFormat;

    #[test]
    fn the_firmware_s_cost_is_that_of_its_synthesis() {
        let whole = |ramb36, dsp48| Cost { ramb36, ramb18: 0, dsp48 };
        assert_eq!(Cost::of(&Datapath::THESIS, 8), whole(2 + 8, 8 + 2));
        assert_eq!(Cost::of(&Datapath::THESIS, 16), whole(4 + 16, 16 + 2));
        let wide = Datapath { w1: WordFormat { width: 30, fraction: 37 }, ..Datapath::THESIS };
        assert_eq!(Cost::of(&wide, 8), Cost { ramb36: 3 + 8, ramb18: 1, dsp48: 16 + 2 });
    }

    #[test]
    fn a_small_table_takes_half_a_block_ram() {
        let table = |address_bits, width| {
            let l1_out = WordFormat { width, fraction: width - 1 };
            let Cost { ramb36, ramb18, .. } =
                Cost::of(&Datapath { address_bits, l1_out, ..Datapath::THESIS }, 2);
            // Two neurons have one copy, and 32 bits of MEM1, which is a half.
            (ramb36, ramb18 - 1)
        };
        assert_eq!(table(10, 16), (0, 1), "1024 x 16");
        assert_eq!(table(9, 16), (0, 1), "512 x 16: two ports have 18 bits at most");
        assert_eq!(table(10, 18), (0, 1), "1024 x 18");
        assert_eq!(table(10, 20), (1, 0), "1024 x 20");
        assert_eq!(table(11, 9), (0, 1), "2048 x 9");
        assert_eq!(table(11, 16), (1, 0), "2048 x 16");
        assert_eq!(table(12, 10), (1, 1), "4096 x 10: nine bits and four");
        assert_eq!(table(12, 16), (2, 0), "4096 x 16, the firmware's");
        assert_eq!(table(13, 16), (4, 0), "8192 x 16");
        assert_eq!(table(15, 16), (16, 0), "32768 x 16");
        assert_eq!(table(16, 16), (32, 0), "65536 x 16");
        let halves = Cost { ramb36: 1, ramb18: 3, dsp48: 0 };
        assert_eq!(halves.block_rams(), 2.5);
    }
}
