//! The KC705's datapath in the types of thesis Table 6.4, against the one whose formats are parameters.
//!
//! Each word is a type of its own, so that a binary point in the wrong place does not compile or shows here; the
//! parametric datapath counts in plain integers.

use fixed::types::extra::{U4, U9, U13, U14, U15, U17, U23, U29};
use fixed::{FixedI16, FixedI32, FixedI64};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use tofsim::firmware::depth_estimator::Params;
use tofsim::firmware::depth_estimator::datapath::Datapath;
use tofsim::firmware::forward2::NEURONS;
use tofsim::kernel::wrapped;
use tofsim::network::{Histogram, Network, estimate};
use tofsim::{DepthM, Setup};

/// Histograms of each network.
const HISTOGRAMS: usize = 5_000;
/// Width of a sum and of the depth [bits].
const SUM_BITS: u32 = 36;

/// Weight of the hidden layer; 16 bits, of which the point is past the first.
type W1 = FixedI32<U23>;
/// Bias of the hidden layer.
type B1 = FixedI16<U13>;
/// Sum of a hidden neuron.
type L1In = FixedI64<U23>;
/// Address of the table: a sum in steps of 2^-9.
type Address = FixedI64<U9>;
/// Activation.
type L1Out = FixedI16<U15>;
/// Weight of the output layer [m].
type W2 = FixedI16<U14>;
/// Bias of the output layer [m]; 16 bits, of which the point is past the first.
type B2 = FixedI32<U17>;

/// A network of the thesis's size and formats.
struct Typed {
    w1: Vec<[W1; NEURONS]>,
    b1: [B1; NEURONS],
    w2: [W2; NEURONS],
    b2: B2,
}

impl Typed {
    fn new(params: &Params) -> Self {
        let (hidden, output) = (&params.forward1, &params.forward2);
        let eight = |of: &dyn Fn(usize) -> i64| -> [i64; NEURONS] { std::array::from_fn(of) };
        let row = |row: &[_]| eight(&|k| tofsim::kernel::S::<24>::get(row[k]));
        Typed {
            w1: hidden.w1.iter().map(|one| row(one).map(|w| W1::from_bits(w as i32))).collect(),
            b1: row(&hidden.b1).map(|b| B1::from_bits(b as i16)),
            w2: row(&output.w2).map(|w| W2::from_bits(w as i16)),
            b2: B2::from_bits(output.b2.get() as i32),
        }
    }

    fn depth(&self, histogram: &[u32]) -> DepthM {
        let activation = |neuron: usize| {
            let products = self
                .w1
                .iter()
                .zip(histogram)
                .map(|(row, &count)| L1In::from(row[neuron]) * i64::from(count));
            let sum = products.fold(L1In::from(self.b1[neuron]), |sum, product| sum + product);
            tansig(L1In::from_bits(wrapped(sum.to_bits(), SUM_BITS)))
        };
        // An activation times its weight has the depth's 29 fraction bits.
        let term =
            |neuron: usize| FixedI64::<U29>::from(activation(neuron).wide_mul(self.w2[neuron]));
        let sum = (0..NEURONS).map(term).fold(DepthM::from_num(self.b2), |sum, term| sum + term);
        DepthM::from_bits(wrapped(sum.to_bits(), SUM_BITS))
    }
}

/// The hyperbolic tangent of a sum, rounded half up to a step of 2^-9 within +-4, as a word of 16 bits: the only
/// rounding of the datapath.
fn tansig(l1_in: L1In) -> L1Out {
    let half = Address::DELTA.to_num::<L1In>() / 2;
    let address = Address::from_num(l1_in + half);
    let address = address.clamp(Address::from_num(-4), Address::from_num(4) - Address::DELTA);
    let exact = libm::tanh(address.to_num()) * f64::from(1 << L1Out::FRAC_NBITS);
    L1Out::from_bits(exact.round().min(f64::from(i16::MAX)) as i16)
}

/// A histogram of any shape whose total the words bear: an echo, spikes, or noise.
fn histogram(random: &mut impl Rng) -> Histogram {
    let hits = random.random_range(0..65_536u32);
    let mut counts = vec![0; 256];
    let (centre, width) = (random.random_range(0..256), random.random_range(1..128));
    for _ in 0..random.random_range(1..400) {
        let bin = (centre + random.random_range(0..width)) % 256;
        counts[bin] += random.random_range(0..=hits / 400);
    }
    counts.into_iter().collect()
}

fn check(name: &str, seed: u64) {
    let network = Network::builtin(name).unwrap().unwrap();
    assert_eq!(network.datapath, Datapath::THESIS, "{name}");
    let params = network.params(&Default::default());
    let (typed, mut random) = (Typed::new(&params), ChaCha8Rng::seed_from_u64(seed));
    let mut depths = std::collections::BTreeSet::new();
    for place in 0..HISTOGRAMS {
        let histogram = histogram(&mut random);
        let expected = estimate(&params, &histogram).depth;
        let found = typed.depth(&histogram);
        assert_eq!(found.to_bits(), expected.get(), "{name}, histogram {place}: {histogram:?}");
        depths.insert(found);
    }
    assert!(depths.len() > HISTOGRAMS / 2, "{name}: {} depths", depths.len());
}

#[test]
fn the_parametric_datapath_gives_the_words_of_table_6_4_in_10_000_histograms() {
    check("uniform", 1);
    check("ideal", 2);
}

/// Time from the laser edge, in the KC705's units of a 16th of a bin [bins].
type BinTime = FixedI32<U4>;

#[test]
fn a_code_of_the_kc705_is_the_whole_bins_of_its_time() {
    let setup = Setup::load("kc705", &["tdc.profile=kintex7"]).unwrap();
    let decoder = &setup.params.tdc.decoder;
    let period = BinTime::from_num(320);
    let mut codes = 0;
    for (n, age) in decoder.cal.iter().enumerate() {
        let age = BinTime::from_bits(age.get() as i32);
        for coarse in 0..8 {
            let time = period * (coarse + 1) - age;
            let code = (0..256).contains(&time.floor().to_num::<i32>()).then(|| time.to_num());
            let found = decoder.code(coarse as u64, n).map(|code| code.get() as i32);
            assert_eq!(found, code, "edge {coarse}, {n} taps");
            codes += usize::from(code.is_some());
        }
    }
    assert!(codes > 400, "{codes} of the taps have a code");
}
