//! Random numbers of a training: seeds of its data, and starting points.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use tofsim::sensor::streams::uniform;

use super::recipe::RandomStart;
use super::sums::parameters;

/// Place of the starting points' seed among those of a training; the data's are in [`super::data`].
const STARTS: u64 = 1;

/// A seed of its own for each purpose: a step of SplitMix64 (Steele, Lea and Flood, 2014).
pub fn derived(seed: u64, place: u64) -> u64 {
    let mut word = seed.wrapping_add(0x9e37_79b9_7f4a_7c15u64.wrapping_mul(place));
    word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// Parameters of so many neurons with so many columns to begin with; each start has random numbers of its own.
pub fn start(settings: &RandomStart, size: [usize; 2], seed: u64, number: usize) -> Vec<f64> {
    let [neurons, columns] = size;
    let mut random = ChaCha8Rng::seed_from_u64(derived(seed, STARTS));
    random.set_stream(number as u64);
    let length = settings.lengths[number % settings.lengths.len()];
    let mut x = Vec::with_capacity(parameters(neurons, columns));
    for k in 0..neurons {
        let row: Vec<f64> = (1..columns).map(|_| normal(&mut random)).collect();
        let norm = row.iter().map(|weight| weight * weight).sum::<f64>().sqrt();
        x.extend(row.iter().map(|weight| weight / norm * length));
        let share = if neurons > 1 { k as f64 / (neurons - 1) as f64 } else { 0.5 };
        x.push(settings.bias * (2.0 * share - 1.0));
    }
    x.extend((0..neurons).map(|_| settings.output_m * (2.0 * uniform(random.next_u64()) - 1.0)));
    x.push(0.0);
    debug_assert_eq!(x.len(), parameters(neurons, columns));
    x
}

/// A normal number (Box and Muller, 1958).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let [radius, turn] = [uniform(random.next_u64()), uniform(random.next_u64())];
    (-2.0 * libm::log(radius)).sqrt() * libm::cos(2.0 * std::f64::consts::PI * turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::recipe::Recipe;

    #[test]
    fn a_start_is_as_the_recipe_says() {
        let settings = Recipe::default().start;
        for (number, length) in [(0, 0.1), (1, 0.3), (2, 0.1)] {
            let x = start(&settings, [8, 72], 1, number);
            assert_eq!(x.len(), parameters(8, 72));
            for (k, row) in x.chunks_exact(72).take(8).enumerate() {
                let norm = row[..71].iter().map(|weight| weight * weight).sum::<f64>().sqrt();
                assert!((norm - length).abs() < 1e-12);
                assert!((row[71] - (k as f64 / 3.5 - 1.0)).abs() < 1e-12);
            }
            assert!(x[8 * 72..].iter().all(|weight| weight.abs() <= 0.1));
        }
        assert_ne!(start(&settings, [8, 72], 1, 0), start(&settings, [8, 72], 1, 2));
        assert_ne!(start(&settings, [8, 72], 1, 0), start(&settings, [8, 72], 2, 0));
        assert_eq!(start(&settings, [1, 88], 1, 0).len(), parameters(1, 88));
    }

    #[test]
    fn no_two_purposes_share_a_seed() {
        let places = [STARTS, 2, 3, 4].into_iter().chain(16..21);
        let mut seeds: Vec<_> =
            places.flat_map(|place| [1, 2].map(|seed| derived(seed, place))).collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 18);
    }
}
