//! A table from random words to outcomes of shots.
//!
//! An avalanche comes later, the smaller its word is, so that the staircase of outcomes over time is
//! one over words too: a step that begins at T is reached by words below exp(-H(T)) 2^64. A table
//! over a word's upper bits knows the outcome, or the one place where it changes. Words within
//! [`guard`] of such a place are computed as the cycle-accurate model does it, and so are those in cells
//! with several steps: the outcome is the same to the last bit. A place is stored to 2^-44 of all words, much
//! finer than the guard, so that the table fits into a first-level cache.

use crate::kernel::Time;
use crate::optics::Hazard;
use crate::sensor::streams::exponential;

use super::outcomes::{OUTCOMES, ShotOutcome, ShotOutcomes};

/// Bits of a word that choose a cell.
const CELL_BITS: u32 = 12;

/// Number of outcomes, rounded up to a power of two.
pub const COUNTS: usize = OUTCOMES.next_power_of_two();

/// Stands for an outcome that has to be computed; it is not below [`COUNTS`].
const EXACTLY: ShotOutcome = ShotOutcome::MAX;

/// Bits of a word below those of a place within a cell.
const REST_BITS: u32 = u64::BITS - CELL_BITS - u32::BITS;

/// A part of all words.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Place within the cell of the first word that has to be computed, because the outcome changes nearby; 0 in a
    /// cell with one outcome.
    near: u32,
    /// Outcome of the cell's words before that.
    below: ShotOutcome,
    /// Outcome of those that follow the computed ones.
    above: ShotOutcome,
}

/// The outcomes of all words under one illumination.
#[derive(Clone, Debug)]
pub struct Draws {
    cells: Box<[Cell; 1 << CELL_BITS]>,
    /// Distance from the first to the last word that has to be computed in a cell [places].
    width: u32,
    outcomes: ShotOutcomes,
    hazard: Hazard,
}

impl Draws {
    /// A table for shots with that hazard.
    pub fn new(outcomes: ShotOutcomes, hazard: Hazard) -> Self {
        let guard = guard(&hazard);
        // Both ends of the distance are rounded.
        let places_of_guard = u32::try_from((guard >> REST_BITS) + 2).unwrap_or(u32::MAX);
        let one = |outcome| Cell { near: 0, below: outcome, above: outcome };
        let (mut cells, mut places) = (Box::new([one(EXACTLY); 1 << CELL_BITS]), Vec::new());
        for step in outcomes.steps().windows(2).rev() {
            // The later step has the smaller words.
            places.push((word(-hazard.at(step[1].0)), step[1].1, step[0].1));
        }
        let mut next = 0;
        for (number, cell) in cells.iter_mut().enumerate() {
            let first = (number as u64) << (u64::BITS - CELL_BITS);
            let last = first | u64::MAX >> CELL_BITS;
            while next < places.len() && places[next].0.saturating_add(guard) < first {
                next += 1;
            }
            let near = places[next..].iter();
            let near: Vec<_> =
                near.take_while(|place| place.0.saturating_sub(guard) <= last).collect();
            *cell = match near[..] {
                [] => {
                    let before = next.checked_sub(1).map(|place| places[place].2);
                    let outcome = before.or(places.first().map(|place| place.1));
                    one(outcome.unwrap_or(outcomes.of(Time::ZERO)))
                }
                [&(split, below, above)] if (first..=last).contains(&split) => {
                    Cell { near: place(split).saturating_sub(places_of_guard), below, above }
                }
                _ => one(EXACTLY),
            };
        }
        let width = places_of_guard.saturating_mul(2);
        Draws { cells, width, outcomes, hazard }
    }

    /// Counts the outcomes of shots whose first avalanches are drawn by `words`.
    pub fn count(&self, words: &[u64], counts: &mut [u32; COUNTS]) {
        let (cells, width) = (&*self.cells, self.width);
        for &word in words {
            let cell = cells[(word >> (u64::BITS - CELL_BITS)) as usize];
            // Words before `near` wrap around.
            let (beyond, is_before) = place(word).overflowing_sub(cell.near);
            let outcome = if is_before { cell.below } else { cell.above };
            // One comparison keeps the index within bounds and finds an outcome that has to be computed.
            match counts.get_mut(outcome as usize) {
                Some(count) if beyond > width => *count += 1,
                _ => counts[self.exactly(word) as usize] += 1,
            }
        }
    }

    /// Returns the outcome of an avalanche `arrival` after the laser edge.
    pub fn outcome_at(&self, arrival: Time) -> ShotOutcome {
        self.outcomes.of(arrival)
    }

    /// Computes the outcome as the cycle-accurate model does: the draw, its time, the outcome.
    #[cold]
    fn exactly(&self, word: u64) -> ShotOutcome {
        self.outcomes.of(self.hazard.inverse(exponential(word)))
    }
}

/// Returns the place of a word within its cell.
#[inline(always)]
fn place(word: u64) -> u32 {
    (word >> REST_BITS) as u32
}

/// Returns exp(`exponent`) of the range of words.
fn word(exponent: f64) -> u64 {
    (libm::exp(exponent) * 2f64.powi(64)) as u64
}

/// Number of words on either side of a change of outcome that have to be computed: the rounding error of a time,
/// less than 1e-7 fs, as a part of all words, and ten times that. The other roundings are below
/// 2^-40 of all words.
fn guard(hazard: &Hazard) -> u64 {
    ((2f64.powi(-40) + 1e-6 * hazard.steepest_per_fs()) * 2f64.powi(64)) as u64
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::scenario;
    use crate::sensor::light::Light;
    use crate::sim::setup::Setup;

    fn draws(keys: &[&str], rate: usize, lit: bool) -> Draws {
        let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
        let setup = Setup::new(scenario::load("kc705", &keys).unwrap()).unwrap();
        let Light::Optics(optics) = &setup.light else { panic!("optics") };
        let period = setup.params.vcsel_driver.periods[rate];
        let outcomes = ShotOutcomes::new(&setup.params.tdc, period).unwrap();
        Draws::new(outcomes, optics.hazard(lit).clone())
    }

    #[test]
    fn every_word_has_the_outcome_of_its_arrival() {
        let faint = ["ambient.irradiance_w_m2_nm=0", "spad.dark_rate_hz=100"];
        let none = ["ambient.irradiance_w_m2_nm=0", "spad.dark_rate_hz=0"];
        let sharp = ["laser.pulse_sigma_ps=1", "target.distance_m=0.05"];
        let scenes: [&[&str]; 5] = [&[], &faint, &none, &sharp, &["target.distance_m=0.02"]];
        let mut random = ChaCha8Rng::seed_from_u64(4);
        for (keys, lit) in scenes.into_iter().flat_map(|keys| [(keys, true), (keys, false)]) {
            for rate in [0, 3] {
                let draws = draws(keys, rate, lit);
                let cells = draws.cells.iter().enumerate();
                let near = cells.flat_map(|(cell, of)| {
                    let first = (cell as u64) << (u64::BITS - CELL_BITS);
                    let width = u64::from(draws.width) << REST_BITS;
                    let around = [0, 1, 4097, width / 2, width, width + 1, width + (1 << 21)];
                    around.into_iter().flat_map(move |by| {
                        let near = first + (u64::from(of.near) << REST_BITS);
                        [first.wrapping_sub(by), first.wrapping_add(by)]
                            .into_iter()
                            .chain([near.wrapping_sub(by), near.wrapping_add(by)])
                    })
                });
                let anywhere: Vec<_> = (0..20_000).map(|_| random.next_u64()).collect();
                for word in near.chain(anywhere) {
                    let mut counts = [0; COUNTS];
                    draws.count(&[word], &mut counts);
                    assert_eq!(counts[draws.exactly(word) as usize], 1, "{keys:?} {word:x}");
                }
            }
        }
    }

    #[test]
    fn few_words_have_to_be_worked_out() {
        let draws = draws(&[], 3, true);
        let crowded = draws.cells.iter().filter(|cell| cell.below == EXACTLY).count();
        assert!(crowded < draws.cells.len() / 50, "{crowded} cells");
        assert!(draws.width < 1 << 21, "{:x}", draws.width);
    }
}
