//! Which avalanche and which shot a hit of the TDC is of, and which shot an avalanche.

use std::collections::VecDeque;

use crate::firmware::tof_top::Params;
use crate::kernel::Time;
use crate::optics::hazard::Cause;

/// Avalanches that may still travel in the chain, and then some.
const KEPT: usize = 16;
/// Cycles from the one of `start` to the first in which a hit of that shot can be latched.
const FIRST_LATCH: u64 = 2;

/// The last avalanches, each with what is known of it.
#[derive(Clone, Debug)]
pub(super) struct LastAvalanches<T> {
    /// Oldest first.
    avalanches: VecDeque<(Time, T)>,
}

impl<T> Default for LastAvalanches<T> {
    fn default() -> Self {
        LastAvalanches { avalanches: VecDeque::new() }
    }
}

impl<T: Copy> LastAvalanches<T> {
    /// Adds an avalanche at `at`.
    pub(super) fn push(&mut self, at: Time, what: T) {
        self.avalanches.push_back((at, what));
        if self.avalanches.len() > KEPT {
            self.avalanches.pop_front();
        }
    }

    /// Returns the avalanche of a hit whose taps were sampled at the edge at `sampled`.
    pub(super) fn of_hit(&self, sampled: Time, p: &Params) -> Option<(Time, T)> {
        let tap_0 = p.tdc.delays.tap_0();
        self.avalanches.iter().rfind(|(at, _)| *at + tap_0 <= sampled).copied()
    }
}

/// Avalanches that no edge has passed yet, with their causes.
///
/// How far a device has gone by the time that its registers are shown depends on who else observes it, and it has gone
/// past the edge: what comes after the edge belongs to the shot that begins with it.
#[derive(Clone, Debug, Default)]
pub(super) struct ComingAvalanches {
    /// Oldest first.
    avalanches: VecDeque<(Time, Option<Cause>)>,
}

impl ComingAvalanches {
    /// Adds an avalanche at `at`.
    pub(super) fn push(&mut self, at: Time, cause: Option<Cause>) {
        self.avalanches.push_back((at, cause));
    }

    /// Takes the next avalanche before an edge at `now`, which is of the shot before it.
    pub(super) fn take_before(&mut self, now: Time) -> Option<(Time, Option<Cause>)> {
        let is_before = self.avalanches.front().is_some_and(|(at, _)| *at < now);
        if is_before { self.avalanches.pop_front() } else { None }
    }

    /// Takes the next avalanche at an edge at `now` itself, which is of the shot that may begin with it.
    pub(super) fn take_at(&mut self, now: Time) -> Option<(Time, Option<Cause>)> {
        self.take_before(now.saturating_add(Time::from_fs(1)))
    }
}

/// Returns whether a hit that is latched in cycle `latched` can be of the shot whose `start` was in cycle `begun`; it is
/// of the last such shot.
pub(super) fn may_be_of(begun: u64, latched: u64) -> bool {
    begun + FIRST_LATCH <= latched
}
