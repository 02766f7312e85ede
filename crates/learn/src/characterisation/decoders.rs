//! Comparison of decoders on the same hits and the same chain.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use tofsim::firmware::tdc;
use tofsim::firmware::tdc_decoder::{self, Decoder, Encoder};

use super::bubbles;
use super::density::{CodeDensity, Spread};
use super::timing::TimeError;

/// Resources of a decoder's Verilog on a Kintex-7, by Yosys (`docs/resources.md`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecoderCost {
    /// LUT1 to LUT6 and INV.
    pub luts: u64,
    /// Flip-flops.
    pub ffs: u64,
}

/// Of [`Decoder::ALL`], each of `tdc_decoder` with 800 taps, those of `reordered` in the order of `kintex7`.
pub const COSTS: [DecoderCost; 3] = [
    DecoderCost { luts: 1660, ffs: 353 },
    DecoderCost { luts: 1045, ffs: 353 },
    DecoderCost { luts: 1049, ffs: 353 },
];

/// What a decoder is like.
#[derive(Clone, Debug, Serialize)]
pub struct DecoderFigures {
    /// `ones`, `leading`, `reordered`, or `states` where each pattern of the taps is a code of its own.
    #[serde(rename = "decoder")]
    pub name: &'static str,
    /// The code-density test.
    #[serde(skip)]
    pub density: CodeDensity,
    /// Codes that hits have.
    pub codes: usize,
    /// Codes between the least and the largest that no hit has.
    pub empty: usize,
    /// Mean width of a code from the least to the largest [ps].
    pub lsb_ps: f64,
    /// By the delays [own LSB].
    #[serde(rename = "dnl_lsb")]
    pub dnl: Spread,
    /// Widest code [ps].
    pub widest_ps: f64,
    /// Equal codes as coarse as these are so wide [ps].
    pub equivalent_ps: f64,
    /// Single-shot precision with the ROM of a converter that nobody has calibrated [ps].
    pub raw_precision_ps: f64,
    /// Single-shot precision with the decoder's own ROM [ps].
    pub precision_ps: f64,
    /// Part of the hits whose time is off by more than a bin of the histogram, uncalibrated [1].
    pub raw_off_by_a_bin: f64,
    /// The same part, with the decoder's own ROM [1].
    pub off_by_a_bin: f64,
    /// Look-up tables, where there is Verilog of it.
    pub luts: Option<u64>,
    /// Flip-flops, where there is Verilog of it.
    pub ffs: Option<u64>,
}

/// A pattern of the taps, and the number that each decoder makes of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Read {
    /// From the first zero to the last one, tap 0's side first; empty without a bubble.
    pub levels: String,
    /// Part of the phases at which it is seen [1].
    pub share: f64,
    /// By [`Decoder::ALL`], less the number of ones below the first zero [taps].
    #[serde(rename = "n_above_first_zero", serialize_with = "by_decoder")]
    pub numbers: [usize; 3],
}

/// Serializes a number of each decoder under its name.
fn by_decoder<S: Serializer>(numbers: &[usize; 3], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(Decoder::ALL.map(Decoder::name).iter().zip(numbers))
}

/// All decoders on one chain.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The decoders, then `states`.
    pub decoders: Vec<DecoderFigures>,
    /// Patterns, the most frequent first.
    pub patterns: Vec<Read>,
    /// Width of a bin of the histogram [ps].
    pub bin_ps: f64,
}

impl Comparison {
    /// Of a converter's chain, with so many hits, the same for each decoder.
    pub fn new(p: &tdc::Params, hits: u64, seed: u64) -> Self {
        let bin_ps = p.decoder.scale.bin().fs() as f64 * 1e-3;
        let figures = |(decoder, cost): (Decoder, DecoderCost)| {
            let own = p.clone().with_decoder(decoder);
            let density = CodeDensity::new(&own, hits, seed);
            DecoderFigures::new(decoder.name(), &own, density, bin_ps, Some(cost))
        };
        let mut decoders: Vec<_> = Decoder::ALL.into_iter().zip(COSTS).map(figures).collect();
        // A hit that has reached one more tap shows another pattern, so the ones count tells all of them apart.
        let ones = p.clone().with_decoder(Decoder::Ones);
        let mut states = CodeDensity::new(&ones, hits, seed);
        states.bins.retain(|bin| bin.true_width_ps > 0.0);
        decoders.push(DecoderFigures::new("states", &ones, states, bin_ps, None));
        Comparison { decoders, patterns: patterns(p), bin_ps }
    }
}

impl DecoderFigures {
    fn new(
        name: &'static str,
        p: &tdc::Params,
        density: CodeDensity,
        bin_ps: f64,
        cost: Option<DecoderCost>,
    ) -> Self {
        let scale = p.decoder.scale;
        let uncalibrated = tdc_decoder::Params::uniform_calibration(&p.delays, &scale);
        let raw = TimeError::new(&p.clone().with_calibration(uncalibrated), &density);
        let calibrated = TimeError::new(p, &density);
        let widths_ps = density.true_ps();
        let codes = widths_ps.iter().filter(|ps| **ps > 0.0).count();
        DecoderFigures {
            name,
            codes,
            empty: widths_ps.len() - codes,
            lsb_ps: density.lsb_ps(),
            dnl: Spread::of(&density.dnl(&widths_ps)),
            widest_ps: Spread::of(&widths_ps).largest,
            equivalent_ps: CodeDensity::equivalent_ps(&widths_ps),
            raw_precision_ps: raw.precision_ps,
            precision_ps: calibrated.precision_ps,
            raw_off_by_a_bin: off(&raw, &density, bin_ps),
            off_by_a_bin: off(&calibrated, &density, bin_ps),
            luts: cost.map(|cost| cost.luts),
            ffs: cost.map(|cost| cost.ffs),
            density,
        }
    }
}

/// Part of the hits whose time, but for the mean error, is off by more than that.
fn off(error: &TimeError, density: &CodeDensity, most_ps: f64) -> f64 {
    let bins = error.errors_ps.iter().zip(&density.bins);
    let beyond = bins.map(|(middle_ps, bin)| {
        // Errors of its hits are spread evenly over its width.
        let half_ps = bin.true_width_ps / 2.0;
        let above = (middle_ps + half_ps - most_ps).clamp(0.0, bin.true_width_ps);
        let below = (half_ps - middle_ps - most_ps).clamp(0.0, bin.true_width_ps);
        above + below
    });
    beyond.sum::<f64>() / density.period_ps
}

/// Each pattern that hits show, by the phases at which they do.
fn patterns(p: &tdc::Params) -> Vec<Read> {
    let encoders = Decoder::ALL.map(|decoder| Encoder::new(decoder, &p.delays));
    let reached = CodeDensity::new(&p.clone().with_decoder(Decoder::Ones), 0, 0);
    let mut found: BTreeMap<(String, [usize; 3]), f64> = BTreeMap::new();
    bubbles::each_phase(&p.delays, &reached, |levels, rank, share| {
        let below = levels.iter().position(|level| !level).unwrap_or(levels.len());
        let numbers = encoders.each_ref().map(|encoder| encoder.of_rank(rank) - below);
        let pattern = bubbles::shown(bubbles::between(levels));
        *found.entry((pattern, numbers)).or_default() += share;
    });
    let read = |((levels, numbers), share)| Read { levels, share, numbers };
    let mut patterns: Vec<_> = found.into_iter().map(read).collect();
    patterns.sort_by(|a, b| b.share.total_cmp(&a.share));
    patterns
}
