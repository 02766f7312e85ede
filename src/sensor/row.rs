//! SPADs of a row tracked individually, which is required for afterpulsing, crosstalk, unequal dark rates and
//! paralysable dead time.
//!
//! Photons and dark carriers arrive for the row as a whole, and each picks a SPAD; a carrier that picks a SPAD that
//! is not armed is lost, which is exact for any rates. An avalanche traps a carrier with a given probability, and the
//! carrier is released in the same SPAD after an exponential time; a second kind of trap may have another mean
//! lifetime. With another probability, an avalanche fires each neighbour at the same instant.

use std::ops::Range;

use crate::kernel::Time;

use super::streams::{Source, Stretches, exponential, uniform};

/// Effects that require SPADs to be tracked individually.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// Probability that an avalanche traps a carrier [1].
    pub trap_probability: f64,
    /// Mean lifetime of a trapped carrier [fs].
    pub afterpulse_fs: f64,
    /// Mean lifetime in a trap of the second kind [fs].
    pub afterpulse_second_fs: f64,
    /// Fraction of the trapped carriers that are in traps of the second kind [1].
    pub afterpulse_second_share: f64,
    /// Whether a carrier within the dead time of MODE 1 restarts it.
    pub paralysable: bool,
    /// Probability that an avalanche fires a neighbour [1].
    pub crosstalk_probability: f64,
    /// Relative dark rate of each SPAD, if they differ [1].
    pub dark_rates: Vec<f64>,
    /// SPADs whose OR is `tdc_stop`; `None` for all.
    pub on_tdc: Option<Range<usize>>,
}

impl Effects {
    /// Returns the fraction of trapped carriers and the mean lifetime for each kind of trap [1, fs].
    pub fn traps(&self) -> [(f64, f64); 2] {
        let share = self.afterpulse_second_share;
        [(1.0 - share, self.afterpulse_fs), (share, self.afterpulse_second_fs)]
    }

    /// Returns the longest mean lifetime of the kinds of trap in use [fs].
    pub fn longest_trap_fs(&self) -> f64 {
        let there = self.traps().into_iter().filter(|(share, _)| *share > 0.0);
        there.map(|(_, mean_fs)| mean_fs).fold(0.0, f64::max)
    }

    /// Returns the probability that an avalanche traps a carrier that is released after at least `fs` [1].
    pub fn released_after(&self, fs: f64) -> f64 {
        let late = |(share, mean_fs): (f64, f64)| {
            if share > 0.0 { share * libm::exp(-fs / mean_fs) } else { 0.0 }
        };
        self.trap_probability * self.traps().map(late).iter().sum::<f64>()
    }

    /// Returns whether `count` SPADs have none of the effects, so that they need not be tracked.
    pub fn are_none(&self, count: usize) -> bool {
        if self.on_tdc.is_some() {
            return false;
        }
        let together = self.crosstalk_probability == 0.0 && self.dark_rates.is_empty();
        self.trap_probability == 0.0 && !self.paralysable && (together || count == 1)
    }
}

/// SPADs of a row.
#[derive(Clone, Debug)]
pub struct SpadRow {
    effects: Effects,
    /// SPADs connected to the TDC.
    on_tdc: Range<usize>,
    /// End of each SPAD's dead time, if it has fired.
    dead: Vec<Option<Time>>,
    /// Release time and SPAD of each trapped carrier, next one last.
    trapped: Vec<(Time, usize)>,
    afterpulses: Stretches,
    neighbours: Stretches,
    diodes: Stretches,
}

impl SpadRow {
    /// Creates `count` armed SPADs.
    pub fn new(count: usize, effects: Effects, seed: u64) -> Self {
        let stretches = |source| Stretches::new(seed, source);
        SpadRow {
            on_tdc: effects.on_tdc.clone().unwrap_or(0..count),
            effects,
            dead: vec![None; count],
            trapped: Vec::new(),
            afterpulses: stretches(Source::Afterpulse),
            neighbours: stretches(Source::Crosstalk),
            diodes: stretches(Source::Diode),
        }
    }

    /// Returns the effects.
    pub fn effects(&self) -> &Effects {
        &self.effects
    }

    /// Begins a frame.
    pub fn begin_frame(&mut self, frame: u64) {
        self.streams().into_iter().for_each(|stream| stream.begin_frame(frame));
    }

    /// Begins a shot.
    pub fn begin_shot(&mut self) {
        self.streams().into_iter().for_each(Stretches::begin_shot);
    }

    fn streams(&mut self) -> [&mut Stretches; 3] {
        [&mut self.afterpulses, &mut self.neighbours, &mut self.diodes]
    }

    /// Arms all SPADs. Trapped carriers remain.
    pub fn arm_all(&mut self) {
        self.dead.fill(None);
    }

    /// Extends all dead times to at least `now`, when the quench mode changes.
    pub fn not_before(&mut self, now: Time) {
        self.dead.iter_mut().flatten().for_each(|until| *until = now.max(*until));
    }

    /// Returns the ends of the present dead times, in ascending order.
    pub fn fired(&self) -> impl Iterator<Item = Time> {
        let mut fired: Vec<_> = self.dead.iter().flatten().copied().collect();
        fired.sort_unstable();
        fired.into_iter()
    }

    /// Returns the number of fired SPADs that are not connected to the TDC.
    pub fn unwired(&self) -> usize {
        let others = self.dead.iter().enumerate().filter(|(place, _)| !self.on_tdc.contains(place));
        others.filter(|(_, dead)| dead.is_some()).count()
    }

    /// Returns the outputs, one bit per SPAD.
    pub fn outputs(&self) -> u64 {
        let bit = |(place, dead): (usize, &Option<Time>)| u64::from(dead.is_some()) << place;
        self.dead.iter().take(u64::BITS as usize).enumerate().map(bit).sum()
    }

    /// Returns the dark fraction of a SPAD's rate, where `dark` is that of the whole row [1].
    pub fn dark_part(&self, diode: usize, dark: f64) -> f64 {
        let rates = &self.effects.dark_rates;
        let Some(own) = rates.get(diode) else { return dark };
        let own = dark * own / rates.iter().sum::<f64>();
        let light = (1.0 - dark) / self.dead.len() as f64;
        if own > 0.0 { own / (own + light) } else { 0.0 }
    }

    /// Returns the time at which the next trapped carrier is released.
    pub fn release(&self) -> Time {
        self.trapped.last().map_or(Time::NEVER, |(at, _)| *at)
    }

    /// Rearms the SPADs whose dead time ends at `now`.
    pub fn recover(&mut self, now: Time) {
        for until in &mut self.dead {
            *until = until.filter(|until| *until > now);
        }
    }

    /// Releases the next trapped carrier, and returns its SPAD.
    pub fn released(&mut self) -> Option<usize> {
        self.trapped.pop().map(|(_, diode)| diode)
    }

    /// Draws the SPAD of a carrier, where `dark` is the dark fraction of the rate [1].
    pub fn pick(&mut self, dark: f64) -> usize {
        let count = self.dead.len();
        if count == 1 {
            return 0;
        }
        let [kind, place] = [(); 2].map(|()| uniform(self.diodes.next_u64()));
        let rates = &self.effects.dark_rates;
        if rates.is_empty() || kind >= dark {
            return ((place * count as f64) as usize).min(count - 1);
        }
        let mut left = place * rates.iter().sum::<f64>();
        let found = rates.iter().position(|rate| {
            left -= rate;
            left < 0.0
        });
        found.unwrap_or(count - 1)
    }

    /// Processes a carrier in a SPAD at `now`, and returns whether a SPAD connected to the TDC fires. `again` selects
    /// whether the carrier restarts a dead time.
    pub fn carrier(&mut self, diode: usize, now: Time, dead_time: Time, again: bool) -> bool {
        let until = now.saturating_add(dead_time);
        let mut coming = vec![diode];
        let mut fires = false;
        while let Some(diode) = coming.pop() {
            match &mut self.dead[diode] {
                Some(end) if again => *end = until,
                Some(_) => {}
                armed => {
                    *armed = Some(until);
                    fires |= self.on_tdc.contains(&diode);
                    self.trap(diode, now);
                    self.light_neighbours(diode, &mut coming);
                }
            }
        }
        fires
    }

    /// Draws whether an avalanche at `now` traps a carrier.
    fn trap(&mut self, diode: usize, now: Time) {
        let chance = self.effects.trap_probability;
        if chance == 0.0 {
            return;
        }
        let [drawn, after] = [(); 2].map(|()| self.afterpulses.next_u64());
        let drawn = uniform(drawn);
        if drawn < chance {
            // Among those that are trapped it is uniform up to the chance.
            let is_second = drawn < chance * self.effects.afterpulse_second_share;
            let (_, mean_fs) = self.effects.traps()[usize::from(is_second)];
            let after = Time::from_fs((exponential(after) * mean_fs) as u64);
            let at = now.saturating_add(after);
            let place = self.trapped.partition_point(|(later, _)| *later > at);
            self.trapped.insert(place, (at, diode));
        }
    }

    /// Draws whether an avalanche fires its neighbours.
    fn light_neighbours(&mut self, diode: usize, coming: &mut Vec<usize>) {
        let chance = self.effects.crosstalk_probability;
        if chance == 0.0 {
            return;
        }
        for neighbour in [diode.checked_sub(1), Some(diode + 1)].into_iter().flatten() {
            if uniform(self.neighbours.next_u64()) < chance && neighbour < self.dead.len() {
                coming.push(neighbour);
            }
        }
    }
}

#[cfg(test)]
mod tests;
