//! The diodes of a row one by one, where it matters which of them fires: afterpulses, crosstalk, dark rates
//! that differ, and a dead time that starts again.
//!
//! Carriers (photons, and those of the dark) come to all diodes together, and each picks its diode, so that one
//! that comes to a diode at rest is lost: that is exact for any rates. An avalanche traps a carrier with some
//! chance, and it comes back after an exponential time as a carrier of that diode; traps of a second kind may
//! have another mean time. An avalanche sets off each neighbour with some chance too, at the same instant.

use std::ops::Range;

use crate::kernel::Time;

use super::streams::{Source, Stretches, exponential, uniform};

/// What the diodes of a row do beside firing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// Chance that an avalanche traps a carrier [1].
    pub afterpulse_probability: f64,
    /// Mean time until that is released [fs].
    pub afterpulse_fs: f64,
    /// The same in a trap of the second kind [fs].
    pub afterpulse_second_fs: f64,
    /// Part of the trapped carriers that are in one [1].
    pub afterpulse_second_share: f64,
    /// Whether a carrier within the dead time of MODE 1 starts it again.
    pub paralysable: bool,
    /// Chance that an avalanche sets off a neighbour [1].
    pub crosstalk_probability: f64,
    /// Dark rate of each diode, if they differ, to a common factor [1].
    pub dark_rates: Vec<f64>,
    /// Those whose OR is `tdc_stop`, where a whole row is followed; otherwise all.
    pub on_tdc: Option<Range<usize>>,
}

impl Effects {
    /// The kinds of traps: what part of the trapped carriers they have, and the mean time there [1, fs].
    pub fn traps(&self) -> [(f64, f64); 2] {
        let share = self.afterpulse_second_share;
        [(1.0 - share, self.afterpulse_fs), (share, self.afterpulse_second_fs)]
    }

    /// The longest mean time of a trap that there is [fs].
    pub fn longest_trap_fs(&self) -> f64 {
        let there = self.traps().into_iter().filter(|(share, _)| *share > 0.0);
        there.map(|(_, mean_fs)| mean_fs).fold(0.0, f64::max)
    }

    /// Chance that an avalanche traps a carrier which is released after so long or later [1].
    pub fn released_after(&self, fs: f64) -> f64 {
        let late = |(share, mean_fs): (f64, f64)| match share > 0.0 {
            true => share * libm::exp(-fs / mean_fs),
            false => 0.0,
        };
        self.afterpulse_probability * self.traps().map(late).iter().sum::<f64>()
    }

    /// Whether that many diodes do nothing but fire, all of them alike and on the TDC.
    pub fn are_none(&self, count: usize) -> bool {
        if self.on_tdc.is_some() {
            return false;
        }
        let together = self.crosstalk_probability == 0.0 && self.dark_rates.is_empty();
        self.afterpulse_probability == 0.0 && !self.paralysable && (together || count == 1)
    }
}

/// The row.
#[derive(Clone, Debug)]
pub struct Row {
    effects: Effects,
    /// Those on the TDC.
    on_tdc: Range<usize>,
    /// When the dead time of each ends that has fired.
    dead: Vec<Option<Time>>,
    /// Trapped carriers, the next one to be released last: when, and in which diode.
    trapped: Vec<(Time, usize)>,
    afterpulses: Stretches,
    neighbours: Stretches,
    diodes: Stretches,
}

impl Row {
    /// That many diodes, armed.
    pub fn new(count: usize, effects: Effects, seed: u64) -> Self {
        let stretches = |source| Stretches::new(seed, source);
        Row {
            on_tdc: effects.on_tdc.clone().unwrap_or(0..count),
            effects,
            dead: vec![None; count],
            trapped: Vec::new(),
            afterpulses: stretches(Source::Afterpulse),
            neighbours: stretches(Source::Crosstalk),
            diodes: stretches(Source::Diode),
        }
    }

    /// What they do.
    pub fn effects(&self) -> &Effects {
        &self.effects
    }

    /// A new frame begins.
    pub fn begin_frame(&mut self, frame: u64) {
        self.streams().into_iter().for_each(|stream| stream.begin_frame(frame));
    }

    /// A shot begins.
    pub fn begin_shot(&mut self) {
        self.streams().into_iter().for_each(Stretches::begin_shot);
    }

    fn streams(&mut self) -> [&mut Stretches; 3] {
        [&mut self.afterpulses, &mut self.neighbours, &mut self.diodes]
    }

    /// All are armed; what is trapped stays so.
    pub fn arm_all(&mut self) {
        self.dead.fill(None);
    }

    /// The quench mode changes: no dead time ends before `now`.
    pub fn not_before(&mut self, now: Time) {
        self.dead.iter_mut().flatten().for_each(|until| *until = now.max(*until));
    }

    /// The dead times that are not over, the first to end first.
    pub fn fired(&self) -> impl Iterator<Item = Time> {
        let mut fired: Vec<_> = self.dead.iter().flatten().copied().collect();
        fired.sort_unstable();
        fired.into_iter()
    }

    /// How many have fired, that are not on the TDC.
    pub fn unwired(&self) -> usize {
        let others = self.dead.iter().enumerate().filter(|(place, _)| !self.on_tdc.contains(place));
        others.filter(|(_, dead)| dead.is_some()).count()
    }

    /// The outputs that are high, a bit each.
    pub fn outputs(&self) -> u64 {
        let bit = |(place, dead): (usize, &Option<Time>)| u64::from(dead.is_some()) << place;
        self.dead.iter().take(u64::BITS as usize).enumerate().map(bit).sum()
    }

    /// The part of the rate that a diode has in the dark, where `dark` of all diodes' rate is that of the dark [1].
    pub fn dark_part(&self, diode: usize, dark: f64) -> f64 {
        let rates = &self.effects.dark_rates;
        let Some(own) = rates.get(diode) else { return dark };
        let own = dark * own / rates.iter().sum::<f64>();
        let light = (1.0 - dark) / self.dead.len() as f64;
        if own > 0.0 { own / (own + light) } else { 0.0 }
    }

    /// When the next trapped carrier is released.
    pub fn release(&self) -> Time {
        self.trapped.last().map_or(Time::NEVER, |(at, _)| *at)
    }

    /// The dead time of those that end it at `now` is over.
    pub fn recover(&mut self, now: Time) {
        for until in &mut self.dead {
            *until = until.filter(|until| *until > now);
        }
    }

    /// Releases the next trapped carrier, and says in which diode.
    pub fn released(&mut self) -> Option<usize> {
        self.trapped.pop().map(|(_, diode)| diode)
    }

    /// The diode that a carrier comes to, where `dark` of the rate is that of the dark [1].
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

    /// A carrier in a diode at `now`; whether there is an avalanche of one on the TDC. `again` if it starts a dead time
    /// again.
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

    /// An avalanche at `now` may trap a carrier.
    fn trap(&mut self, diode: usize, now: Time) {
        let chance = self.effects.afterpulse_probability;
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

    /// It may set its neighbours off.
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
