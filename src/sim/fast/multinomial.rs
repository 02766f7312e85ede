//! Histograms of a known number of shots, each a multinomial draw.
//!
//! Exact: the same as [`BinProbabilities::draw`], with the binomials of [`super::binomial`].

use pulp::{Arch, Simd, WithSimd};
use rand::Rng;

use crate::optics::BinProbabilities;

use super::binomial::Binomial;

/// Distribution of histograms.
#[derive(Clone, Debug)]
pub(super) struct Multinomial {
    shots: u64,
    bins: usize,
    /// The codes that occur, and the successes among the shots that have none of those before.
    codes: Vec<(usize, Binomial)>,
}

impl Multinomial {
    /// Histograms of `shots` shots, each of which has one of the codes or none.
    pub(super) fn new(codes: &BinProbabilities, shots: u64) -> Self {
        let binomials = codes
            .shares()
            .map(|(code, share, left)| (code, Binomial::new(share, left * shots as f64)));
        Multinomial { shots, bins: codes.of_code().len(), codes: binomials.collect() }
    }

    /// Draws a histogram, and returns with it the number of shots without a code.
    pub(super) fn draw(&self, random: &mut impl Rng) -> (Vec<u32>, u64) {
        let mut histogram = vec![0; self.bins];
        let left = Arch::new().dispatch(Draw { of: self, histogram: &mut histogram, random });
        (histogram, left)
    }
}

/// A draw, compiled for each kind of processor: some have an instruction that rounds.
struct Draw<'a, R> {
    of: &'a Multinomial,
    histogram: &'a mut [u32],
    random: &'a mut R,
}

impl<R: Rng> WithSimd for Draw<'_, R> {
    type Output = u64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> u64 {
        let mut shots_left = self.of.shots;
        for (code, binomial) in &self.of.codes {
            if shots_left == 0 {
                break;
            }
            let count = binomial.draw(shots_left, self.random);
            self.histogram[*code] = count as u32;
            shots_left -= count;
        }
        shots_left
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::sensor::light::Light;
    use crate::sim::setup::Setup;

    #[test]
    fn a_histogram_is_that_of_the_plain_draw() {
        for set in [&[][..], &["target.distance_m=0.1"], &["firmware.laser_en=false"]] {
            let setup = Setup::load("kc705", set).unwrap();
            let Light::Optics(optics) = &setup.light else { panic!("optics") };
            let codes = BinProbabilities::new(optics.hazard(true), &setup.bins());
            for shots in [0, 1, 300, 30_000, 1 << 30] {
                let fast = Multinomial::new(&codes, shots);
                let mut random = ChaCha8Rng::seed_from_u64(shots);
                let mut plain = random.clone();
                for _ in 0..50 {
                    let expected = codes.draw(shots, &mut plain);
                    let (found, left) = fast.draw(&mut random);
                    assert_eq!(left, shots - expected.iter().sum::<u64>());
                    assert!(found.into_iter().map(u64::from).eq(expected), "{set:?} {shots}");
                    assert_eq!(random.get_word_pos(), plain.get_word_pos());
                }
            }
        }
    }
}
