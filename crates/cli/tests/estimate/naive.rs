//! The firmware's estimator in plain integers, written without a look at the other.

use std::fmt::Write as _;

use tofsim::network::Histogram;

/// A small generator of random words (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, limit: u64) -> u64 {
        self.word() % limit
    }

    /// A 16-bit word, now and then one of its ends, made smaller by a shift.
    fn weight(&mut self, shift: u32) -> i128 {
        let word = match self.below(16) {
            0 => -32768,
            1 => 32767,
            _ => i128::from(self.word() as i16),
        };
        word >> shift
    }
}

/// A network as plain integers.
pub struct Naive {
    w1: Vec<Vec<i128>>,
    b1: Vec<i128>,
    w2: Vec<i128>,
    b2: i128,
}

/// The signed integer that the low 36 bits of a number make.
fn wrap_36(number: i128) -> i128 {
    let low = number.rem_euclid(1 << 36);
    if low >= 1 << 35 { low - (1 << 36) } else { low }
}

/// tanh(address / 512) x 2^15 to the nearest integer, at most 32767.
pub fn activation(address: i128) -> i128 {
    let exact = (address.abs() as f64 / 512.0).tanh() * 32768.0;
    let nearest = ((exact + 0.5).floor() as i128).min(32767);
    if address < 0 { -nearest } else { nearest }
}

impl Naive {
    pub fn random(random: &mut Random, neurons: usize, shift: u32) -> Naive {
        let each = 0..neurons;
        Naive {
            w1: each.clone().map(|_| (0..256).map(|_| random.weight(shift)).collect()).collect(),
            b1: each.clone().map(|_| random.weight(shift)).collect(),
            w2: each.map(|_| random.weight(0)).collect(),
            b2: random.weight(0),
        }
    }

    /// Every weight the same.
    pub fn constant(neurons: usize, weight: i128) -> Naive {
        Naive {
            w1: vec![vec![weight; 256]; neurons],
            b1: vec![weight; neurons],
            w2: vec![weight; neurons],
            b2: weight,
        }
    }

    /// Depth and sums as integers.
    pub fn estimate(&self, histogram: &Histogram) -> (i128, Vec<i128>) {
        let mut sums = Vec::new();
        let mut depth = self.b2 * 4096;
        for neuron in 0..self.w2.len() {
            let mut sum = self.b1[neuron] * 1024;
            for (bin, &count) in histogram.iter().enumerate() {
                sum += self.w1[neuron][bin] * i128::from(count);
            }
            let sum = wrap_36(sum);
            // The nearest multiple of 2^14, halves up.
            let address = (sum + 8192).div_euclid(16384).clamp(-2048, 2047);
            depth += self.w2[neuron] * activation(address);
            sums.push(sum);
        }
        (wrap_36(depth), sums)
    }

    pub fn toml(&self) -> String {
        let mut text = String::from(
            "schema = 'tofsim.network/1'\ndescription = 'random'\n\
             training = { origin = 'none', chain = 'none' }\n\
             scaling = { input = 'counts', output = 'metres', normalisation = 'folded' }\n\
             [formats]\nw1 = { width = 16, fraction = 23 }\nb1 = { width = 16, fraction = 13 }\n\
             w2 = { width = 16, fraction = 14 }\nb2 = { width = 16, fraction = 17 }\n\
             l1_out = { width = 16, fraction = 15 }\n\
             tansig = { address_bits = 12, range = 4 }\n[integers]\n",
        );
        let (w1, b1, w2, b2) = (&self.w1, &self.b1, &self.w2, self.b2);
        writeln!(text, "w1 = {w1:?}\nb1 = {b1:?}\nw2 = {w2:?}\nb2 = {b2}").unwrap();
        text
    }
}

/// Hand-made extremes, then random histograms of at most 65,535 hits.
pub fn histograms(random: &mut Random) -> Vec<Histogram> {
    let of = |word: &dyn Fn(usize) -> u32| (0..256).map(word).collect::<Histogram>();
    let one = |bin: usize, count| of(&|k| if k == bin { count } else { 0 });
    let alternating = |odd| of(&|k| if k % 2 == odd { 500 } else { 0 });
    let mut list = vec![vec![0; 256], one(0, 30_000), one(255, 30_000), one(100, 65_535)];
    list.extend([alternating(0), alternating(1), vec![255; 256], one(128, 1)]);
    for _ in 0..24 {
        let hits = random.below(65_536);
        let (first, span) = (random.below(200), 1 + random.below(56));
        let mut histogram = vec![0; 256];
        for _ in 0..hits {
            histogram[(first + random.below(span)) as usize] += 1;
        }
        list.push(histogram);
    }
    list
}
