//! The number formats of the network (thesis Table 6.4), and what widths follow from them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Input, Result};
use crate::firmware::histogram_builder;
use crate::kernel::{Overflow, WordFormat};

/// Fraction bits of the depth [2^-29 m].
pub const DEPTH_FRACTION: u32 = 29;
/// Width of the depth [bits].
pub const DEPTH_BITS: u32 = 36;
/// Fewest bits of a sum of the hidden layer: the thesis's.
const FEWEST_SUM_BITS: u32 = 36;
/// Most bits of a bias where it is added.
const MOST_ALIGNED_BITS: u32 = 48;
/// Most fraction bits of a product of the output layer.
const MOST_TERM_FRACTION: u32 = 46;

/// Word lengths of the depth estimator, and the size of its table of activations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Datapath {
    /// Weights of the hidden layer.
    pub w1: WordFormat,
    /// Biases of the hidden layer.
    pub b1: WordFormat,
    /// Weights of the output layer [m].
    pub w2: WordFormat,
    /// Bias of the output layer [m].
    pub b2: WordFormat,
    /// Activations.
    pub l1_out: WordFormat,
    /// Address bits of the table.
    pub address_bits: u32,
    /// The table goes from minus to plus two to this power; sums past it share its last entries.
    pub range_log2: u32,
}

/// The thesis's, Table 6.4.
impl Default for Datapath {
    fn default() -> Self {
        Datapath::THESIS
    }
}

impl Datapath {
    /// The thesis's, Table 6.4: W1 below 2^-8, B1 below 4, W2 below 2 m, B2 below 1/4 m, a table of 4096
    /// entries over +-4.
    pub const THESIS: Datapath = Datapath {
        w1: WordFormat { width: 16, fraction: 23 },
        b1: WordFormat { width: 16, fraction: 13 },
        w2: WordFormat { width: 16, fraction: 14 },
        b2: WordFormat { width: 16, fraction: 17 },
        l1_out: WordFormat { width: 16, fraction: 15 },
        address_bits: 12,
        range_log2: 2,
    };

    /// Names of its words.
    pub const WORDS: [&str; 5] = ["w1", "b1", "w2", "b2", "l1_out"];

    /// Its words, as named.
    pub fn words(&self) -> [(&'static str, WordFormat); 5] {
        let [w1, b1, w2, b2, l1_out] = Self::WORDS;
        [(w1, self.w1), (b1, self.b1), (w2, self.w2), (b2, self.b2), (l1_out, self.l1_out)]
    }

    /// The format of a word.
    pub fn word(&mut self, name: &str) -> Option<&mut WordFormat> {
        let words = [&mut self.w1, &mut self.b1, &mut self.w2, &mut self.b2, &mut self.l1_out];
        Self::WORDS.into_iter().zip(words).find(|(word, _)| *word == name).map(|(_, format)| format)
    }

    /// Checks that its words are of a size that is built, can be aligned, and its table has a step of 2^-k.
    ///
    /// # Errors
    /// When not, of `source`.
    pub fn check(&self, source: &str) -> Result<()> {
        match self.fault() {
            Some((field, value, expected)) => {
                Err(Input::new(source, expected).field(field).value(value).into())
            }
            None => Ok(()),
        }
    }

    /// Returns the word that is wrong, its value, and what was expected.
    pub fn fault(&self) -> Option<(String, u32, String)> {
        for (name, WordFormat { width, fraction }) in self.words() {
            if !(2..=24).contains(&width) {
                let expected = "expected a width of 2 to 24 bits".to_owned();
                return Some((format!("{name}.width"), width, expected));
            }
            if fraction > 32 {
                let expected = "expected 32 fraction bits or less".to_owned();
                return Some((format!("{name}.fraction"), fraction, expected));
            }
        }
        let Datapath { w1, b1, w2, b2, l1_out, address_bits, range_log2 } = *self;
        let term = w2.fraction + l1_out.fraction;
        let least =
            |bias: WordFormat, other: u32| (bias.width + other).saturating_sub(MOST_ALIGNED_BITS);
        let (b1_least, b2_least) = (least(b1, w1.fraction), least(b2, term));
        let checks = [
            (
                "w2.fraction",
                w2.fraction,
                term <= MOST_TERM_FRACTION,
                format!("expected {MOST_TERM_FRACTION} with those of l1_out, or less"),
            ),
            (
                "b1.fraction",
                b1.fraction,
                (b1_least..=w1.fraction).contains(&b1.fraction),
                format!("expected {b1_least} to {}, as w1 has", w1.fraction),
            ),
            (
                "b2.fraction",
                b2.fraction,
                (b2_least..=term).contains(&b2.fraction),
                format!("expected {b2_least} to {term}, as w2 and l1_out have together"),
            ),
            (
                "address_bits",
                address_bits,
                (4..=16).contains(&address_bits),
                "expected 4 to 16".to_owned(),
            ),
            ("range_log2", range_log2, range_log2 <= 6, "expected 6 or less".to_owned()),
            (
                "address_bits",
                address_bits,
                address_bits <= w1.fraction + range_log2,
                format!(
                    "expected {} or less: steps coarser than the last of w1's {} fraction bits",
                    w1.fraction + range_log2,
                    w1.fraction
                ),
            ),
        ];
        let found = checks.into_iter().find(|(_, _, holds, _)| !holds);
        found.map(|(field, value, _, expected)| (field.to_owned(), value, expected))
    }

    /// Step of the table, in a neuron's sum [1].
    pub fn step(&self) -> f64 {
        (f64::from(self.range_log2) + 1.0 - f64::from(self.address_bits)).exp2()
    }

    /// Fraction bits of a neuron's sum that the address of the table drops.
    pub fn shift(&self) -> u32 {
        self.w1.fraction + 1 + self.range_log2 - self.address_bits
    }

    /// By how many bits B1 is shifted up to be added to a sum.
    pub fn hidden_bias_shift(&self) -> u32 {
        self.w1.fraction - self.b1.fraction
    }

    /// Fraction bits of an activation times its weight, and of the sums of those.
    pub fn term_fraction(&self) -> u32 {
        self.w2.fraction + self.l1_out.fraction
    }

    /// By how many bits B2 is shifted up to be added to a sum.
    pub fn output_bias_shift(&self) -> u32 {
        self.term_fraction() - self.b2.fraction
    }

    /// Width of a word of the histogram times a weight [bits].
    pub fn product_bits(&self, histogram: &histogram_builder::Params) -> u32 {
        histogram.count_bits + self.w1.width + 1
    }

    /// Width of a neuron's sum: 36 as in the thesis, or as many as the largest sum, the bias or the range of the table
    /// has [bits].
    pub fn sum_bits(&self, histogram: &histogram_builder::Params) -> u32 {
        let bias = self.b1.width + self.hidden_bias_shift() + 1;
        let range = self.w1.fraction + self.range_log2 + 2;
        FEWEST_SUM_BITS.max(self.product_bits(histogram) + 1).max(bias).max(range)
    }

    /// Width of an activation times its weight [bits].
    pub fn term_bits(&self) -> u32 {
        self.w2.width + self.l1_out.width
    }

    /// Width of a sum of those: what the depth keeps of it, or a term and its sign [bits].
    pub fn output_sum_bits(&self) -> u32 {
        let dropped = self.term_fraction().saturating_sub(DEPTH_FRACTION);
        (DEPTH_BITS + dropped).max(self.term_bits() + 1)
    }

    /// The depth that a sum of the output layer comes to: aligned, what is past its last bit dropped, not yet wrapped.
    #[inline(always)]
    pub fn depth(&self, sum: i64) -> i64 {
        match self.term_fraction().checked_sub(DEPTH_FRACTION) {
            Some(dropped) => sum >> dropped,
            None => sum << (DEPTH_FRACTION - self.term_fraction()),
        }
    }

    /// The table of activations by address as an unsigned word: tanh, rounded half away from zero. The
    /// last entries may be 1.0, which the word does not have; they are the nearest it has.
    pub fn table(&self) -> Vec<i64> {
        let entries = 1i64 << self.address_bits;
        let entry = |place: i64| {
            let address = if place < entries / 2 { place } else { place - entries };
            let value = libm::tanh(address as f64 * self.step());
            self.l1_out.round(value, Overflow::Saturate).unwrap_or_default()
        };
        (0..entries).map(entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thesis_s_widths_are_table_6_4_s() {
        let (thesis, histogram) = (Datapath::THESIS, histogram_builder::Params::default());
        assert_eq!(thesis.check("thesis").ok(), Some(()));
        assert_eq!((thesis.product_bits(&histogram), thesis.sum_bits(&histogram)), (33, 36));
        assert_eq!((thesis.term_bits(), thesis.output_sum_bits()), (32, 36));
        assert_eq!((thesis.hidden_bias_shift(), thesis.output_bias_shift()), (10, 12));
        assert_eq!((thesis.shift(), thesis.depth(-5)), (14, -5));
    }

    #[test]
    fn the_depth_keeps_29_fraction_bits_of_any_products() {
        let w2 = |fraction| WordFormat { width: 18, fraction };
        let fine = Datapath { w2: w2(16), ..Datapath::THESIS };
        assert_eq!((fine.term_fraction(), fine.depth(7), fine.depth(-7)), (31, 1, -2));
        assert_eq!(fine.output_sum_bits(), 38);
        let coarse = Datapath { w2: w2(11), ..Datapath::THESIS };
        assert_eq!((coarse.depth(7), coarse.output_sum_bits()), (56, 36));
    }

    #[test]
    fn the_table_is_tanh_with_its_sign_in_the_top_address_bit() {
        let table = Datapath::THESIS.table();
        assert_eq!([table[0], table[1], table[4095]], [0, 64, -64]);
        assert_eq!(table[512], 24956, "tanh(1) = 0.761594");
        assert_eq!(table[2048], -32746, "tanh(-4) = -0.999329");
        assert_eq!(table[2047], 32746);
        for place in 1..2048 {
            assert_eq!(table[place], -table[4096 - place]);
            assert!(table[place] >= table[place - 1]);
        }
    }

    #[test]
    fn what_cannot_be_built_is_named_with_what_can() {
        let of = |change: &dyn Fn(&mut Datapath)| {
            let mut datapath = Datapath::THESIS;
            change(&mut datapath);
            let (field, value, expected) = datapath.fault().unwrap();
            format!("{field} = {value}: {expected}")
        };
        for (found, expected) in [
            (of(&|d| d.w1.width = 25), "w1.width = 25: expected a width of 2 to 24 bits"),
            (of(&|d| d.l1_out.fraction = 33), "l1_out.fraction = 33: expected 32 fraction bits"),
            (of(&|d| d.w2.fraction = 32), "w2.fraction = 32: expected 46 with those of l1_out"),
            (of(&|d| d.b1.fraction = 24), "b1.fraction = 24: expected 0 to 23, as w1 has"),
            (of(&|d| d.b2.fraction = 30), "b2.fraction = 30: expected 0 to 29"),
            (of(&|d| d.address_bits = 17), "address_bits = 17: expected 4 to 16"),
            (of(&|d| d.range_log2 = 7), "range_log2 = 7: expected 6 or less"),
            (
                of(&|d| (d.w1.fraction, d.b1.fraction) = (9, 5)),
                "address_bits = 12: expected 11 or less",
            ),
        ] {
            assert!(found.starts_with(expected), "{found}");
        }
    }
}
