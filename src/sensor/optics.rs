//! Light simulated from the link budget.
//!
//! One time per avalanche is drawn from the cumulative hazard of the shot. A shot begins with its laser edge; the
//! pending avalanche is then drawn again, which is exact because photons before and after an instant are
//! independent.

use std::sync::Arc;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use crate::kernel::Time;
use crate::optics::hazard::varied::Varied;
use crate::optics::hazard::{Cause, Hazard};

use super::blocks::{BLOCK, Blocks, WORDS};
use super::streams::{Seeds, Source, exponential, normal, seek, stream, uniform};

/// Light simulated from the link budget.
#[derive(Clone, Debug)]
pub struct Optics {
    /// Hazard of a shot with the laser, and of a shot without.
    hazards: Arc<[Hazard; 2]>,
    seeds: Seeds,
    first: ChaCha8Rng,
    further: ChaCha8Rng,
    causes: ChaCha8Rng,
    pulses: ChaCha8Rng,
    /// Deviations of the present pulse's time and energy from their means [standard deviations]; `None` if all shots
    /// are equal.
    pulse: Option<[f64; 2]>,
    /// Whether the present shot has a laser pulse.
    lit: bool,
    /// Start of the present shot.
    origin: Time,
    /// Number of the present shot in its frame; 0 is the time before the first shot.
    shot: u64,
    /// Random word of the shot's first avalanche, until it is used.
    word: Option<u64>,
    /// Cumulative hazard at the last avalanche drawn [1].
    reached: f64,
    /// Time of the last avalanche that was consumed and the cumulative hazard there, until the next draw.
    taken: Option<(Time, f64)>,
    /// Number of further avalanches, and of causes, drawn in this shot.
    further_drawn: u64,
    causes_drawn: u64,
}

impl Optics {
    /// Creates light with the hazards of a shot with and without laser pulse, before the first frame.
    pub fn new(lit: Hazard, dark: Hazard, seeds: impl Into<Seeds>) -> Self {
        let seeds = seeds.into();
        let Seeds { pixel, row } = seeds;
        Optics {
            hazards: Arc::new([dark, lit]),
            seeds,
            first: stream(pixel, Source::Avalanche, 0),
            further: stream(pixel, Source::FurtherAvalanches, 0),
            causes: stream(pixel, Source::Cause, 0),
            pulses: stream(row, Source::LaserPulse, 0),
            pulse: None,
            lit: false,
            origin: Time::ZERO,
            shot: 0,
            word: None,
            reached: 0.0,
            taken: None,
            further_drawn: 0,
            causes_drawn: 0,
        }
    }

    pub(super) fn begin_frame(&mut self, frame: u64) {
        let Seeds { pixel, row } = self.seeds;
        self.first = stream(pixel, Source::Avalanche, frame);
        self.further = stream(pixel, Source::FurtherAvalanches, frame);
        self.causes = stream(pixel, Source::Cause, frame);
        self.pulses = stream(row, Source::LaserPulse, frame);
        (self.shot, self.further_drawn, self.causes_drawn) = (0, 0, 0);
    }

    #[inline(always)]
    pub(super) fn begin_shot(&mut self, now: Time, laser: bool) {
        (self.origin, self.lit) = (now, laser);
        self.taken = None;
        self.shot += 1;
        self.word = Some(self.first.next_u64());
        (self.further_drawn, self.causes_drawn) = (0, 0);
        if !self.hazards[1].variation().is_none() {
            self.draw_pulse();
        }
    }

    /// Draws the time and energy of a shot's pulse, also in a shot without laser.
    #[cold]
    fn draw_pulse(&mut self) {
        seek(&mut self.pulses, self.shot, 0);
        let drawn = [(); 2].map(|()| normal(self.pulses.next_u64()));
        self.pulse = self.lit.then_some(drawn);
    }

    /// Returns the hazard of a shot with or without laser pulse.
    pub fn hazard(&self, lit: bool) -> &Hazard {
        &self.hazards[lit as usize]
    }

    /// Skips `shots` shots that have at most one avalanche each, and passes their random words to `take`, many at once
    /// and in any order.
    #[inline]
    pub fn pass(&mut self, shots: u64, mut take: impl FnMut(&[u64])) {
        let in_order = |stream: &mut ChaCha8Rng, count: u64, take: &mut dyn FnMut(&[u64])| {
            let mut words = [0; WORDS];
            let words = &mut words[..count as usize];
            stream.fill(words);
            take(words);
        };
        // The rest of a block, whole blocks, the begin of another one.
        let rest = self.first.get_word_pos().wrapping_neg() % BLOCK / 2;
        let before = shots.min(rest as u64);
        in_order(&mut self.first, before, &mut take);
        let (groups, after) = ((shots - before) / WORDS as u64, (shots - before) % WORDS as u64);
        if groups > 0 {
            let (mut blocks, mut words) = (Blocks::of(&self.first), [0; WORDS]);
            for _ in 0..groups {
                blocks.fill(&mut words);
                take(&words);
            }
            let passed = u128::from(groups) * 2 * WORDS as u128;
            self.first.set_word_pos(self.first.get_word_pos() + passed);
        }
        in_order(&mut self.first, after, &mut take);
        self.shot += shots;
    }

    #[inline(always)]
    pub(super) fn next_avalanche(&mut self, now: Time, share: f64) -> Time {
        let word = match self.word.take() {
            Some(word) => word,
            None => self.further_word(),
        };
        if self.pulse.is_some() || self.taken.is_some() {
            return self.next_of(now, exponential(word) * share);
        }
        let hazard = &self.hazards[self.lit as usize];
        self.reached = hazard.at(now.since(self.origin)) + exponential(word) * share;
        self.origin.saturating_add(hazard.inverse(self.reached)).max(now)
    }

    /// Draws the next avalanche in a shot whose pulse varies, or after a carrier. It may coincide with the last one,
    /// as with photons that the pulse puts before the laser edge.
    #[cold]
    fn next_of(&mut self, now: Time, further: f64) -> Time {
        let hazard = &self.hazards[self.lit as usize];
        let varied: Option<Varied> = self.pulse.map(|pulse| hazard.varied(pulse));
        let since = now.since(self.origin);
        let begin = match (self.taken.take(), &varied) {
            (Some((at, reached)), _) if at == now => reached,
            (_, Some(shot)) => shot.at(since),
            (_, None) => hazard.at(since),
        };
        self.reached = begin + further;
        let next = match &varied {
            Some(shot) => shot.inverse(self.reached),
            None => hazard.inverse(self.reached),
        };
        self.origin.saturating_add(next).max(now)
    }

    #[cold]
    fn further_word(&mut self) -> u64 {
        if self.further_drawn == 0 {
            seek(&mut self.further, self.shot, 0);
        }
        self.further_drawn += 1;
        self.further.next_u64()
    }

    /// Consumes the avalanche at `at`, the last one drawn.
    pub(super) fn take(&mut self, at: Time) {
        self.taken = Some((at, self.reached));
    }

    /// Replaces the hazards by those of another scene.
    pub(super) fn change(&mut self, other: &Optics) {
        self.hazards = Arc::clone(&other.hazards);
    }

    pub(super) fn dark_part(&self, at: Time) -> f64 {
        let hazard = &self.hazards[self.lit as usize];
        let since = at.since(self.origin);
        match self.pulse {
            Some(pulse) => hazard.varied(pulse).dark_part(since),
            None => hazard.dark_part(since),
        }
    }

    pub(super) fn cause(&mut self, at: Time, dark: Option<f64>) -> Cause {
        seek(&mut self.causes, self.shot, self.causes_drawn);
        self.causes_drawn += 1;
        let (since, mut draw) = (at.since(self.origin), uniform(self.causes.next_u64()));
        if let Some(dark) = dark {
            if draw >= 1.0 - dark {
                return Cause::Dark;
            }
            // Among those that come of light it is uniform up to their part.
            draw *= (1.0 - self.dark_part(at)) / (1.0 - dark);
        }
        let hazard = &self.hazards[self.lit as usize];
        match self.pulse {
            Some(pulse) => hazard.varied(pulse).cause(since, draw),
            None => hazard.cause(since, draw),
        }
    }
}
