//! Follows some of the signals through every instant at which one may change.
//!
//! A register changes with its own clock, so the levels of the clocks tell what is worth a look.

use crate::firmware::TofTop;
use crate::firmware::tof_top::Clocks;
use crate::kernel::signals::Sink;

use super::{Part, follow};

/// An instant, by what may change at it: with each, all that may change with those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Instant {
    /// No edge of the PLL's clocks: pins, the lock.
    Between,
    /// `clk_250` falls: the DDR output register, and what it drives.
    Fall250,
    /// `clk_250` rises: its registers.
    Rise250,
    /// `clk_125` rises too: everything.
    Rise125,
}

impl Instant {
    /// By the clocks as they are now, and as `clk_250` was.
    #[inline]
    fn of(clk_250: bool, now: &Clocks) -> Self {
        match (clk_250, now.clk_250, now.clk_125) {
            (false, true, true) => Instant::Rise125,
            (false, true, false) => Instant::Rise250,
            (true, false, _) => Instant::Fall250,
            _ => Instant::Between,
        }
    }
}

/// Some of the signals, and what they were at the last instant.
#[derive(Clone, Debug)]
pub struct Instants {
    part: Part,
    /// Level of `clk_250`.
    clk_250: bool,
}

impl Instants {
    /// The signals of those ids.
    pub fn of(ids: impl IntoIterator<Item = usize>) -> Self {
        Instants { part: Part::of(ids, true), clk_250: false }
    }

    /// Reports every signal, whichever ids were asked for.
    pub fn show(&mut self, top: &TofTop, sink: &mut impl Sink) {
        self.clk_250 = top.clocks.clk_250;
        self.part.show(top, sink);
    }

    /// Reports every signal that differs from what it was. After [`Instants::show`] this has to be
    /// called at every edge of `clk_250`, of which every other one is an edge of `clk_125`, and at
    /// every change between them.
    #[inline]
    pub fn follow(&mut self, top: &TofTop, sink: &mut impl Sink) {
        let instant = Instant::of(self.clk_250, &top.clocks);
        self.clk_250 = top.clocks.clk_250;
        let groups = self.part.groups;
        match (instant, &mut self.part.kept) {
            (Instant::Between, Some(kept)) => {
                follow::<{ Instant::Between as u8 }>(top, groups, kept, sink);
            }
            (Instant::Fall250, Some(kept)) => {
                follow::<{ Instant::Fall250 as u8 }>(top, groups, kept, sink);
            }
            (Instant::Rise250, Some(kept)) => {
                follow::<{ Instant::Rise250 as u8 }>(top, groups, kept, sink);
            }
            _ => {
                // The synchronisers are so few that they need not sleep.
                self.part.control_changes();
                self.part.follow(top, sink);
            }
        }
    }

    /// The same where only levels of clocks, the first of all ids, may have changed.
    #[inline(always)]
    pub fn tick(&mut self, top: &TofTop, sink: &mut impl Sink) {
        self.clk_250 = top.clocks.clk_250;
        if let Some(kept) = &mut self.part.kept {
            let (now, then) = (top.clocks.levels(), kept.clocks.levels());
            for (id, (now, then)) in now.into_iter().zip(then).enumerate() {
                if now != then {
                    sink.word(id, u64::from(now));
                }
            }
            kept.clocks = top.clocks;
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::hierarchy::part::tests::{Values, control};
    use crate::hierarchy::{IDS, changes};
    use crate::kernel::Time;
    use crate::kernel::signals::Signals;
    use crate::scenario;
    use crate::sim::device::{Off, SignalProbe};
    use crate::sim::setup::Setup;

    /// Follows every signal, and looks at all of them beside it.
    struct Both {
        instants: Instants,
        followed: Values,
        begun: bool,
        ticks: usize,
        others: usize,
    }

    impl SignalProbe for Both {
        const ON: bool = true;

        fn sample(&mut self, now: Time, top: &TofTop) {
            let mut every = Values(vec![0; IDS]);
            changes(top, None, &mut every);
            if !self.begun {
                self.begun = true;
                self.instants.show(top, &mut self.followed);
            } else if self.others > self.ticks
                && every.0[Clocks::COUNT..] == self.followed.0[Clocks::COUNT..]
            {
                self.ticks += 1;
                self.instants.tick(top, &mut self.followed);
            } else {
                self.others += 1;
                self.instants.follow(top, &mut self.followed);
            }
            assert!(self.followed == every, "at {now}");
        }

        fn tick(&mut self, now: Time, top: &TofTop) {
            let mut every = Values(vec![0; IDS]);
            changes(top, None, &mut every);
            let others = Clocks::COUNT..;
            let still = every.0[others.clone()] == self.followed.0[others];
            assert!(still || !self.begun, "more than clocks at {now}");
            self.sample(now, top);
        }
    }

    #[test]
    fn no_change_is_missed_at_any_instant() {
        for seed in 0..4 {
            let (mut random, cycles) = (ChaCha8Rng::seed_from_u64(seed), 20_000);
            let short = ["firmware.shots_per_frame=30".to_owned()];
            let load = || scenario::load("bright", &short).unwrap();
            let (plain, mut loaded) = (Setup::new(load()).unwrap(), load());
            loaded.scenario.control = control(&plain, cycles, &mut random);
            let setup = Setup::new(loaded).unwrap();
            let mut both = Both {
                instants: Instants::of(0..IDS),
                followed: Values(vec![0; IDS]),
                begun: false,
                ticks: 0,
                others: 0,
            };
            let mut device = setup.device();
            if seed % 2 == 0 {
                device.resume_clocks(Time::ZERO);
                both.sample(Time::ZERO, &device.top);
                device.power_up(&mut both, &mut Off);
            } else {
                device.power_up(&mut Off, &mut Off);
                for _ in 0..random.random_range(0..40) {
                    device.step(&setup.params, &mut Off, &mut Off);
                }
                let edge = device.next_edge();
                device.resume_clocks(edge);
            }
            for _ in 0..cycles {
                device.step(&setup.params, &mut both, &mut Off);
            }
            assert!(both.ticks > 40_000 && both.others > 40_000, "seed {seed}");
        }
    }
}
